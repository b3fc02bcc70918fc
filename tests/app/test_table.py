"""Tests of planning on a table, in a bin, and of what is said where nothing is found there."""

import csv
import json
import re
import shlex

import program

README = program.SOURCE_DIR / "app/README.md"


class RestPoses(program.ProgramTest):
    def test_all_poses_have_a_folder_each_where_there_is_one_pose(self):
        ball = self.folder / "round.off"
        program.run("shape", "ball", "--out", ball)
        for flags, folder in (((), "."), (("--rest-pose", "all"), "rest_pose_1")):
            with self.subTest(flags):
                out = self.folder / f"out{len(flags)}"
                done = program.run("plan", ball, "--on-table", "--count", "1", "--max-attempts", "5",
                                   *flags, "--out", out)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertTrue((out / folder / "grasps.json").is_file())
                self.assertEqual((out / "rest_pose_1").exists(), bool(flags))

    def test_a_pose_that_there_is_not_is_refused(self):
        self.assert_refused("plan", self.write_torus(), "--on-table", "--rest-pose", "9", says=[
            "torus.off: there is no rest pose 9 among its 2 (graspfit inspect lists them)"])


class Bin(program.ProgramTest):
    def hand_vertices(self, path):
        """Returns the vertices of the hand in a posed scene."""
        text = path.read_text()
        return [[float(x) for x in line.split()[1:]]
                for line in text[text.index("o link"):].splitlines() if line.startswith("v ")]

    def test_the_page_plans_out_of_a_bin(self):
        text = README.read_text(encoding="utf-8")
        chapter = re.search(r"(?ms)^## Out of a bin$(.*?)^## ", text).group(1)
        (script,) = re.findall(r"(?ms)^```sh\n(.*?)^```$", chapter)
        commands = [shlex.split(line, comments=True) for line in script.splitlines()]
        self.assertGreaterEqual(len(commands), 4)
        for command in commands:
            with self.subTest(command):
                self.assertEqual(command[0], "graspfit")
                done = program.run(*command[1:], cwd=self.folder)
                self.assertEqual(done.returncode, 0, done.stderr)
        out = self.folder / "mug_in_bin"
        self.assertIn("obstacle", (out / "grasps.html").read_text())
        file = json.loads((out / "grasps.json").read_text())
        obstacle, = file["surroundings"]["obstacles"]
        self.assertEqual(obstacle["file"], "bin.off")
        self.assertEqual(file["surroundings"]["table_z_O_m"], 0)

        # The object stands in the bin, between its walls, off its middle.
        inner = {"x": 0.346 / 2, "y": 0.265 / 2}
        middle = {"x": 0.06, "y": 0.04}
        box = file["object"]["mesh"]["bounding_box_m"]
        self.assertAlmostEqual(box["lower"][2], 0, places=12)
        for axis, name in enumerate(inner):
            self.assertLess(max(middle[name] - box["lower"][axis], box["upper"][axis] - middle[name]), inner[name])

        # So is the hand, at the grasp by its vertices, on the way there by what is measured.
        with open(out / "grasps.csv", newline="", encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
        self.assertGreaterEqual(len(rows), 1)
        for rank, row in enumerate(rows, 1):
            for x, y, z in self.hand_vertices(out / f"grasp_{rank:03}.obj"):
                self.assertGreater(z, 0.001)
                if z < 0.1:
                    self.assertLess(abs(x - middle["x"]), inner["x"])
                    self.assertLess(abs(y - middle["y"]), inner["y"])
            self.assertGreaterEqual(float(row["pre_grasp_clearance_m"]), 0.005)
        # By exact queries too, from the files.
        self.assertEqual(commands[-1][1], "evaluate")
        lines = done.stdout.splitlines()
        valid = lines[0].split().index("valid") - lines[0].split().index("rank") - 2
        for line in lines[1:1 + len(rows)]:
            self.assertEqual(line.split()[valid], "yes", done.stdout)

    def test_walls_stop_the_hand(self):
        # The hand is wider than this bin, and the ball lies deep in it.
        self.assertEqual(program.run("shape", "bin", "--set", "inner_length=0.1,inner_width=0.1,inner_height=0.3",
                                     "--out", self.folder / "bin.off").returncode, 0)
        self.assertEqual(program.run("shape", "ball", "--out", self.folder / "round.off").returncode, 0)
        message = self.assert_refused(
            "plan", self.folder / "round.off", "--preset", "strong", "--on-table", "--obstacle",
            self.folder / "bin.off", "--max-attempts", "2", code=3)
        self.assertRegex(message, r"2 of 2 attempts: .*more room to the obstacles")


class NoGrasp(program.ProgramTest):
    def test_it_is_said_what_stopped_most_and_what_would_help(self):
        # A plate of 12 mm, beside which fingers cannot lie.
        plate = self.write("plate.off", program.off_text(*program.box(0.2, 0.15, 0.012)))
        message = self.assert_refused(
            "plan", plate, "--preset", "strong", "--on-table", "--max-attempts", "3", code=3)
        self.assertRegex(message, r"; 3 of 3 attempts: .* or another --hand\n$")
        self.assertIn("the object raised or tilted (it is 12 mm high, and the fingertips are ", message)
        self.assertIn("a smaller --table-clearance-mm (now 1)", message)
        self.assertIn("more --max-attempts (now 3)", message)
        # Without a clearance one attempt of twenty lays the Barrett hand around that plate: one of 8 mm.
        lower = self.write("lower.off", program.off_text(*program.box(0.2, 0.15, 0.008)))
        message = self.assert_refused(
            "plan", lower, "--preset", "strong", "--on-table", "--max-attempts", "3", "--approach",
            "0,0,-1", "--approach-angle-deg", "20", "--table-clearance-mm", "0", code=3)
        self.assertIn("a wider --approach-angle-deg (now 20)", message)
        self.assertNotIn("--table-clearance", message)


if __name__ == "__main__":
    program.main()
