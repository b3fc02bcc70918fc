#!/usr/bin/python3
"""The numbers of REPRODUCTION.md are those of the published tables: test_results_page.py SOURCE_DIR.

Sentences and rows of tables are written here from notebooks-data/*.csv and must stand in the page,
and in the sections that are covered no other number may. With --print they are printed.
"""

import pathlib
import re
import sys
import unittest

try:
    import pandas
except ImportError as missing:
    print(f"SKIPPED: {missing.name} is not installed")
    sys.exit(0)

OBJECTS = {"bowling_pin": "bowling pin", "bowling_ball": "bowling ball", "max_planck": "Max Planck", "kitten": "kitten"}
METHODS = ["gs-targets", "gs", "ma", "ma-full-retreat", "fitting", "fitting-reject-deviation", "fitting-reject-m"]
HEADLINE = "fitting-reject-deviation"
BASELINES = {"gs-targets": "GS by targets", "gs": "GS by approach", "ma": "MA as published", "ma-full-retreat": "MA with full retreat"}


def digits(value, places=2):
    """Two significant digits, as the page has them; nothing where there is nothing."""
    if pandas.isna(value):
        return "none"
    return f"{value:.{places}f}" if abs(value) >= 0.1 or value == 0 else f"{value:.2g}" if abs(value) >= 1e-4 else f"{value:.1g}"


def percent(value):
    return f"{100 * value:.0f} %"


class Results:
    """Everything that the page says of tables, by section."""

    def __init__(self, folder):
        self.folder = folder

    def table(self, name):
        return pandas.read_csv(self.folder / f"{name}.csv", dtype={"size": str})

    def method_rows(self, name, row, cell):
        """One row per object and `row`, one cell per method."""
        summary = self.table(f"{name}.summary").set_index(["object", row, "planner"])
        for key in dict.fromkeys((obj, second) for obj, second, _ in summary.index):
            cells = " | ".join(cell(summary.loc[(*key, method)]) for method in METHODS)
            size = f" | {key[1]} m" if row == "size" else f" | {key[1]}"
            yield f"| {OBJECTS[key[0]]}{size} | {cells} |"

    @staticmethod
    def quality(row):
        if row["grasps"] == 0:
            return "none"
        error = "" if pandas.isna(row["se_m"]) else f" ± {digits(row['se_m'])}"
        return f"{digits(row['mean_m'])}{error} ({digits(row['m_over_paper'])})"

    def orders(self, name, row, method, objects=tuple(OBJECTS), seconds=None, measure="mean_m"):
        """Of how many rows with both a method is above each baseline."""
        summary = self.table(f"{name}.summary")
        summary = summary[summary["object"].isin(objects)]
        if seconds:
            summary = summary[summary[row].isin(seconds)]
        means = summary.pivot(index=["object", row], columns="planner", values=measure)
        for baseline in BASELINES:
            both = means[[method, baseline]].dropna() if baseline in means else means.iloc[:0]
            yield baseline, int((both[method] > both[baseline]).sum()), len(both)

    def order_sentence(self, name, row, method, **subset):
        return ", ".join(f"above {BASELINES[baseline]} in {above} of {both}"
                         for baseline, above, both in self.orders(name, row, method, **subset))

    def state_rows(self):
        """What the hands of Table 1 are like, per method, over all rows."""
        details = self.table("table1.details")
        cells = self.table("table1")
        keys = ["object", "size", "run", "planner"]
        grasps = details.merge(cells[[*keys, "clip_thickness_m", "voxel_size_m"]], on=keys)
        for method in METHODS:
            own = grasps[grasps["planner"] == method]
            attempts = cells[cells["planner"] == method]["attempts"].sum()
            rejected = cells[cells["planner"] == method]["attempts_rejected"].sum()
            distance = own["target_distance_mean"].mean()
            yield (f"| {method} | {len(own)} | {percent(len(own) / attempts)} | {percent(rejected / attempts)} "
                   f"| {digits(own['area_share_median'].median())} | {digits((own['gap_median_m'] / own['clip_thickness_m']).median())} "
                   f"| {digits(own['d_min_voxels'].min())} | {1000 * own['penetration'].mean():.1f} | {1000 * own['penetration'].max():.1f} "
                   f"| {'–' if pandas.isna(distance) else f'{1000 * distance:.1f}'} |")

    def table1(self):
        yield from self.method_rows("table1", "size", self.quality)
        yield from self.method_rows("table1", "size", lambda row: digits(row["m_per_attempt"]))
        yield from self.state_rows()
        yield f"With rejection by deviation, as in its settings, fitting is {self.order_sentence('table1', 'size', HEADLINE)} rows"
        yield f"without rejection {self.order_sentence('table1', 'size', 'fitting')}"
        yield f"with rejection by M, which selects what is averaged, {self.order_sentence('table1', 'size', 'fitting-reject-m')}"
        yield ("For ball, Max Planck and kitten at 0.15 and 0.20 m it is "
               + self.order_sentence("table1", "size", HEADLINE, objects=("bowling_ball", "max_planck", "kitten"), seconds=("0.15", "0.20")))
        yield f"Per attempt fitting without rejection is {self.order_sentence('table1', 'size', 'fitting', measure='m_per_attempt')}"
        details = self.table("table1.details").merge(
            self.table("table1")[["object", "size", "run", "planner", "voxel_size_m"]], on=["object", "size", "run", "planner"])
        edges = (details["penetration"] / details["voxel_size_m"])[details["planner"] != "ma"]
        yield f"{percent((edges <= 1).mean())} of these grasps are in the object by at most one voxel edge, the deepest by {edges.max():.1f}"
        ma = self.table("table1.details")[lambda all_rows: all_rows["planner"] == "ma"]
        yield f"{percent((ma['d_min_voxels'] < 0).mean())} of its grasps have links in full voxels"


#: Section of the page, what of the tables stands in it, and what other numbers may (settings, names, the paper's).
SECTIONS = {
    "### Table 1": (Results.table1, (r"Table 1", r"table1[a-z_.]*`", r"A\d+", r"M[123]", r"22 objects", r"\d DOF", r"0\.10|0\.15|0\.20", r"[Ss]ection \d+(\.\d)?", r"100 attempts", r"0\.96|0\.61|0\.52|1\.18|0\.85|0\.92|1\.36|1\.22|1\.06")),
}


def flat(text):
    return re.sub(r"\s+", " ", text)


def section_of(page, heading):
    start = page.index(heading + "\n")
    following = re.search(r"^#{1,%d} " % heading.count("#"), page[start + len(heading):], re.MULTILINE)
    return page[start:start + len(heading) + following.start()] if following else page[start:]


class Page(unittest.TestCase):
    def test_what_the_tables_say_stands_in_the_page_and_no_other_number(self):
        page = (SOURCE / "REPRODUCTION.md").read_text(encoding="utf-8")
        results = Results(SOURCE / "notebooks-data")
        for heading, (statements, others) in SECTIONS.items():
            text = flat(section_of(page, heading))
            for statement in statements(results):
                with self.subTest(heading, statement=statement):
                    self.assertIn(flat(statement), text)
                    text = text.replace(flat(statement), " ", 1)
            for other in others:
                text = re.sub(other, " ", text)
            with self.subTest(heading):
                self.assertEqual(re.findall(r"[^ ]*\d[^ ]*", text), [])


if __name__ == "__main__":
    SOURCE = pathlib.Path(sys.argv.pop(1))
    if "--print" in sys.argv:
        for statements, _ in SECTIONS.values():
            print(*statements(Results(SOURCE / "notebooks-data")), sep="\n")
    else:
        unittest.main(verbosity=2)
