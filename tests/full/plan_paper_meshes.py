#!/usr/bin/python3
"""Plans on every mesh of $GRASPFIT_DATA/meshes/paper and prints one table.

Barrett hand, longest extent 0.15 m, seed 1, a fixed number of attempts, every usable grasp counted (so the
rates are per attempt and nothing is selected). A mesh that the program refuses is a row with its reason. Fails
if any run ends in anything but grasps, "no grasp found" or a refusal in one line.

Usage: plan_paper_meshes.py PROGRAM [--attempts N] [--longest M] [--csv FILE]
"""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

COLUMNS = [
    "object", "attempts", "usable", "valid", "usable_per_attempt", "valid_per_attempt",
    "best_m", "mean_m", "largest_penetration_m", "failures",
]


def data_folder():
    default = pathlib.Path(__file__).resolve().parents[2].parent / "shared"
    return pathlib.Path(os.environ.get("GRASPFIT_DATA", default))


def run(program, mesh, arguments, folder):
    """Returns one row, and the seconds it took."""
    out = folder / mesh.stem
    start = time.monotonic()
    done = subprocess.run(
        [program, "plan", str(mesh), "--hand", "barrett", "--longest", str(arguments.longest),
         "--preset", "exact", "--seed", "1", "--contacts", "3", "--accept", "usable",
         "--count", str(arguments.attempts), "--max-attempts", str(arguments.attempts),
         "--out", str(out)],
        capture_output=True, text=True)
    seconds = time.monotonic() - start
    row = dict.fromkeys(COLUMNS, "")
    row["object"] = mesh.name
    lines = done.stderr.strip().splitlines()
    if done.returncode == 2:
        if len(lines) != 1:
            raise RuntimeError(f"{mesh.name}: refused in {len(lines)} lines: {done.stderr}")
        row["failures"] = "refused: " + lines[0]
        return row, seconds
    if done.returncode == 3:
        row.update(attempts=arguments.attempts, usable=0, valid=0,
                   failures="; ".join(lines[-1:]) or "no grasp found")
        return row, seconds
    if done.returncode != 0:
        raise RuntimeError(f"{mesh.name}: exit code {done.returncode}: {done.stderr}")
    results = json.loads((out / "grasps.json").read_text())["results"]
    grasps, statistics = results["grasps"], results["statistics"]
    qualities = [grasp["m"] for grasp in grasps]
    usable = len(grasps)
    valid = sum(grasp["valid"] for grasp in grasps)
    attempts = statistics["attempts"]
    row.update(
        attempts=attempts, usable=usable, valid=valid,
        usable_per_attempt=round(usable / attempts, 4),
        valid_per_attempt=round(valid / attempts, 4),
        best_m=round(max(qualities), 4), mean_m=round(sum(qualities) / usable, 4),
        largest_penetration_m=round(
            max(grasp["penetration"]["object_depth_m"] for grasp in grasps), 6),
        failures=", ".join(f"{name} {count}" for name, count in statistics["outcomes"].items()
                           if count and not name.startswith(("valid", "usable"))))
    return row, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--attempts", type=int, default=100)
    parser.add_argument("--longest", type=float, default=0.15)
    parser.add_argument("--csv", type=pathlib.Path)
    arguments = parser.parse_args()
    folder = data_folder() / "meshes" / "paper"
    meshes = sorted(path for path in folder.glob("*") if path.suffix in (".off", ".obj", ".stl"))
    if not meshes:
        print(f"SKIPPED: no meshes in {folder}; set GRASPFIT_DATA")
        return 0
    rows = []
    failed = False
    print(f"{'object':22s} {'usable':>7s} {'valid':>6s} {'best M':>7s} {'mean M':>7s} "
          f"{'deepest':>9s} {'time':>7s}  of {arguments.attempts} attempts")
    with tempfile.TemporaryDirectory() as temporary:
        for mesh in meshes:
            try:
                row, seconds = run(arguments.program, mesh, arguments, pathlib.Path(temporary))
            except RuntimeError as error:
                print(f"FAILED: {error}")
                failed = True
                continue
            rows.append(row)
            depth = row["largest_penetration_m"]
            depth = f"{1e3 * depth:6.2f} mm" if depth != "" else ""
            print(f"{row['object']:22s} {row['usable']!s:>7s} {row['valid']!s:>6s} "
                  f"{row['best_m']!s:>7s} {row['mean_m']!s:>7s} {depth:>9s} {seconds:6.1f}s  "
                  f"{row['failures']}", flush=True)
    if arguments.csv:
        temporary = arguments.csv.with_suffix(".tmp")
        with open(temporary, "w", newline="") as stream:
            writer = csv.DictWriter(stream, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)
        os.replace(temporary, arguments.csv)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
