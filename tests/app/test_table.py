"""Tests of planning on a table."""

import program


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


if __name__ == "__main__":
    program.main()
