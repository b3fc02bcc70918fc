#!/usr/bin/python3
"""Tests of paper-figures/make on the committed tables: test_make.py CLASS."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PACKAGES = "apt-get install python3-pandas python3-matplotlib python3-vtk9 xvfb xauth python3-pil"

try:
    import matplotlib  # noqa: F401
    import numpy as np
    import pandas  # noqa: F401
    import vtk  # noqa: F401
    from PIL import Image
except ImportError as error:
    print(f"SKIPPED: {error}; {PACKAGES}")
    sys.exit(0)

SOURCE_DIR = pathlib.Path(os.environ["GRASPFIT_SOURCE_DIR"])
FIGURES_DIR = SOURCE_DIR / "paper-figures"
TABLES = SOURCE_DIR / "notebooks-data"
sys.path.insert(0, str(FIGURES_DIR))
from figure_list import FIGURES, ROOMS  # noqa: E402

sys.path[1:1] = [str(FIGURES_DIR / room) for room in ROOMS]
from figure_data import BadData, read_mesh  # noqa: E402

CUBE = {
    "cube.off": "OFF\n# a comment\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
    "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n",
    "cube.obj": "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvn 0 0 1\n"
    "f 1//1 4//1 3//1 2//1\nf -4 -3 -2 -1\nf 1 2 6 5\nf 2 3 7 6\nf 3/1 4/1 8/1 7/1\nf 4 1 5 8\n",
}


def make(*words, data=None):
    environment = dict(os.environ)
    if data is not None:
        environment["GRASPFIT_DATA"] = str(data)
    return subprocess.run(
        [sys.executable, str(FIGURES_DIR / "make"), *map(str, words)],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip


def signed_volume(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class Lists(unittest.TestCase):
    def test_every_figure_has_a_script_and_a_row_in_the_readme_and_no_script_is_left_out(self):
        readme = (FIGURES_DIR / "README.md").read_text(encoding="utf-8")
        slugs = [figure.slug for figure in FIGURES]
        self.assertEqual(len(slugs), len(set(slugs)))
        drawing = [path for path in FIGURES_DIR.rglob("*.py") if "\ndef draw(source)" in path.read_text()]
        self.assertEqual(sorted(path.stem for path in drawing), sorted(slugs))
        self.assertEqual({path.parent.name for path in drawing}, {"scenes", "charts"})
        rows = re.findall(r"^\| `(\w+)` \|(?:[^|]*\|){3}$", readme, re.MULTILINE)
        self.assertEqual(sorted(rows), sorted(slugs))

    def test_list_names_all_and_draws_nothing(self):
        done = make("--list")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([line.split()[0] for line in done.stdout.splitlines()], [f.slug for f in FIGURES])

    def test_names_of_stand_ins_have_a_star_in_every_claim(self):
        from object_names import STAND_INS
        from special_cases import CLAIMS, label

        self.assertEqual(label("torus_7cm"), "TORUS* 7 cm wide: all contacts on the outer side")
        self.assertEqual(label("bunny_9cm"), "BUNNY 9 cm wide: pinch, ears left alone")
        for case, (name, _) in CLAIMS.items():
            self.assertTrue(case.startswith(f"{name}_"), case)
            self.assertEqual("*" in label(case), name in STAND_INS, case)

    def test_an_empty_cell_says_why(self):
        from heat_table import why_empty

        self.assertEqual(why_empty("ok", float("nan")), "none")
        too_large = "the object measures 0.15 x 0.15 x 0.15 m; the hand spans 0.1 m"
        self.assertEqual(why_empty("failed", too_large), "too large")
        self.assertEqual(why_empty("failed", "out of memory"), "failed")
        self.assertEqual(why_empty("skipped", "x.off is not there"), "skipped")

    def test_no_committed_file_of_the_figures_holds_a_mesh_of_an_object(self):
        embedding = {".off", ".obj", ".ply", ".stl", ".glb", ".gltf", ".html", ".vtp", ".vti"}
        tracked = subprocess.run(
            ["git", "-C", str(SOURCE_DIR), "ls-files", "paper-figures"],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        if tracked.returncode != 0:
            self.skipTest("not a git checkout")
        for name in tracked.stdout.splitlines():
            self.assertNotIn(pathlib.PurePath(name).suffix, embedding, name)


class Readers(Folder):
    def test_polygons_of_off_and_obj_files_become_the_triangles_of_a_unit_cube(self):
        for name, text in CUBE.items():
            (self.folder / name).write_text(text)
            vertices, triangles = read_mesh(self.folder / name)
            self.assertEqual((vertices.shape, triangles.shape), ((8, 3), (12, 3)), name)
            self.assertAlmostEqual(signed_volume(vertices, triangles), 1.0, places=14, msg=name)

    def test_corners_of_stl_files_are_merged(self):
        (self.folder / "cube.obj").write_text(CUBE["cube.obj"])
        vertices, triangles = read_mesh(self.folder / "cube.obj")
        record = np.zeros(12, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        record["corners"] = vertices[triangles]
        text = "solid cube\n"
        for corners in record["corners"]:
            lines = "".join("vertex {} {} {}\n".format(*corner) for corner in corners)
            text += f"facet normal 0 0 1\nouter loop\n{lines}endloop\nendfacet\n"
        binary = bytes(80) + np.uint32(12).tobytes() + record.tobytes()
        for name, content in (("binary.stl", binary), ("text.stl", text.encode())):
            (self.folder / name).write_bytes(content)
            vertices, triangles = read_mesh(self.folder / name)
            self.assertEqual(vertices.shape, (8, 3), name)
            self.assertAlmostEqual(signed_volume(vertices, triangles), 1.0, places=14, msg=name)

    def test_voxels_lie_in_the_middle_of_their_edges(self):
        from voxel_data import voxel_centers

        np.testing.assert_allclose(voxel_centers(-1.0, 2.0, 3), [-0.5, 0.5, 1.5], atol=1e-15)

    def test_a_hand_whose_joints_do_not_start_at_the_palm_is_refused(self):
        from hands import forward_kinematics

        def joint(parent, child):
            return {"name": f"{parent}_{child}", "type": "revolute", "lower": 0.0, "upper": 1.0,
                    "parent_link": parent, "child_link": child, "axis_J": [0, 0, 1],
                    "X_PJ": {"translation_m": [1, 0, 0], "rotation_wxyz": [1, 0, 0, 0]},
                    "closing_sign": 0, "coupling": None}  # fmt: skip

        joints = [joint("b", "c"), joint("a", "b")]
        links, _ = forward_kinematics({"name": "chain", "palm": {"link": "a"}, "joints": joints})
        np.testing.assert_allclose(links["c"][:3, 3], [2, 0, 0], atol=1e-15)
        with self.assertRaisesRegex(BadData, "hand chain: .* a_b"):
            forward_kinematics({"name": "chain", "palm": {"link": "b"}, "joints": joints})

    def test_a_file_that_makes_no_sense_is_named(self):
        (self.folder / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n1 0\n")
        with self.assertRaisesRegex(BadData, "broken.off"):
            read_mesh(self.folder / "broken.off")


class Plots(Folder):
    def test_without_meshes_every_plot_of_a_published_table_is_drawn_and_the_others_are_listed(self):
        done = make("all", "--out", self.folder, data=self.folder / "nowhere")
        self.assertEqual(done.returncode, 0, done.stderr)
        for figure in FIGURES:
            png, pdf = (self.folder / f"{figure.slug}{suffix}" for suffix in (".png", ".pdf"))
            if not all((TABLES / f"{slug}.csv").exists() for slug in figure.experiments):
                self.assertRegex(done.stdout, rf"skipped {figure.slug}: .* is not published")
                continue
            if figure.shows_meshes:
                self.assertRegex(done.stdout, rf"skipped {figure.slug}: .*GRASPFIT_DATA")
                self.assertFalse(png.exists())
                continue
            self.assertNotIn(f"skipped {figure.slug}:", done.stdout)
            self.assertTrue(pdf.read_bytes().startswith(b"%PDF"), figure.slug)
            with Image.open(png) as image:
                self.assertGreater(len(image.convert("RGB").getcolors(1 << 24)), 40, figure.slug)

    def test_the_same_table_gives_the_same_bytes(self):
        for name in ("one", "two"):
            done = make("force_closure", "--out", self.folder / name)
            self.assertEqual(done.returncode, 0, done.stderr)
        for suffix in (".png", ".pdf"):
            files = [self.folder / name / f"force_closure{suffix}" for name in ("one", "two")]
            self.assertEqual(files[0].read_bytes(), files[1].read_bytes())


class BadDataIsOneLine(Folder):
    def refused(self, *words):
        done = make(*words, "--out", self.folder / "out")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertFalse(list(self.folder.glob("out/*.p*")))
        return done.stderr

    def test_a_table_without_a_column(self):
        text = (TABLES / "special_cases.csv").read_text()
        (self.folder / "special_cases.csv").write_text(text.replace("satisfying_grasps", "others", 1))
        said = self.refused("special_cases", "--tables", self.folder)
        self.assertRegex(said, r"special_cases.csv: has no column satisfying_grasps; it has case, seed")

    def test_a_table_that_is_empty(self):
        (self.folder / "special_cases.csv").write_text("")
        self.assertIn("special_cases.csv", self.refused("special_cases", "--tables", self.folder))

    def test_a_table_that_is_not_there_is_no_error_but_listed(self):
        done = make("special_cases", "--tables", self.folder, "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0)
        self.assertIn("graspfit experiment run special_cases --publish", done.stdout)

    def test_grasps_of_another_run_than_the_published_one(self):
        if not (FIGURES_DIR / "data/paper_grasps").is_dir():
            self.skipTest("no grasp files are adopted")
        grasps = self.folder / "grasps/paper_grasps"
        shutil.copytree(FIGURES_DIR / "data/paper_grasps", grasps)
        path = grasps / "gallery_kitten.json"
        record = json.loads(path.read_text())
        record["table_sha256"] = "0" * 64
        path.write_text(json.dumps(record))
        said = self.refused("gallery_times", "--grasps", self.folder / "grasps")
        self.assertIn("gallery_kitten.json: belongs to another run", said)

    def test_a_figure_that_is_not_there(self):
        self.assertIn("there is no figure fig_99; --list shows all", self.refused("fig_99"))


class Rerun(Folder):
    """Tests make --rerun on copies of the scripts, with programs that only record how they are
    called."""

    def setUp(self):
        super().setUp()
        self.scripts = self.folder / "paper-figures"
        self.scripts.mkdir()
        for path in (FIGURES_DIR / "make", *FIGURES_DIR.rglob("*.py")):
            copy = self.scripts / path.relative_to(FIGURES_DIR)
            copy.parent.mkdir(exist_ok=True)
            shutil.copy(path, copy)
        (self.folder / "viewer").symlink_to(SOURCE_DIR / "viewer")
        self.stale = [self.scripts / f"data/{slug}/stale.json" for slug in ("paper_grasps", "fitting_stages")]
        for path in self.stale:
            path.parent.mkdir(parents=True)
            path.write_text("{}")
        self.log = self.folder / "log"
        # It refuses, as publishing does, once anything of what was there has changed.
        self.program("graspfit", f'''test -e "{self.stale[0]}" -a -e "{self.stale[1]}" || exit 1
            echo "$3" >> "{self.log}"
            mkdir -p "$5"
            echo object > "$5/$3.csv"''')
        self.program("xvfb-run", 'shift 3; exec "$@"')

    def program(self, name, text):
        path = self.folder / "bin" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"#!/bin/sh\n{text}\n")
        path.chmod(0o755)

    def make(self, *words):
        environment = {k: v for k, v in os.environ.items() if k != "GRASPFIT_UNDER_XVFB"}
        environment["PATH"] = f"{self.folder / 'bin'}{os.pathsep}{environment['PATH']}"
        return subprocess.run(
            [sys.executable, str(self.scripts / "make"), *map(str, words)],
            env=environment, capture_output=True, text=True, check=False,
        )  # fmt: skip

    def test_every_experiment_is_run_once_before_any_grasp_file_is_adopted(self):
        done = self.make("contact_triangles", "fitting_stages", "--rerun")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.log.read_text().split(), ["paper_grasps", "fitting_stages"])
        self.assertEqual(done.stdout.count("grasp files adopted"), 2)
        self.assertFalse(any(path.exists() for path in self.stale))

    def test_pictures_of_earlier_runs_do_not_enter_the_sheet(self):
        out = self.folder / "out"
        out.mkdir()
        shutil.copy(FIGURES_DIR / "contact_sheet.png", out / "special_cases.png")
        done = self.make("special_cases", "--out", out, "--contact-sheet", self.folder / "sheet.png")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
        self.assertIn("no figure was drawn for it", done.stderr)
        self.assertFalse((self.folder / "sheet.png").exists())


class Rendered(Folder):
    def colors(self, slug):
        """Returns the share of pixels near the colors of object, hand and contacts."""
        with Image.open(self.folder / f"{slug}.png") as image:
            pixels = np.asarray(image.convert("RGB")).reshape(-1, 3).astype(int)
        red, green, blue = pixels.T
        masks = {
            "object": (red > green) & (green > blue) & (red - blue > 8) & (red - blue < 60),
            "hand": (blue > red + 20) & (green > red),
            "contact": (red > green + 80) & (red > blue + 80),
        }
        return {name: float(mask.mean()) for name, mask in masks.items()}

    def test_pictures_of_grasps_show_object_hand_and_contacts(self):
        slugs = ("torus_sizes", "fitting_stages")
        done = make(*slugs, "--out", self.folder)
        if "GRASPFIT_DATA" in done.stdout:
            self.skipTest("no meshes; set GRASPFIT_DATA")
        if "is not published" in done.stdout:
            self.skipTest("tables of these figures are not published")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 figures", done.stdout)
        for slug in slugs:
            shares = self.colors(slug)
            for name, least in (("object", 0.02), ("hand", 0.03), ("contact", 0.0005)):
                self.assertGreater(shares[name], least, f"{slug}: {name} in {shares}")


if __name__ == "__main__":
    name = "BadDataIsOneLine" if sys.argv[1] == "BadData" else sys.argv[1]
    outcome = unittest.main(module="__main__", defaultTest=name, argv=sys.argv[:1], exit=False).result
    if outcome.skipped and outcome.testsRun == len(outcome.skipped):
        print(f"SKIPPED: {outcome.skipped[0][1]}")
    sys.exit(not outcome.wasSuccessful())
