#!/usr/bin/python3
"""Draws hands open, half closed and closed, and a contact sheet of all."""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys

MODELS = pathlib.Path(__file__).resolve().parent
DESCRIPTIONS = (".urdf", ".xml")
GAP = 12  # between the pictures of the sheet [pixels]


def program_of(given):
    """The program graspfit: as given, of the build tree, or on the path."""
    tree = MODELS.parent.parent
    candidates = [given] if given else [tree / f"build/{build}/bin/graspfit" for build in ("unity", "release")]
    for candidate in candidates:
        if candidate and pathlib.Path(candidate).is_file():
            return str(candidate)
    found = None if given else shutil.which("graspfit")
    if not found:
        sys.exit(f"draw_hands.py: no program {given or 'graspfit'}; build it, or say --program FILE")
    return found


def hands_of(data):
    """(name, what to call `graspfit hand show` with): shipped ones, then those of a data folder."""
    hands = [
        (folder.name, folder.name)
        for folder in sorted(MODELS.iterdir())
        if (folder / f"{folder.name}.urdf").is_file()
    ]
    if data is None:
        return hands
    folder = data / "hands"
    if not folder.is_dir():
        sys.exit(f"draw_hands.py: --data: no folder {folder}")
    for hand in sorted(path for path in folder.iterdir() if path.is_dir()):
        for file in sorted(path for path in hand.iterdir() if path.suffix in DESCRIPTIONS):
            hands.append((f"{hand.name}_{file.stem}", str(file)))
    return hands


def write_sheet(pictures, path, width):
    """All pictures below each other in two columns, shrunk to a common width, with few colors."""
    try:
        from PIL import Image
    except ImportError as error:
        sys.exit(f"draw_hands.py: {error}; install python3-pil")
    columns = 2 if len(pictures) > 1 else 1
    tiles = []
    for picture in pictures:
        image = Image.open(picture).convert("RGB")
        tiles.append(image.resize((width, round(image.height * width / image.width)), Image.LANCZOS))
    rows = [tiles[i : i + columns] for i in range(0, len(tiles), columns)]
    heights = [max(tile.height for tile in row) for row in rows]
    size = (columns * (width + GAP) + GAP, sum(heights) + GAP * (len(rows) + 1))
    sheet = Image.new("RGB", size, "white")
    y = GAP
    for row, height in zip(rows, heights):
        for column, tile in enumerate(row):
            sheet.paste(tile, (GAP + column * (width + GAP), y))
        y += height + GAP
    part = path.with_name(f".{path.name}.{os.getpid()}")
    sheet.quantize(128, dither=Image.Dither.NONE).save(part, format="PNG", optimize=True)
    os.replace(part, path)


def main():
    parser = argparse.ArgumentParser(
        prog="draw_hands.py",
        description="Writes OUT/<hand>.png, each hand open, half closed and closed in two views, and "
        "OUT/hands.png, a contact sheet of all. Pictures of hands that are not shipped must not be "
        "published without their makers' leave.",
    )
    parser.add_argument("out", metavar="OUT", type=pathlib.Path, help="folder, made if need be")
    parser.add_argument(
        "--data",
        metavar="DIR",
        type=pathlib.Path,
        default=os.environ.get("GRASPFIT_DATA"),
        help="also every description in DIR/hands/*/ (default: $GRASPFIT_DATA, if set)",
    )
    parser.add_argument("--only", metavar="NAME", action="append", help="these hands alone")
    parser.add_argument("--pose", default="open,half,closed", help="as graspfit hand show (default: %(default)s)")
    parser.add_argument("--program", metavar="FILE", help="graspfit (default: the build tree's, or on the path)")
    parser.add_argument("--sheet-width", type=int, default=560, help="pixels per hand of the sheet (default: 560)")
    arguments = parser.parse_args()
    program = program_of(arguments.program)
    data = pathlib.Path(arguments.data) if arguments.data else None
    hands = hands_of(data)
    if arguments.only:
        names = [name for name, _ in hands]
        for name in arguments.only:
            if name not in names:
                sys.exit(f"draw_hands.py: --only {name}: there are {', '.join(names)}")
        hands = [hand for hand in hands if hand[0] in arguments.only]
    arguments.out.mkdir(parents=True, exist_ok=True)
    drawn = []
    failed = 0
    for name, hand in hands:
        picture = arguments.out / f"{name}.png"
        command = [program, "hand", "show", hand, "--pose", arguments.pose, "--png", str(picture)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        sys.stderr.write(done.stderr)
        if done.returncode == 0:
            drawn.append(picture)
            print(picture)
        else:
            failed += 1
    if drawn:
        sheet = arguments.out / "hands.png"
        write_sheet(drawn, sheet, arguments.sheet_width)
        print(sheet)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
