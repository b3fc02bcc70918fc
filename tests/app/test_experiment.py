"""graspfit experiment: list, describe, run."""

import csv
import json
import os
import pathlib

from program import SOURCE_DIR, ProgramTest, main, run

SLUGS = sorted(path.stem for path in (SOURCE_DIR / "experiments/configs").glob("*.json"))


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
                self.assertEqual({row["status"] for row in rows},
                                 {"ok" if has_data else "skipped"}, rows)
                self.assertEqual(len(rows_of(out / f"{slug}.timing.csv")), len(rows))
                manifest = json.loads((out / f"{slug}.manifest.json").read_text())
                self.assertTrue(manifest["config"]["is_quick"])
                self.assertEqual(manifest["cells"]["total"], len(rows))
                if has_data:
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
        self.assert_refused(*experiment, "force_closure", "--set", "cone=30_deg",
                            says=["--set cone", "there are 45_deg, atan_0.4"])
        self.assert_refused(*experiment, "force_closure", "--set", "style=pinch",
                            says=["--set style", "precision|power"])
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
