"""`graspfit hand` as its user meets it: list, show, check, derive, export, and hands without sidecar."""

import csv
import json
import os
import pty
import re
import shutil
import struct
import subprocess
import time
import xml.etree.ElementTree as ElementTree

import program

MODELS = program.SOURCE_DIR / "hands/models"
SHIPPED = sorted(path.name for path in MODELS.iterdir() if (path / f"{path.name}.urdf").is_file())


def gripper_urdf(extra="", finger_joint="prismatic"):
    """Returns two jaws of 10 x 20 x 60 mm on a 100 mm palm, which close along x by up to 40 mm
    each."""
    def link(name, size, center):
        return (f'<link name="{name}"><collision><origin xyz="{center}"/><geometry><box size="{size}"/>'
                f'</geometry></collision></link>')

    def joint(name, child, x, axis, mimic=""):
        return (f'<joint name="{name}" type="{finger_joint}"><parent link="base"/><child link="{child}"/>'
                f'<origin xyz="{x} 0 0.02"/><axis xyz="{axis} 0 0"/>'
                f'<limit lower="0" upper="0.04" effort="1" velocity="1"/>{mimic}</joint>')

    return ('<robot name="two_jaws">'
            + link("base", "0.1 0.04 0.02", "0 0 0.01")
            + link("left", "0.01 0.02 0.06", "-0.005 0 0.03")
            + link("right", "0.01 0.02 0.06", "0.005 0 0.03")
            + joint("left_slide", "left", -0.04, 1)
            + joint("right_slide", "right", 0.04, -1, '<mimic joint="left_slide"/>')
            + extra + "</robot>")


def gripper_in_millimeters():
    """Returns the same with every length 1000 times as large."""
    def thousandfold(match):
        return match[1] + " ".join(repr(1000 * float(x)) for x in match[2].split()) + '"'

    return re.sub(r'(origin xyz="|size="|upper=")([^"]*)"', thousandfold, gripper_urdf())


class List(program.ProgramTest):
    def test_every_shipped_hand_with_its_counts_and_file(self):
        done = program.run("hand", "list")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        found = re.findall(r"(?m)^(\w+): (\d+) fingers, (\d+) joints, (\d+) independent, (\d+) pads", done.stdout)
        self.assertEqual([name for name, *_ in found], SHIPPED)
        counts = {name: tuple(map(int, numbers)) for name, *numbers in found}
        # The counts are fingers, joints and independent joints of the paper's three hands.
        self.assertEqual(counts["parallel_gripper"][:3], (2, 2, 1))
        self.assertEqual(counts["barrett"][:3], (3, 8, 4))
        self.assertEqual(counts["human_hand"][:3], (5, 20, 20))
        for name in SHIPPED:
            self.assertIn(f"{name}/{name}.urdf", done.stdout)

    def test_a_hand_that_cannot_be_read_does_not_hide_the_others(self):
        shutil.copytree(MODELS / "barrett", self.folder / "barrett")
        (self.folder / "broken").mkdir()
        self.write("broken/broken.urdf", "<robot")
        done = program.run("hand", "list", env={**os.environ, "GRASPFIT_HANDS": str(self.folder)})
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn("broken.urdf", done.stderr)
        self.assertIn("barrett: 3 fingers", done.stdout)


