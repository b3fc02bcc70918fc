"""Rooms: folders of sources, each of one topic. A room uses those before it in its module's ROOMS and
none after it, and holds no more than 25 files, its public headers included.

  check_rooms.py SOURCE_DIR
"""

import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
MOST_FILES = 25

faults = []
num_modules = 0


def rooms_of(folder):
    """The rooms of a module in the order of its CMakeLists.txt; none if it has one room only."""
    match = re.search(r"\bROOMS:?\s+([a-z_ \n]+?)\s*(?:SOURCES|:|$)",
                      (folder / "CMakeLists.txt").read_text(), re.M)
    return match.group(1).split() if match else []


def includes(file):
    return re.findall(r'^#include "([^"]+)"', file.read_text(), re.M)


def check_module(folder):
    global num_modules
    num_modules += 1
    name = str(folder.relative_to(SOURCE))
    source = folder / "src"
    rooms = rooms_of(folder)
    found = {path.name for path in source.iterdir() if path.is_dir()}
    for room in sorted(found ^ set(rooms)):
        faults.append("%s: room %s is not both in ROOMS and in src/" % (name, room))
    if found != set(rooms):
        return
    files = {room: sorted((source / room).glob("*.[ch]pp")) for room in rooms}
    if not rooms:
        files = {"": sorted(source.glob("*.[ch]pp"))}
    room_of = {file.stem: room for room, members in files.items() for file in members}
    # A public header belongs to the room of the source of its name.
    headers = sorted(folder.glob("include/graspfit/*/*.hpp"))
    for room, members in files.items():
        number = len(members) + sum(room_of.get(header.stem) == room for header in headers)
        if number > MOST_FILES:
            faults.append("%s: room %s holds %d files, more than %d"
                          % (name, room or "src", number, MOST_FILES))
    place = {room: i for i, room in enumerate(rooms)}
    own = "graspfit/%s/" % headers[0].parent.name if headers else None
    sources = [(file, room) for room, members in files.items() for file in members]
    sources += [(header, room_of[header.stem]) for header in headers if header.stem in room_of]
    for file, room in sources:
        for include in includes(file):
            parts = include.split("/")
            if len(parts) == 2 and parts[0] in place:
                used = parts[0]
            elif own and include.startswith(own):
                used = room_of.get(pathlib.Path(include).stem)
            else:
                continue
            if used is not None and place.get(used, 0) > place.get(room, 0):
                faults.append("%s: room %s includes %s of room %s, which comes after it"
                              % (file.relative_to(SOURCE), room, include, used))


for listing in sorted(SOURCE.glob("*/CMakeLists.txt")) + sorted(SOURCE.glob("*/*/CMakeLists.txt")):
    if (listing.parent / "src").is_dir() and listing.parts[len(SOURCE.parts)] != "tests":
        check_module(listing.parent)
assert num_modules > 8, "no modules were found"
for folder in sorted(path for path in (SOURCE / "tests").rglob("*") if path.is_dir()):
    number = len([file for file in folder.iterdir() if file.suffix in (".cpp", ".hpp", ".py")])
    if number > MOST_FILES:
        faults.append("%s holds %d files, more than %d"
                      % (folder.relative_to(SOURCE), number, MOST_FILES))
print("\n".join(faults) or "%d modules, no arrow back" % num_modules)
sys.exit(bool(faults))
