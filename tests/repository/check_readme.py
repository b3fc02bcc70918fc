#!/usr/bin/python3
"""Checks that a page shows the sources that the tests build, word for word, and what their program
prints.

Usage: check_readme.py README.md OUTPUT_FILE SHOWN_FILE...

OUTPUT_FILE is "-" for sources that print nothing.

Numbers of the output may differ: the C library picks its sine and cosine by the processor, and the
planner's search may take another turn after a different last digit.
"""

import pathlib
import re
import sys


def code_blocks(markdown, language):
    return re.findall(rf"^```{language}\n(.*?)^```$", markdown, re.MULTILINE | re.DOTALL)


def without_numbers(text):
    return re.sub(r"-?\d+(\.\d+)?", "#", text)


def main():
    output = sys.argv[2]
    readme, *shown = (pathlib.Path(argument) for argument in (sys.argv[1], *sys.argv[3:]))
    markdown = readme.read_text(encoding="utf-8")
    failures = []
    for file in shown:
        language = "cpp" if file.suffix == ".cpp" else "cmake"
        if file.read_text(encoding="utf-8") not in code_blocks(markdown, language):
            failures.append(f"{readme}: no {language} block equals {file}")
    if output != "-":
        printed = pathlib.Path(output).read_text(encoding="utf-8")
        if without_numbers(printed) not in map(without_numbers, code_blocks(markdown, "text")):
            failures.append(f"{readme}: no text block looks like the program's output:\n{printed}")
    print("\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
