"""`graspfit evaluate` computes every grasp again from the meshes."""

import csv
import io
import json
import pathlib
import shutil
import tempfile

import program


class Evaluate(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.planned = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.planned.cleanup)
        folder = pathlib.Path(cls.planned.name)
        (folder / "torus.off").write_text(program.off_text(*program.torus()))
        # The object has a relative name, so that copies of the folder refer to their own object.
        done = program.run("plan", "torus.off", "--count", "2", "--accept", "usable",
                           "--search", "first", "--out", "out", cwd=folder)
        assert done.returncode == 0, done.stderr

    def setUp(self):
        super().setUp()
        shutil.copytree(self.planned.name, self.folder, dirs_exist_ok=True)
        self.object = self.folder / "torus.off"
        self.file = self.folder / "out/grasps.json"

    def evaluate(self, *arguments):
        return program.run("evaluate", *arguments, cwd=self.folder)

    def changed(self, change):
        data = json.loads(self.file.read_text())
        change(data)
        return self.write("changed.json", json.dumps(data))

    def test_reproduces_what_was_planned(self):
        done = self.evaluate(self.file, "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        report = json.loads(done.stdout)
        self.assertLess(report["largest_m_difference"], 1e-9)
        stored = json.loads(self.file.read_text())["results"]["grasps"]
        self.assertEqual(len(report["grasps"]), len(stored))
        for row, grasp in zip(report["grasps"], stored):
            self.assertTrue(row["same_contacts"])
            self.assertLess(row["largest_difference"], 1e-9)
            self.assertEqual(row["stored"]["m"], grasp["m"])
            self.assertEqual(row["computed"]["valid"], grasp["valid"])

        done = self.evaluate(self.file, "--metrics", "none")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("largest difference of M: ", done.stdout)
        self.assertEqual(len(done.stdout.splitlines()), len(stored) + 2)

    def test_prints_metrics_in_groups_with_their_conventions(self):
        done = self.evaluate(self.file)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for group in ("the paper's measure", "wrench space", "contacts", "penetration"):
            self.assertIn("\n" + group + "\n", done.stdout)
        self.assertIn("graspfit: torques about (", done.stdout)

        rows = list(csv.DictReader(io.StringIO(self.evaluate(self.file, "--csv").stdout)))
        report = json.loads(self.evaluate(self.file, "--json").stdout)["grasps"]
        self.assertEqual(len(rows), sum(len(grasp["metrics"]) for grasp in report))
        for row in rows:
            grasp = report[int(row["grasp"]) - 1]
            metric = grasp["metrics"][row["metric"]]
            value = None if row["value"] == "" else float(row["value"])
            self.assertEqual((value, row["unit"], row["better"], row["convention"]),
                             tuple(metric[key] for key in ("value", "unit", "better",
                                                           "convention")))
        for grasp in report:
            metrics = grasp["metrics"]
            self.assertEqual(metrics["m"]["value"], grasp["computed"]["m"])
            self.assertEqual(metrics["epsilon_graspit"]["value"], grasp["computed"]["epsilon"])
            self.assertEqual(metrics["num_contacts"]["value"], grasp["computed"]["num_contacts"])
            self.assertIn("GraspIt!: ", metrics["epsilon_graspit"]["convention"])

    def test_metrics_by_name_and_in_another_convention(self):
        done = self.evaluate(self.file, "--metrics", "volume,m", "--csv", "--convention", "simox")
        rows = list(csv.DictReader(io.StringIO(done.stdout)))
        self.assertEqual([row["metric"] for row in rows], ["m", "volume"] * 2)
        self.assertTrue(rows[1]["convention"].startswith("Simox: "))
        self.assert_refused("evaluate", self.file, "--metrics", "m,goodness", cwd=self.folder,
                            says=["--metrics", "goodness", "epsilon"])
        self.assert_refused("evaluate", self.file, "--metrics", "m,m", cwd=self.folder,
                            says="once")
        self.assert_refused("evaluate", self.file, "--convention", "ours", cwd=self.folder,
                            says="dexgraspbench")
        self.assert_refused("evaluate", self.file, "--json", "--csv", cwd=self.folder,
                            says="exclude")

    def test_reproduces_other_readings_too(self):
        done = program.run("plan", self.object, "--count", "2", "--accept", "usable",
                           "--search", "first",
                           "--measure-units", "cm", "--regularity", "edge-only",
                           "--centroid", "vertices", "--averaging", "plain", "--alpha", "0.7",
                           "--theta-max-deg", "40", "--clip-thickness-mm", "2.5", "--longest",
                           "0.13", "--out", self.folder / "other")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.evaluate(self.folder / "other/grasps.json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_another_m_is_found_out(self):
        def add(data):
            data["results"]["grasps"][1]["m"] += 2e-9

        done = self.evaluate(self.changed(add))
        self.assertEqual(done.returncode, 4)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn("differs", done.stderr)

    def test_a_moved_hand_is_found_out(self):
        def move(data):
            data["results"]["grasps"][0]["X_OH"]["translation_m"][0] += 1e-4

        self.assertEqual(self.evaluate(self.changed(move)).returncode, 4)

    def test_object_that_is_gone_moved_or_another_one(self):
        moved = self.folder / "elsewhere.off"
        self.object.rename(moved)
        self.assert_refused("evaluate", self.file, says=["torus.off", "--object"],
                            cwd=self.folder)
        self.assertEqual(self.evaluate(self.file, "--object", moved).returncode, 0)
        shutil.copy(moved, self.folder / "out/torus.off")  # This is beside the grasp file.
        self.assertEqual(self.evaluate(self.file).returncode, 0)
        self.write("out/torus.off", program.off_text(*program.torus(0.051)))
        self.assert_refused("evaluate", self.file, says=["torus.off", "SHA-256"],
                            cwd=self.folder)

    def test_files_that_are_no_grasp_files(self):
        self.assert_refused("evaluate", self.folder / "no.json", says="no.json")
        self.assert_refused("evaluate", self.object, says="not JSON")
        self.assert_refused("evaluate", self.write("empty.json", ""), says="not JSON")
        self.assert_refused("evaluate", self.write("list.json", "[1, 2]"),
                            says="is [1,2], must be an object")
        deep = '{"a": ' + "[" * 100000 + "]" * 100000 + "}"
        self.assert_refused("evaluate", self.write("deep.json", deep),
                            says=["deep.json: line 1, column 70", "64 levels"])

        def item(data, *keys):
            for key in keys:
                data = data[key]
            return data

        for keys, value, says in (
                (("format",), "urdf", "graspfit-grasps"),
                (("version",), 1, "versions 4 to 6"),
                (("hand", "description_sha256"), "0" * 64, "/hand"),
                (("hand", "sidecar_sha256"), "0" * 64, "sidecar"),
                (("hand", "links", 0, "mesh_sha256"), "0" * 64, "mesh of link"),
                (("results", "stop"), "bored", "/results/stop"),
                (("results", "grasps", 0, "m"), "high", "/results/grasps/0/m"),
                (("results", "grasps", 0, "contacts", 0, "pad"), "elbow", "elbow"),
                (("results", "grasps", 0, "X_OH", "rotation_wxyz"), [1, 1, 0, 0], "unit"),
                (("results", "grasps", 0, "X_OH", "translation_m"), [1, 2], "3"),
                (("planner", "used", "fingers"), ["pinky"], "pinky"),
                (("planner", "options", "quality", "units"), "feet", "normalized|cm")):
            def change(data, keys=keys, value=value):
                item(data, *keys[:-1])[keys[-1]] = value

            with self.subTest(keys):
                self.assert_refused("evaluate", self.changed(change), says=says)

                def remove(data, keys=keys):
                    del item(data, *keys[:-1])[keys[-1]]

                if "options" not in keys:  # Options have defaults.
                    self.assert_refused("evaluate", self.changed(remove), says="is missing")

    def test_joint_beyond_its_limits(self):
        def bend(data):
            joints = data["results"]["grasps"][0]["joints"]
            joints[next(iter(joints))] = 9.0

        self.assert_refused("evaluate", self.changed(bend), says="/results/grasps/0/joints")


if __name__ == "__main__":
    program.main()
