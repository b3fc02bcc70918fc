"""Checks that the packages which the two commands install, the table of docs/building.md, what
CMake looks for, and what sources include and scripts import all agree; and that tests use the names
that stand for those of both versions of Catch2.

  check_needs.py SOURCE_DIR
"""

import ast
import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
PRODUCT = ("base", "geometry", "hands", "grasp", "experiments", "viewer", "app")
# What scripts of these folders import must come with the program or its pictures.
PRODUCT_SCRIPTS = ("viewer",)
IN_PROGRAM = {"build", "build?", "picture"}
IN_TESTS = IN_PROGRAM | {"test", "slow"}
# These are headers of the C library and the kernel.
POSIX = {"dlfcn.h", "fcntl.h", "malloc.h", "signal.h", "spawn.h", "stdlib.h", "strings.h", "sys",
         "time.h", "unistd.h"}
# These are CMake's own package, and ours, which consumers look for.
OWN_PACKAGES = {"Threads", "graspfit"}
# Only this header uses what versions 2 and 3 of Catch2 call differently.
CATCH_HEADER = pathlib.Path("tests/support/catch.hpp")

faults = []


def listed():
    lines = (SOURCE / "setup/debian-packages.txt").read_text().splitlines()
    return [tuple(line.split()[:2]) for line in lines if line.strip() and not line.startswith("#")]


def table():
    """Returns rows (group, package, CMake packages, words of headers and modules) of
    docs/building.md."""
    rows = []
    for line in (SOURCE / "docs/building.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 5 and re.fullmatch(r"[a-z]+\??", cells[0]) and cells[0] != "group":
            rows.append((cells[0], cells[1], cells[2], re.findall(r"`([^`]+)`", cells[3])))
    return rows


def compare_list(rows):
    of_table = [row[:2] for row in rows]
    for entry in listed():
        if entry not in of_table:
            faults.append("docs/building.md: no row for %s of group %s" % (entry[1], entry[0]))
    for entry in of_table:
        if entry not in listed():
            faults.append("setup/debian-packages.txt: no %s in group %s" % (entry[1], entry[0]))


def compare_cmake(rows):
    wanted = {row[2] for row in rows if row[2]}
    found = set()
    for file in [SOURCE / "CMakeLists.txt", *SOURCE.glob("*/**/CMakeLists.txt")]:
        name = str(file.relative_to(SOURCE))
        if name.startswith("build"):
            continue
        text = re.sub(r"#.*", "", file.read_text())
        for package, version in re.findall(r"find_package\(\s*([\w-]+)(?:\s+(\d[\d.]*\d))?", text):
            if package in OWN_PACKAGES:
                continue
            if not version:  # Its version is compared after it was found.
                match = re.search(package + r"_VERSION VERSION_LESS (\d[\d.]*)", text)
                version = match.group(1) if match else ""
            found.add((package + " " + version).strip())
    for entry in sorted(found - wanted):
        faults.append("docs/building.md: no row for CMake's package " + entry)
    for entry in sorted(wanted - found):
        faults.append("docs/building.md: no CMakeLists.txt looks for " + entry)


def sources(*suffixes):
    for folder in sorted(path for path in SOURCE.iterdir() if path.is_dir()):
        if folder.name.startswith((".", "build", "results", "graspfit-")):
            continue
        for file in sorted(folder.rglob("*")):
            if file.suffix in suffixes and "build" not in file.relative_to(SOURCE).parts:
                yield file.relative_to(SOURCE)


def compare(file, name, kind, groups):
    """Returns whether the package with `name` is in a group that is there where `file` is used."""
    has = groups.get(name)
    if has is None:
        faults.append("%s: %s %s is of no package in docs/building.md" % (file, kind, name))
        return
    is_product = file.parts[0] in (PRODUCT if kind == "header" else PRODUCT_SCRIPTS)
    allowed = IN_PROGRAM if is_product else IN_TESTS
    if not has & allowed:
        faults.append("%s: %s %s comes with group %s only" % (file, kind, name, ", ".join(has)))


def compare_sources(rows):
    groups = {}
    for group, _, _, names in rows:
        for name in names:
            groups.setdefault(name, set()).add(group)
    for file in sources(".cpp", ".hpp"):
        text = (SOURCE / file).read_text()
        if file != CATCH_HEADER and re.search(r"\bCatch::|<catch2/", text):
            faults.append("%s: names Catch2, which %s does for both versions of it"
                          % (file, CATCH_HEADER))
        for header in re.findall(r"^#include <([^>]+)>", text, re.M):
            name = header.split("/")[0]
            if ("/" in header or header.endswith(".h")) and name not in POSIX:
                compare(file, name, "header", groups)
    own = {path.stem for path in sources(".py")} | {
        path.name for path in SOURCE.rglob("*") if path.is_dir()}
    for file in sources(".py"):
        for node in ast.walk(ast.parse((SOURCE / file).read_text())):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and not node.level:
                names = [node.module]
            else:
                continue
            for name in {name.split(".")[0] for name in names} - sys.stdlib_module_names - own:
                compare(file, name, "module", groups)


ROWS = table()
assert len(ROWS) > 40, "the table of docs/building.md was not found"
compare_list(ROWS)
compare_cmake(ROWS)
compare_sources(ROWS)
print("\n".join(faults) or "%d packages agree" % len(ROWS))
sys.exit(bool(faults))
