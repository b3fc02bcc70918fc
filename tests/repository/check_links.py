"""Checks that links of the pages lead to files and headings that exist: check_links.py SOURCE."""

import re
import subprocess
import sys
from pathlib import Path

SOURCE = Path(sys.argv[1]).resolve()
LINK = re.compile(r"\]\(([^()\s]+)\)")
CODE = re.compile(r"(?ms)^```.*?^```|`[^`\n]*`")


def pages():
    """Returns the pages of the repository; in a copy without it all that exist, but for what was
    built."""
    listed = subprocess.run(["git", "ls-files", "*.md"], cwd=SOURCE, capture_output=True, text=True,
                            check=False).stdout.split()
    if listed:
        return [SOURCE / name for name in listed]
    return [page for page in SOURCE.rglob("*.md") if "build" not in page.relative_to(SOURCE).parts]


def anchors(page):
    """Returns the names by which the headings of a page are linked to."""
    text = re.sub(r"(?ms)^```.*?^```", "", page.read_text(encoding="utf-8"))
    names = set()
    for heading in re.findall(r"(?m)^#+ (.*)$", text):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
        name = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
        number = 0
        while name + (f"-{number}" if number else "") in names:
            number += 1
        names.add(name + (f"-{number}" if number else ""))
    return names


def faults_of(page):
    text = CODE.sub("", page.read_text(encoding="utf-8"))
    for target in LINK.findall(text):
        if re.match(r"[a-z]+:", target):
            continue  # It is a page of the web, which no test of ours reads.
        file, _, anchor = target.partition("#")
        place = (page.parent / file).resolve() if file else page
        if not place.exists():
            yield f"{page.relative_to(SOURCE)}: {target}: there is no such file"
        elif anchor and anchor not in anchors(place):
            yield f"{page.relative_to(SOURCE)}: {target}: there is no such heading"


def main():
    found = pages()
    num_links = sum(len(LINK.findall(CODE.sub("", page.read_text(encoding="utf-8"))))
                    for page in found)
    assert len(found) > 10 and num_links > 50, "the pages were not found"
    faults = [fault for page in found for fault in faults_of(page)]
    print("\n".join(faults) or f"{num_links} links of {len(found)} pages")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
