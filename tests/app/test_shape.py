"""`graspfit shape` writes meshes that the other commands take without any repair."""

import re

import program


class Shape(program.ProgramTest):
    def names(self):
        done = program.run("shape", "--list")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return re.findall(r"(?m)^(\w+): ", done.stdout)

    def test_every_shape_is_written_and_needs_no_repair(self):
        names = self.names()
        self.assertEqual(names, sorted(names))
        self.assertLessEqual({"bottle", "mug", "octopus", "table", "torus"}, set(names))
        for name in names:
            with self.subTest(name):
                path = self.folder / f"{name}.off"
                done = program.run("shape", name, "--out", path)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                vertices, faces = path.read_text().split()[1:3]
                self.assertIn(f"{name}.off: {vertices} vertices, {faces} faces, ", done.stdout)
                text = program.run("inspect", path, "--repair", "strict", "--no-thickness").stdout
                self.assertRegex(text, r"(?m)^repair +nothing changed")

    def test_dimensions_are_those_given(self):
        path = self.folder / "mug.obj"
        done = program.run("shape", "mug", "--set", "height=0.12,segments=120", "--out", path)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("0.12 x 0.082 x 0.12 m", done.stdout)
        first = path.read_bytes()
        program.run("shape", "mug", "--set", "segments=120,height=0.12", "--out", path)
        self.assertEqual(path.read_bytes(), first)

    def test_a_shape_goes_where_it_is_asked_to(self):
        def vertices(*arguments):
            path = self.folder / "bin.off"
            done = program.run("shape", "bin", *arguments, "--out", path)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            lines = path.read_text().splitlines()
            return [[float(x) for x in line.split()] for line in lines[2:2 + int(lines[1].split()[0])]]

        at = (0.1, -0.05, 0.25)
        middle = vertices()
        moved = vertices("--at", "0.1,-0.05,0.25")
        self.assertEqual(len(moved), len(middle))
        for a, b in zip(middle, moved):
            for x, y, shift in zip(a, b, at):
                self.assertAlmostEqual(x + shift, y, places=12)
        self.assertEqual(vertices("--at", "0,0,0"), middle)

    def test_what_cannot_be_built_is_refused(self):
        out = ["--out", self.folder / "x.obj"]
        for arguments, says in [
                (["cup"] + out, ["cup", "bottle", "mug"]),
                (out, "NAME"),
                (["mug"], "--out"),
                (["mug", "--out", self.folder / "x.xyz"], "xyz"),
                (["mug", "--at", "1,2"] + out, ["--at", "1,2", "three numbers"]),
                (["mug", "--at", "1,2,up"] + out, ["--at", "up"]),
                (["mug", "--set", "height"] + out, ["height", "NAME=VALUE"]),
                (["mug", "--set", "height=tall"] + out, ["height", "tall"]),
                (["mug", "--set", "hight=1"] + out, ["hight", "handle_height"]),
                (["mug", "--set", "height=0.1,height=0.2"] + out, "twice"),
                (["mug", "--set", "segments=9.5"] + out, ["segments", "9.5", "integer"]),
                (["mug", "--set", "height=-1"] + out, ["height", "-1"]),
                (["mug", "--set", "wall_thickness=0.5"] + out, "wall_thickness"),
                (["bottle", "--set", "segments=90"] + out, ["90", "multiple of 4"])]:
            with self.subTest(arguments):
                self.assert_refused("shape", *arguments, says=says)


if __name__ == "__main__":
    program.main()
