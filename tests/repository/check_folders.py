"""Checks that folders of sources are each of one topic: one uses those before it in its module's
FOLDERS and none after it, and holds no more than 25 files, its public headers included. The folders
of tests, too, use those before them in tests/CMakeLists.txt and none after them. And no source
outside tests is longer than 500 lines.

  check_folders.py SOURCE_DIR
"""

import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
MOST_FILES = 25
MOST_LINES = 500

faults = []
num_modules = 0


def folders_of(module):
    """Returns the folders of a module in the order of its CMakeLists.txt; none if it has one
    folder only."""
    match = re.search(r"\bFOLDERS:?\s+([a-z_ \n]+?)\s*(?:SOURCES|:|$)",
                      (module / "CMakeLists.txt").read_text(), re.M)
    return match.group(1).split() if match else []


def includes(file):
    return re.findall(r'^#include "([^"]+)"', file.read_text(), re.M)


def check_module(module):
    global num_modules
    num_modules += 1
    name = str(module.relative_to(SOURCE))
    source = module / "src"
    folders = folders_of(module)
    found = {path.name for path in source.iterdir() if path.is_dir()}
    for folder in sorted(found ^ set(folders)):
        faults.append("%s: folder %s is not both in FOLDERS and in src/" % (name, folder))
    if found != set(folders):
        return
    files = {folder: sorted((source / folder).glob("*.[ch]pp")) for folder in folders}
    if not folders:
        files = {"": sorted(source.glob("*.[ch]pp"))}
    folder_of = {file.stem: folder for folder, members in files.items() for file in members}
    # A public header belongs to the folder of the source of its name.
    headers = sorted(module.glob("include/graspfit/*/*.hpp"))
    for folder, members in files.items():
        number = len(members) + sum(folder_of.get(header.stem) == folder for header in headers)
        if number > MOST_FILES:
            faults.append("%s: folder %s holds %d files, more than %d"
                          % (name, folder or "src", number, MOST_FILES))
    place = {folder: i for i, folder in enumerate(folders)}
    own = "graspfit/%s/" % headers[0].parent.name if headers else None
    sources = [(file, folder) for folder, members in files.items() for file in members]
    sources += [(header, folder_of[header.stem]) for header in headers if header.stem in folder_of]
    for file, folder in sources:
        for include in includes(file):
            parts = include.split("/")
            if len(parts) == 2 and parts[0] in place:
                used = parts[0]
            elif own and include.startswith(own):
                used = folder_of.get(pathlib.Path(include).stem)
            else:
                continue
            if used is not None and place.get(used, 0) > place.get(folder, 0):
                faults.append("%s: folder %s includes %s of folder %s, which comes after it"
                              % (file.relative_to(SOURCE), folder, include, used))


def check_tests():
    """Checks what the folders of tests include of one another. Other projects (tests/consumer) have
    no place among them and include none."""
    tests = SOURCE / "tests"
    listing = (tests / "CMakeLists.txt").read_text()
    order = ["support"] + re.findall(r"^\s*add_subdirectory\((\w+)\)", listing, re.M)
    assert len(order) > 12, "the folders of tests were not understood"
    place = {folder: i for i, folder in enumerate(order)}
    for file in sorted(tests.rglob("*.[ch]pp")):
        folder = file.relative_to(tests).parts[0]
        for include in includes(file):
            used = include.split("/")[0]
            if (tests / include).is_file() and place.get(used, 0) > place.get(folder, -1):
                faults.append("%s: tests/%s includes %s of tests/%s, which comes after it"
                              % (file.relative_to(SOURCE), folder, include, used))


for listing in sorted(SOURCE.glob("*/CMakeLists.txt")) + sorted(SOURCE.glob("*/*/CMakeLists.txt")):
    if (listing.parent / "src").is_dir() and listing.parts[len(SOURCE.parts)] != "tests":
        check_module(listing.parent)
assert num_modules > 8, "no modules were found"
check_tests()
for module in sorted(path for path in (SOURCE / "tests").rglob("*") if path.is_dir()):
    number = len([file for file in module.iterdir() if file.suffix in (".cpp", ".hpp", ".py")])
    if number > MOST_FILES:
        faults.append("%s holds %d files, more than %d"
                      % (module.relative_to(SOURCE), number, MOST_FILES))
for file in sorted(SOURCE.glob("*/**/*")):
    top = file.relative_to(SOURCE).parts[0]
    if top in ("tests", "build") or file.suffix not in (".cpp", ".hpp", ".py", ".js"):
        continue
    number = len(file.read_text().splitlines())
    if number > MOST_LINES:
        faults.append("%s: %d lines, more than %d" % (file.relative_to(SOURCE), number, MOST_LINES))
print("\n".join(faults) or "%d modules, no arrow back" % num_modules)
sys.exit(bool(faults))
