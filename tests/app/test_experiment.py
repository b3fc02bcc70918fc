"""graspfit experiment: list, describe, run."""

import csv
import json
import os
import pathlib

from program import SOURCE_DIR, ProgramTest, main, run

SLUGS = sorted(path.stem for path in (SOURCE_DIR / "experiments/configs").glob("*.json"))

WITHOUT_MESHES = {"measured_contacts"}  # experiments whose cells read no mesh of an object


def data_folder():
    return pathlib.Path(os.environ.get("GRASPFIT_DATA", SOURCE_DIR.parent / "shared"))


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


class Quick(ProgramTest):
    """--quick of every experiment; cells whose meshes are not there are skipped rows."""

    def test_every_experiment_runs(self):
        has_data = (data_folder() / "meshes/paper/torus.obj").is_file()
        for slug in SLUGS:
            with self.subTest(slug):
                out = self.folder / slug
                done = run("experiment", "run", slug, "--quick", "--out", out)
                self.assertEqual(done.returncode, 0, done.stderr)
                rows = rows_of(out / f"{slug}.csv")
                self.assertGreater(len(rows), 0)
                needs_data = slug not in WITHOUT_MESHES
                can_run = (has_data or not needs_data) and "no physics engine" not in rows[0]["reason"]
                self.assertEqual({row["status"] for row in rows},
                                 {"ok" if can_run else "skipped"}, rows)
                self.assertEqual(len(rows_of(out / f"{slug}.timing.csv")), len(rows))
                manifest = json.loads((out / f"{slug}.manifest.json").read_text())
                self.assertTrue(manifest["config"]["is_quick"])
                self.assertEqual(manifest["cells"]["total"], len(rows))
                if has_data and needs_data:
                    self.assertRegex(json.dumps(manifest["inputs_sha256"]), "meshes/[a-z]+/[a-z_]+")
                    self.assertNotIn(str(data_folder()), json.dumps(manifest["inputs_sha256"]))

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

    def test_missing_data_is_skipped_and_said(self):
        out = self.folder / "out"
        environment = dict(os.environ, GRASPFIT_DATA=str(self.folder))
        done = run("experiment", "run", "special_cases", "--quick", "--out", out, env=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 skipped", done.stdout)
        for row in rows_of(out / "special_cases.csv"):
            self.assertEqual(row["status"], "skipped")
            self.assertIn("set GRASPFIT_DATA", row["reason"])


class Hold(ProgramTest):
    """Grasps put to the hold test. SciPy computes the summary again from the rows per grasp."""

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"

    def run_quick(self, slug, *arguments):
        done = run("experiment", "run", slug, "--quick", "--out", self.out, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = rows_of(self.out / f"{slug}.csv")
        for row in rows:
            if row["status"] == "skipped":
                self.skipTest(row["reason"])
        return rows

    def test_rows_count_what_the_details_say(self):
        rows = self.run_quick("hold_rates")
        details = rows_of(self.out / "hold_rates.details.csv")
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

    def test_two_jobs_write_the_same_bytes(self):
        slug = "hold_prediction"
        self.run_quick(slug)
        two = self.folder / "two"
        done = run("experiment", "run", slug, "--quick", "--out", two, "--jobs", 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        for ending in (".csv", ".details.csv", ".summary.csv"):
            self.assertEqual((self.out / (slug + ending)).read_bytes(),
                             (two / (slug + ending)).read_bytes())

    def test_scipy_agrees_with_the_summary(self):
        try:
            from scipy import stats
        except ImportError as missing:
            self.skipTest(f"{missing.name} is not installed")
        self.run_quick("hold_prediction")
        details = rows_of(self.out / "hold_prediction.details.csv")
        self.assertGreater(len(details), 3)
        for row in rows_of(self.out / "hold_prediction.summary.csv"):
            if row["scope"] != "all":
                continue
            own = [d for d in details if row["grip"] in ("all", d["grip"])]
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


class Describe(ProgramTest):
    def test_list_has_every_configuration(self):
        done = run("experiment", "list")
        self.assertEqual(done.returncode, 0, done.stderr)
        for slug in SLUGS:
            self.assertIn(f"{slug}: ", done.stdout)

    def test_describe_names_axes_columns_and_settings(self):
        done = run("experiment", "describe", "special_cases")
        self.assertEqual(done.returncode, 0, done.stderr)
        for text in ("320 cells", "torus_16cm", "satisfied", "first_grasp_s", "score-threshold"):
            self.assertIn(text, done.stdout)
        done = run("experiment", "describe", "special_cases", "--set", "seed=1,2")
        self.assertIn("32 cells", done.stdout)


class Refusals(ProgramTest):
    def test_one_line_says_what_and_what_is_allowed(self):
        experiment = ("experiment", "run")
        self.assert_refused("experiment", "walk", says="there are list, describe and run")
        self.assert_refused(*experiment, "nothing", says=["nothing", "planner_everyday"])
        self.assert_refused(*experiment, "force_closure", "--set", "grip=pinch",
                            says=["--set grip", "there are precision_45_deg, "])
        self.assert_refused(*experiment, "force_closure", "--set", "accept=pinch",
                            says=["--set accept", "valid|usable"])
        self.assert_refused(*experiment, "force_closure", "--set", "colour=red",
                            says=["--set colour", "is no setting; there are"])
        self.assert_refused(*experiment, "force_closure", "--jobs", "0", says="jobs = 0")
        self.assert_refused(*experiment, "force_closure", "--quick", "--publish",
                            says="results are not published: --quick")

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
