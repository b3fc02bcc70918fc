"""Every bad input ends in one clear line, a code of its kind, and no output left behind."""

import json
import os
import resource
import shutil
import subprocess

import program
from program import box, off_text, torus


class BadMeshes(program.ProgramTest):
    def refuse(self, path, says=()):
        self.assert_refused("plan", path, "--longest", "0.14", "--out", self.folder / "out",
                            says=[path.name, *([says] if isinstance(says, str) else says)])

    def test_missing_file(self):
        self.refuse(self.folder / "nothing.off")

    def test_folder_instead_of_a_file(self):
        path = self.folder / "mesh.off"
        path.mkdir()
        self.refuse(path)

    def test_empty_file(self):
        for extension in ("off", "obj", "ply", "stl", "glb"):
            with self.subTest(extension):
                self.refuse(self.write(f"empty.{extension}", ""), "empty")

    def test_unknown_extension(self):
        self.refuse(self.write("cup.xyz", off_text(*torus())), "xyz")
        self.refuse(self.write("cup", off_text(*torus())))

    def test_text_that_is_not_a_mesh(self):
        for extension in ("off", "obj", "ply", "stl", "gltf", "glb"):
            with self.subTest(extension):
                self.refuse(self.write(f"letter.{extension}", "Dear Sir,\nno mesh here.\n"))

    def test_truncated_file(self):
        self.refuse(self.write("half.off", off_text(*torus())[:9000]))

    def test_coordinates_that_are_not_finite(self):
        vertices, faces = torus()
        for value in ("nan", "inf", "-inf", "1e999"):
            with self.subTest(value):
                lines = off_text(vertices, faces).splitlines()
                lines[5] = f"0.01 {value} 0.02"
                self.refuse(self.write("bad.off", "\n".join(lines) + "\n"))
                obj = "".join(f"v {x} {y} {z}\n" for x, y, z in vertices[1:])
                obj = f"v 0.01 {value} 0.02\n" + obj
                obj += "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces)
                self.refuse(self.write("bad.obj", obj))

    def test_face_index_out_of_range(self):
        vertices, faces = torus()
        self.refuse(self.write("bad.off", off_text(vertices, faces + [(0, 1, 99999)])), "99999")
        self.refuse(self.write("neg.off", off_text(vertices, faces + [(0, 1, -7)])))
        obj = "".join(f"v {x} {y} {z}\n" for x, y, z in vertices)
        obj += "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces) + "f 1 2 99999\n"
        self.refuse(self.write("bad.obj", obj))

    def test_zero_faces(self):
        self.refuse(self.write("points.off", off_text(torus()[0], [])), "no faces")

    def test_point_cloud(self):
        vertices = torus()[0]
        ply = (f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\n"
               "property float y\nproperty float z\nend_header\n")
        ply += "".join(f"{x} {y} {z}\n" for x, y, z in vertices)
        self.refuse(self.write("cloud.ply", ply), "point cloud")
        obj = "".join(f"v {x} {y} {z}\n" for x, y, z in vertices)
        self.refuse(self.write("cloud.obj", obj), "point cloud")

    def test_box_without_a_side_is_refused_as_open(self):
        # The hole is as long as the box; by default one of half the length is filled.
        vertices, faces = box(0.1, 0.08, 0.06)
        self.refuse(self.write("tray.off", off_text(vertices, faces[2:])), "boundary edges")

    def test_small_hole_is_repaired_and_recorded_or_refused_as_asked(self):
        vertices, faces = torus()
        path = self.write("hole.off", off_text(vertices, faces[:-2]))
        done = program.run("inspect", path)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("filled holes 1", done.stdout)
        self.assert_refused("plan", path, "--repair", "strict", says="hole.off")
        self.assert_refused("plan", path, "--repair", "as-is", says=["open", "--repair"])
        self.assert_refused("plan", path, "--max-hole", "0.01", says="hole.off")

    def test_flat_mesh(self):
        self.refuse(self.write("flat.off", off_text([(0, 0, 0), (1, 0, 0), (0, 1, 0)],
                                                    [(0, 1, 2), (0, 2, 1)])))

    def test_object_of_impossible_size_says_extents_and_flags(self):
        for size, extent in ((150.0, "150"), (0.002, "0.002")):
            with self.subTest(size):
                path = self.write("block.off", off_text(*box(size, size, size)))
                self.assert_refused("plan", path, "--out", self.folder / "out",
                                    says=[extent, " m", "--mesh-unit", "--longest"])