class Show(program.ProgramTest):
    def table(self, text, name):
        """Returns the rows of the table under a heading, as lists of words."""
        block = text.split(f"\n\n{name}\n")[1].split("\n\n")[0]
        return [re.split(r"  +", line.strip()) for line in block.strip().splitlines()]

    def test_tables_say_what_the_model_has(self):
        done = program.run("hand", "show", "barrett")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        joints = self.table(done.stdout, "joints")
        self.assertEqual(joints[0][-3:], ["open", "half", "closed"])
        rows = {row[0]: row[1:] for row in joints[1:]}
        self.assertEqual(len(rows), 8)
        # The range is 140 degrees; the distal joint follows by one third.
        self.assertEqual(rows["finger_1_proximal"][3:5], ["0.0000", "2.4435"])
        self.assertRegex(" ".join(rows["finger_1_distal"]), r"0\.3333 finger_1_proximal.* breakaway")
        self.assertEqual({row[0] for row in self.table(done.stdout, "fingers")[1:]},
                         {"finger_1", "finger_2", "thumb"})
        for row in self.table(done.stdout, "poses")[1:]:
            self.assertEqual(row[1:], ["none", "-"])

    def test_poses_are_those_asked_for(self):
        done = program.run("hand", "show", "barrett", "--pose",
                           "finger_1_proximal=0.6,half,finger_1_spread=1.5,closed")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        joints = self.table(done.stdout, "joints")
        self.assertEqual(joints[0][-3:],
                         ["finger_1_proximal=0.6", "half, finger_1_spread=1.5", "closed"])
        rows = {row[0]: row[-3:] for row in joints[1:]}
        self.assertEqual(rows["finger_1_proximal"][:2], ["0.6000", "1.2217"])
        self.assertEqual(rows["finger_1_distal"][:2], ["0.2000", "0.4072"])
        self.assertEqual(rows["finger_2_spread"], ["0.0000", "1.5000", "0.0000"])
        self.assertEqual(rows["finger_2_proximal"][0], "0.0000")
        # After a breakaway the distal joint moves alone, up to 48 degrees.
        alone = program.run("hand", "show", "barrett", "--pose", "finger_1_distal=0.8")
        self.assertEqual(alone.returncode, 0, alone.stderr)

    def test_what_cannot_be_shown_is_one_line(self):
        bad = self.folder / "missing" / "x.png"
        for arguments, says in [
                (["claw"], ["claw", "barrett", "URDF"]),
                ([self.folder / "no.urdf"], "no.urdf"),
                ([], "HAND"),
                (["barrett", "human_hand"], "HAND"),
                (["barrett", "--pose", "wide"], ["wide", "open", "JOINT=VALUE"]),
                (["barrett", "--pose", "elbow=1"], ["elbow", "finger_1_proximal"]),
                (["barrett", "--pose", "finger_1_proximal=3"], ["finger_1_proximal", "3", "2.44", "rad"]),
                (["barrett", "--pose", "finger_1_proximal=nan"], ["finger_1_proximal", "nan"]),
                (["barrett", "--pose", "finger_1_proximal=1,finger_1_proximal=1"], "twice"),
                (["barrett", "--pose", "finger_2_spread=1"], ["finger_2_spread", "finger_1_spread"]),
                (["barrett", "--pose", "open,,closed"], "pose"),
                (["barrett", "--pose", ""], "pose"),
                (["barrett", "--clip-thickness-mm", "0"], "clip-thickness-mm"),
                (["barrett", "--png", bad], ["--png", "missing"]),
                (["barrett", "--html", bad], ["--html", "missing"]),
                (["barrett", "--html", self.folder], ["--html", "folder"])]:
            with self.subTest(arguments):
                self.assert_refused("hand", "show", *arguments, says=says)

    def test_page_is_self_contained_reproducible_and_holds_the_poses(self):
        pages = []
        for name in ("a.html", "b.html"):
            path = self.folder / name
            done = program.run("hand", "show", "barrett", "--pose", "open,closed", "--html", path)
            self.assertEqual((done.returncode, done.stderr, done.stdout), (0, "", f"written to {path}\n"))
            pages.append(path.read_text())
        self.assertEqual(pages[0], pages[1])
        self.assertNotRegex(pages[0], r"(?i)(src|href)\s*=|https?://|@import|url\(")
        data = json.loads(re.search(r'id="data">(.*?)</script>', pages[0], re.S).group(1))
        self.assertEqual([pose["name"] for pose in data["poses"]], ["open", "closed"])
        self.assertEqual(len(data["hand"]["joints"]), 8)
        self.assertEqual(self.contents(), ["a.html", "b.html"])


