#!/usr/bin/python3
"""Checks that README.md shows the program and the project that the tests build, and its output,
and that the files it links to exist.

Usage: check_readme.py README.md PROJECT_DIRECTORY OUTPUT_FILE

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
    readme, project, output = (pathlib.Path(argument) for argument in sys.argv[1:])
    markdown = readme.read_text(encoding="utf-8")
    failures = []
    for language, file in (("cpp", "plan_a_grasp.cpp"), ("cmake", "CMakeLists.txt")):
        if (project / file).read_text(encoding="utf-8") not in code_blocks(markdown, language):
            failures.append(f"README.md: no {language} block equals {project / file}")
    printed = output.read_text(encoding="utf-8")
    if without_numbers(printed) not in map(without_numbers, code_blocks(markdown, "text")):
        failures.append(f"README.md: no text block looks like the program's output:\n{printed}")
    for target in re.findall(r"\]\(([^)#:]+)\)", markdown):
        if not (readme.parent / target).exists():
            failures.append(f"README.md: links to {target}, which does not exist")
    print("\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
