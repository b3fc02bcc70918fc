#!/usr/bin/python3
"""Tests that the independent check recomputes grasps that the program plans, and that it finds
wrong numbers in files. The program is $GRASPFIT."""

import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy  # noqa: F401
    import scipy  # noqa: F401
except ImportError as missing:
    print(f"SKIPPED: {missing.name} is not installed")
    sys.exit(0)

CHECK = pathlib.Path(__file__).parent / "check_grasps.py"
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache"))
PACKAGED_MESHES = os.environ.get("GRASPFIT_PACKAGED_MESHES", CACHE / "graspfit/meshes")
BUNNY = pathlib.Path(PACKAGED_MESHES) / "bunny00.off"


class Planned(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_program(self, *arguments):
        done = subprocess.run([os.environ["GRASPFIT"], *map(str, arguments)], capture_output=True,
                              text=True, check=False, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)

    def shape(self, kind, *settings):
        self.run_program("shape", kind, *settings, "--out", self.folder / f"{kind}.off")
        return self.folder / f"{kind}.off"

    def plan(self, mesh, *arguments):
        """Returns the path of the file, and what is in it."""
        out = self.folder / "out"
        self.run_program("plan", mesh, "--out", out, "--quiet", *arguments)
        path = out / "grasps.json"
        return path, json.loads(path.read_text())

    def check(self, *paths):
        return subprocess.run([sys.executable, "-B", CHECK, *paths], capture_output=True, text=True,
                              check=False)

    def assert_agrees(self, mesh, *arguments, least=1):
        path, record = self.plan(mesh, *arguments)
        self.assertGreaterEqual(len(record["results"]["grasps"]), least)
        done = self.check(path)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return path, record


class Hands(Planned):
    def test_barrett_on_a_torus_with_a_table_and_what_is_altered_is_found(self):
        path, record = self.assert_agrees(
            self.shape("torus", "--set",
                       "major_radius=0.05,minor_radius=0.02,major_segments=48,minor_segments=24"),
            "--count", 2, "--max-attempts", 20, "--table", -0.2)
        self.assertIsNotNone(record["results"]["grasps"][0]["wrench"])

        def turn_joint(grasp):
            name = max(grasp["joints"], key=grasp["joints"].get)
            grasp["joints"][name] += 1e-6

        # Files hold the first grasp alone. Sampling the way in is most of the work, so that all but
        # "clearance" are without its pre-grasp; that the grasp agrees without a change is the first
        # of them.
        changes = {
            "nothing": lambda g: None,
            "a joint": turn_joint,
            "gap": lambda g: g["contacts"][0].update(gap_m=g["contacts"][0]["gap_m"] + 1e-7),
            "area": lambda g: g["contacts"][0].update(area_m2=g["contacts"][0]["area_m2"] * 1.0001),
            "M": lambda g: g.update(m=g["m"] * 1.00001),
            "epsilon": lambda g: g["wrench"].update(epsilon=g["wrench"]["epsilon"] + 1e-7),
            "penetration": lambda g: g["penetration"].update(object_intersects=True),
            "pair": lambda g: g["stable_pairs"].pop(),
            "contact": lambda g: g["contacts"].pop(),
            "clearance": lambda g: g["pre_grasp"].update(clearance_m=0.0049),
            "squeeze": lambda g: g["squeeze"]["forces_O_N"].reverse()}
        files = {}
        for what, change in changes.items():
            changed = copy.deepcopy(record)
            del changed["results"]["grasps"][1:]
            grasp = changed["results"]["grasps"][0]
            change(grasp)
            if what != "clearance":
                grasp["pre_grasp"] = None
            files[what] = path.with_name(f"altered_{len(files)}.json")
            files[what].write_text(json.dumps(changed))
        done = self.check(*files.values())
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        # The report of a file begins with the file's path.
        reports = done.stdout.split(str(path.parent / "altered_"))[1:]
        self.assertEqual(len(reports), len(files), done.stdout)
        for what, report in zip(files, reports):
            with self.subTest(what):
                self.assertEqual("DIFFERS" in report, what != "nothing", report)

    def test_gripper_on_a_ball(self):
        self.assert_agrees(self.shape("ball", "--set", "radius=0.03"), "--hand",
                           "parallel_gripper", "--contacts", 2, "--count", 2, "--max-attempts", 4)

    def test_human_hand_on_a_ball(self):
        self.assert_agrees(self.shape("ball", "--set", "radius=0.03"), "--hand", "human_hand",
                           "--count", 1, "--max-attempts", 10)

    def test_voxel_only_grasps_that_cut_the_object(self):
        _, record = self.assert_agrees(
            self.shape("ball", "--set", "radius=0.03"), "--count", 4, "--max-attempts", 10,
            "--refine", "off", "--guard", "voxels", "--contact-state", "first-graze",
            "--accept", "usable",
            "--search", "first", "--averaging", "plain", "--regularity", "angle-only",
            "--centroid", "vertices")
        self.assertTrue(any(grasp["penetration"]["object_intersects"]
                            for grasp in record["results"]["grasps"]))


class Bunny(Planned):
    """Tests on 75 408 triangles: Barrett and human hand, precision and power, 50 grasps in all."""

    def test_fifty_grasps(self):
        if not BUNNY.is_file():
            print("SKIPPED: bunny00.off is not there (see tests/support/test_data.hpp)")
            return
        total = 0
        for hand, style, count in (("barrett", "precision", 25), ("barrett", "power", 10),
                                   ("human_hand", "precision", 15)):
            with self.subTest(f"{hand} {style}"):
                _, record = self.assert_agrees(BUNNY, "--longest", 0.12, "--hand", hand,
                                               "--style", style, "--count", count, "--search",
                                               "first", "--max-attempts", 400)
                total += len(record["results"]["grasps"])
        self.assertGreaterEqual(total, 50)


if __name__ == "__main__":
    unittest.main(verbosity=2)
