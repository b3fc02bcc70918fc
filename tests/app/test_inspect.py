"""Tests of what `graspfit inspect` prints and of the files it writes, which VTK opens."""

import os
import re

import program

try:
    from vtkmodules.vtkIOPLY import vtkPLYReader
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader
except ImportError:
    vtkPLYReader = None


class InspectTest(program.ProgramTest):
    def inspect(self, *arguments):
        done = program.run("inspect", *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout

    def row(self, text, name):
        return re.search(rf"^{re.escape(name)} {{2,}}(.*)$", text, re.MULTILINE)[1]


class Inspect(InspectTest):
    def test_report_of_a_box(self):
        # The grid has 30 voxels of 1 cm along x. The box's faces lie on voxel planes, and each
        # belongs to one of its two sides.
        path = self.write("box.off", program.off_text(*program.box(0.3, 0.2, 0.1)))
        text = self.inspect(path)
        self.assertIn("8 vertices, 12 faces, 1 part; closed, manifold, outward",
                      self.row(text, "after repair"))
        self.assertEqual(self.row(text, "repair"), "nothing changed")
        self.assertEqual(self.row(text, "extents"), "0.3 x 0.2 x 0.1 m")
        self.assertAlmostEqual(float(self.row(text, "volume").split()[0]), 0.006, places=12)
        self.assertTrue(self.row(text, "voxels").endswith(" of 0.01 m"))
        counts = [int(n) for n in re.findall(r"\d+", self.row(text, "classes"))]
        lattice = [int(n) for n in self.row(text, "voxels").split(" of ")[0].split(" x ")]
        self.assertEqual(sum(counts), lattice[0] * lattice[1] * lattice[2])
        self.assertTrue(self.row(text, "patches").startswith(f"{counts[1]}, "))
        self.assertIn("above 0.6", self.row(text, "above threshold"))

    def test_thickness_and_weak_features(self):
        # The block has a fin of 3 mm, 25 mm of which stand out on one neck.
        block, faces = program.box(0.06, 0.04, 0.04)
        fin, _ = program.box(0.03, 0.003, 0.04)
        vertices = block + [(x, y, z + 0.025) for x, y, z in fin]
        faces = faces + [tuple(v + len(block) for v in face) for face in faces]
        path = self.write("finned.off", program.off_text(vertices, faces))
        env = dict(os.environ, GRASPFIT_CACHE=str(self.folder / "cache"))
        done = program.run("inspect", path, "--no-cache", env=env)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        self.assertFalse((self.folder / "cache").exists())
        self.assertRegex(self.row(done.stdout, "weak"),
                         r"^\d+\.\d% of the surface; thin regions: 1, 1 weak$")
        self.assertGreater(float(self.row(done.stdout, "weak").split("%")[0]), 5.0)
        self.assertRegex(self.row(done.stdout, "thickness"), r"^lowest 0\.00[34]\d, .* m ")
        # The first run finds weak regions, the next ones read them; what is fragile is up to the
        # user.
        for _ in range(2):
            self.assertEqual(program.run("inspect", path, env=env).stdout, done.stdout)
            self.assertEqual(len(list((self.folder / "cache").rglob("*.txt"))), 1)
        text = self.inspect(path, "--weak-thickness-mm", 2)
        self.assertEqual(self.row(text, "weak"), "0.0% of the surface; thin regions: 0")
        self.assertIn("thinner than that everywhere",
                      self.row(self.inspect(path, "--weak-thickness-mm", 50), "weak"))
        self.assert_refused("inspect", path, "--weak-thickness-mm", 0, says="--weak-thickness-mm is 0, must be > 0")
        plain = self.inspect(path, "--no-thickness")
        self.assertEqual(plain.splitlines(), [line for line in done.stdout.splitlines()
                                              if not line.startswith(("thickness", "weak"))])

    def test_report_of_defects_and_repairs(self):
        vertices, faces = program.torus()
        faces = [(a, c, b) for a, b, c in faces[2:]]  # The mesh is inside out and has a hole.
        text = self.inspect(self.write("bad.off", program.off_text(vertices, faces)))
        self.assertIn("open", self.row(text, "before repair"))
        self.assertIn("boundary edges 4", self.row(text, "before repair"))
        self.assertIn("filled holes 1", text)
        self.assertIn("turned parts 1", text)
        self.assertIn("closed, manifold, outward", self.row(text, "after repair"))
        text = self.inspect(self.folder / "bad.off", "--repair", "as-is")
        self.assertIn("none", self.row(text, "voxels"))

    def test_size_is_checked_for_a_hand(self):
        path = self.write("box.off", program.off_text(*program.box(30, 20, 10)))
        self.inspect(path)
        self.assert_refused("inspect", path, "--hand", "barrett",
                            says=["30 x 20 x 10", "--longest"])

    def write_two_boxes(self):
        a, faces = program.box(0.1, 0.1, 0.1)
        b = [(x + 0.03, y + 0.02, z + 0.01) for x, y, z in a]
        return self.write("two.off", program.off_text(
            a + b, faces + [tuple(i + 8 for i in face) for face in faces]))

    def crossings(self, text, row):
        found = re.search(r"pairs of crossing faces (\d+)", self.row(text, row))
        return int(found[1]) if found else 0

    def test_crossing_faces_are_counted_or_resolved(self):
        path = self.write_two_boxes()
        text = self.inspect(path)
        # The program did not look for them.
        self.assertEqual(self.crossings(text, "after repair"), 0)
        # The overlap of 0.07 x 0.08 x 0.09 counts once, whether or not the surfaces cross.
        union = 2 * 0.1 ** 3 - 0.07 * 0.08 * 0.09
        self.assertTrue(self.row(text, "volume").endswith(" m3, parts united"))
        self.assertAlmostEqual(float(self.row(text, "volume").split()[0]), union, places=12)
        text = self.inspect(path, "--self-intersections", "report")
        pairs = self.crossings(text, "before repair")
        self.assertGreater(pairs, 0)
        self.assertEqual(self.crossings(text, "after repair"), pairs)
        self.assert_refused("inspect", path, "--self-intersections", "report", "--repair", "strict",
                            says=[f"{pairs} pairs of crossing faces"])
        text = self.inspect(path, "--self-intersections", "resolve")
        self.assertIn(f"resolved self-intersections {pairs}, volume changed by -0.000504 m3",
                      self.row(text, "repair"))
        self.assertIn("1 part; closed, manifold, outward; no crossing faces",
                      self.row(text, "after repair"))
        self.assertAlmostEqual(float(self.row(text, "volume").split()[0]), union, places=12)

    def test_vertices_are_welded_as_far_as_asked(self):
        vertices, faces = program.box(0.1, 0.1, 0.1)
        # Every face has three vertices of its own, and those of the last one are 1e-5 m away.
        soup = [vertices[v] for face in faces for v in face]
        soup[-3:] = [(x + 1e-5, y, z) for x, y, z in soup[-3:]]
        path = self.write("soup.off", program.off_text(
            soup, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(12)]))
        self.assert_refused("inspect", path, "--max-hole", "0", says="not closed")
        text = self.inspect(path, "--weld", "0.001", "--max-hole", "0")
        self.assertIn("welded vertices 3, volume changed by", self.row(text, "repair"))
        self.assertIn("surface by at most 1e-05 m", self.row(text, "repair"))

    def test_an_open_mesh_is_wrapped_only_when_asked(self):
        vertices, faces = program.box(0.1, 0.08, 0.06)
        path = self.write("tray.off", program.off_text(vertices, faces[2:]))
        self.assert_refused("inspect", path, says="not closed")
        text = self.inspect(path, "--wrap", "--wrap-alpha", "0.2", "--wrap-offset", "0.02")
        self.assertIn("wrapped ", self.row(text, "repair"))
        self.assertIn("closed, manifold, outward", self.row(text, "after repair"))

    def test_refusals_name_what_helps(self):
        vertices, faces = program.box(0.1, 0.08, 0.06)
        path = self.write("tray.off", program.off_text(vertices, faces[2:]))
        self.assert_refused("inspect", path, says=["--max-hole 1 fills it", "--wrap"])
        self.inspect(path, "--max-hole", "1")
        self.assert_refused("inspect", self.write("cup.fbx", "?"), says=["Blender", "assimp export"])

    def test_a_wrap_that_is_not_needed_says_why(self):
        vertices, faces = program.box(0.04, 0.04, 0.16)
        path = self.write("open.off", program.off_text(vertices, faces[2:]))
        self.assertEqual(self.row(self.inspect(path, "--wrap"), "wrap"),
                         "--wrap: not needed: the mesh was closed by filling 1 hole")
        self.assertEqual(self.row(self.inspect(self.write_torus(), "--wrap"), "wrap"),
                         "--wrap: not needed: the mesh is closed as it is")
        self.assertEqual(
            self.row(self.inspect(self.write_torus(), "--wrap", "--repair", "strict"), "wrap"),
            "--wrap: not made: only --repair repair changes the mesh")

    def test_tiny_extents_are_not_rounded_away(self):
        text = self.inspect(self.write_torus(), "--longest", "1e-9", "--no-thickness")
        self.assertEqual(self.row(text, "extents"), "1e-09 x 1e-09 x 2.857e-10 m")

    def test_pipes_are_refused_at_once(self):
        path = self.folder / "pipe.stl"
        os.mkfifo(path)
        for command in ("inspect", "plan"):
            self.assert_refused(command, path, says=["pipe.stl", "is not a regular file"])
        for command in ("evaluate", "hold"):
            self.assert_refused(command, path, says=["pipe.stl", "is not a regular file"])

    def test_a_glb_of_22_bytes_is_refused_at_once(self):
        path = self.write("x.glb", b"glTF" + (2).to_bytes(4, "little") + (22).to_bytes(4, "little") +
                          (4200000000).to_bytes(4, "little") + b"JSON{}")
        self.assert_refused("inspect", path, says="chunk 0 states 4200000000 bytes, 2 are left")


