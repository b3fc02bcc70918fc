"""graspfit experiment: list, describe, run, status, merge, verify, columns, schema."""

import csv
import json
import os
import pathlib
import shutil
import tempfile

from program import SOURCE_DIR, ProgramTest, main, run

SLUGS = sorted(path.stem for path in (SOURCE_DIR / "experiments/configs").glob("*.json"))


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


class Quick(ProgramTest):
    """Tests of --quick, without any data: test_SLUG of every experiment."""

    def check(self, slug):
        environment = dict(os.environ, GRASPFIT_DATA=str(self.folder / "none"),
                           GRASPFIT_PACKAGED_MESHES=str(self.folder / "none"))
        out = self.folder / slug
        done = run("experiment", "run", slug, "--quick", "--out", out, env=environment)
        if "no physics engine" in done.stderr:
            self.assertEqual(done.returncode, 2)
            self.skipTest(done.stderr)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        rows = rows_of(out / f"{slug}.csv")
        self.assertGreater(len(rows), 0)
        self.assertEqual({row["status"] for row in rows}, {"ok"}, rows)
        manifest = json.loads((out / f"{slug}.manifest.json").read_text())
        self.assertEqual(len(rows_of(out / f"{slug}.timing.csv")), len(rows))
        self.assertTrue(manifest["config"]["is_quick"])
        self.assertFalse(manifest["config"]["is_modified"])
        self.assertEqual(manifest["cells"]["total"], len(rows))


for name in SLUGS:
    setattr(Quick, f"test_{name}", lambda self, slug=name: self.check(slug))