class BadFlags(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.object = self.write_torus()

    def refuse(self, *flags, says=()):
        self.assert_refused("plan", self.object, "--out", self.folder / "out", *flags, says=says)

    def test_hand_and_fingers(self):
        self.refuse("--hand", "claw", says=["claw", "barrett"])
        self.refuse("--hand", self.folder / "no.urdf", says="no.urdf")
        self.refuse("--contacts", "4", says=["3 fingers", "4"])
        self.refuse("--contacts", "1")
        self.refuse("--fingers", "finger_1,pinky", says=["pinky", "thumb"])
        self.refuse("--fingers", "thumb", says="two")
        self.refuse("--fingers", "thumb,thumb", says="twice")
        self.refuse("--fingers", "thumb,,finger_1", says="empty")
        self.refuse("--fingers", "thumb,finger_1", "--contacts", "3", says="contradicts")

    def test_palm_and_style(self):
        self.refuse("--palm", "--no-palm", says="exclude")
        hand = self.folder / "hand"
        shutil.copytree(program.SOURCE_DIR / "hands/models/barrett", hand)
        sidecar = hand / "barrett.graspfit.json"
        data = json.loads(sidecar.read_text())
        data["pads"] = [pad for pad in data["pads"] if pad["finger"] != "palm"]
        data["palm"]["pad"] = None
        sidecar.write_text(json.dumps(data))
        self.refuse("--hand", hand / "barrett.urdf", "--palm", says=["barrett", "palm"])
        self.refuse("--hand", hand / "barrett.urdf", "--style", "power",
                    says=["barrett", "palm", "--no-palm asks for none"])

    def test_surroundings(self):
        self.refuse("--table", "0.5", says=["--table", "highest z"])
        self.refuse("--table", "low", says="--table")
        self.refuse("--obstacle", self.folder / "no.off", says="no.off")
        self.refuse("--obstacle-unit", "mm", says=["without --obstacle"])
        self.refuse("--obstacle", self.object, "--obstacle-unit", "ft", says=["m|cm|mm|in"])
        vertices, faces = box(0.1, 0.08, 0.06)
        tray = self.write("tray.off", off_text(vertices, faces[2:]))
        self.refuse("--obstacle", tray, says="tray.off")

    def test_flags_that_mean_nothing_together(self):
        self.refuse("--approach-angle-deg", "30", says="without --approach")
        self.refuse("--no-weak", "--weak-thickness-mm", "4", says="with --no-weak")
        self.refuse("--no-weak", "--exclude-weak", "no", says="with --no-weak")

    def test_values_out_of_range(self):
        for flag, *values in (
                ("score-threshold", "-0.1", "1", "1.5"), ("theta-max-deg", "0", "-5", "90", "120"),
                ("resolution", "3", "513", "-30"), ("count", "0", "-1"), ("max-attempts", "0"),
                ("max-iterations", "0", "-1", "1.5"),
                ("contact-score-threshold", "-0.1", "1"),
                ("alpha", "-1"), ("beta", "-0.3"), ("w1", "-1"), ("w2", "-1"), ("w3", "-1"),
                ("max-hole", "-0.1", "1.1"), ("weld", "-0.001", "0.011"), ("longest", "0", "-0.15"),
                ("clip-thickness-mm", "0", "-1"), ("wall-clock-limit-s", "0", "-1"),
                ("edge-tolerance", "-1"), ("pool-fraction", "0", "1.1"), ("max-seeds", "0"),
                ("clearance-mm", "-1"), ("mean-filter-radius", "-1"),
                ("score-length-voxels", "0"), ("threads", "-1"), ("friction", "-0.1"),
                ("squeeze-friction", "-0.1"),
                ("squeeze-force", "0"), ("squeeze-stiffness", "0"), ("ideal-m-bias", "-1"),
                ("ideal-m-draws", "0"), ("angle-weight", "-1"), ("palm-reach-tolerance-mm", "-1"),
                ("weak-thickness-mm", "0"), ("largest-gap-mm", "0"), ("wanted-gap-mm", "0", "0.2"),
                ("least-distance-mm", "0"), ("largest-shift-mm", "-1"), ("largest-turn-deg", "-1"),
                ("refine-iterations", "0", "1001"), ("slide-steps", "-1", "99999"), ("near-pad-steps", "1001"), ("pre-grasp-clearance-mm", "0"),
                ("pre-grasp-retreat-mm", "-1"), ("distinct-translation-mm", "-1"),
                ("distinct-rotation-deg", "-1"), ("distinct-joints", "-1"), ("seed", "-1", "18446744073709551616")):
            for value in values:
                with self.subTest(flag=flag, value=value):
                    line = self.assert_refused("plan", self.object, f"--{flag}", value,
                                               says=[f"graspfit plan: --{flag} ", value])
                    self.assertNotRegex(line, "Options|[a-z]_[a-z]")  # These would be names of C++.
        self.refuse("--clearance-mm", "1e30", says="--clearance-mm is 1e+30, must be in [0, 10000]")
        self.refuse("--approach", "0,0,0", says="--approach is a direction without length")
        self.refuse("--fingers", "thumb", says="--fingers asks for 1 finger, must be at least two")
        self.refuse("--missing-contact", "measured", says=["--missing-contact is measured", "refine off"])
        self.refuse("--largest-gap-mm", "0.01", says=["--wanted-gap-mm is ", "below largest-gap-mm, which is 0.01"])
        for planner in ("gs", "ma"):
            self.refuse("--planner", planner, f"--{planner}-samples", "0",
                        says=f"--{planner}-samples is 0, must be in [1, 1000000]")
        for flag, value, says in (("resolution", "3", "in [4, 512]"), ("weld", "-1", "in [0, 0.01]"),
                                  ("weak-thickness-mm", "0", "> 0"), ("mean-filter-radius", "32", "in [0, 31]")):
            self.assert_refused("inspect", self.object, f"--{flag}", value,
                                says=f"graspfit inspect: --{flag} is {value}, must be {says}")

    def test_wrap_out_of_range(self):
        for flag, *values in (("wrap-alpha", "0", "0.0009", "1.1"), ("wrap-offset", "0", "2")):
            for value in values:
                with self.subTest(flag=flag, value=value):
                    self.refuse("--wrap", f"--{flag}", value, says=f"--{flag} is {value}, must be in [")
            self.refuse(f"--{flag}", "0.1", says=["without --wrap"])

    def test_text_that_is_not_a_number(self):
        for value in ("abc", "1.5x", "0,3", "nan", "inf", "-inf", "1e999", "0x10", "--1", " 1",
                      "1 ", ""):
            with self.subTest(value):
                self.refuse(f"--alpha={value}", says="alpha")
                self.refuse(f"--longest={value}", says="longest")
        for value in ("3.5", "1e3", "abc", "3,0", "99999999999999999999"):
            with self.subTest(value):
                self.refuse(f"--count={value}", says="count")
        self.refuse("--beta", "0,3", says="point")
        for value in ("0", "-10", "181"):
            self.refuse("--approach", "0,0,1", f"--approach-angle-deg={value}", says="angle")
        for value in ("1,2", "1,2,3,4", "1,b,3", "0,0,0", "1,,3", "1,2,"):
            with self.subTest(value):
                self.refuse(f"--approach={value}")

    def test_unknown_choices(self):
        for flag in ("style", "accept", "score-normalization", "plane-distance", "averaging",
                     "pair-rule", "regularity", "centroid", "measure-units", "repair", "mesh-unit",
                     "self-intersections", "target-search", "refine", "pre-grasps", "exclude-weak",
                     "contact-state", "palm-after-contact", "counted-pads", "contact-pieces",
                     "contact-faces",
                     "reject", "guard-self", "pre-grasp-open-neutral",
                     "pre-grasp-leave-pressing", "candidate-order", "keep", "search", "rank"):
            with self.subTest(flag):
                self.refuse(f"--{flag}", "whatever", says=["whatever", f"--{flag}"])

    def test_a_mistyped_name_is_told_from_its_nearest_known_one(self):
        self.assert_refused("plam", says='did you mean "plan"?')
        self.assert_refused("hand", "shwo", says='did you mean "show"?')
        self.assert_refused("shape", "toru", "--out", self.folder / "x.obj", says='did you mean "torus"?')
        self.assert_refused("evaluate", self.object, "--metrics", "epsilonn",
                            says='did you mean "epsilon"?')
        self.assert_refused("hold", self.object, "--protocol", "dexonomy",
                            says=["--protocol", 'did you mean "dexonomy-hard"?'])
        self.assert_refused("hold", self.object, "--set", "forceN=1", says='did you mean "force_N"?')
        self.refuse("--resolutoin", "20", says='unknown option --resolutoin; did you mean "--resolution"?')
        self.refuse("--resolutoin=20", says='unknown option --resolutoin; did you mean "--resolution"?')
        self.refuse("--resol=10", says='unknown option --resol; did you mean "--resolution"?')
        self.refuse("--hand", "barett", says='did you mean "barrett"?')
        self.refuse("--fingers", "thumb,finger1", says='did you mean "finger_1"?')
        self.refuse("--style", "presicion", says='did you mean "precision"?')
        self.refuse("--planner", "fiting", says='did you mean "fitting"?')
        self.refuse("--hold", "tabletop-lfit", says=["--hold", 'did you mean "tabletop-lift"?'])
        self.refuse("--rank", "margin", says="--rank margin needs --hold PROTOCOL")
        # The program guesses at no name that is near to nothing.
        self.assertNotIn("mean", self.assert_refused("grab", self.object))
        self.assertNotIn("mean", self.assert_refused("plan", self.object, "--fastest"))

    def test_flags_that_do_not_exist_or_fit(self):
        self.refuse("--fastest", says="--fastest")
        self.refuse("--cou", "3", says="--cou")  # Abbreviations are not guessed.
        self.refuse("--count", says="count")
        self.refuse("--count", "1", "--count", "2", says="count")
        self.refuse("second.off", says="more than one")
        self.refuse("--mesh-unit", "mm", "--longest", "0.15", says="exclude")
        self.assert_refused("plan", says="OBJECT")
        self.assert_refused("plan", self.object, "--pictures", says="--out")
        self.assert_refused("plan", self.object, "--page", says="--out")
        self.assert_refused("evaluate", says="GRASPS.json")
        self.assert_refused("inspect", self.object, "--count", "3", says="--count")
        self.assert_refused("grab", self.object, says="grab")
        self.assert_refused(says="command")

    def test_a_name_that_begins_with_a_dash_comes_after_two(self):
        self.write_torus("-strange=name.off")
        self.write_torus("--stranger.off")
        for name in ("-strange=name.off", "--stranger.off"):
            for command in (("plan", "--count", "1"), ("inspect",)):
                with self.subTest(name=name, command=command):
                    done = program.run(*command, "--", name, cwd=self.folder)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assert_refused(*command, name, cwd=self.folder,
                                        says=["unknown option -", "the file of that name is given after --"])
        self.assert_refused("plan", "--", "-strange=name.off", "--count", "1", cwd=self.folder,
                            says="more than one OBJECT")
        self.assertIn("a name may begin with -", program.run("plan", "--help").stdout)

    def test_output_folder_that_cannot_be_written(self):
        file = self.write("file", "keep me")
        self.assert_refused("plan", self.object, "--out", file, says="file")
        self.assert_refused("plan", self.object, "--out", file / "below", says="file")
        self.assert_refused("plan", self.object, "--out", "/proc/graspfit", says="/proc")
        self.assert_refused("plan", self.object, "--out=", says="out")
        self.assertEqual(file.read_text(), "keep me")

    def test_folder_without_permission(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        locked = self.folder / "locked"
        locked.mkdir(mode=0o555)
        self.assert_refused("plan", self.object, "--out", locked / "out", says="locked")


class FileSizeLimit(program.ProgramTest):
    """Limits the size of files as `ulimit -f` does: a file that would grow beyond it."""

    def run_limited(self, size, *arguments, stdout=subprocess.PIPE):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        return subprocess.run([program.PROGRAM, *map(str, arguments)], stdout=stdout,
                              stderr=subprocess.PIPE, text=True, preexec_fn=limit, check=False)

    def test_it_is_said_and_leaves_nothing(self):
        mesh = self.write_torus()
        before = self.contents()
        for size, arguments in ((1000, ("shape", "octopus", "--out", self.folder / "octopus.off")),
                                (3000, ("plan", mesh, "--count", "2", "--out", self.folder / "out"))):
            with self.subTest(arguments[0]):
                done = self.run_limited(size, *arguments)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertRegex(done.stderr, f"^graspfit {arguments[0]}: .*File too large")
                self.assertEqual(self.contents(), before)

    def test_of_standard_output_it_is_said(self):
        with open(self.folder / "out.txt", "w", encoding="utf-8") as stream:
            done = self.run_limited(1000, "plan", "--help", stdout=stream)
        self.assertEqual((done.returncode, done.stderr),
                         (1, "graspfit: standard output could not be written\n"))


class NoGrasp(program.ProgramTest):
    def test_no_grasp_found_has_its_own_code_and_says_why(self):
        # The friction cone is half a degree wide, and no two voxels of a torus face each other so
        # well.
        message = self.assert_refused(
            "plan", self.write_torus(), "--theta-max-deg", "0.5", "--max-attempts", "4",
            "--out", self.folder / "out", code=3, says=["no valid grasp", "4 attempts"])
        self.assertRegex(message, r"4 attempts \(all attempts made\): .* \d+")


if __name__ == "__main__":
    program.main()
