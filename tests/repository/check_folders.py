"""Checks that folders of sources are each of one topic: one uses those before it in its module's
FOLDERS and none after it, and holds no more than 25 files, its public headers included; nor does a
folder of tests, figures or pages hold more. The folders of tests, too, use those before them in
tests/CMakeLists.txt and none after them. A module includes no private header of another one but
those listed here. And no source outside tests is longer than 500 lines.

  check_folders.py SOURCE_DIR
"""

import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
MOST_FILES = 25
MOST_LINES = 500

# The headers in src/ of a module are its own business. What others need of it is public, except for
# these, by module and owner.
PRIVATE_HEADERS = {
    # The pre-grasp of another tool is checked as ours are; users ask find_pre_grasp for one.
    ("grasp/exchange", "grasp"): {"approach/checked_pre_grasp.hpp"},
    # The report of a hold test is text of the same form as grasp files.
    ("grasp/hold_test", "grasp"): {"io/json_text.hpp", "io/record_json.hpp"},
    # One place loads models of MuJoCo and turns its errors into exceptions. Public headers do not
    # show MuJoCo's types, and a build without MuJoCo has none.
    ("grasp/hold_test", "hands"): {"import/mujoco_model.hpp"},
    # Motion files write poses as grasp files do; a motion is proven free as the way to a grasp is.
    ("grasp/motion", "grasp"): {"io/json_text.hpp", "io/record_json.hpp",
                                "scene/straight_way.hpp"},
}

faults = []
modules = []


def folders_of(module):
    """Returns the folders of a module in the order of its CMakeLists.txt; none if it has one
    folder only."""
    match = re.search(r"\bFOLDERS:?\s+([a-z_ \n]+?)\s*(?:SOURCES|:|$)",
                      (module / "CMakeLists.txt").read_text(), re.M)
    return match.group(1).split() if match else []


def includes(file):
    return re.findall(r'^#include "([^"]+)"', file.read_text(), re.M)


def check_module(module):
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


def check_private_headers():
    """Checks that modules include those private headers of others that are listed and no more, and
    that their CMakeLists.txt name no src/ of another module in vain."""
    names = [str(module.relative_to(SOURCE)) for module in modules]
    used = {}
    for module, name in zip(modules, names):
        listing = (module / "CMakeLists.txt").read_text()
        for owner in re.findall(r"\{PROJECT_SOURCE_DIR\}/([a-z_/]+)/src\b", listing):
            used.setdefault((name, owner), set())
        for file in sorted([*module.glob("src/**/*.[ch]pp"), *module.glob("include/**/*.hpp")]):
            for include in includes(file):
                if (module / "src" / include).is_file() or (file.parent / include).is_file():
                    continue
                for owner in names:
                    if (SOURCE / owner / "src" / include).is_file():
                        used.setdefault((name, owner), set()).add(include)
    for name, owner in sorted(set(used) | set(PRIVATE_HEADERS)):
        found = used.get((name, owner), set())
        listed = PRIVATE_HEADERS.get((name, owner), set())
        for header in sorted(found - listed):
            faults.append("%s includes %s, a private header of %s" % (name, header, owner))
        for header in sorted(listed - found):
            faults.append("%s no longer includes %s of %s: its line in check_folders.py can go"
                          % (name, header, owner))
        if not found and (name, owner) in used:
            faults.append("%s/CMakeLists.txt names %s/src, of which it includes nothing"
                          % (name, owner))


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
        modules.append(listing.parent)
assert len(modules) > 8, "no modules were found"
for module in modules:
    check_module(module)
check_private_headers()
check_tests()
for top in ("tests", "paper-figures", "viewer", "setup"):
    assert (SOURCE / top).is_dir(), top
    for folder in sorted({file.parent for file in (SOURCE / top).rglob("*")}):
        files = [file for file in folder.iterdir() if file.suffix in (".cpp", ".hpp", ".py", ".js")]
        if len(files) > MOST_FILES:
            faults.append("%s holds %d files, more than %d"
                          % (folder.relative_to(SOURCE), len(files), MOST_FILES))
for file in sorted(SOURCE.glob("*/**/*")):
    top = file.relative_to(SOURCE).parts[0]
    if top in ("tests", "build") or file.suffix not in (".cpp", ".hpp", ".py", ".js"):
        continue
    number = len(file.read_text().splitlines())
    if number > MOST_LINES:
        faults.append("%s: %d lines, more than %d" % (file.relative_to(SOURCE), number, MOST_LINES))
print("\n".join(faults) or "%d modules, no arrow back" % len(modules))
sys.exit(bool(faults))
