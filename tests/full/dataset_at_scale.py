#!/usr/bin/python3
"""Makes a data set of many objects on a Slurm of one node, with kills, and again in one piece.

Objects: shapes with seeded dimensions, unions of two of them, the packaged meshes and those of the
data folder at several scales; two hands, three tested grasps each. Shards are killed on the way and
resubmitted. Fails unless index, details, arrays and card are the same bytes as those of a run in one
piece. Prints rates, shares and sizes.

Usage: dataset_at_scale.py PROGRAM [--objects N] [--shards N] [--out DIR]
"""

import argparse
import csv
import json
import math
import os
import pathlib
import random
import subprocess
import tempfile
import time

from one_node_slurm import SlurmSweep, output_of, require_slurm, say, slurm

HANDS = ("barrett", "human_hand")
GRASPS = 3
LONGEST = (0.08, 0.11, 0.15, 0.2)  # of real meshes [m]
KINDS = {  # shapes, with ranges of their dimensions [m]
    "ball": {"radius": (0.025, 0.05)},
    "box": {"x": (0.03, 0.16), "y": (0.03, 0.1), "z": (0.03, 0.08)},
    "capsule": {"radius": (0.015, 0.04), "height": (0.03, 0.12)},
    "cylinder": {"radius": (0.015, 0.045), "height": (0.04, 0.16)},
    "torus": {"major_radius": (0.035, 0.06), "minor_radius": (0.012, 0.022)},
}


def dimensions_of(program):
    """Returns the names of the dimensions of every shape that the program lists."""
    names, shape = {}, None
    for line in output_of(program, "shape", "--list").splitlines():
        if not line.startswith(" "):
            shape = line.split(":")[0]
            names[shape] = []
        else:
            names[shape].append(line.split("=")[0].strip())
    return names


def write_shape(program, rng, kind, file):
    sizes = ",".join(f"{name}={rng.uniform(*limits):.4f}" for name, limits in KINDS[kind].items())
    subprocess.run([program, "shape", kind, "--set", sizes, "--out", file], check=True,
                   stdout=subprocess.DEVNULL)


def read_off(file):
    numbers = file.read_text().split()[1:]
    num_vertices, num_faces = int(numbers[0]), int(numbers[1])
    values = numbers[3:]
    vertices = [tuple(map(float, values[3 * i:3 * i + 3])) for i in range(num_vertices)]
    values = values[3 * num_vertices:]
    return vertices, [tuple(map(int, values[4 * i + 1:4 * i + 4])) for i in range(num_faces)]


def write_union(program, rng, file):
    """Writes two shapes that overlap as the parts of one mesh: their union is the solid."""
    vertices, faces = [], []
    for part in range(2):
        write_shape(program, rng, rng.choice(sorted(KINDS)), file)
        own, own_faces = read_off(file)
        angle = rng.uniform(0, 2 * math.pi)
        shift = [0.02 * part * rng.uniform(-1, 1) for _ in range(3)]
        turned = [(x * math.cos(angle) - y * math.sin(angle) + shift[0],
                   x * math.sin(angle) + y * math.cos(angle) + shift[1], z + shift[2])
                  for x, y, z in own]
        faces += [tuple(len(vertices) + v for v in face) for face in own_faces]
        vertices += turned
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    lines += [" ".join(f"{x:.9g}" for x in vertex) for vertex in vertices]
    lines += ["3 " + " ".join(map(str, face)) for face in faces]
    file.write_text("\n".join(lines) + "\n")


def real_meshes():
    """Returns the packaged meshes and those of the data folder, as far as they are there."""
    home = pathlib.Path.home() / ".cache/graspfit/meshes"
    packaged = pathlib.Path(os.environ.get("GRASPFIT_PACKAGED_MESHES", home))
    data = pathlib.Path(os.environ.get("GRASPFIT_DATA", "/nonexistent")) / "meshes"
    found = [packaged / name for name in ("elephant.off", "bunny00.off", "dino.off")]
    found += sorted(data.glob("multidex/*.stl")) + sorted(data.glob("everyday/*.*"))
    return [file for file in found if file.is_file()]


