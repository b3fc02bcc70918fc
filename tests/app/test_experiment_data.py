"""graspfit experiment: what it does where data are missing, and with meshes of the user's own."""

import csv
import hashlib
import json
import os
import pathlib
import re
import subprocess

from program import PROGRAM, ProgramTest, main, off_text, run, torus

CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
PACKAGED_MESHES = pathlib.Path(os.environ.get("GRASPFIT_PACKAGED_MESHES", CACHE / "graspfit/meshes"))

# Every cell is one attempt on a coarse grid.
SHORT = ("--set", "count=1", "--set", "max-attempts=1", "--set", "resolution=10",
         "--set", "weak-thickness-mm=0")


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


class DataTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"

    def environment(self, **changes):
        return dict(os.environ, **{name: str(value) for name, value in changes.items()})

    def without_data(self, *arguments, **changes):
        """Runs on a machine that has no data folder. Returns what the run wrote to standard
        error."""
        done = run("experiment", "run", *arguments, "--out", self.out,
                   env=self.environment(GRASPFIT_DATA=self.folder / "none", **changes))
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def manifest_of(self, slug):
        return json.loads((self.out / f"{slug}.manifest.json").read_text())


class WithoutData(DataTest):
    """Tests without a data folder: runs have objects that every machine has, say so, and are
    never published."""

    def test_a_sweep_has_objects_that_every_machine_has(self):
        for slug, axis, others in (("planner_everyday", "object", {"gripper", "barrett", "human"}),
                                   ("table1_all_objects", "object", None)):
            with self.subTest(slug):
                self.out = self.folder / slug
                error = self.without_data(slug, *SHORT, GRASPFIT_PACKAGED_MESHES=self.folder / "none")
                self.assertRegex(error, "^graspfit experiment: note: there is no data folder [^\n]*/none "
                                        "\\(GRASPFIT_DATA\\): object is shape_box, [^\n]*, without "
                                        "[0-9]+ of [0-9]+[^\n]*; this run is never published\n$")
                rows = rows_of(self.out / f"{slug}.csv")
                self.assertEqual({row[axis] for row in rows},
                                 {"shape_box", "shape_bottle", "shape_mug", "shape_torus"})
                if others:
                    self.assertEqual({row["hand"] for row in rows}, others)
                self.assertNotIn("skipped", {row["status"] for row in rows})
                self.assertGreater(sum(row["status"] == "ok" for row in rows), len(rows) / 2, rows)
                self.assertTrue(self.manifest_of(slug)["config"]["is_modified"])
        done = run("experiment", "run", "planner_everyday", "--publish", "--out", self.out,
                   env=self.environment(GRASPFIT_DATA=self.folder / "none"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("results are not published: data are not there", done.stderr)

    def test_sizes_of_the_sweep_are_those_of_its_default_objects(self):
        self.without_data("table1", *SHORT, "--set", "size=0.20", "--set", "run=1",
                          "--set", "planner=fitting")
        rows = rows_of(self.out / "table1.csv")
        self.assertIn("shape_mug", {row["object"] for row in rows})
        # This is a shape of the axis itself.
        self.assertIn("bowling_ball", {row["object"] for row in rows})
        for row in rows:
            self.assertEqual(row["status"], "ok", row)
            self.assertAlmostEqual(float(row["object_extent_m"]), 0.2, places=6)

    def test_what_is_asked_for_is_not_replaced(self):
        done = run("experiment", "run", "planner_paper_objects", *SHORT, "--set", "object=mug,duck",
                   "--set", "grip=barrett_3", "--out", self.out,
                   env=self.environment(GRASPFIT_DATA=self.folder / "none"))
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertRegex(done.stderr, "^graspfit experiment run: all 2 cells were skipped, so there is no table; "
                                      "the first, object=mug [^\n]*: meshes/paper/mug.obj is not there; "
                                      "set GRASPFIT_DATA to the folder that holds it\n$")
        self.assertFalse((self.out / "planner_paper_objects.csv").exists())

    def test_a_packaged_mesh_stands_for_the_same_bytes_of_the_data_folder(self):
        if not (PACKAGED_MESHES / "bunny00.off").is_file():
            self.skipTest("no packaged meshes; set GRASPFIT_PACKAGED_MESHES")
        error = self.without_data("object_voxels", "--set", "object=bunny", "--set", "resolution=8",
                                  "--set", "weak-thickness-mm=0")
        self.assertEqual(error, "")
        row, = rows_of(self.out / "object_voxels.csv")
        self.assertEqual((row["object"], row["status"]), ("bunny", "ok"), row)
        digest = hashlib.sha256((PACKAGED_MESHES / "bunny00.off").read_bytes()).hexdigest()
        self.assertEqual(self.manifest_of("object_voxels")["inputs_sha256"]["packaged/bunny00.off"], digest)

    def test_every_sweep_has_rows(self):
        """Checks what describe says a run would have here: no axis is empty."""
        if not (PACKAGED_MESHES / "bunny00.off").is_file():
            self.skipTest("no packaged meshes; set GRASPFIT_PACKAGED_MESHES")
        environment = self.environment(GRASPFIT_DATA=self.folder / "none")
        for slug, says in (("special_cases", "case is bunny_9cm, bunny_15cm, bunny_30cm, teddy_six_contacts, without 13 of 17"),
                           ("paper_grasps", "case is gallery_bunny, "),
                           ("hold_rates", "grip is gripper_precision, barrett_precision"),
                           ("table_tidying", "scene is shapes_past_a_bottle, without 2 of 3"),
                           ("force_closure", None), ("measured_contacts", None)):
            with self.subTest(slug):
                text = run("experiment", "describe", slug, env=environment).stdout
                self.assertEqual("a run here, without that folder: " in text, says is not None, text)
                self.assertIn(says or "", text)


class OwnObjects(DataTest):
    """Tests of --object FILE on the axis of objects."""

    def setUp(self):
        super().setUp()
        (self.folder / "sub").mkdir()
        self.mesh = self.write_torus("my torus.off")
        self.other = self.write("sub/my_torus.off", off_text(*torus(minor=0.015)))

    def test_they_are_the_objects_of_the_sweep(self):
        slug = "planner_paper_objects"
        done = run("experiment", "run", slug, "--quick", "--object", "my torus.off", "--object",
                   "sub/my_torus.off", "--longest", "0.12", "--out", self.out, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = rows_of(self.out / f"{slug}.csv")
        self.assertEqual([row["object"] for row in rows],
                         ["my_torus", "my_torus", "my_torus_2", "my_torus_2"])
        for row in rows:
            self.assertEqual(row["status"], "ok", row)
            self.assertAlmostEqual(float(row["object_extent_m"]), 0.12, places=6)
        manifest = self.manifest_of(slug)
        self.assertTrue(manifest["config"]["is_modified"])
        self.assertEqual(manifest["config"]["as_run"]["axes"][0]["values"][0]["settings"]["file"], str(self.mesh))
        for mesh in (self.mesh, self.other):
            self.assertEqual(manifest["inputs_sha256"][str(mesh)],
                             hashlib.sha256(mesh.read_bytes()).hexdigest())
        self.assertIn('--object \'my torus.off\'', manifest["command"])
        self.assert_refused("experiment", "run", slug, "--object", self.mesh, "--publish",
                            says="results are not published: --set and --object change")

    def test_beside_objects_that_are_picked(self):
        text = run("experiment", "describe", "object_voxels", "--set", "object=box", "--object", self.mesh).stdout
        self.assertIn("\n  object: box my_torus\n", text)
        text = run("experiment", "describe", "object_voxels", "--object", self.mesh).stdout
        self.assertIn("\n  object: my_torus\n", text)

    def test_what_cannot_be_is_refused_in_one_line(self):
        experiment = ("experiment", "run")
        for slug, names in (("special_cases", "case, seed"), ("force_closure", "grip, seed"),
                            ("table_tidying", "scene"), ("measured_contacts", "set")):
            self.assert_refused(*experiment, slug, "--object", self.mesh,
                                says=f"--object: {slug} has no axis object; there are {names}")
        self.assert_refused(*experiment, "table1", "--object", self.mesh, "--longest", "0.1",
                            says=["--longest: axis size of table1 sets", "--set size=..."])
        self.assert_refused(*experiment, "object_voxels", "--longest", "0.1",
                            says="--longest means nothing without --object")
        self.assert_refused(*experiment, "object_voxels", "--object", self.mesh, "--longest", "0",
                            says="--longest is 0, must be > 0")
        self.assert_refused(*experiment, "object_voxels", "--object", self.folder / "none.off", says="none.off")
        self.assert_refused(*experiment, "object_voxels", "--object", self.write("text.off", "no mesh"),
                            says="text.off")
        name = os.fsdecode(b"not-utf8-\xff.off")
        self.write_torus(name)
        done = subprocess.run([PROGRAM, *experiment, "object_voxels", "--object", name], cwd=self.folder,
                              capture_output=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"the path is not UTF-8", done.stderr)


class Described(DataTest):
    """Tests of describe, which says which value needs which data."""

    def data_of(self, slug, *arguments, **changes):
        text = run("experiment", "describe", slug, *arguments, env=self.environment(**changes)).stdout
        lines = text.split("\nData, ")[1].split("\n\n")[0].splitlines()[1:]
        return [re.split("  +", line.strip()) for line in lines]

    def test_it_marks_what_needs_which(self):
        none = self.folder / "none"
        rows = self.data_of("object_voxels", GRASPFIT_DATA=none, GRASPFIT_PACKAGED_MESHES=none)
        self.assertEqual(rows[:4], [
            ["axis", "from", "now", "values"],
            ["object", "data folder or libcgal-demo", "missing", "bunny armadillo"],
            ["object", "data folder", "missing", "squirrel bowling max_planck kitten horse"],
            ["object", "built in", "there", "box ball"]])
        self.assertIn("a run here, without that folder: object is box, ball, shape_box, ", rows[4][0])
        (none / "meshes/paper").mkdir(parents=True)
        (none / "meshes/paper/kitten.obj").write_text("")
        rows = self.data_of("object_voxels", GRASPFIT_DATA=none, GRASPFIT_PACKAGED_MESHES=none)
        self.assertIn(["object", "data folder", "there", "kitten"], rows)
        self.assertEqual(len(rows), 5)

    def test_hands_and_settings_of_all_count_and_nothing_is_nothing(self):
        none = self.folder / "none"
        rows = self.data_of("planner_everyday", GRASPFIT_DATA=none)
        self.assertIn(["hand", "data folder", "missing", "allegro shadow"], rows)
        rows = self.data_of("force_closure", GRASPFIT_DATA=none, GRASPFIT_PACKAGED_MESHES=none)
        self.assertEqual(rows[1], ["all cells", "data folder or libcgal-demo", "missing", "by the settings of all"])
        self.assertEqual(self.data_of("measured_contacts"), [["none"]])
        mesh = self.write_torus()
        self.assertEqual(self.data_of("object_voxels", "--object", mesh)[1],
                         ["object", "your file", "there", "torus"])


if __name__ == "__main__":
    main()
