"""The readings page names the options of every reading, with the values that they may have, as the
options page has them, which the program writes from its rows; in its column of options it names no
others but those below.

  check_readings.py SOURCE_DIR            says what differs
  check_readings.py SOURCE_DIR --write    puts it into docs/readings.md
"""

import difflib
import re
import sys
from pathlib import Path

SOURCE = Path(sys.argv[1])
PAGE = SOURCE / "docs/readings.md"
OPTION = re.compile(r"(?m)^\| `([a-z0-9-]+)` \| .* \| (.*?) \| `[\w.]+` \| (.*) \|$")
OTHERS = {
    "hand", "max-hole", "no-palm", "no-weak", "obstacle", "on-table", "repair", "table",
    "table-clearance-mm",
}
CELL = re.compile(r"(?<!\\) \| ")


def options():
    """Returns a dictionary from names to (the flag as the page writes it, numbers of its
    readings)."""
    found = {}
    for name, values, meaning in OPTION.findall((SOURCE / "docs/options.md").read_text()):
        is_choice = re.fullmatch(r"[a-z0-9-]+(\\\|[a-z0-9-]+)+", values) is not None
        source = re.search(r"\[([^\]]*)\]$", meaning)
        found[name] = (f"`--{name} {values}`" if is_choice else f"`--{name}`",
                       set(re.findall(r"A\d+", source.group(1))) if source else set())
    return found


def written(line, known, page):
    """Returns a row of the page with its options as they are; each stands in a row of its
    reading."""
    cells = CELL.split(line)
    if not line.startswith("|") or len(cells) < 6:
        return line
    numbers, flags = set(re.findall(r"A\d+", cells[0])), cells[4]
    for name, (flag, readings) in known.items():
        flags = re.sub(rf"`--{name} [^`]*\\\|[^`]*`", lambda _, flag=flag: flag, flags)
        for number in numbers & readings:
            rows = re.findall(rf"(?m)^\|[^|]*\b{number}\b.*$", page)
            if not any(re.search(rf"`--{name}[ `]", row) for row in rows):
                flags = flag if flags == "none" else f"{flags}, {flag}"
    return " | ".join(cells[:4] + [flags] + cells[5:])


def main():
    known = options()
    assert len(known) > 60, "the options page was not understood"
    before = PAGE.read_text()
    numbers = set(re.findall(r"A\d+", "".join(re.findall(r"(?m)^\| A[^|]*\|", before))))
    unknown = {name: readings - numbers for name, (_, readings) in known.items()
               if readings - numbers}
    assert len(numbers) > 40 and not unknown, f"there are no such readings: {unknown}"
    cells = [CELL.split(row)[4] for row in re.findall(r"(?m)^\| A?[^-].*$", before)
             if len(CELL.split(row)) > 5]
    gone = set(re.findall(r"`--([a-z0-9-]+)", " ".join(cells))) - set(known) - OTHERS
    assert not gone, f"there are no such options: {gone}"
    after = "".join(written(line, known, before) for line in before.splitlines(keepends=True))
    if "--write" in sys.argv:
        PAGE.write_text(after)
    elif after != before:
        print("run: check_readings.py . --write")
        print("\n".join(difflib.unified_diff(before.splitlines(), after.splitlines(), n=0,
                                             lineterm="")))
        return 1
    print(f"{len(numbers)} readings, {len(known)} options")
    return 0


if __name__ == "__main__":
    sys.exit(main())