class Run(ProgramTest):
    """Tests of what a run writes and says."""

    def test_rows_do_not_depend_on_jobs_and_runs(self):
        slug = "planner_paper_objects"
        texts = []
        for name, jobs in (("one", 1), ("two", 2), ("two", 2)):
            out = self.folder / name
            done = run("experiment", "run", slug, "--quick", "--set", "resolution=12",
                       "--jobs", jobs, "--out", out)
            self.assertEqual(done.returncode, 0, done.stderr)
            texts.append((out / f"{slug}.csv").read_bytes())
        self.assertEqual(texts[0], texts[1])
        self.assertEqual(texts[0], texts[2])

    def test_a_run_says_why_its_first_cell_failed(self):
        done = run("experiment", "run", "parameter_sweeps", "--quick", "--set", "hand=barett",
                   "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, "first without result: [^\\n]* hand=barett seed=1: no hand barett: ")

    def test_missing_data_is_skipped_and_said(self):
        out = self.folder / "out"
        environment = dict(os.environ, GRASPFIT_DATA=str(self.folder))
        done = run("experiment", "run", "object_voxels", "--set", "object=horse,ball", "--set",
                   "resolution=8", "--set", "weak-thickness-mm=0", "--out", out, env=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 finished (0 earlier), 0 of these failed, 1 skipped", done.stdout)
        self.assertRegex(done.stdout, "first without result: object=horse [^\\n]*set GRASPFIT_DATA")
        rows = rows_of(out / "object_voxels.csv")
        self.assertEqual([row["status"] for row in rows], ["skipped", "ok"])
        self.assertIn("set GRASPFIT_DATA", rows[0]["reason"])


class Shards(ProgramTest):
    """Tests of a sweep of a shape, which needs no data, in parts."""

    SLUG = "parameter_sweeps"
    CHANGES = ("--quick", "--set", "seed=1,2,3")  # This makes 6 cells.

    def run_part(self, out, *arguments):
        done = run("experiment", "run", self.SLUG, *self.CHANGES, "--out", out, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_shards_merge_to_the_bytes_of_one_run(self):
        one, two = self.folder / "one", self.folder / "two"
        self.run_part(one)
        self.assertIn("3 cells: 3 finished", self.run_part(two, "--shard", "2/2"))
        merge = ("experiment", "merge", self.SLUG, *self.CHANGES, "--out", two)
        done = run(*merge)
        self.assertEqual(done.returncode, 2)
        self.assertIn("3 of 6 cells are missing, object=shape_torus option=resolution_20 seed=1",
                      done.stderr)
        self.assertFalse((two / f"{self.SLUG}.csv").exists())
        status = run("experiment", "status", self.SLUG, "--out", two).stdout.splitlines()
        self.assertRegex(status[0], "^all +3 of 6 cells done, 0 of these failed, 3 left")
        self.assertRegex(status[2], "^shard 2-of-2 +3 of 3 cells done, .* per s$")
        self.run_part(two, "--shard", "1/2")
        done = run(*merge)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in (f"{self.SLUG}.csv",):
            self.assertEqual((one / name).read_bytes(), (two / name).read_bytes())
        manifest = json.loads((two / f"{self.SLUG}.manifest.json").read_text())
        self.assertEqual([part["command"][-11:] for part in manifest["shards"]],
                         ["--shard 1/2", "--shard 2/2"])
        self.assertNotIn(str(self.folder), json.dumps(manifest))
        self.assertEqual(manifest["command"], "graspfit experiment merge parameter_sweeps --quick "
                                              "--set seed=1,2,3")

    def test_verify_names_cell_and_column(self):
        out, other = self.folder / "out", self.folder / "other"
        self.run_part(out)
        self.run_part(other)
        verify = ("experiment", "verify", self.SLUG, "--out", out, "--against", other)
        done = run(*verify)
        self.assertEqual((done.returncode, done.stdout),
                         (0, f"{self.SLUG}.csv: 6 rows compared, the same bytes\n"))
        table = other / f"{self.SLUG}.csv"
        whole = table.read_text()
        table.write_text(whole.replace("shape", "form"))
        done = run(*verify)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertIn(f"{table}: is not the table that", done.stderr)
        table.write_text(whole)
        # Manifests may lack the hashes of their tables.
        for folder in (out, other):
            manifest = folder / f"{self.SLUG}.manifest.json"
            content = json.loads(manifest.read_text())
            self.assertEqual(len(content.pop("tables_sha256")), 2)
            manifest.write_text(json.dumps(content))
        rows = rows_of(table)
        row = next(row for row in rows if row["mean_m"])
        value = float(row["mean_m"])

        def write(mean_m):
            row["mean_m"] = repr(mean_m)
            with open(table, "w", newline="", encoding="utf-8") as stream:
                writer = csv.DictWriter(stream, rows[0], lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)

        write(value * (1 + 5e-10))
        done = run(*verify)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("0 fields differ; the others by at most 5.0e-10", done.stdout)
        write(value * (1 + 2e-9))
        done = run(*verify)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("1 fields differ", done.stdout)
        self.assertIn(f"object={row['object']} option={row['option']} seed={row['seed']}: "
                      f"mean_m is \"{value!r}\"", done.stdout)

    def test_verify_says_that_the_published_tables_were_made_otherwise(self):
        out, other = self.folder / "out", self.folder / "other"
        self.run_part(out)
        done = run("experiment", "run", self.SLUG, "--quick", "--set", "seed=1,2",
                   "--set", "angle-weight=0.5", "--out", other)
        self.assertEqual(done.returncode, 0, done.stderr)
        verify = ("experiment", "verify", self.SLUG, "--out", out, "--against", other)
        manifest = other / f"{self.SLUG}.manifest.json"
        content = json.loads(manifest.read_text())
        as_run = content["config"]["as_run"]
        as_run["axes"] = [axis for axis in as_run["axes"] if axis["name"] != "angle-weight"]
        as_run["settings"]["max-attempts"] = 77
        as_run["axes"][0]["values"][0]["settings"]["size_m"] = 0.5
        manifest.write_text(json.dumps(content))
        first = run(*verify).stdout.splitlines()[0]
        ours = json.loads((out / f"{self.SLUG}.manifest.json").read_text())["config"]["as_run"]
        shape = ours["axes"][0]["values"][0]
        self.assertEqual(first, f"{other}: published with other settings: max-attempts 77, here "
                                f"{ours['settings']['max-attempts']}; object={shape['label']} size_m 0.5, here "
                                f"{shape['settings'].get('size_m', 'not given')}")
        content["config"]["as_run"] = ours
        for damage in ({"cells": 5}, {"cells": {"total": "six"}}, {"config": {"as_run": {"axes": 3}}}):
            damaged = self.folder / "damaged"
            shutil.copytree(out, damaged, dirs_exist_ok=True)
            file = damaged / f"{self.SLUG}.manifest.json"
            file.write_text(json.dumps({**json.loads((out / file.name).read_text()), **damage}))
            done = run("experiment", "verify", self.SLUG, "--out", damaged, "--against", other)
            self.assertEqual(done.returncode, 2, f"{damage} {done.stdout}{done.stderr}")
            self.assertIn("damaged", done.stderr)
        content.update(commit="0123456789", is_commit_clean=True, program_sha256="")
        manifest.write_text(json.dumps(content))
        self.assertRegex(run(*verify).stdout.splitlines()[0],
                         "published by other code: commit 0123456, here ")

    def test_a_folder_of_another_experiment_is_refused(self):
        out = self.folder / "out"
        self.run_part(out, "--shard", "1/2")
        for command in (("run", "--quick"), ("run", "--quick", "--shard", "1/2"), ("merge", "--quick")):
            self.assert_refused("experiment", command[0], "measured_contacts", *command[1:], "--out", out,
                                says=["holds results of parameter_sweeps", "--out"])
        other = self.folder / "other"
        self.run_part(other)
        self.assert_refused("experiment", "run", "measured_contacts", "--quick", "--out", other,
                            says="holds results of parameter_sweeps")
        self.run_part(other)  # Its own part may go on.

    def test_shards_that_cannot_be_are_refused(self):
        part = ("experiment", "run", self.SLUG, "--out", "out", "--shard")
        self.assert_refused(*part, "3/2", says=["--shard", "3/2", "1 <= I <= N"])
        self.assert_refused(*part, "two", says="--shard \"two\" is not I/N")
        self.assert_refused(*part, "1/2", "--publish", says="merge has it")
        self.assert_refused("experiment", "merge", self.SLUG, "--out", self.folder / "none",
                            says="has no shards of parameter_sweeps")
        self.assert_refused("experiment", "status", self.SLUG, "--out", self.folder / "none",
                            says="has no results of parameter_sweeps")


class Schema(ProgramTest):
    """Tests of experiments/config.schema.json, and of the program's own checks beside it."""

    def setUp(self):
        super().setUp()
        try:
            import jsonschema
        except ImportError as missing:
            self.skipTest(f"{missing.name} is not installed")
        self.schema = json.loads((SOURCE_DIR / "experiments/config.schema.json").read_text())
        self.validator = jsonschema.Draft202012Validator(self.schema)

    def test_the_committed_schema_is_the_program_s(self):
        done = run("experiment", "schema")
        self.assertEqual(done.stdout, (SOURCE_DIR / "experiments/config.schema.json").read_text(),
                         "run: graspfit experiment schema > experiments/config.schema.json")

    def test_every_configuration_is_valid(self):
        for slug in SLUGS:
            config = json.loads((SOURCE_DIR / f"experiments/configs/{slug}.json").read_text())
            self.assertEqual([e.message for e in self.validator.iter_errors(config)], [], slug)

    def test_schema_and_program_refuse_the_same(self):
        """Checks that the program, too, refuses what the schema refuses, naming file, key and
        what is allowed."""
        folder = self.folder / "configs"
        folder.mkdir()
        text = (SOURCE_DIR / "experiments/configs/parameter_sweeps.json").read_text()
        (folder / "planner_paper_objects.json").write_text(
            (SOURCE_DIR / "experiments/configs/planner_paper_objects.json").read_text())

        def changed(path, value):
            config = json.loads(text)
            *way, last = path
            place = config
            for key in way:
                place = place[key]
            if value is None:
                del place[last]
            else:
                place[last] = value
            return config

        for path, value, says in [
                (["seed"], -1, "/seed: is -1, must be an integer from 0"),
                (["seeds"], 0, "/seeds: is 0, must be in [1, 100000]"),
                (["question"], None, "/question: is missing"),
                (["colour"], "red", "/colour: is not a member that is known here; there are "),
                (["settings", "accept"], "all", "/settings/accept: is \"all\", must be one of "),
                (["settings", "accpet"], "all", "/settings/accpet: is no setting; there are "),
                (["settings", "refine"], "on", "/settings/refine: is \"on\", must be true or"),
                (["settings", "slide-steps"], 1.5, "/settings/slide-steps: is 1.5, must be an"),
                (["settings", "approach"], [0, 1], "/settings/approach: is [0,1], must be three"),
                (["settings", "size_m"], 0, "/settings/size_m: is 0, must be > 0"),
                (["axes", "option"], [], "/axes/option: is [], must be an array with at least one"),
                (["axes", "option", 0, "name"], None, "/axes/option/0/name: is missing"),
                (["axes", "option", 0, "name"], "a/b", "/axes/option/0: is named \"a/b\""),
                (["axes", "refine"], [1], "/axes/refine/0: is 1, must be true or false"),
                (["axes", "seed"], [1], "/axes/seed: no axis can be named \"seed\""),
                (["quick", "cells"], 3, "/quick/cells: is not a member")]:
            with self.subTest(says):
                config = changed(path, value)
                self.assertFalse(self.validator.is_valid(config))
                (folder / "parameter_sweeps.json").write_text(json.dumps(config))
                done = run("experiment", "describe", "parameter_sweeps", "--quick",
                           env=dict(os.environ, GRASPFIT_EXPERIMENTS=str(folder)))
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertIn("parameter_sweeps.json: " + says, done.stderr)


class Columns(ProgramTest):
    def test_every_published_table_has_a_dictionary_of_its_columns(self):
        tables = sorted((SOURCE_DIR / "notebooks-data").glob("*.csv"))
        self.assertGreater(len(tables), 0)
        for table in tables:
            with self.subTest(table.name):
                slug = table.name.split(".")[0]
                dictionary = json.loads(table.with_name(f"{slug}.columns.json").read_text())
                columns = dictionary["tables"][table.name]
                with open(table, newline="", encoding="utf-8") as stream:
                    self.assertEqual(next(csv.reader(stream)), [c["name"] for c in columns])
                for column in columns:
                    self.assertTrue(column["meaning"], column)


class OneRun(ProgramTest):
    """Tests of one --quick run of an experiment, which takes too long for one run per test."""

    SLUG = ""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.out = pathlib.Path(temporary.name)
        cls.done = run("experiment", "run", cls.SLUG, "--quick", "--out", cls.out)

    def setUp(self):
        super().setUp()
        if "no physics engine" in self.done.stderr:
            self.skipTest(self.done.stderr)
        self.assertEqual(self.done.returncode, 0, self.done.stderr)

    def table(self, name=""):
        return rows_of(self.out / f"{self.SLUG}{name}.csv")

    def assert_two_jobs_write_the_same_bytes(self, *names):
        two = self.folder / "two"
        done = run("experiment", "run", self.SLUG, "--quick", "--out", two, "--jobs", 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in names:
            table = f"{self.SLUG}{name}.csv"
            self.assertEqual((self.out / table).read_bytes(), (two / table).read_bytes(), table)


class HoldRates(OneRun):
    """Tests of grasps put to the hold test."""

    SLUG = "hold_rates"

    def test_rows_count_what_the_details_say(self):
        rows, details = self.table(), self.table(".details")
        stages = {"held": "held", "rejected": "rejected", "approach": "lost_before_load",
                  "load": "lost_under_load"}
        for row in rows:
            own = [d for d in details if (d["object"], d["grip"]) == (row["object"], row["grip"])]
            self.assertEqual(len(own), int(row["grasps"]))
            self.assertEqual(int(row["grasps"]) + int(row["duplicates"]), int(row["valid"]))
            for protocol in ("normal_", "hard_", "multidex_"):
                for stage, column in stages.items():
                    self.assertEqual(sum(d[protocol + "stage"] == stage for d in own),
                                     int(row[protocol + column]))
                self.assertEqual(float(row[protocol + "held_per_attempt"]),
                                 int(row[protocol + "held"]) / int(row["attempts"]))
            self.assertEqual(sum(d["margin_force_n"] != "" for d in own), int(row["margins"]))


class HoldPrediction(OneRun):
    """Tests of what predicts the hold test. SciPy computes the summary again from the rows per
    grasp."""

    SLUG = "hold_prediction"

    def test_two_jobs_write_the_same_bytes(self):
        self.assert_two_jobs_write_the_same_bytes("", ".details", ".summary")

    def test_the_dictionary_has_the_columns_of_all_tables(self):
        tables = json.loads(run("experiment", "columns", self.SLUG).stdout)["tables"]
        self.assertEqual(len(tables), 4)
        for name, columns in tables.items():
            with open(self.out / name, newline="", encoding="utf-8") as stream:
                self.assertEqual(next(csv.reader(stream)), [c["name"] for c in columns])

    def test_scipy_agrees_with_the_summary(self):
        try:
            from scipy import stats
        except ImportError as missing:
            self.skipTest(f"{missing.name} is not installed")
        details = self.table(".details")
        self.assertGreater(len(details), 3)
        for row in self.table(".summary"):
            if row["scope"] != "all":
                continue
            own = [d for d in details if row["grip"] in ("all", d["grip"]) and d[row["measure"]]]
            if row["statistic"] == "auc":
                column = row["target"].replace("held", "stage")
                scores = {held: [float(d[row["measure"]]) for d in own
                                 if d[column] and (d[column] == "held") == held]
                          for held in (True, False)}
                pairs = len(scores[True]) * len(scores[False])
                if pairs == 0 or len(set(scores[True] + scores[False])) == 1:
                    self.assertEqual(row["value"], "")
                else:
                    expected = stats.mannwhitneyu(scores[True], scores[False]).statistic / pairs
                    self.assertAlmostEqual(float(row["value"]), expected, places=12)
            else:
                both = [(float(d[row["measure"]]), float(d[row["target"]])) for d in own
                        if d[row["target"]]]
                if any(len({pair[i] for pair in both}) < 2 for i in (0, 1)):
                    self.assertEqual(row["value"], "")
                else:
                    expected = stats.spearmanr(both).statistic
                    self.assertAlmostEqual(float(row["value"]), expected, places=12)


class Methods(OneRun):
    """Tests that compare planning methods. SciPy computes both tables over all cells again."""

    SLUG = "table1"

    def test_two_jobs_write_the_same_bytes(self):
        self.assert_two_jobs_write_the_same_bytes("", ".details", ".summary", ".correlations")

    def test_scipy_agrees_with_both_tables(self):
        try:
            from scipy import stats
        except ImportError as missing:
            self.skipTest(f"{missing.name} is not installed")
        rows, details = self.table(), self.table(".details")
        self.assertGreater(len(details), 4)
        for row in rows:
            own = [float(d["m"]) for d in details if d["planner"] == row["planner"]]
            self.assertEqual(len(own), int(row["grasps"]))
            self.assertTrue(all(m > 0 for m in own))
            if len(own) > 1:
                self.assertAlmostEqual(float(row["m_mean"]), stats.tmean(own), places=12)
                self.assertAlmostEqual(float(row["m_sd"]), stats.tstd(own), places=12)
        summary = self.table(".summary")
        self.assertEqual([(row["planner"], row["mean_m"]) for row in summary],
                         [(row["planner"], row["m_mean"]) for row in rows])
        for row in self.table(".correlations"):
            if row["scope"] != "all":
                continue
            both = [(float(d[row["measure"]]), float(d[row["other"]])) for d in details
                    if row["planner"] in ("all", d["planner"])
                    and d[row["measure"]] and d[row["other"]]]
            self.assertEqual(len(both), int(row["grasps"]))
            if len(both) < 2 or any(len({pair[i] for pair in both}) < 2 for i in (0, 1)):
                self.assertEqual(row["spearman"], "")
            else:
                self.assertAlmostEqual(float(row["spearman"]), stats.spearmanr(both).statistic,
                                       places=12)


if __name__ == "__main__":
    main()
