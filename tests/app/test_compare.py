"""`graspfit compare` sets two sets of grasps on the same objects side by side."""

import csv
import json
import pathlib
import random
import re
import shutil
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import program

try:
    import numpy
except ImportError:
    numpy = None

RATES = ("touching", "clear", "valid", "closed", "held")


class CompareTest(program.ProgramTest):
    """Tests on grasps of a torus and a box, planned once."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.planned = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.planned.cleanup)
        folder = pathlib.Path(cls.planned.name)
        (folder / "torus.off").write_text(program.off_text(*program.torus()))
        (folder / "box.off").write_text(program.off_text(*program.box(0.05, 0.06, 0.08)))
        for mesh, side, flags in (("torus", "a", ()), ("box", "a", ()), ("torus", "b", ("--seed", "5"))):
            done = program.run("plan", f"{mesh}.off", "--count", "2", "--preset", "exact", *flags,
                               "--out", f"{side}/{mesh}", cwd=folder)
            assert done.returncode == 0, done.stderr

    def setUp(self):
        super().setUp()
        shutil.copytree(self.planned.name, self.folder, dirs_exist_ok=True)

    def compare(self, *arguments):
        """Returns what is printed and, by object and side, the rows of the table."""
        done = program.run("compare", *arguments, "--out", "compared", cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        with open(self.folder / "compared/compare.csv", encoding="utf-8", newline="") as file:
            rows = {(row["object"], row["side"]): row for row in csv.DictReader(file)}
        return done.stdout, rows

    def changed(self, name, change):
        data = json.loads((self.folder / "a/torus/grasps.json").read_text())
        change(data)
        (self.folder / "a/torus" / name).write_text(json.dumps(data))
        return f"a/torus/{name}"

    def printed_row(self, printed, measure):
        (line,) = [line for line in printed.splitlines() if line.strip().startswith(measure + "  ")]
        return re.split(r"  +", line.strip())[1:]


class Compared(CompareTest):
    def test_a_file_is_as_good_as_itself(self):
        file = "a/torus/grasps.json"
        printed, rows = self.compare(file, file, "--no-hold")
        mine, theirs = dict(rows["torus", "A"]), dict(rows["torus", "B"])
        self.assertEqual((mine.pop("side"), theirs.pop("side")), ("A", "B"))
        self.assertEqual(mine, theirs)
        self.assertEqual(mine["num_grasps"], "2")
        for line in printed.splitlines():
            cells = re.split(r"  +", line.strip())
            if len(cells) == 4 and cells[0] != "measure":
                self.assertIn(cells[3], ("0", "0 points", "-"), line)
        self.assertNotIn("note:", printed)
        self.assertEqual(self.printed_row(printed, "held"), ["-", "-", "-"])
        # 2 of 2: the interval of Wilson begins at 1 / (1 + 1.96^2 / 2).
        self.assertAlmostEqual(float(mine["touching_low"]), 1 / (1 + 1.959963984540054 ** 2 / 2))
        self.assertEqual((mine["touching_rate"], mine["touching_high"]), ("1", "1"))
        self.assertEqual(self.printed_row(printed, "touching"),
                         ["100 % (34-100)", "100 % (34-100)", "0 points"])

    def test_measures_are_those_of_the_file(self):
        record = json.loads((self.folder / "a/torus/grasps.json").read_text())
        grasps = record["results"]["grasps"]
        row = self.compare("a/torus/grasps.json", "a/torus/grasps.json", "--no-hold")[1]["torus", "A"]
        self.assertAlmostEqual(float(row["median_m"]), sum(g["m"] for g in grasps) / 2, delta=1e-9)
        self.assertAlmostEqual(float(row["largest_gap_m"]),
                               max(g["largest_requested_gap_m"] for g in grasps), delta=1e-9)
        self.assertAlmostEqual(float(row["time_per_grasp_s"]), record["timings"]["total_s"] / 2)
        self.assertEqual(row["object_sha256"], record["object"]["sha256"])

    def test_a_grasp_that_was_moved_is_worse(self):
        def move(data):
            random.seed(1)
            pose = data["results"]["grasps"][0]["X_OH"]["translation_m"]
            for axis in range(3):
                pose[axis] += random.choice((-1, 1)) * 0.004
        moved = self.changed("moved.json", move)
        printed, rows = self.compare("a/torus/grasps.json", moved, "--no-hold")
        self.assertEqual(rows["torus", "A"]["num_valid"], "2")
        self.assertEqual(rows["torus", "B"]["num_valid"], "1")
        self.assertEqual(self.printed_row(printed, "valid")[2], "-50 points")
        self.assertLess(float(rows["torus", "B"]["valid_low"]), 0.5)
        self.assertGreater(float(rows["torus", "B"]["valid_high"]), 0.5)

    def test_both_are_measured_alike(self):
        def change(data):
            data["planner"]["options"]["friction"] = 0.1
            data["planner"]["options"]["refinement"]["largest_gap_m"] = 2e-4
        other = self.changed("other.json", change)
        printed, rows = self.compare("a/torus/grasps.json", other, "--no-hold")
        self.assertIn("note: a/torus/other.json was measured with friction 0.1, an accepted gap of "
                      "0.2 mm; here it is measured as a/torus/grasps.json", printed)
        for key in ("median_epsilon", "num_closed", "num_touching", "median_m"):
            self.assertEqual(rows["torus", "A"][key], rows["torus", "B"][key])

    def test_folders_have_the_objects_of_both(self):
        printed, rows = self.compare("a", "b", "--no-hold")
        self.assertIn("note: only A has grasps of box, which are left out", printed)
        self.assertEqual(list(rows), [("all", "A"), ("all", "B"), ("torus", "A"), ("torus", "B")])
        printed, rows = self.compare("a", "a", "--no-hold")
        self.assertIn("2 objects", printed)
        self.assertEqual(rows["all", "A"]["num_grasps"], "4")
        self.assertEqual(rows["box", "B"]["num_grasps"], "2")
        shutil.rmtree(self.folder / "a/torus")
        printed, rows = self.compare("a", "a/box/grasps.json", "--no-hold")
        self.assertEqual(rows["all", "A"]["num_grasps"], "2")

    def test_another_tools_grasps(self):
        for name in ("theirs.npz", "theirs.yaml"):
            done = program.run("convert", "a/torus/grasps.json", name, cwd=self.folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            printed, rows = self.compare("a/torus/grasps.json", name, "--no-hold", "--hand", "barrett",
                                         "--object", "torus.off")
            for key in ("median_m", "median_epsilon", "median_gap_m"):
                self.assertAlmostEqual(float(rows["torus", "A"][key]),
                                       float(rows["torus", "B"][key]), delta=1e-9)
            self.assertEqual(rows["torus", "B"]["num_closed"], rows["torus", "A"]["num_closed"])
            self.assertEqual(rows["torus", "B"]["time_per_grasp_s"], "")
            self.assertEqual(self.printed_row(printed, "time per grasp [s]")[1:], ["-", "-"])

    def test_picture(self):
        shutil.copytree(self.folder / "a/torus", self.folder / "a & <b>")
        self.compare("a & <b>", "b", "--no-hold")
        self.assertEqual(sorted(path.name for path in (self.folder / "compared").iterdir()),
                         ["compare.csv", "compare.svg"])
        root = ElementTree.parse(self.folder / "compared/compare.svg").getroot()
        name = "{http://www.w3.org/2000/svg}"
        texts = [text.text for text in root.iter(name + "text")]
        for text in (*RATES, "share of grasps [%]", "A: a & <b>", "B: b", "2/2"):
            self.assertIn(text, texts)
        # The background, two in the legend, and two for each rate but that of the physics test.
        self.assertEqual(len(list(root.iter(name + "rect"))), 1 + 2 + 2 * (len(RATES) - 1))

    def test_held_and_margins(self):
        done = program.run("compare", "a/torus", "b/torus", "--margins", "1", cwd=self.folder)
        if "no physics engine" in done.stderr:
            self.skipTest("built without MuJoCo")
        printed, rows = self.compare("a/torus", "b/torus", "--margins", "1")
        self.assertEqual(done.stdout + "written to compared\n", printed)
        self.assertIn("held: under dexgraspbench-100g", printed)
        for side, folder in (("A", "a"), ("B", "b")):
            held = program.run("hold", f"{folder}/torus/grasps.json", "--margin", "--quick", "--out",
                               "held", cwd=self.folder)
            self.assertEqual(held.returncode, 0, held.stderr)
            report = json.loads((self.folder / "held/hold.json").read_text())["results"]
            self.assertEqual(rows["torus", side]["num_held"], str(report["stages"]["held"]))
            self.assertGreater(float(rows["torus", side]["median_margin_force_N"]), 0.0)


class BadInput(CompareTest):
    def refused(self, *arguments, says):
        return self.assert_refused("compare", *arguments, says=says, cwd=self.folder)

    def test_command_lines_and_files(self):
        a = "a/torus/grasps.json"
        self.write("broken.json", "{")
        self.write("broken.npz", "no archive")
        (self.folder / "empty").mkdir()
        npz = ("--hand", "barrett", "--object", "torus.off")
        for arguments, says in (
                ((), "no A given"),
                ((a,), "no B given"),
                ((a, a, a), "more than A and B"),
                ((a, "none.json"), "none.json"),
                ((a, "broken.json"), "broken.json"),
                ((a, "empty"), "empty: no grasps.json in this folder"),
                ((a, "a/box"), ["A and B have no object in common", "only A has grasps of torus"]),
                ((a, "broken.npz"), "--hand NAME|FILE says which"),
                ((a, "broken.npz", "--hand", "barrett"), "--object FILE says which"),
                ((a, "broken.npz", *npz), "broken.npz: is no NPZ file"),
                ((a, "broken.npz", "--hand", "elbow", "--object", "torus.off"), "elbow"),
                ((a, a, "--hand", "barrett"), "--hand is for .yaml and .npz files"),
                ((a, a, "--longest", "0.1"), "--longest is for .yaml and .npz files"),
                ((a, a, "--object", "box.off"), ["box.off", "SHA-256"]),
                ((a, a, "--protocol", "dexgraspbench"), "--protocol \"dexgraspbench\""),
                ((a, a, "--no-hold", "--protocol", "dexonomy-hard"), "exclude each other"),
                ((a, a, "--no-hold", "--margins", "1"), "exclude each other"),
                ((a, a, "--margins", "-1"), "--margins"),
                ((a, a, "--protocol", "tabletop-lift", "--margins", "1"), "does not pull six ways"),
                ((a, a, "--no-hold", "--jobs", "two"), "--jobs")):
            with self.subTest(arguments):
                self.refused(*arguments, "--out", "compared", says=says)

    def test_same_name_and_another_size(self):
        def scale(data):
            data["object"]["sha256"] = "0" * 64
        other = self.changed("other.json", scale)
        self.refused("a/torus/grasps.json", other, "--no-hold",
                     says="the other's torus is another file (SHA-256)")


@unittest.skipIf(numpy is None, "python3-numpy is not installed")
class Arrays(CompareTest):
    """Arrays that NumPy wrote, not we."""

    FLAGS = ("--hand", "barrett", "--object", "torus.off")

    def setUp(self):
        super().setUp()
        done = program.run("convert", "a/torus/grasps.json", "ours.npz", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        with numpy.load(self.folder / "ours.npz") as arrays:
            self.arrays = dict(arrays)

    def convert(self, *flags):
        done = program.run("convert", "theirs.npz", "back.json", *self.FLAGS, *flags, cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout, json.loads((self.folder / "back.json").read_text())

    def test_compressed_single_precision_without_names(self):
        del self.arrays["joint_names"]
        numpy.savez_compressed(
            self.folder / "theirs.npz", more=numpy.array({"a": 1}, dtype=object),
            **{k: v.astype("f4") if k.endswith("qpos") else v for k, v in self.arrays.items()})
        printed, back = self.convert()
        self.assertIn("note: the file has no joint_names", printed)
        self.assertEqual(back["imported"]["format"], "DexGraspBench arrays")
        ours = json.loads((self.folder / "a/torus/grasps.json").read_text())["results"]["grasps"]
        numpy.testing.assert_allclose(
            sorted(g["X_OH"]["translation_m"] for g in back["results"]["grasps"]),
            sorted(g["X_OH"]["translation_m"] for g in ours), rtol=0, atol=1e-7)

    def test_size_of_the_object(self):
        numpy.savez(self.folder / "theirs.npz", **{**self.arrays, "obj_scale": 0.5})
        self.assertEqual(self.convert()[1]["object"]["meters_per_file_unit"], 0.5)
        printed, back = self.convert("--mesh-unit", "m")
        self.assertEqual(back["object"]["meters_per_file_unit"], 1.0)
        self.assertIn("note: the file's obj_scale is 0.5, but by --mesh-unit", printed)

    def test_arrays_that_are_refused(self):
        rows = self.arrays["grasp_qpos"]
        for arrays, says in (
                ({"grasp_qpos": rows.astype(object)}, "holds Python objects; save plain arrays"),
                ({"grasp_qpos": numpy.asfortranarray(rows)}, "is in Fortran order"),
                ({"grasp_qpos": rows.astype(">f8")}, "big-endian"),
                ({"grasp_qpos": rows[:, :5]}, "7 + dof"),
                ({"grasps": rows}, "no such array; the file has grasps")):
            with self.subTest(says):
                numpy.savez(self.folder / "bad.npz", **arrays)
                self.assert_refused("convert", "bad.npz", "back.json", *self.FLAGS,
                                    says=["bad.npz: grasp_qpos: ", says], cwd=self.folder)


class CompareHelp(program.ProgramTest):
    def test_help_says_what_is_compared(self):
        done = program.run("compare", "--help")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("Usage: graspfit compare A B [options]", done.stdout)
        for text in (*RATES, "--protocol", "--margins", "--no-hold", "--out", "Exit codes"):
            self.assertIn(text, done.stdout)
        self.assertLessEqual(max(map(len, done.stdout.splitlines())), 110)


if __name__ == "__main__":
    program.main()
