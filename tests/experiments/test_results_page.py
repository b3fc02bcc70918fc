#!/usr/bin/python3
"""The numbers of README.md, REPRODUCTION.md, docs/paper-results.md and docs/hold-results.md are those of the published tables:
test_results_page.py SOURCE_DIR.

Sentences and rows of tables are written by results_statements.py and hold_statements.py and must stand in the pages, and in
their sections no other number may but names, settings and the paper's. With --print they are printed.
"""

import pathlib
import re
import sys
import unittest

try:
    import matplotlib  # noqa: F401
    import numpy  # noqa: F401
    import pandas  # noqa: F401
    import scipy  # noqa: F401
except ImportError as missing:
    print(f"SKIPPED: {missing.name} is not installed")
    sys.exit(0)

import hold_statements
import results_statements as statements

TABLE1_NAMES = (r"Table 1", r"table1[a-z_.]*[`/]?", r"22 objects", r"\d DOF", r"0\.10|0\.15|0\.20", r"first 30|first 100|100 attempts", r"planner seed 1")
PAPER_OF_TABLE1 = r"0\.96|0\.61|0\.52|1\.18|0\.85|0\.92|1\.36|1\.22|1\.06"
NAMES = (r"\bA\d+\b", r"\bM[123]?\b", r"[Ss]ection \d+(\.\d)?", r"Figs?\. \d+")
# The values are, for each section of the page, what of the tables stands in it, and which other
# numbers may.
FIRST_OF_PAPER = "## Results: the tables and what made them"
PROTOCOLS = (r"`dexgraspbench-100g`", r"`gendexgrasp`", r"64 per grip")
SECTIONS = {
    "# graspfit": (
        hold_statements.at_a_glance,
        (r"Computer, 2018", r"C\+\+20", r"0\.1 mm", r"M > 0", r"(22|32|12) objects", r"15 cm", r"with 100 g"),
    ),
    "## How many hold": (
        hold_statements.hold_rates,
        (*PROTOCOLS, r"32 objects, 2 attempts each", r"20 N", r"coefficient 0\.2", r"24 sides", r"lost without any load|0 where it is", r"95 %",
         r"0\.7 to 4\.8 s", r"MuJoCo's impratio is 1", r"\| (60\.5|27\.2|24\.2|12\.8|88\.1|93\.2|83\.0) %"),
    ),
    "## How many hold without flags": (
        hold_statements.hold_default,
        (*PROTOCOLS, r"256 per hand", r"μ = 0\.4", r"95 % interval", r"8 attempts"),
    ),
    "## How many are picked up from a table": (
        hold_statements.from_table,
        (*PROTOCOLS, r"(of |: |the )20 (attempts|each)", r"95 % interval", r"100 g", r"0\.1 m", r"30 mm", r"1\.5 m", r"\b1 mm", r"1 N", r"160 mm", r"85 mm", r"60 mm", r"50 to 75°"),
    ),
    "## What predicts that a grasp holds": (
        hold_statements.hold_prediction,
        (*PROTOCOLS, r"12 objects", r"\(0\.5: says nothing\)", r"95 % intervals"),
    ),
    "## What an attempt gains by choosing": (
        hold_statements.hold_choices,
        (*PROTOCOLS, r"of 20 attempts each", r"[Ss]trongest of (4|24)"),
    ),
    FIRST_OF_PAPER: (statements.made_by, (r"\b6464d50\b", r"\b76d486d\b", r"\b7a1e452\b", r"\beec3cc1\b")),
    "## Table tidying (Fig. 20)": (statements.table_tidying, (r"`contacts` 2", r"10 mm", r"0\.3 m")),
    "## Special cases": (
        lambda tables: [*statements.special_cases(tables), *statements.force_closure(tables)],
        (r"20 seeds, 12 attempts each, 40 at the horse, 50", r"12 cm", r"30 cm", r"first 100", r"μ = 0\.4", r"45°", r"21\.8°", r"`--slide-steps` 8", r"--max-redraws 5", r"0\.6"),
    ),
    "### Table 1": (statements.table1, (*TABLE1_NAMES, PAPER_OF_TABLE1, r"above 1\.")),
    "### Table 1, other readings": (statements.table1_readings, (*TABLE1_NAMES, PAPER_OF_TABLE1)),
    "### Table 1, refined": (statements.table1_refined, TABLE1_NAMES),
    "### Table 1, all objects": (statements.table1_all_objects, TABLE1_NAMES),
    "## What is known of a candidate before it is fitted": (
        statements.candidate_prediction,
        (r"0\.08, 0\.12 and 0\.20 m", r"seed 1", r"μ = 0\.4", r"5 mm", r"15°", r"\(0\.5: says nothing\)", r"512 per cell", r"valid of 96 \| closed of 96")),
    "## Targets that the hand can meet": (
        statements.reach_grasps, (r"0\.(08|12|15|20|30) m", r"first 20", r"seed 1", r"μ = 0\.4", r"200 attempts", r"--max-redraws 5", r"firm as 0\.04")),
    "## Figures, tables and claims": (
        statements.claims,
        (r"9, 15, 30 cm", r"\d+(\.\d)? cm", r"1, 4 and 20", r"2478", r"27 would", r"30 voxels", r"3\.4 GHz", r"0\.3 to 3\.7 s", r"under 1 s",
         r"22 objects, 11 of them", r"5 grips, 50 attempts", r"6 of 15", r"N' (>= |= )?\d", r"over 100 usable", r"Tables? 1", r"`[a-z_ ]*table1`", r"#table-1", r"#table-tidying-fig-20", r"M 0\b"),
    ),
}  # fmt: skip


def flat(text):
    return re.sub(r"\s+", " ", text)


def pages():
    """Returns the first page, the hold test's, then the paper's tables, then the verdicts that rest on them."""
    return "\n".join((SOURCE / name).read_text(encoding="utf-8")
                     for name in ("README.md", "docs/hold-results.md", "docs/paper-results.md", "REPRODUCTION.md"))


def section_of(page, heading):
    start = page.index(heading + "\n")
    following = re.search(r"^#{1,6} ", page[start + len(heading):], re.MULTILINE)
    return page[start + len(heading):start + len(heading) + following.start()] if following else page[start + len(heading):]


class Page(unittest.TestCase):
    def test_what_the_tables_say_stands_in_the_page_and_no_other_number(self):
        page = pages()
        tables = statements.Tables(SOURCE)
        for heading, (says, others) in SECTIONS.items():
            text = flat(section_of(page, heading))
            # The longest statement comes first, as a short one may stand within another.
            for statement in sorted(says(tables), key=len, reverse=True):
                with self.subTest(heading, statement=statement):
                    self.assertIn(flat(statement), text)
                    text = text.replace(flat(statement), " ", 1)
            for other in (*others, *NAMES):
                text = re.sub(other, " ", text)
            with self.subTest(heading):
                self.assertEqual(re.findall(r"[^ ]*\d[^ ]*", text), [])

    def test_every_section_about_the_paper_is_covered(self):
        page = pages()
        headings = re.findall(r"^#{2,3} .*$", page[page.index(FIRST_OF_PAPER):], re.MULTILINE)
        self.assertLessEqual(set(headings) - {"### Table 1: settings"}, set(SECTIONS))


if __name__ == "__main__":
    SOURCE = pathlib.Path(sys.argv.pop(1))
    if "--print" in sys.argv:
        for says, _ in SECTIONS.values():
            print(*says(statements.Tables(SOURCE)), sep="\n")
    else:
        unittest.main(verbosity=2)