class Reach(program.ProgramTest):
    def test_jaws_are_square_as_far_as_they_open(self):
        files = {flag: self.folder / f"reach.{flag}" for flag in ("csv", "svg", "html")}
        flags = [word for flag, file in files.items() for word in (f"--{flag}", file)]
        done = program.run("hand", "reach", "parallel_gripper", *flags)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("parallel_gripper at friction 0.4: pads may lean by 21.8 degrees", done.stdout)
        self.assertRegex(done.stdout, r"fingertips +0 to 85 +0\.0 ")
        self.assertRegex(done.stdout, r"other pads +no such pads +- +- +-")
        rows = [row for row in csv.DictReader(files["csv"].read_text().splitlines())
                if row["pinch"] == "fingertips"]
        self.assertEqual(len(rows), 18)  # classes of 5 mm to 85 mm, that of 85 to 90 included
        for number, row in enumerate(rows):
            self.assertGreaterEqual(float(row["opening_m"]), 0.005 * number)
            self.assertLess(float(row["opening_m"]), 0.005 * (number + 1))
            self.assertLess(float(row["lean_rad"]), 1e-7)
        self.assertTrue(files["svg"].read_text().startswith("<svg "))
        self.assertIn("What parallel_gripper pinches squarely", files["html"].read_text())
        self.assertEqual(self.contents(), ["reach.csv", "reach.html", "reach.svg"])

    def test_less_friction_leaves_less(self):
        def square(friction):
            done = program.run("hand", "reach", "barrett", "--friction", friction)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            ranges = re.search(r"thumb and two fingers +(.*?)  +\d", done.stdout).group(1)
            return sum(float(last) - float(first)
                       for first, last in re.findall(r"(\d+) to (\d+)", ranges))
        self.assertGreater(square("0.4"), square("0.2"))
        self.assertGreater(square("0.2"), 0)

    def test_what_cannot_be_charted_is_one_line(self):
        for arguments, says in [
                (["claw"], ["claw", "barrett"]),
                (["barrett", "--friction", "-1"], ["friction", "-1"]),
                (["barrett", "--step-mm", "0"], ["step-mm", "0"]),
                (["barrett", "--svg", self.folder / "missing" / "x.svg"], ["--svg", "missing"])]:
            with self.subTest(arguments):
                self.assert_refused("hand", "reach", *arguments, says=says)


