"""`graspfit hold` tests grasps in physics, and `graspfit plan --hold` keeps those that hold."""

import csv
import json
import pathlib
import tempfile
import unittest

import program

try:
    import jsonschema
except ImportError:
    jsonschema = None

# The test is short: what it tells apart needs no two seconds under load.
SHORT = ("--set", "hold_time_s=0.4", "--set", "approach_time_s=0.2", "--set", "squeeze_time_s=0.2")
LOADS = ["+x", "-x", "+y", "-y", "+z", "-z"]


def plan(folder, *flags):
    """Plans by a relative name, so that the file does not depend on the folder."""
    (folder / "torus.off").write_text(program.off_text(*program.torus()))
    return program.run("plan", "torus.off", "--search", "first", "--seed", "7", *flags,
                       "--out", "out", cwd=folder)


class PhysicsTest(program.ProgramTest):
    """Tests that are skipped in a build without the engine, which says so."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.planned = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.planned.cleanup)
        cls.folder_of_plan = pathlib.Path(cls.planned.name)
        done = plan(cls.folder_of_plan, "--count", "2")
        assert done.returncode == 0, done.stderr
        cls.file = cls.folder_of_plan / "out/grasps.json"
        done = program.run("hold", "out/grasps.json", cwd=cls.folder_of_plan)
        if "no physics engine" in done.stderr:
            assert done.returncode == 2, done.stderr
            assert done.stderr.startswith("graspfit hold: this build"), done.stderr
            raise unittest.SkipTest("built without MuJoCo")
        assert done.returncode == 0, done.stderr

    def hold(self, *flags, out="held", short=SHORT):
        done = program.run("hold", "out/grasps.json", *short, *flags, "--out", self.folder / out,
                           cwd=self.folder_of_plan)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done, json.loads((self.folder / out / "hold.json").read_text())


class Hold(PhysicsTest):
    def test_file_table_and_rows_say_the_same_and_follow_the_schema(self):
        done, data = self.hold("--margin", "--grasp", "1")
        if jsonschema is not None:
            schema = json.loads(
                (program.SOURCE_DIR / "grasp/hold_test/hold.schema.json").read_text())
            jsonschema.Draft202012Validator.check_schema(schema)
            jsonschema.validate(data, schema, cls=jsonschema.Draft202012Validator)
            _, in_turn = self.hold("--protocol", "dro", "--grasp", "1", "--quick", out="dro", short=())
            jsonschema.validate(in_turn, schema, cls=jsonschema.Draft202012Validator)
            self.assertEqual(in_turn["protocol"]["parameters"]["load"], "six-in-turn")
        results = data["results"]
        self.assertEqual((results["num_grasps"], results["num_tested"]), (2, 1))
        self.assertEqual(sum(results["stages"].values()), 1)
        (grasp,) = results["grasps"]
        self.assertEqual([one["load"] for one in grasp["directions"]], LOADS)
        for axis, sign in ((k, s) for k in range(3) for s in (1, -1)):
            expected = [float(sign * (k == axis)) for k in range(3)]
            self.assertEqual(grasp["directions"][2 * axis + (sign < 0)]["direction_O"], expected)
        self.assertEqual(grasp["held"], all(one["stage"] == "held" for one in grasp["directions"]))
        for one in grasp["directions"]:
            self.assertEqual(one["failed_at_s"] is not None, one["stage"] == "load")
        self.assertEqual(results["stages"][grasp["stage"]], 1)
        # A grasp holds exactly if its margin is above the protocol's force, up to the bisection's
        # accuracy.
        force = data["protocol"]["parameters"]["force_N"]
        if not 0.95 * force < grasp["margin"]["force_N"] < 1.05 * force:
            self.assertEqual(grasp["held"], grasp["margin"]["force_N"] > force)

        lines = done.stdout.splitlines()
        near = "yes" if grasp["near_limit"] else "no"
        self.assertEqual(lines[1].split()[:3], ["1", grasp["stage"], near])
        self.assertIn(f"{results['stages']['held']} of 1 grasps held", lines[2])
        self.assertIn("with another step_s, approach_time_s, squeeze_time_s, hold_time_s", lines[2])
        with open(self.folder / "held/hold.csv", newline="") as file:
            (row,) = csv.DictReader(file)
        self.assertEqual(float(row["margin_force_N"]), grasp["margin"]["force_N"])
        self.assertEqual(row["stage"], grasp["stage"])
        for one in grasp["directions"]:
            for key in ("stage", "failed_at_s", "largest_shift_m", "largest_turn_rad"):
                cell = row[f"{one['load']}_{key}"]
                self.assertEqual(value_of(cell), one[key])

        self.assertGreaterEqual(data["object"]["pieces"]["num_pieces"], 2)  # A torus is not convex.
        links = json.loads(self.file.read_text())["hand"]["links"]
        with_surface = [link["name"] for link in links if link["mesh_files"]]
        self.assertEqual([link["name"] for link in data["hand"]["links"]], with_surface)

    def test_same_bytes_for_one_and_two_jobs(self):
        self.hold("--jobs", "1", out="a")
        self.hold("--jobs", "2", out="b")
        for name in ("hold.json", "hold.csv"):
            self.assertEqual((self.folder / "a" / name).read_bytes(),
                             (self.folder / "b" / name).read_bytes())

    def test_one_grasp_alone_has_the_verdict_that_it_has_among_others(self):
        _, both = self.hold(out="both")
        _, second = self.hold("--grasp", "2", "--step", "0.004", out="second")
        self.assertEqual(second["results"]["grasps"], both["results"]["grasps"][1:])

    def test_what_the_protocol_asks_decides(self):
        # A kilonewton tears anything out of a hand, and limits that nothing reaches are kept by
        # all.
        _, data = self.hold("--set", "force_N=1000", "--quick", out="strong")
        self.assertEqual(data["results"]["stages"]["held"], 0)
        self.assertEqual({one["near_limit"] for one in data["results"]["grasps"]}, {None})
        self.assertIn("force_N", data["protocol"]["changed_parameters"])
        _, data = self.hold("--set", "largest_shift_m=1e6", "--set", "largest_turn_rad=4",
                            "--set", "largest_penetration_m=1", out="lenient")
        self.assertEqual(data["results"]["stages"]["held"], 2)

    def test_a_verdict_near_a_limit_is_said_to_be_one(self):
        def at(load, name, *flags):
            done, data = self.hold("--grasp", "1", "--step", "0.004", "--set", f"force_N={load}", *flags, out=name)
            (grasp,) = data["results"]["grasps"]
            return done, grasp

        held, lost = 1.0, 1000.0
        while lost > 1.05 * held:
            middle = (held * lost) ** 0.5
            if at(middle, "middle", "--quick")[1]["held"]:
                held = middle
            else:
                lost = middle
        found = set()
        for load in (held, lost, 0.3 * held):
            done, grasp = at(load, "asked")
            others = {at(share * load, "other", "--quick")[1]["held"] for share in (0.9, 1.1)}
            near = others != {grasp["held"]}
            self.assertEqual(grasp["near_limit"], near, load)
            self.assertEqual("1 near a limit: 0.9 or 1.1 times the load decides otherwise" in done.stdout, near)
            self.assertIn(f",{str(near).lower()},", (self.folder / "asked/hold.csv").read_text())
            found.add(near)
        self.assertEqual(found, {True, False})

    def test_a_single_grasp_is_judged_at_a_millisecond_unless_a_step_is_given(self):
        for flags, step in (((), 0.001), (("--step", "0.002"), 0.002), (("--set", "step_s=0.004"), 0.004)):
            _, data = self.hold("--grasp", "1", "--quick", *flags, out=f"step{step}")
            self.assertEqual(data["protocol"]["parameters"]["step_s"], step)
            self.assertEqual("step_s" in data["protocol"]["changed_parameters"], step != 0.004)
        _, data = self.hold("--quick", out="both")
        self.assertEqual(data["protocol"]["parameters"]["step_s"], 0.004)

    def test_every_parameter_is_written_and_can_be_set(self):
        _, data = self.hold("--squeeze", "extrapolation", "--step", "0.002", "--set",
                            "hand_solimp=0.6,0.98,0.0002", "--set", "multi_point_contacts=no",
                            "--protocol", "dexonomy-hard", "--grasp", "1")
        protocol = data["protocol"]
        self.assertEqual(protocol["name"], "dexonomy-hard")
        self.assertEqual(protocol["parameters"]["squeeze"], "extrapolation")
        self.assertEqual(protocol["parameters"]["step_s"], 0.002)
        self.assertEqual(protocol["parameters"]["sliding_friction"], 0.3)
        self.assertEqual(protocol["parameters"]["hand_solimp"], [0.6, 0.98, 0.0002])
        self.assertIs(protocol["parameters"]["multi_point_contacts"], False)
        self.assertEqual(set(protocol["changed_parameters"]),
                         {"squeeze", "step_s", "hand_solimp", "multi_point_contacts",
                          "hold_time_s", "approach_time_s", "squeeze_time_s"})

    def test_replay_is_a_page_of_the_same_verdict(self):
        _, data = self.hold("--replay", "2")
        self.assertEqual(sorted(path.name for path in (self.folder / "held").iterdir()),
                         ["hold.csv", "hold.json", "replay_002.html"])
        html = (self.folder / "held/replay_002.html").read_text()
        text = html.split('<script type="application/json" id="data">')[1].split("</script>")[0]
        replay = json.loads(text)
        parameters = data["protocol"]["parameters"]
        start = parameters["approach_time_s"] + parameters["squeeze_time_s"]
        for verdict, shown in zip(data["results"]["grasps"][1]["directions"], replay["directions"]):
            self.assertEqual(shown["name"], verdict["load"])
            self.assertEqual(shown["largest_shift"], verdict["largest_shift_m"])
            # The frames are those of the test: at its checks they are where the test says.
            at_checks = [
                shift for t, shift in zip(shown["times"], shown["shifts"])
                if t > start + 1e-6 and abs(remainder(t - start, parameters["check_interval_s"])) < 1e-6
                and (verdict["failed_at_s"] is None or t - start < verdict["failed_at_s"] + 1e-6)
            ]
            if verdict["stage"] in ("held", "load") and at_checks:
                self.assertAlmostEqual(max(at_checks), verdict["largest_shift_m"], delta=1e-4)

    def test_without_folder_nothing_is_written(self):
        before = sorted(path.name for path in (self.folder_of_plan / "out").iterdir())
        done = program.run("hold", "out/grasps.json", *SHORT, cwd=self.folder_of_plan)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("written", done.stdout)
        self.assertEqual(sorted(path.name for path in (self.folder_of_plan / "out").iterdir()), before)


class BadFlags(PhysicsTest):
    def test_refusals_are_one_line_and_leave_nothing(self):
        out = self.folder / "held"
        for flags, says in (
                (("--protocol", "harsh"), ["harsh", "dexgraspbench-100g"]),
                (("--squeeze", "hard"), ["hard", "forces|extrapolation|limits|none"]),
                (("--set", "mass=1"), ["mass", "object_mass_kg"]),
                (("--set", "force_N"), ["PARAMETER=VALUE"]),
                (("--set", "force_N=much"), ["force_N", "much"]),
                (("--set", "hand_solref=1"), ["hand_solref", "2 numbers"]),
                (("--set", "multi_point_contacts=1"), ["multi_point_contacts", "yes"]),
                (("--step", "0"), ["--step is 0, must be >= 0.00001"]),
                (("--set", "step_s=1e-12"), ["--set step_s=1e-12: step is 1e-12; it must be finite and >= 1e-05"]),
                (("--set", "hold_time_s=1e9"), ["--set hold_time_s=1e9: hold_time is 1e+09; it must be in [step, 1000]"]),
                (("--set", "object_mass_kg=-1"), ["--set object_mass_kg=-1: object_mass is -1; it must be"]),
                (("--set", "lift_time_s=2", "--set", "step_s=0.5"), ["--set step_s=0.5: approach_time"]),
                (("--step", "x"), ["--step"]),
                (("--grasp", "0"), ["--grasp", "ranks from 1"]),
                (("--grasp", "1.5"), ["ranks from 1"]),
                (("--grasp", "3"), ["--grasp 3", "2 grasps"]),
                (("--grasp", "1", "--replay", "2", "--out", out), ["--replay 2", "--grasp"]),
                (("--replay", "1"), ["--out"]),
                (("--gif", "--out", out), ["--replay"]),
                (("--jobs", "-1"), ["--jobs"]),
                (("--pieces", "0"), ["--pieces is 0, must be >= 1"]),
                (("--deviation", "0"), ["--deviation is 0, must be > 0"]),
                (("--protocol", "tabletop-lift", "--margin"), ["--margin", "tabletop-lift"])):
            with self.subTest(flags=flags):
                self.assert_refused("hold", self.file, *flags, says=says, cwd=self.folder_of_plan)
        self.assert_refused("hold", says="GRASPS.json")
        self.assert_refused("hold", self.folder / "none.json", says="none.json")
        self.assert_refused("hold", self.folder_of_plan / "torus.off", says="not JSON")
        self.assert_refused("plan", self.folder_of_plan / "torus.off", "--hold", "harsh",
                            says=["harsh", "dexgraspbench-100g"])


class PlanHold(PhysicsTest):
    def test_plan_keeps_what_holds_largest_margin_first(self):
        done = plan(self.folder, "--count", "4", "--hold", "dexgraspbench-100g")
        self.assertIn(done.returncode, (0, 3), done.stderr)
        self.assertIn("planned grasps hold under dexgraspbench-100g", done.stdout + done.stderr)
        # That no grasp holds is said in one line, and nothing is written.
        if done.returncode == 3:
            self.assertEqual(len(done.stderr.splitlines()), 1)
            self.assertFalse((self.folder / "out").exists())
            return
        data = json.loads((self.folder / "out/grasps.json").read_text())
        if jsonschema is not None:
            schema = json.loads((program.SOURCE_DIR / "grasp/grasps.schema.json").read_text())
            jsonschema.validate(data, schema, cls=jsonschema.Draft202012Validator)
        hold = data["results"]["hold"]
        margins = hold["margins_N"]
        self.assertEqual(margins, sorted(margins, reverse=True))
        self.assertEqual(len(margins), len(data["results"]["grasps"]))
        self.assertEqual(hold["stages"]["held"], len(margins))
        self.assertIn("margin_N", done.stdout)

        # A second test from the file gives the same.
        done = program.run("hold", "out/grasps.json", "--margin", "--grasp", "1", "--step", "0.004", "--out", "held",
                           cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        (grasp,) = json.loads((self.folder / "held/hold.json").read_text())["results"]["grasps"]
        self.assertTrue(grasp["held"])
        self.assertAlmostEqual(grasp["margin"]["force_N"], margins[0], delta=0.03 * margins[0])

        # By another rank the same grasps hold; their order is the planner's.
        done = plan(self.folder, "--count", "4", "--hold", "dexgraspbench-100g", "--rank", "m")
        self.assertEqual(done.returncode, 0, done.stderr)
        by_m = json.loads((self.folder / "out/grasps.json").read_text())["results"]
        self.assertEqual(sorted(by_m["hold"]["margins_N"], reverse=True), margins)
        measures = [grasp["m"] for grasp in by_m["grasps"]]
        self.assertEqual(measures, sorted(measures, reverse=True))
        self.assert_refused("plan", "torus.off", "--hold", "tabletop-lift", "--rank", "margin", cwd=self.folder,
                            says="--rank margin: protocol tabletop-lift finds no margins")


def value_of(cell):
    """Returns None, a number or a text."""
    try:
        return float(cell) if cell else None
    except ValueError:
        return cell


def remainder(x, step):
    return x - step * round(x / step)


if __name__ == "__main__":
    program.main()
