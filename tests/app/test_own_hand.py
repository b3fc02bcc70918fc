"""What hands/README.md says about bringing a hand of one's own works as it stands there."""

import json
import re
import shlex

import program

README = program.SOURCE_DIR / "hands" / "README.md"


def blocks(text, language):
    return re.findall(rf"(?ms)^```{language}\n(.*?)^```$", text)


class OwnHand(program.ProgramTest):
    def test_every_command_of_the_page_runs_on_the_description_that_it_shows(self):
        text = README.read_text(encoding="utf-8")
        chapter = re.search(r"(?ms)^## Your own hand in five minutes$(.*?)^## ", text).group(1)
        (urdf,) = blocks(chapter, "xml")
        (self.folder / "claw.urdf").write_text(urdf, encoding="utf-8")
        (script,) = blocks(chapter, "sh")
        commands = [shlex.split(line, comments=True) for line in script.splitlines()]
        commands = [command for command in commands if command]
        self.assertGreaterEqual(len(commands), 5)
        for command in commands:
            with self.subTest(command):
                self.assertEqual(command[0], "graspfit")
                if "--png" in command:
                    continue  # It needs a display; the pictures have tests of their own.
                done = program.run(*command[1:], cwd=self.folder)
                self.assertEqual(done.returncode, 0, done.stderr)
        grasps = json.loads((self.folder / "grasps" / "grasps.json").read_text(encoding="utf-8"))
        self.assertGreaterEqual(len(grasps["results"]["grasps"]), 1)
        sidecar = json.loads((self.folder / "claw.graspfit.json").read_text(encoding="utf-8"))
        # The derived sidecar is what the page says.
        self.assertEqual([len(finger["links"]) for finger in sidecar["fingers"]], [1, 1])
        self.assertEqual(sidecar["palm"]["direction"], [0.0, 0.0, 1.0])
        # What follows a joint closes with it.
        self.assertEqual(sidecar["closing"], {"left_hinge": 1})


if __name__ == "__main__":
    program.main()
