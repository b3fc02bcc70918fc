"""graspfit experiment: what list and describe say, and what is refused in which words."""

import json
import os
import re
import shutil

from program import SOURCE_DIR, ProgramTest, main, run

SLUGS = sorted(path.stem for path in (SOURCE_DIR / "experiments/configs").glob("*.json"))


class Describe(ProgramTest):
    def test_list_has_every_configuration(self):
        done = run("experiment", "list")
        self.assertEqual(done.returncode, 0, done.stderr)
        for slug in SLUGS:
            self.assertIn(f"{slug}: ", done.stdout)

    def test_describe_names_axes_columns_and_settings(self):
        done = run("experiment", "describe", "special_cases")
        self.assertEqual(done.returncode, 0, done.stderr)
        for text in ("340 cells", "torus_16cm", "satisfied", "first_grasp_s", "score-threshold"):
            self.assertIn(text, done.stdout)
        done = run("experiment", "describe", "special_cases", "--set", "seed=1,2")
        self.assertIn("34 cells", done.stdout)

    def settings_of(self, slug, *arguments):
        """Returns what describe says of each setting: default, unit, allowed, meaning."""
        done = run("experiment", "describe", slug, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = done.stdout.split("\nSettings, ")[1].splitlines()[1:]
        rows = [re.split("  +", line.strip(), maxsplit=4) for line in lines]
        self.assertEqual(rows[0], ["name", "default", "unit", "allowed", "meaning"])
        self.assertEqual({len(row) for row in rows}, {5})
        return {row[0]: row[1:] for row in rows[1:]}

    def test_describe_says_what_every_setting_is_there_and_may_be(self):
        properties = json.loads((SOURCE_DIR / "experiments/config.schema.json").read_text())[
            "$defs"]["known_settings"]["properties"]
        config = json.loads((SOURCE_DIR / "experiments/configs/table1.json").read_text())
        settings = self.settings_of("table1")
        for name, value in config["settings"].items():
            shown = value if isinstance(value, str) else json.dumps(value)
            self.assertEqual(settings[name][0], shown, name)
        self.assertEqual(settings["planner"][0], "axis planner")
        self.assertEqual(settings["size_m"][:3], ["axis size", "m", "> 0"])
        self.assertEqual(settings["resolution"][:3], ["30", "1", "in [4, 512]"])
        self.assertEqual(settings["theta-max-deg"][:3], ["45", "deg", "in (0, 90)"])
        self.assertEqual(settings["style"][:3], ["precision", "-", "precision|power|auto"])
        self.assertEqual(settings["refine"][:3], ["false", "-", "true|false"])
        self.assertEqual(settings["max-iterations"][:2], ["-", "1"])
        for name, (_, unit, allowed, meaning) in settings.items():
            described = properties[name]["description"]
            self.assertTrue(described.startswith(meaning), name)
            if "enum" in properties[name]:
                self.assertEqual(allowed, "|".join(properties[name]["enum"]), name)
        changed = self.settings_of("table1", "--set", "resolution=20,40", "--set", "alpha=3")
        self.assertEqual(changed["resolution"][0], "axis resolution")
        strong = self.settings_of("planner_everyday", "--set", "preset=strong")
        self.assertEqual([strong[name][0] for name in ("keep", "search", "max-placements")],
                         ["axis preset", "axis preset", "4"])
        self.assertEqual(self.settings_of("table1", "--quick")["count"][0],
                         json.dumps(config["quick"]["settings"]["count"]))

    def test_list_names_a_bad_configuration_and_lists_the_others(self):
        folder = self.folder / "configs"
        shutil.copytree(SOURCE_DIR / "experiments/configs", folder)
        config = folder / "force_closure.json"
        config.write_text(config.read_text().replace('"first"', '"fast"'))
        (folder / "measured_contacts.json").unlink()
        done = run("experiment", "list", env=dict(os.environ, GRASPFIT_EXPERIMENTS=str(folder)))
        self.assertEqual(done.returncode, 2)
        errors = done.stderr.splitlines()
        self.assertEqual(len(errors), 2, done.stderr)
        self.assertRegex(errors[0], "^graspfit experiment list: force_closure: .*/settings/search: is \"fast\"")
        self.assertRegex(errors[1], "^graspfit experiment list: measured_contacts: ")
        for slug in SLUGS:
            self.assertEqual(f"\n{slug}: " in "\n" + done.stdout, slug not in ("force_closure", "measured_contacts"))


class Refusals(ProgramTest):
    def test_one_line_says_what_and_what_is_allowed(self):
        experiment = ("experiment", "run")
        self.assert_refused("experiment", "walk", says="there are list, describe, run, status")
        self.assert_refused(*experiment, "nothing", says=["nothing", "planner_everyday"])
        self.assert_refused(*experiment, "force_closure", "--set", "grip=pinch",
                            says=["--set grip", "there are precision_45_deg, "])
        self.assert_refused(*experiment, "force_closure", "--set", "regularity=round",
                            says=["--set regularity", "combined|angle-only"])
        self.assert_refused(*experiment, "force_closure", "--set", "colour=red",
                            says=["--set colour", "is no setting; there are"])
        self.assert_refused(*experiment, "force_closure", "--jobs", "0", says="--jobs is 0, must be in [1, 1024]")
        self.assert_refused(*experiment, "force_closure", "--jobs", "100000",
                            says="--jobs is 100000, must be in [1, 1024]")
        self.assert_refused(*experiment, "fitting_stages", "--quick", "--set", "planner=gs",
                            says="must be one whose hands are fitted to targets")
        self.assert_refused(*experiment, "force_closure", "--quick", "--publish",
                            says="results are not published: --quick")

    def test_a_value_out_of_range_is_refused_in_the_words_of_its_setting(self):
        for change, says in (("resolution=3", "--set resolution: is 3, must be in [4, 512]"),
                             ("friction=-1", "--set friction: is -1, must be >= 0"),
                             ("wanted-gap-mm=0", "--set wanted-gap-mm: is 0, must be > 0 [mm]"),
                             ("wanted-gap-mm=9", "--set wanted-gap-mm: is 9, must be below largest-gap-mm"),
                             ("theta-max-deg=90", "--set theta-max-deg: is 90, must be in (0, 90) [deg]"),
                             ("neighborhood=4", "--set neighborhood: is 4, must be odd")):
            with self.subTest(change):
                line = self.assert_refused("experiment", "run", "planner_everyday",
                                           "--set", change, says=says)
                self.assertNotRegex(line, "[a-z]Options|[a-z]+_[a-z_]+ = ")
        for change in ("travel_clearance_mm=-1", "max_moves=0", "frame_step_mm=0"):
            line = self.assert_refused("experiment", "run", "table_tidying", "--set", change,
                                       says=["--set " + change.split("=")[0] + ": is ", "must be "])
            self.assertNotIn("Options", line)
        self.assert_refused("experiment", "verify", "table1", "--relative", "-1",
                            says="--relative is -1, must be >= 0")

    def test_a_mistyped_name_is_told_from_its_nearest_known_one(self):
        experiment = ("experiment", "run")
        self.assert_refused("experiment", "rnu", says='did you mean "run"?')
        self.assert_refused(*experiment, "tabel1", says='did you mean "table1"?')
        self.assert_refused(*experiment, "table1", "--sett", "object=kitten", says='did you mean "--set"?')
        self.assert_refused(*experiment, "table1", "--set", "objet=kitten",
                            says=["--set objet", "no axis or setting", 'did you mean "object"?'])
        self.assert_refused(*experiment, "table1", "--set", "object=kiten",
                            says=["--set object", 'did you mean "kitten"?'])
        self.assert_refused(*experiment, "table1", "--set", "resolutoin=20",
                            says='did you mean "resolution"?')

    def test_objects_of_a_table_lie_as_start_and_goal_say(self):
        folder = self.folder / "configs"
        folder.mkdir()
        config = json.loads((SOURCE_DIR / "experiments/configs/table_tidying.json").read_text())
        config.setdefault("settings", {})["rotation_deg"] = [90, 0, 0]
        (folder / "table_tidying.json").write_text(json.dumps(config))
        done = run("experiment", "describe", "table_tidying",
                   env=dict(os.environ, GRASPFIT_EXPERIMENTS=str(folder)))
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("/settings/rotation_deg: means nothing here", done.stderr)

    def test_a_broken_configuration_names_file_and_key(self):
        folder = self.folder / "configs"
        folder.mkdir()
        text = (SOURCE_DIR / "experiments/configs/force_closure.json").read_text()
        (folder / "force_closure.json").write_text(text.replace('"first"', '"fast"'))
        done = run("experiment", "describe", "force_closure",
                   env=dict(os.environ, GRASPFIT_EXPERIMENTS=str(folder)))
        self.assertEqual(done.returncode, 2)
        self.assertIn("force_closure.json: /settings/search: is \"fast\", must be one of best|first",
                      done.stderr)


if __name__ == "__main__":
    main()
