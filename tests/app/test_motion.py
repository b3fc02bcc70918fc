"""graspfit motion: a motion of table_tidying, checked again and shown."""

import csv
import json

from program import ProgramTest, main, run


class Motion(ProgramTest):
    """Tests on the quick table. Its motion is checked at half the steps at which it was
    measured."""

    def setUp(self):
        super().setUp()
        out = self.folder / "out"
        done = run("experiment", "run", "table_tidying", "--quick", "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(out / "table_tidying.csv", newline="", encoding="utf-8") as stream:
            self.row = next(csv.DictReader(stream))
        with open(out / "table_tidying.details.csv", newline="", encoding="utf-8") as stream:
            self.details = list(csv.DictReader(stream))
        self.motion = next((out / "cells").glob("*/motion.json"))

    def test_tidies_checks_and_shows(self):
        self.assertEqual((self.row["status"], self.row["at_goal"]), ("ok", self.row["objects"]),
                         self.row)
        self.assertEqual(self.row["overlaps"], "0")
        self.assertLess(float(self.row["goal_error_m"]), 1e-9)
        self.assertLess(float(self.row["goal_error_rad"]), 1e-7)
        travelling = [row for row in self.details if row["phase"] in ("reach", "transport", "retreat")]
        self.assertEqual(len(travelling), 3 * int(self.row["moves"]))
        for row in travelling:
            self.assertGreater(float(row["hand_clearance_m"]), float(self.row["proven_clearance_m"]))

        page = self.folder / "motion.html"
        done = run("motion", self.motion, "--step-mm", "10", "--html", page)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count(" yes\n"), int(self.row["moves"]), done.stdout)
        self.assertIn("A flower pot past a bottle", page.read_text(encoding="utf-8"))
        self.assertIn('"check":"free"', page.read_text(encoding="utf-8"))
        done = run("motion", self.motion, "--no-check", "--html", page)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn('"check":"not_checked"', page.read_text(encoding="utf-8"))

        # This goes into the table: it is the pose in which the first object is put down, 5 mm
        # deeper.
        motion = json.loads(self.motion.read_text())
        steps = motion["moves"][0]["to"]
        place = next(i for i, step in enumerate(steps) if step["phase"] == "place")
        steps[place]["X_WH"]["translation_m"][2] -= 0.005
        for step in steps[place:]:
            step["X_WO"]["translation_m"][2] -= 0.005
        changed = self.write("changed.json", json.dumps(motion))
        done = run("motion", changed, "--step-mm", "50", "--html", page)
        self.assertEqual(done.returncode, 4, done.stdout + done.stderr)
        self.assertIn("and table", done.stdout)
        self.assertIn('"check":"not_free"', page.read_text(encoding="utf-8"))

        # This is another mesh than the one that was moved.
        motion["objects"][1].update(file=self.write_torus("bottle.off").name, sha256="0" * 64)
        other = self.write("other.json", json.dumps(motion))
        self.assert_refused("motion", other, "--meshes", self.folder, says=["bottle.off", "SHA-256"])


class BadFlags(ProgramTest):
    def test_help_says_what_exit_code_4_means(self):
        text = run("motion", "--help").stdout
        self.assertIn("motion: not free of collisions", " ".join(text.split()))

    def test_refusals(self):
        self.assert_refused("motion", says=["MOTION.json"])
        self.assert_refused("motion", "none.json", says=["none.json"])
        self.assert_refused("motion", self.write("x.json", "{}"), says=["/format"])
        for step in ("0", "-5", "1e-300", "0.009"):
            self.assert_refused("motion", "x.json", "--step-mm", step,
                                says=[f"--step-mm {step} is below 0.01 mm"])


if __name__ == "__main__":
    main()
