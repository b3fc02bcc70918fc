"""Tests of what `graspfit plan` writes and prints."""

import importlib.util
import json
import os
import re
import shutil
import subprocess

import program

# With these flags the first grasps with M > 0 of a few attempts count.
FAST = ("--preset", "exact", "--accept", "usable", "--search", "first")


def results_text(path):
    """Returns the results of a grasp file as its own bytes."""
    text = path.read_text()
    return text[text.index('\n  "results": '):text.index('\n  "timings": ')]


class Plan(program.ProgramTest):
    def plan(self, *flags, out="out", **options):
        done = program.run("plan", self.folder / "torus.off", "--count", "2", "--seed", "7",
                           *FAST, "--out", self.folder / out, *flags, **options)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def setUp(self):
        super().setUp()
        self.write_torus()

    def options(self, *flags):
        """The preset and the options that are recorded."""
        done = program.run("plan", self.folder / "torus.off", *flags, "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        planner = json.loads((self.folder / "out/grasps.json").read_text())["planner"]
        return planner["preset"], planner["options"]

    def test_every_planner_plans_and_is_recorded(self):
        for planner, said in (("fitting", None), ("gs", "guided by samples"),
                              ("ma", "balls"), ("ma-full-retreat", "candidates")):
            with self.subTest(planner):
                done = self.plan("--planner", planner, "--refine", "off", "--export-guidance",
                                 "--max-attempts", "400", out=planner)
                if said:
                    self.assertIn(said, done.stdout)
                file = json.loads((self.folder / planner / "grasps.json").read_text())
                self.assertEqual(file["planner"]["options"]["planner"], planner)
                self.assertTrue(file["planner"]["name"])
                for grasp in file["results"]["grasps"]:
                    self.assertEqual(bool(grasp["targets"]["contacts"]), planner == "fitting")
                lines = (self.folder / planner / "guidance.csv").read_text().splitlines()
                self.assertTrue(lines[0].startswith("x_m,y_m,z_m,"), lines[0])
                self.assertGreater(len(lines), 100)
                ply = (self.folder / planner / "guidance.ply").read_text()
                self.assertIn(f"element vertex {len(lines) - 1}\n", ply)

    def test_style_auto_says_what_the_hand_can_pinch(self):
        done = self.plan("--target-search", "reach", "--style", "auto")
        said = re.search(r"^(\d) of 2 grasps press on the palm, (\d) with other pads than fingertips'; two "
                         r"fingertips of barrett pinch squarely at friction 0.4 what is (\d+) to "
                         r"(\d+) mm wide", done.stdout, re.M)
        self.assertTrue(said, done.stdout)
        file = json.loads((self.folder / "out/grasps.json").read_text())
        targets = [grasp["targets"]["contacts"] for grasp in file["results"]["grasps"]]
        self.assertEqual(int(said[1]), sum(any(target["finger"] == "palm" for target in own)
                                           for own in targets))
        self.assertEqual(int(said[2]), sum(any("pad" in target for target in own)
                                           for own in targets))
        # As `graspfit hand reach` has it, to two of its steps of 5 mm.
        table = program.run("hand", "reach", "barrett", "--friction", "0.4").stdout
        tips = re.search(r"fingertips +(\d+) to (\d+) ", table)
        for width, expected in zip(said.groups()[2:], tips.groups()):
            self.assertAlmostEqual(int(width), int(expected), delta=10)
        self.assertNotIn("press on the palm", self.plan().stdout)
        # Without friction pads may not lean at all, and those of the Barrett hand always do.
        done = self.plan("--target-search", "reach", "--style", "auto", "--friction", "0")
        self.assertIn("two fingertips of barrett pinch nothing squarely at friction 0\n", done.stdout)

    def test_a_preset_is_recorded_and_flags_beside_it_change_it(self):
        keys = ("style", "kept_candidate", "count", "search", "rank", "idle_fingers",
                "max_redraws")
        strong = ("auto", "firmest", 5, "closed", "epsilon", "close", 5)
        exact = ("precision", "first", 1, "best", "m", "stay", 0)
        for flags, expected_preset, expected in (
                ((), "strong", strong),
                (("--preset", "strong"), "strong", strong),
                (("--target-search", "reach", "--planner", "fitting"), "strong", strong),
                # A default that is written out counts as well.
                (("--count", "1"), "strong", (*strong[:2], 1, *strong[3:])),
                (("--preset", "exact"), "exact", exact),
                (("--target-search", "random"), "exact", exact),
                (("--planner", "gs"), "exact", exact)):
            with self.subTest(flags):
                preset, options = self.options("--max-attempts", "20", *flags)
                self.assertEqual(preset, expected_preset)
                self.assertEqual(tuple(options[key] for key in keys), expected)
        preset, paper = self.options("--preset", "paper", "--pre-grasps", "yes")
        self.assertEqual((preset, paper["refine"], paper["pre_grasps"], paper["rank"]),
                         ("paper", False, True, "m"))
        self.assert_refused("plan", self.folder / "torus.off", "--preset", "stronk",
                            says='--preset "stronk" is not one of paper|exact|fast|strong; did you '
                                 'mean "strong"?')

    def test_without_flags_grasps_close_and_the_hardest_to_break_comes_first(self):
        done = program.run("plan", self.folder / "torus.off", "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0].split(),
                         ["rank", "M", "M1", "M2", "M3", "epsilon", "epsilon_mu0.2", "closed",
                          "contacts", "gap_mm", "penetration_mm", "touches", "clear"])
        rows = [line.split() for line in lines[1:6]]
        strengths = [float(row[6]) for row in rows]
        self.assertEqual(strengths, sorted(strengths, reverse=True))
        self.assertEqual([row[7] for row in rows], ["yes"] * 5)
        self.assertEqual([row[-2:] for row in rows], [["yes", "yes"]] * 5)
        self.assertRegex(lines[6], r"^5 of 5 grasps, all closed, in \d+ attempts \(")
        grasps = json.loads((self.folder / "out/grasps.json").read_text())["results"]["grasps"]
        for row, grasp in zip(rows, grasps):
            self.assertEqual(row[5], f"{grasp['wrench']['epsilon']:.4f}")
            self.assertGreater(grasp["wrench"]["epsilon"], 0)

    def test_where_no_posture_is_found_targets_are_drawn_at_random(self):
        # A rod of 16 by 20 mm is not two voxels thick, which the postures of two jaws are too coarse for.
        rod = self.write("rod.off", program.off_text(*program.box(16, 20, 330)))
        arguments = ["plan", rod, "--mesh-unit", "mm", "--hand", "parallel_gripper", "--no-palm", "--out",
                     self.folder / "out"]
        done = program.run(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.splitlines(), [
            f"graspfit plan: {rod}: no grasp at targets by the hand's reach; these are at random "
            "targets (--target-search random)"])
        options = json.loads((self.folder / "out/grasps.json").read_text())["planner"]["options"]
        self.assertEqual((options["targets"]["search"], options["style"], options["rank"]),
                         ("random", "precision", "epsilon"))
        # Who asks for the search by reach gets no other.
        for flags in (("--preset", "strong"), ("--target-search", "reach"), ("--style", "auto")):
            self.assert_refused(*arguments, *flags, says="no target set 50", code=3)

    def test_a_solid_that_differs_from_the_file_is_said_everywhere(self):
        # One face of the torus is missing: 1 of 512 pairs, about 14 mm wide, which repair fills
        # flat.
        vertices, faces = program.torus(sides=8, rings=16)
        self.write("torus.off", program.off_text(vertices, faces[2:]))
        done = self.plan("--page")
        said = re.fullmatch(r"graspfit plan: (torus\.off: the solid differs from the file: filled 1 "
                            r"hole \(volume [+-]?0(\.\d)? %, surface up to (\d\.?\d*) % of the "
                            r"extent\))\n", done.stderr)
        self.assertTrue(said, done.stderr)
        self.assertGreater(float(said[3]), 1.0)
        page = (self.folder / "out/grasps.html").read_text()
        self.assertIn('"note":"' + said[1] + '"', page)
        again = program.run("evaluate", self.folder / "out/grasps.json")
        self.assertEqual(again.stderr, f"graspfit evaluate: {said[1]}\n")
        held = program.run("hold", self.folder / "out/grasps.json", "--replay", "1",
                           "--out", self.folder / "held")
        if held.returncode == 0:
            self.assertEqual(held.stderr, f"graspfit hold: {said[1]}\n")
            replay = (self.folder / "held/replay_001.html").read_text()
            self.assertIn('"note":"' + said[1] + '"', replay)

    def test_flags_of_another_planner_are_refused(self):
        for flags in (("--gs-sampling", "box-rays"), ("--planner", "gs", "--ma-samples", "5"),
                      ("--planner", "none"), ("--export-guidance",)):
            done = program.run("plan", self.folder / "torus.off", *flags)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(flags[-1] if flags[-1].startswith("--") else flags[-2], done.stderr)

    def test_writes_file_table_and_posed_meshes(self):
        done = self.plan()
        self.assertEqual(done.stderr, "")  # There is no progress bar when piped.
        names = sorted(path.name for path in (self.folder / "out").iterdir())
        posed = [f"grasp_00{i}.{extension}" for i in (1, 2) for extension in ("obj", "ply")]
        meshes = [name for name in names if name.startswith("link_") or name == "object.ply"]
        self.assertEqual(names, sorted(posed + meshes + ["grasps.csv", "grasps.json"]))

        lines = done.stdout.splitlines()
        self.assertEqual(lines[0].split(),
                         ["rank", "M", "M1", "M2", "M3", "epsilon", "epsilon_mu0.2", "closed",
                          "contacts", "gap_mm", "penetration_mm", "touches", "clear"])
        self.assertEqual([line.split()[0] for line in lines[1:3]], ["1", "2"])
        file = json.loads((self.folder / "out/grasps.json").read_text())
        grasps = file["results"]["grasps"]
        for grasp, line in zip(grasps, lines[1:3]):
            self.assertEqual(f"{grasp['m']:.4f}", line.split()[1])
            self.assertEqual("no" not in line.split()[-2:], grasp["valid"])
            self.assertTrue(grasp["usable"])
        self.assertEqual(sorted(grasps, key=lambda grasp: -grasp["m"]), grasps)

        rows = (self.folder / "out/grasps.csv").read_text().splitlines()
        self.assertEqual(len(rows), 3)
        header = rows[0].split(",")
        self.assertEqual(file["object"]["used_mesh_file"], "object.ply")
        self.assertEqual([link["used_mesh_file"] for link in file["hand"]["links"]],
                         sorted(meshes)[:-1])
        self.assertRegex(lines[3], r"grasps, .*closed, in \d+ attempts \(.*\): ")
        for column in ("m", "epsilon", "largest_requested_gap_m", "largest_penetration_m", "palm_x_m",
                       "palm_qw", "pre_grasp_clearance_m", "squeeze_residual"):
            self.assertIn(column, header)
        for joint in file["hand"]["joints"]:
            column = header.index(f"{joint['name']}_{joint['unit']}")
            self.assertEqual(float(rows[1].split(",")[column]), grasps[0]["joints"][joint["name"]])

    def test_posed_obj_has_a_part_for_every_body(self):
        self.plan()
        text = (self.folder / "out/grasp_001.obj").read_text()
        file = json.loads((self.folder / "out/grasps.json").read_text())
        links = [f"link {link['name']}" for link in file["hand"]["links"] if link["mesh_files"]]
        self.assertEqual(re.findall(r"^o (.*)$", text, re.MULTILINE), ["object", *links])
        num_vertices = len(re.findall(r"^v ", text, re.MULTILINE))
        indices = [int(i) for face in re.findall(r"^f (.*)$", text, re.MULTILINE)
                   for i in face.split()]
        self.assertEqual((min(indices), max(indices)), (1, num_vertices))
        first = [float(x) for x in re.search(r"^v (.*)$", text, re.MULTILINE)[1].split()]
        self.assertEqual(first, list(program.torus()[0][0]))

    def test_same_seed_gives_the_same_bytes_of_results(self):
        self.plan(out="a")
        self.plan(out="b")
        self.assertEqual(results_text(self.folder / "a/grasps.json"),
                         results_text(self.folder / "b/grasps.json"))
        for name in ("grasps.csv", "grasp_001.obj", "grasp_002.ply"):
            self.assertEqual((self.folder / "a" / name).read_bytes(),
                             (self.folder / "b" / name).read_bytes())
        program.run("plan", self.folder / "torus.off", "--count", "2", "--seed", "8", *FAST,
                    "--out", self.folder / "c")
        self.assertNotEqual(results_text(self.folder / "a/grasps.json"),
                            results_text(self.folder / "c/grasps.json"))

    def test_existing_folder_keeps_foreign_files_and_loses_stale_ones(self):
        out = self.folder / "out"
        out.mkdir()
        for name in ("notes.txt", "grasp_009.obj", "grasp_001.obj", "grasp_1.obj", "grasps.html",
                     "obstacle_1.ply", "link_99_tail.ply"):
            (out / name).write_text("old")
        self.plan()
        self.assertEqual((out / "notes.txt").read_text(), "old")
        self.assertEqual((out / "grasp_1.obj").read_text(), "old")
        self.assertNotEqual((out / "grasp_001.obj").read_text(), "old")
        self.assertFalse((out / "grasp_009.obj").exists())
        for name in ("grasps.html", "obstacle_1.ply", "link_99_tail.ply"):
            self.assertFalse((out / name).exists(), name)
        self.assertEqual([path.name for path in out.iterdir() if path.name.startswith(".")], [])

    def test_refused_run_leaves_an_earlier_result_alone(self):
        self.plan()
        before = {path.name: path.read_bytes() for path in (self.folder / "out").iterdir()}
        self.assert_refused("plan", self.folder / "torus.off", "--theta-max-deg", "0.5",
                            "--max-attempts", "2", "--out", self.folder / "out", code=3)
        after = {path.name: path.read_bytes() for path in (self.folder / "out").iterdir()}
        self.assertEqual(before, after)

    def test_quiet_and_without_folder(self):
        self.assertEqual(self.plan("--quiet").stdout, "")
        before = self.contents()
        done = program.run("plan", self.folder / "torus.off", *FAST)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("rank", done.stdout)
        self.assertEqual(self.contents(), before)

    def test_named_fingers_and_approach(self):
        self.plan("--fingers", "finger_1,thumb", "--approach", "-0.2,0.1,-1")
        file = json.loads((self.folder / "out/grasps.json").read_text())
        self.assertEqual(file["planner"]["used"]["fingers"], ["thumb", "finger_1"])
        self.assertEqual(file["planner"]["options"]["approach_O"], [-0.2, 0.1, -1])
        direction_H = file["hand"]["palm"]["direction_H"]
        for grasp in file["results"]["grasps"]:
            w, x, y, z = grasp["X_OH"]["rotation_wxyz"]
            rotation = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
            direction_O = [sum(r * d for r, d in zip(row, direction_H)) for row in rotation]
            self.assertGreater(sum(a * b for a, b in zip(direction_O, (-0.2, 0.1, -1))), 0)

    def test_table_and_obstacles_are_recorded_and_their_meshes_written(self):
        # These are millimeters, beside the way in from above.
        vertices, faces = program.box(20, 20, 20)
        vertices = [(x + 150, y, z + 110) for x, y, z in vertices]
        obstacle = self.write("box.off", program.off_text(vertices, faces))
        self.plan("--table", "-0.15", "--obstacle", obstacle, "--obstacle-unit", "mm")
        file = json.loads((self.folder / "out/grasps.json").read_text())
        self.assertEqual(file["surroundings"]["table_z_O_m"], -0.15)
        record, = file["surroundings"]["obstacles"]
        self.assertEqual((record["file"], record["meters_per_file_unit"]), (str(obstacle), 0.001))
        self.assertAlmostEqual(record["mesh"]["bounding_box_m"]["upper"][2], 0.12, places=15)
        self.assertTrue((self.folder / "out" / record["used_mesh_file"]).is_file())
        done = program.run("evaluate", self.folder / "out/grasps.json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        obstacle.write_text(obstacle.read_text() + "\n")
        self.assert_refused("evaluate", self.folder / "out/grasps.json", says=["box.off", "SHA-256"])

    def test_an_object_is_laid_on_the_table(self):
        # The torus has one likely pose, flat on the table, from either side, and none on its edge.
        def plan(*flags, out):
            done = program.run("plan", self.folder / "torus.off", "--hand", "human_hand", "--on-table",
                               "--count", "2", "--out", self.folder / out, *flags)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            return done

        plan("--table-clearance-mm", "2", out="out")
        file = json.loads((self.folder / "out/grasps.json").read_text())
        self.assertEqual(file["surroundings"]["table_z_O_m"], 0)
        self.assertEqual(file["surroundings"]["table_clearance_m"], 0.002)
        laid = file["object"]["laid"]
        self.assertEqual(laid["rank"], 1)
        self.assertAlmostEqual(laid["probability"], 0.5, delta=0.05)
        lower = file["object"]["mesh"]["bounding_box_m"]["lower"]
        self.assertAlmostEqual(lower[2], 0, places=12)
        for grasp in file["results"]["grasps"]:
            posed = (self.folder / f"out/grasp_{grasp['rank']:03}.obj").read_text()
            hand = posed[posed.index("o link"):]
            heights = [float(line.split()[3]) for line in hand.splitlines() if line.startswith("v ")]
            self.assertGreater(min(heights), 0.002)
        for arguments in (("evaluate",), ("hold", "--protocol", "tabletop-lift")):
            done = program.run(*arguments[:1], self.folder / "out/grasps.json", *arguments[1:])
            if "no physics" in done.stderr:
                continue
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        # In the file's own frame the second pose is the first one upside down.
        done = plan("--rest-pose", "all", out="all")
        folders = sorted(path.name for path in (self.folder / "all").iterdir())
        self.assertEqual(folders, ["rest_pose_1", "rest_pose_2"])
        self.assertIn("in rest pose 2, in which it lands in", done.stdout)

    def test_flags_about_the_table_that_make_no_sense_are_refused(self):
        torus = self.folder / "torus.off"
        for flags, says in (
            (("--table", "0", "--on-table"), "--table and --on-table exclude each other"),
            (("--rest-pose", "2"), "--rest-pose means nothing without --on-table"),
            (("--table-clearance-mm", "2"), "means nothing without --table or --on-table"),
            (("--on-table", "--rest-pose", "9"), "graspfit inspect lists them"),
            (("--on-table", "--rest-pose", "0"), "--rest-pose"),
            (("--on-table", "--rest-pose", "both"), "--rest-pose"),
            (("--on-table", "--table-clearance-mm", "-1"), "--table-clearance-mm"),
        ):
            with self.subTest(flags):
                self.assert_refused("plan", torus, *flags, "--out", self.folder / "none", says=[says])
                self.assertFalse((self.folder / "none").exists())
        done = program.run("inspect", torus, "--no-thickness")
        self.assertRegex(done.stdout, r"rest pose 1 +(49|50)(\.\d)? % of falls, up \(")

    def test_threads_are_not_recorded_and_do_not_matter(self):
        self.plan("--threads", "1", out="a")
        self.plan("--threads", "2", out="b")
        self.assertEqual(results_text(self.folder / "a/grasps.json"),
                         results_text(self.folder / "b/grasps.json"))
        self.assertNotIn("threads", (self.folder / "a/grasps.json").read_text())

    def test_units_scale_the_file(self):
        vertices, faces = program.torus()
        inches = program.off_text([[x / 0.0254 for x in vertex] for vertex in vertices], faces)
        path = self.write("inches.off", inches)
        for flags, factor in ((("--mesh-unit", "in"), 0.0254), (("--longest", "0.14"), None)):
            done = program.run("plan", path, *flags, *FAST, "--out", self.folder / "scaled")
            self.assertEqual(done.returncode, 0, done.stderr)
            record = json.loads((self.folder / "scaled/grasps.json").read_text())["object"]
            box = record["mesh"]["bounding_box_m"]
            self.assertAlmostEqual(box["upper"][0] - box["lower"][0], 0.14, places=12)
            if factor:
                self.assertEqual(record["meters_per_file_unit"], factor)


class Locale(program.ProgramTest):
    def test_locale_does_not_change_the_bytes(self):
        environment = program.german_environment(self.folder)
        if environment is None:
            self.skipTest("no German locale, and none could be compiled; install the package "
                          "locales")
        comma = subprocess.run(["bash", "-c", "printf %.1f 1,5"], env=environment,
                               capture_output=True, text=True, check=True)
        self.assertEqual(comma.stdout, "1,5")
        self.write_torus()
        results = []
        for name, env in (("a", None), ("b", environment)):
            done = program.run("plan", self.folder / "torus.off", "--count", "2", "--seed", "7",
                               *FAST, "--out", self.folder / name, env=env)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertNotIn("0,", done.stdout)
            results.append(results_text(self.folder / name / "grasps.json"))
        self.assertEqual(*results)


class Page(program.ProgramTest):
    def test_page_is_written_and_removed_by_a_run_without_it(self):
        arguments = ["plan", self.write_torus(), *FAST, "--out", self.folder / "out"]
        done = program.run(*arguments, "--page")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertTrue((self.folder / "out/grasps.html").read_text().startswith("<!"))
        program.run(*arguments)
        self.assertFalse((self.folder / "out/grasps.html").exists())


class Pictures(program.ProgramTest):
    def test_pictures_are_drawn(self):
        if importlib.util.find_spec("vtkmodules") is None or not shutil.which("xvfb-run"):
            self.skipTest("python3-vtk9 or xvfb is not installed")
        done = program.run("plan", self.write_torus(), *FAST, "--pictures", "--out",
                           self.folder / "out")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual((self.folder / "out/grasp_001.png").read_bytes()[:4], b"\x89PNG")


class Help(program.ProgramTest):
    def test_help_and_version(self):
        for arguments in (["--help"], ["plan", "--help"], ["inspect", "--help"],
                          ["evaluate", "-h"], ["shape", "--help"]):
            done = program.run(*arguments)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("Usage: graspfit", done.stdout)
            self.assertLessEqual(max(map(len, done.stdout.splitlines())), 110)
        done = program.run("plan", "--help-all")
        for text in ("[P]", "[R, A1]", "(=0.6)", "(=45)", "(=floor-median)", "Exit codes"):
            self.assertIn(text, done.stdout)
        done = program.run("--version")
        for library in ("graspfit", "CGAL", "Eigen", "assimp", "Boost", "compiler"):
            self.assertRegex(done.stdout, rf"(?m)^{library} +\S*\d+\.\d+|^{library} +\S+ \d+\.\d+")

    def test_plan_s_first_help_has_presets_and_few_flags(self):
        short, full = (set(re.findall(r"(?m)^  (--[a-z][a-z0-9-]+)", program.run("plan", flag).stdout))
                       for flag in ("--help", "--help-all"))
        self.assertLess(short, full)
        self.assertLessEqual(len(short), 20)
        self.assertGreater(len(full), 90)
        text = program.run("plan", "--help").stdout
        for part in ("--preset paper|exact|fast|strong", "refine off", "rank epsilon", "--help-all"):
            self.assertIn(part, " ".join(text.split()))
        # Other commands have one help.
        self.assertEqual(program.run("evaluate", "--help").stdout,
                         program.run("evaluate", "--help-all").stdout)

    def test_the_options_page_is_the_program_s(self):
        done = program.run("options")
        self.assertEqual(done.stdout, (program.SOURCE_DIR / "docs/options.md").read_text(),
                         "build the target write_generated")
        listed = set(re.findall(r"(?m)^\| `([a-z][a-z0-9-]+)` \|", done.stdout)) - {"paper", "exact", "fast", "strong"}
        flags = set(re.findall(r"(?m)^  --([a-z][a-z0-9-]+)", program.run("plan", "--help-all").stdout))
        self.assertLess(listed, flags)
        self.assertGreater(len(listed), 70)
        schema = program.SOURCE_DIR / "grasp/grasps.schema.json"
        self.assertEqual(program.run("options", "--schema", schema).stdout, schema.read_text(),
                         "build the target write_generated")
        self.assert_refused("options", "--schema", self.write("no.json", "{}"), says=("no.json", "/$defs"))
        # Every path is that of a key in a grasp file.
        self.write_torus()
        done = program.run("plan", self.folder / "torus.off", *FAST, "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        options = json.loads((self.folder / "out/grasps.json").read_text())["planner"]["options"]
        text = program.run("options").stdout
        paths = re.findall(r"(?m)^\| `[a-z][a-z0-9-]+` \|(?: (?:\\\||[^|])+\|){2} `([\w.]+)` \|", text)
        self.assertEqual(len(paths), len(listed))
        for path in paths:
            place = options
            for key in path.split("."):
                self.assertIn(key, place, path)
                place = place[key]

    def test_readme_names_flags_and_commands_that_exist(self):
        page = (program.SOURCE_DIR / "app/README.md").read_text()
        section = page.partition("## What to ask of `plan`")[2].partition("\n## ")[0]
        text = program.run("plan", "--help-all").stdout
        for flag in set(re.findall(r"--[a-z][a-z0-9-]+", section)):
            self.assertRegex(text, rf"(?m)^  {flag}\b")
        for flag in ("--planner", "--gs-samples", "--ma-samples", "--missing-contact",
                     "--contact-score-threshold", "--export-guidance"):
            self.assertIn(f"`{flag}", page)
        commands = re.findall(r"(?m)^  graspfit (\w+) ", program.run("--help").stdout)
        self.assertIn("experiment", commands)
        for command in commands:
            self.assertRegex(page, rf"(?m)^\| `graspfit {command}[ `]")

    def test_readings_page_names_flags_and_fields_that_exist(self):
        page = (program.SOURCE_DIR / "docs/readings.md").read_text()
        other_programs = r"`(?:graspfit (?!plan)|paper-figures/)[^`]*`"
        flags = set(re.findall(r"--[a-z][a-z0-9-]+", re.sub(other_programs, "", page))) - {"--help"}
        self.assertGreater(len(flags), 20)
        text = program.run("plan", "--help-all").stdout
        for flag in flags:
            self.assertRegex(text, rf"(?m)^  {flag}\b")
        headers = "".join(path.read_text() for path in program.SOURCE_DIR.glob(
            "grasp/include/graspfit/grasp/*.hpp"))
        for options, field in re.findall(r"`(\w+Options)::(\w+)`", page):
            self.assertIn(f"struct {options} ", headers)
            self.assertRegex(headers, rf"\b{field}\b")


if __name__ == "__main__":
    program.main()
