#!/usr/bin/python3
"""Tests of the picture script: test_render_grasps.py RENDER_GRASPS_PY [--keep-pictures FOLDER]."""

import importlib.util
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PACKAGES = "apt-get install python3-vtk9 xvfb xauth python3-pil"

try:
    import vtk  # noqa: F401
    from PIL import Image, ImageChops
except ImportError as error:
    print(f"SKIPPED: {error}; {PACKAGES}")
    sys.exit(0)

SCRIPT = None
PICTURES = None
RADIUS = 0.04


def ball_obj(first):
    """Returns OBJ text of a ball of 40 mm radius, its first vertex having this index."""
    rows, columns = 24, 48
    lines = []
    for i in range(rows + 1):
        polar = math.pi * i / rows
        for j in range(columns):
            angle = 2 * math.pi * j / columns
            lines.append(
                f"v {RADIUS * math.sin(polar) * math.cos(angle):.9f} "
                f"{RADIUS * math.sin(polar) * math.sin(angle):.9f} {RADIUS * math.cos(polar):.9f}"
            )
    for i in range(rows):
        for j in range(columns):
            a, b = first + columns * i + j, first + columns * i + (j + 1) % columns
            lines.append(f"f {a} {a + columns} {b + columns} {b}")
    return lines, (rows + 1) * columns


def box_obj(first, low, high):
    lines = []
    for k in range(8):
        lines.append("v " + " ".join(str((high if k >> axis & 1 else low)[axis]) for axis in range(3)))
    for face in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
        lines.append("f " + " ".join(str(first + k) for k in face))
    return lines, 8


def write_sample(folder):
    """Returns one grasp of a ball by two box fingers and a thumb behind them, palm below."""
    lines, count = ball_obj(1)
    text = ["o object", *lines]
    boxes = {
        "palm": ((-0.05, -0.05, -0.08), (0.05, 0.05, -0.06)),
        "thumb": ((0.04, -0.01, -0.06), (0.052, 0.01, 0.015)),
        "finger_1": ((-0.052, -0.01, -0.06), (-0.04, 0.01, 0.015)),
        "finger_2": ((-0.01, 0.04, -0.06), (0.01, 0.052, 0.015)),
    }
    next_vertex = 1 + count
    for name, (low, high) in boxes.items():
        lines, count = box_obj(next_vertex, low, high)
        text += [f"o link {name}", *lines]
        next_vertex += count
    (folder / "grasp_001.obj").write_text("\n".join(text) + "\n")

    def contact(finger, x, y):
        return {
            "link": finger,
            "finger": finger,
            "point_O_m": [x, y, 0.0],
            "inward_normal_O": [-x / RADIUS, -y / RADIUS, 0.0],
        }

    data = {
        "object": {"file": "shapes/ball.obj", "center_of_mass_O_m": [0, 0, 0]},
        "hand": {
            "name": "sample",
            "palm": {"link": "palm", "center_H_m": [0, 0, 0], "direction_H": [0, 0, 1]},
        },
        "results": {
            "grasps": [
                {
                    "m": 0.512,
                    "m1": 0.6,
                    "m2": 1.1,
                    "m3": 0.6,
                    "usable": True,
                    "valid": True,
                    "largest_penetration_m": 0.0,
                    "X_OH": {"translation_m": [0, 0, -0.06], "rotation_wxyz": [1, 0, 0, 0]},
                    "contacts": [
                        contact("thumb", RADIUS, 0.0),
                        contact("finger_1", -RADIUS, 0.0),
                        contact("finger_2", 0.0, RADIUS),
                    ],
                    "stable_pairs": [{"contacts": [0, 1], "angle_rad": 0.0}],
                }
            ]
        },
    }
    (folder / "grasps.json").write_text(json.dumps(data))
    return data


def share_near(image, color, tolerance):
    distances = ImageChops.difference(image, Image.new("RGB", image.size, color)).split()
    largest = ImageChops.lighter(ImageChops.lighter(distances[0], distances[1]), distances[2])
    return sum(largest.histogram()[: tolerance + 1]) / (image.width * image.height)