class VtkFiles(InspectTest):
    def test_files_open_in_vtk_and_agree_with_the_report(self):
        if vtkPLYReader is None:
            self.skipTest("python3-vtk9 is not installed")
        out = self.folder / "out"
        text = self.inspect(self.write_torus(), "--out", out)
        self.assertEqual(sorted(path.name for path in out.iterdir()),
                         ["distance_map.vti", "patches.ply", "score_map.vti", "voxels.vti"])
        empty, partial, full = [int(n) for n in re.findall(r"\d+", self.row(text, "classes"))]

        def image(name):
            reader = vtkXMLImageDataReader()
            reader.SetFileName(str(out / name))
            reader.Update()
            self.assertEqual(reader.GetErrorCode(), 0)
            return reader.GetOutput()

        voxels = image("voxels.vti")
        data = voxels.GetCellData().GetArray(0)
        classes = [int(data.GetTuple1(i)) for i in range(data.GetNumberOfTuples())]
        self.assertEqual([classes.count(c) for c in (0, 1, 2)], [empty, partial, full])
        # The box's center is the torus' own, so that index order and origin are right.
        bounds = voxels.GetBounds()
        self.assertAlmostEqual(bounds[0] + bounds[1], 0.0, places=12)
        i, j, k = [int((p - o) / h) for p, o, h in
                   zip((0.05, 0.001, 0.001), voxels.GetOrigin(), voxels.GetSpacing())]
        nx, ny, _ = [n - 1 for n in voxels.GetDimensions()]
        self.assertEqual(classes[i + nx * (j + ny * k)], 2)

        distance = image("distance_map.vti").GetCellData().GetArray("signed_distance_voxels")
        score = image("score_map.vti").GetCellData().GetArray("score")
        for i, voxel_class in enumerate(classes):
            sign = {0: 1, 1: 0, 2: -1}[voxel_class]
            value = distance.GetTuple1(i)
            self.assertEqual((value > 0) - (value < 0), sign)
            # The number is not NaN.
            self.assertEqual(score.GetTuple1(i) == score.GetTuple1(i), voxel_class == 1)

        reader = vtkPLYReader()
        reader.SetFileName(str(out / "patches.ply"))
        reader.Update()
        patches = reader.GetOutput()
        self.assertGreater(patches.GetNumberOfCells(), partial)
        self.assertEqual(patches.GetCellData().GetArray("RGB").GetNumberOfComponents(), 3)
        area = 0.0
        points = patches.GetPoints()
        for i in range(patches.GetNumberOfCells()):
            ids = patches.GetCell(i).GetPointIds()
            corners = [points.GetPoint(ids.GetId(j)) for j in range(ids.GetNumberOfIds())]
            for p, q in zip(corners[1:], corners[2:]):
                u = [a - b for a, b in zip(p, corners[0])]
                v = [a - b for a, b in zip(q, corners[0])]
                n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                     u[0] * v[1] - u[1] * v[0])
                area += sum(x * x for x in n) ** 0.5 / 2
        vertices, faces = program.torus()
        whole = 0.0
        for a, b, c in faces:
            u = [x - y for x, y in zip(vertices[b], vertices[a])]
            v = [x - y for x, y in zip(vertices[c], vertices[a])]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            whole += sum(x * x for x in n) ** 0.5 / 2
        # VTK reads coordinates as floats of 24 bits, which is 1e-6 of the area; 10 000 pieces may
        # add up.
        self.assertAlmostEqual(area / whole, 1.0, delta=1e-5)


if __name__ == "__main__":
    program.main()