class Picture(program.ProgramTest):
    def test_picture_of_every_pose(self):
        path = self.folder / "hand.png"
        done = program.run("hand", "show", "parallel_gripper", "--pose", "open,closed", "--png", path)
        if "install" in done.stderr:
            self.skipTest(done.stderr)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.contents(), ["hand.png"])
        header = path.read_bytes()[:24]
        self.assertEqual(header[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", header[16:24])
        self.assertGreaterEqual(width, 760)
        self.assertGreaterEqual(height, 400)

    def test_without_a_display_one_line_and_no_file(self):
        """Runs with a path without xvfb-run, and without a display."""
        tools = self.folder / "tools"
        tools.mkdir()
        env = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
        done = program.run("hand", "show", "barrett", "--png", self.folder / "x.png",
                           env={**env, "PATH": str(tools)})
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertRegex(done.stderr, "--png: .*install")
        self.assertEqual(self.contents(), ["tools"])


class Check(program.ProgramTest):
    def test_shipped_hands_have_no_fault(self):
        for name in SHIPPED:
            with self.subTest(name):
                done = program.run("hand", "check", name)
                self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
                self.assertRegex(done.stdout.splitlines()[-1], r"\.urdf: 0 faults, 0 suspicious, \d+ notes?$")

    def test_faults_are_all_reported_counted_and_give_exit_code_2(self):
        text = gripper_urdf().replace('axis xyz="1 0 0"', 'axis xyz="0 0 0"')
        text = text.replace('<box size="0.1 0.04 0.02"/>', '<mesh filename="gone.stl"/>')
        path = self.write("bad.urdf", text)
        done = program.run("hand", "check", path)
        self.assertEqual(done.returncode, 2)
        faults = [line for line in done.stdout.splitlines() if line.startswith("fault ")]
        self.assertGreaterEqual(len(faults), 2, done.stdout)
        self.assertIn("gone.stl", done.stdout)
        self.assertIn("left_slide", done.stdout)
        self.assertIn(f"{len(faults)} faults, ", done.stdout.splitlines()[-1])
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("bad.urdf", done.stderr)

    def test_a_hand_in_millimeters_is_told_the_factor(self):
        path = self.write("two_jaws.urdf", gripper_in_millimeters())
        done = program.run("hand", "check", path)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        self.assertRegex(done.stdout, r"(?m)^suspicious  its links span 100 m, 1000 times too large for a hand: "
                                      r"are its lengths millimeters\? .*scale=\"0\.001 0\.001 0\.001\"")
        self.assertNotIn("-2147483648", done.stdout)

    def check_on_a_terminal(self, path):
        """Returns what is printed, what the terminal shows, and how many seconds the program
        ran."""
        start = time.monotonic()
        primary, secondary = pty.openpty()
        env = {**os.environ, "TERM": "xterm"}
        with subprocess.Popen([program.PROGRAM, "hand", "check", str(path)], stdout=subprocess.PIPE,
                              stderr=secondary, env=env) as process:
            os.close(secondary)
            out = process.stdout.read().decode()
            shown = b""
            try:
                while block := os.read(primary, 4096):
                    shown += block
            except OSError:  # The program has closed its end.
                pass
        os.close(primary)
        return out, shown.decode(), time.monotonic() - start

    def test_on_a_terminal_the_seconds_are_shown_and_nothing_of_them_stays(self):
        text = gripper_urdf().replace('<box size="0.01 0.02 0.06"/>',
                                      '<mesh filename="jaw.off" scale="0.1 0.1 0.1"/>')
        path = self.write("slow.urdf", text)
        # The jaws are open and have more and more faces until this machine reads them for seconds.
        seconds, around = 0.0, 200
        while seconds < 2.0:
            around *= 2
            vertices, faces = program.torus(0.05, 0.02, around, around // 2)
            self.write("jaw.off", program.off_text(vertices, faces[:-1]))
            out, shown, seconds = self.check_on_a_terminal(path)
        self.assertIn("slow.urdf: 0 faults", out)
        lines = shown.split("\r\033[K")
        self.assertEqual(lines[:2], ["", f"checking {path}, 1 s"], shown)
        self.assertEqual(lines[-1], "", shown)

    def test_what_is_no_description_is_one_line(self):
        self.assert_refused("hand", "check", self.folder / "gone.urdf", says="gone.urdf")
        self.assert_refused("hand", "check", "claw", says=["claw", "barrett"])
        self.assert_refused("hand", "check", says="HAND")


class Derive(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.hand = self.write("two_jaws.urdf", gripper_urdf())
        self.sidecar = self.folder / "two_jaws.graspfit.json"

    def test_sidecar_is_what_was_derived_and_says_the_same_when_read(self):
        before = program.run("hand", "show", self.hand)
        self.assertEqual(before.returncode, 0, before.stderr)
        self.assertIn("none: derived", before.stdout)
        done = program.run("hand", "derive", self.hand)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn(str(self.sidecar), done.stdout.splitlines()[-1])
        data = json.loads(self.sidecar.read_text())
        self.assertEqual(len(data["fingers"]), 2)
        after = program.run("hand", "show", self.hand)
        strip = lambda text: re.sub(r"(?m)^(sidecar|what) .*\n", "", text)
        self.assertEqual(strip(after.stdout), strip(before.stdout))

    def test_a_sidecar_that_is_there_is_kept_unless_forced(self):
        program.run("hand", "derive", self.hand)
        data = json.loads(self.sidecar.read_text())
        data["fingers"][0]["name"] = "index"
        for pad in data["pads"]:
            if pad["finger"] == "left":
                pad["finger"] = "index"
        mine = json.dumps(data)
        self.sidecar.write_text(mine)
        error = self.assert_refused("hand", "derive", self.hand, says=["--force", "2 fingers"])
        self.assertIn("two_jaws.graspfit.json", error)
        self.assertEqual(self.sidecar.read_text(), mine)

    def test_force_keeps_what_the_file_says_and_derives_what_it_leaves_out(self):
        program.run("hand", "derive", self.hand)
        complete = self.sidecar.read_bytes()
        data = json.loads(complete)
        data["palm"]["center_m"] = [0, 0, 0.025]
        del data["pads"]
        self.sidecar.write_text(json.dumps(data))
        done = program.run("hand", "derive", self.hand, "--force")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        again = json.loads(self.sidecar.read_text())
        self.assertEqual(again["palm"]["center_m"], [0, 0, 0.025])
        self.assertEqual(again["pads"], json.loads(complete)["pads"])

    def test_out_and_what_cannot_be_written(self):
        out = self.folder / "elsewhere.json"
        self.assertEqual(program.run("hand", "derive", self.hand, "--out", out).returncode, 0)
        self.assertEqual(self.contents(), ["elsewhere.json", "two_jaws.urdf"])
        self.assert_refused("hand", "derive", self.hand, "--out", self.folder / "no" / "x.json", says="x.json")
        self.assert_refused("hand", "derive", "claw", says="claw")


class Export(program.ProgramTest):
    def test_export_reads_back_and_shows_the_same(self):
        out = self.folder / "out"
        done = program.run("hand", "export", "barrett", "--out", out)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        robot = ElementTree.parse(out / "barrett.urdf").getroot()
        meshes = {mesh.get("filename") for mesh in robot.iter("mesh")}
        self.assertEqual({path.name for path in out.iterdir()},
                         meshes | {"barrett.urdf", "barrett.graspfit.json"})
        self.assertEqual(len(meshes), 9)
        self.assertEqual(len(list(robot.iter("mimic"))), 4)
        strip = lambda text: re.sub(r"(?m)^(file|sidecar|what) .*\n", "", text)
        here = program.run("hand", "show", "barrett")
        there = program.run("hand", "show", out / "barrett.urdf")
        self.assertEqual(strip(there.stdout), strip(here.stdout))

    def test_an_existing_folder_keeps_what_is_not_ours(self):
        out = self.folder / "out"
        out.mkdir()
        (out / "notes.txt").write_text("mine")
        for _ in range(2):
            self.assertEqual(program.run("hand", "export", "parallel_gripper", "--out", out).returncode, 0)
        self.assertEqual((out / "notes.txt").read_text(), "mine")

    def test_what_cannot_be_exported_leaves_nothing(self):
        hand = self.write("two_jaws.urdf", gripper_urdf().replace('"left"', '"le/ft"'))
        self.write("file", "")
        for arguments, says in [
                (["barrett"], "--out"),
                (["claw", "--out", self.folder / "out"], "claw"),
                (["--out", self.folder / "out"], "HAND"),
                ([hand, "--out", self.folder / "out" / "deep"], "le/ft"),
                (["barrett", "--out", self.folder / "file"], "file"),
                (["barrett", "--out", ""], "name")]:
            with self.subTest(arguments):
                self.assert_refused("hand", "export", *arguments, says=says)

    def test_the_hands_own_files_are_not_replaced(self):
        shutil.copytree(MODELS / "parallel_gripper", self.folder / "mine")
        source = self.folder / "mine" / "parallel_gripper.urdf"
        before = source.read_bytes()
        self.assert_refused("hand", "export", source, "--out", self.folder / "mine", says="of the hand itself")
        self.assertEqual(source.read_bytes(), before)


class WithoutSidecar(program.ProgramTest):
    """Tests of a hand without a sidecar that somebody wrote: planning, its record, and
    evaluation."""

    def setUp(self):
        super().setUp()
        self.hand = self.write("two_jaws.urdf", gripper_urdf())
        self.object = self.write("block.off", program.off_text(*program.box(0.04, 0.03, 0.1)))

    def plan(self):
        out = self.folder / "out"
        done = program.run("plan", self.object, "--hand", self.hand, "--contacts", "2", "--resolution", "16",
                           "--accept", "usable", "--search", "first", "--count", "1",
                           "--max-attempts", "200", "--quiet", "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        return out / "grasps.json"

    def test_grasps_record_the_derivation_and_evaluate_to_the_same(self):
        grasps = self.plan()
        record = json.loads(grasps.read_text())["hand"]
        self.assertEqual(record["sidecar_file"], "")
        self.assertRegex(record["sidecar_sha256"], "^[0-9a-f]{64}$")
        done = program.run("evaluate", grasps)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)

    def test_evaluate_refuses_a_hand_that_is_derived_otherwise(self):
        grasps = self.plan()
        program.run("hand", "derive", self.hand)  # From now on the file counts.
        sidecar = self.folder / "two_jaws.graspfit.json"
        data = json.loads(sidecar.read_text())
        data["palm"]["center_m"] = [0, 0, 0.5]
        sidecar.write_text(json.dumps(data))
        self.assert_refused("evaluate", grasps, says=["two_jaws.graspfit.json", "SHA-256"])

    def test_what_is_suspicious_is_said_and_does_not_stop_the_plan(self):
        # A transmission ratio is written into the axis, as in a well-known export.
        self.hand.write_text(gripper_urdf().replace('axis xyz="1 0 0"', 'axis xyz="0.333 0 0"'))
        done = program.run("plan", self.object, "--hand", self.hand, "--contacts", "2", "--resolution", "16",
                           "--max-attempts", "1", "--quiet")
        lines = [line for line in done.stderr.splitlines() if "suspicious" in line]
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertIn("left_slide", lines[0])
        self.assertIn(done.returncode, (0, 3))


    def test_a_hand_in_millimeters_is_suspected_where_it_grasps_nothing(self):
        self.hand.write_text(gripper_in_millimeters())
        done = program.run("plan", self.object, "--hand", self.hand, "--contacts", "2", "--resolution", "16",
                           "--max-attempts", "3", "--quiet")
        lines = done.stderr.splitlines()
        self.assertIn("suspicious: its links span 100 m, 1000 times too large", done.stderr)
        self.assertIn(done.returncode, (2, 3), done.stderr)
        self.assertIn("the hand's lengths look like another unit than meters", lines[-1])
        self.assertNotIn("--mesh-unit", lines[-1])

    def test_where_no_two_places_fit_the_sizes_are_told(self):
        # No two faces of a tetrahedron look away from each other.
        corners = [(0.02, 0.02, 0.02), (0.02, -0.02, -0.02), (-0.02, 0.02, -0.02), (-0.02, -0.02, 0.02)]
        faces = [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)]
        tetrahedron = self.write("tetrahedron.off", program.off_text(corners, faces))
        done = program.run("plan", tetrahedron, "--hand", self.hand, "--contacts", "2", "--resolution", "16",
                           "--theta-max-deg", "5", "--max-attempts", "3", "--quiet")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("no second 3", done.stderr)
        self.assertIn("these get 0 to 80 mm apart, and the object is 40 x 40 x 40 mm; --mesh-unit or --longest",
                      done.stderr)

    def test_names_that_are_not_utf_8_are_found_again(self):
        folder = os.fsencode(self.folder)
        os.rename(self.object, folder + b"/bl\xf6ck.off")
        os.rename(self.hand, folder + b"/j\xe4ws.urdf")
        done = subprocess.run([program.PROGRAM, "plan", b"bl\xf6ck.off", "--hand", b"j\xe4ws.urdf", "--contacts",
                               "2", "--resolution", "16", "--accept", "usable", "--search", "first", "--count",
                               "1", "--max-attempts", "200", "--quiet", "--out", "out"],
                              cwd=self.folder, capture_output=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        record = json.loads((self.folder / "out/grasps.json").read_bytes().decode("utf-8"))
        self.assertEqual((record["object"]["file"], record["hand"]["description_file"]),
                         ("file:bl%F6ck.off", "file:j%E4ws.urdf"))
        done = program.run("evaluate", "out/grasps.json", cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        os.rename(self.folder / "out/grasps.json", self.folder / "grasps.json")
        done = program.run("evaluate", self.folder / "grasps.json", cwd="/")
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)


class Help(program.ProgramTest):
    def test_every_command_has_help_and_is_named(self):
        names = ["list", "show", "check", "derive", "export"]
        overview = program.run("hand", "--help")
        self.assertEqual((overview.returncode, overview.stderr), (0, ""))
        for name in names:
            self.assertIn(f"graspfit hand {name}", overview.stdout)
            done = program.run("hand", name, "--help")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertTrue(done.stdout.startswith(f"Usage: graspfit hand {name}"))
            for line in done.stdout.splitlines():
                self.assertLessEqual(len(line), 100, line)
        self.assertIn("graspfit hand", program.run("--help").stdout)
        self.assert_refused("hand", says=names)
        self.assert_refused("hand", "lsit", says=["lsit", *names])
        self.assert_refused("hand", "list", "barrett", says=["hand list", "barrett"])


if __name__ == "__main__":
    program.main()