class RenderGrasps(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="graspfit_pictures_")
        self.folder = pathlib.Path(self.temporary.name)
        self.data = write_sample(self.folder)

    def tearDown(self):
        self.temporary.cleanup()

    def run_script(self, *arguments, environment=None):
        return subprocess.run(
            [sys.executable, SCRIPT, self.folder, *arguments],
            capture_output=True,
            text=True,
            timeout=240,
            env=environment,
        )

    def change(self, edit):
        edit(self.data)
        (self.folder / "grasps.json").write_text(json.dumps(self.data))

    def assert_refused(self, *words):
        result = self.run_script()
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertEqual(result.stdout, "")
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertEqual(list(self.folder.glob("*.png")), [], "nothing is left behind")

    def test_picture_shows_object_hand_and_contacts(self):
        environment = {k: v for k, v in os.environ.items() if k != "DISPLAY"}
        result = self.run_script("--width", "900", "--height", "600", environment=environment)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        names = sorted(path.name for path in self.folder.iterdir())
        self.assertEqual(names, ["grasp_001.obj", "grasp_001.png", "grasps.json"])
        image = Image.open(self.folder / "grasp_001.png").convert("RGB")
        if PICTURES:
            shutil.copy(self.folder / "grasp_001.png", PICTURES / "sample.png")
        self.assertEqual(image.size, (900, 600))
        white = share_near(image, (255, 255, 255), 3)
        self.assertGreater(white, 0.3)
        self.assertLess(white, 0.9)
        for half, name in ((0, "left view"), (450, "right view")):
            view = image.crop((half, 60, half + 450, 530))  # This is without caption and legend.
            with self.subTest(view=name):
                self.assertGreater(share_near(view, (208, 196, 176), 45), 0.05, "object's color")
                self.assertGreater(share_near(view, (98, 124, 150), 40), 0.02, "hand's color")
                self.assertGreater(share_near(view, (205, 50, 42), 45), 0.001, "contacts' color")
                self.assertGreater(share_near(view, (95, 150, 100), 45), 0.0005, "stable pair's color")

    def test_pre_grasp_table_and_epsilon_are_shown(self):
        def poses(shift):
            rotation = [1, 0, 0, 0]
            return {
                link: {"translation_m": [s * shift, 0, -2 * shift], "rotation_wxyz": rotation}
                for link, s in (("palm", 0), ("thumb", 1), ("finger_1", -1), ("finger_2", 0))
            }

        def add(data):
            grasp = data["results"]["grasps"][0]
            grasp["X_OL"] = poses(0.0)
            grasp["pre_grasp"] = {"X_OL": poses(0.015)}
            grasp["wrench"] = {"epsilon": 0.125}
            data["surroundings"] = {"table_z_O_m": -0.04, "obstacles": []}

        self.change(add)
        result = self.run_script("--width", "900", "--height", "500", "--up", "z")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        image = Image.open(self.folder / "grasp_001.png").convert("RGB")
        if PICTURES:
            shutil.copy(self.folder / "grasp_001.png", PICTURES / "pre_grasp.png")
        thirds = [image.crop((300 * k, 50, 300 * (k + 1), 440)) for k in range(3)]
        for third in thirds:
            self.assertGreater(share_near(third, (98, 124, 150), 40), 0.02, "hand's color")
        # The direction of view is the same, but the hand is elsewhere.
        self.assertIsNotNone(ImageChops.difference(thirds[0], thirds[2]).getbbox())
        self.assertGreater(share_near(thirds[2], (196, 207, 193), 25), 0.01, "table's color")

    def test_epsilon_is_shown_of_grasps_that_close(self):
        spec = importlib.util.spec_from_file_location("render_grasps", SCRIPT)
        script = importlib.util.module_from_spec(spec)
        sys.path.insert(0, str(pathlib.Path(SCRIPT).parent))
        spec.loader.exec_module(script)
        grasp = {"m": 1, "m1": 1, "m2": 1, "m3": 1, "state": "valid", "penetration": 0.0}
        for wrench, text in ((None, None), ({"epsilon": 0.125, "closes": True}, "epsilon 0.125"),
                             ({"epsilon": -1.0, "closes": False}, "no force closure"),
                             ({"epsilon": 1e-17, "closes": True}, "no force closure")):
            shown = script.measures_text({**grasp, "wrench": wrench})
            self.assertIn(text or "M3 1.000)   valid", shown)
            self.assertEqual("epsilon" in shown, text == "epsilon 0.125")

    def test_a_grasp_of_a_much_larger_object_is_seen_from_near(self):
        obj = self.folder / "grasp_001.obj"
        text = obj.read_text()
        count = text.count("\nv ") + text.startswith("v ")
        # A wall behind the hand, in the middle of which it is a tenth of the picture's height.
        lines, _ = box_obj(count + 1, (-0.8, 0.2, -0.8), (0.8, 0.25, 0.8))
        self.assertEqual(self.run_script("--width", "600", "--height", "400").returncode, 0)
        usual = Image.open(self.folder / "grasp_001.png").convert("RGB")
        obj.write_text(text + "\no object\n" + "\n".join(lines) + "\n")
        self.assertEqual(self.run_script("--width", "600", "--height", "400").returncode, 0)
        near = Image.open(self.folder / "grasp_001.png").convert("RGB")
        shares = [share_near(image, (98, 124, 150), 40) for image in (usual, near)]
        self.assertGreater(shares[1], 0.5 * shares[0], "the hand's part of the picture")

    def test_missing_obstacle(self):
        self.change(
            lambda data: data.update(
                surroundings={"table_z_O_m": None, "obstacles": [{"used_mesh_file": "obstacle_1.ply"}]}
            )
        )
        self.assert_refused("obstacle_1.ply", "No such file")

    def test_no_grasps_is_no_error(self):
        self.change(lambda data: data["results"].update(grasps=[]))
        self.assertEqual(self.run_script().returncode, 0)

    def test_missing_folder(self):
        self.folder = self.folder / "missing"
        self.assert_refused("missing", "no such folder")

    def test_missing_grasp_file(self):
        (self.folder / "grasps.json").unlink()
        self.assert_refused("grasps.json", "No such file")

    def test_grasp_file_and_another_output_folder(self):
        source = self.folder
        out = source / "out"
        out.mkdir()
        self.folder = source / "grasps.json"
        result = self.run_script("--out", out, "--width", "300", "--height", "200")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual([path.name for path in out.iterdir()], ["grasp_001.png"])
        self.assertFalse((source / "grasp_001.png").exists())

    def test_text_that_is_not_json(self):
        (self.folder / "grasps.json").write_text('{"results": ')
        self.assert_refused("grasps.json", "not JSON")

    def test_missing_member(self):
        self.change(lambda data: data["results"]["grasps"][0].pop("contacts"))
        self.assert_refused("grasps.json", "no /contacts")

    def test_point_that_is_not_one(self):
        self.change(lambda data: data["results"]["grasps"][0]["contacts"][1].update(point_O_m=[1, 2]))
        self.assert_refused("/results/grasps/0/contacts/1/point_O_m", "[1, 2]")

    def test_missing_mesh(self):
        (self.folder / "grasp_001.obj").unlink()
        self.assert_refused("grasp_001.obj", "No such file")

    def test_broken_mesh(self):
        mesh = self.folder / "grasp_001.obj"
        mesh.write_text("o object\nv 0 0 0\nv 1 0 0\nf 1 2 3\n")
        self.assert_refused("grasp_001.obj", "line 4", "f 1 2 3")

    def test_pair_of_missing_contacts(self):
        self.change(lambda data: data["results"]["grasps"][0].update(stable_pairs=[{"contacts": [0, 7]}]))
        self.assert_refused("grasp 1", "7")


if __name__ == "__main__":
    if not (os.environ.get("DISPLAY") or (shutil.which("xvfb-run") and shutil.which("xauth"))):
        print(f"SKIPPED: no display and no xvfb-run; {PACKAGES}")
        sys.exit(0)
    SCRIPT = sys.argv.pop(1)
    if "--keep-pictures" in sys.argv:
        at = sys.argv.index("--keep-pictures")
        PICTURES = pathlib.Path(sys.argv[at + 1])
        PICTURES.mkdir(parents=True, exist_ok=True)
        del sys.argv[at : at + 2]
    unittest.main(verbosity=2)