def write_objects(program, folder, count):
    """Writes objects and their list: a tenth real ones, if there are that many, a third of the
    others unions."""
    rng = random.Random(1)
    rows = [(file, f"{file.stem}_{longest}", longest, "as its source states")
            for file in real_meshes() for longest in LONGEST][:count // 10]
    if count >= 50:
        broken = folder / "broken.off"
        broken.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n")
        rows.append((broken, "broken", "", "CC0-1.0"))
    kinds = sorted(KINDS)
    while len(rows) < count:
        number = len(rows)
        is_union = number % 3 == 0
        name = f"union_{number:05d}" if is_union else f"{kinds[number % len(kinds)]}_{number:05d}"
        file = folder / f"{name}.off"
        if is_union:
            write_union(program, rng, file)
        else:
            write_shape(program, rng, kinds[number % len(kinds)], file)
        rows.append((file, name, "", "CC0-1.0"))
    list_file = folder / "objects.csv"
    with open(list_file, "w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(("file", "name", "longest_m", "license"))
        writer.writerows(rows)
    return list_file


def request(list_file):
    arguments = ["--objects", list_file, "--grasps", GRASPS]
    for hand in HANDS:
        arguments += ["--hand", hand]
    return list(map(str, arguments))


def results_of(folder):
    names = ["dataset.csv", "dataset.details.csv", "dataset.columns.json", "CARD.md"]
    return names + sorted(f"arrays/{path.name}" for path in (folder / "arrays").iterdir())


def size_of(folder, pattern):
    return sum(path.stat().st_size for path in folder.glob(pattern) if path.is_file())


def say_numbers(folder, seconds):
    with open(folder / "dataset.csv", newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    with open(folder / "dataset.timing.csv", newline="", encoding="utf-8") as stream:
        times = list(csv.DictReader(stream))
    objects = len({row["object"] for row in rows})
    grasps = sum(int(row["grasps"] or 0) for row in rows)
    held = sum(int(row["held"] or 0) for row in rows)
    failed = sum(row["status"] != "ok" for row in rows)
    cpu = sum(float(row["cpu_s"] or 0) for row in times)
    say(f"{objects} objects, {len(rows)} cells, {failed} failed, {grasps} grasps, {held} held "
        f"({100 * held / max(grasps, 1):.1f} %)")
    say(f"{3600 * objects / seconds:.0f} objects and {3600 * grasps / seconds:.0f} grasps an hour; "
        f"{cpu / len(rows):.2f} s of processor time a cell")
    say(f"bytes per grasp: grasp files {size_of(folder, 'cells/*/*') // max(grasps, 1)}, arrays "
        f"{size_of(folder, 'arrays/*') // max(grasps, 1)}, tables "
        f"{size_of(folder, '*.csv') // max(grasps, 1)}, journal "
        f"{size_of(folder, '*.cells') // max(grasps, 1)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--objects", type=int, default=40)
    parser.add_argument("--shards", type=int, default=7)
    parser.add_argument("--out", type=pathlib.Path, help="kept; without it a temporary folder")
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    require_slurm()
    names = dimensions_of(program)
    for kind, limits in KINDS.items():
        unknown = set(limits) - set(names[kind])
        if unknown:
            raise RuntimeError(f"shape {kind} has no {', '.join(sorted(unknown))}")
    with tempfile.TemporaryDirectory(prefix="graspfit_scale_") as temporary:
        folder = pathlib.Path(temporary)
        kept = arguments.out.resolve() if arguments.out else folder
        (kept / "objects").mkdir(parents=True, exist_ok=True)
        list_file = write_objects(program, kept / "objects", arguments.objects)
        say(f"{arguments.objects} objects written")
        os.environ["GRASPFIT_CACHE"] = str(folder / "cache")
        cells = arguments.objects * len(HANDS)
        shards, whole = kept / "shards", kept / "whole"
        output_of(program, "dataset", "run", shards, *request(list_file), "--request-only")
        begin = time.monotonic()
        with slurm(folder):
            sweep = SlurmSweep("dataset", arguments.shards, shards, folder)
            least = max(1, cells // arguments.shards // 4)
            wait = 600 + 60 * least
            sweep.run(sweep.command(program, mem_mb=1500, minutes=600),
                      kills=((1, 600), (least, wait), (2 * least, wait)), seconds=36000)
        seconds = time.monotonic() - begin
        say(f"{arguments.shards} shards, three kills: {seconds:.0f} s")
        say_numbers(shards, seconds)
        begin = time.monotonic()
        output_of(program, "dataset", "run", whole, *request(list_file), "--quiet", "--jobs",
                  str(os.cpu_count()))
        say(f"in one piece: {time.monotonic() - begin:.0f} s")
        if results_of(whole) != results_of(shards):
            raise RuntimeError("the two runs have not the same files")
        for name in results_of(whole):
            if (whole / name).read_bytes() != (shards / name).read_bytes():
                raise RuntimeError(f"{name} differs")
        say(f"the same bytes: {', '.join(results_of(whole))}")
        packed = output_of(program, "dataset", "pack", whole)
        say(packed.strip())
        manifest = json.loads((whole / "dataset.manifest.json").read_text())
        say(f"cells by the manifest: {manifest['cells']}")


if __name__ == "__main__":
    main()
