#!/usr/bin/python3
"""Checks that the committed hands are, byte for byte, what generate.py writes, and that their
sidecars obey the schema."""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path


def files_below(folder):
    return sorted(p.relative_to(folder) for p in folder.rglob("*") if p.is_file())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--models", type=Path, required=True)
    models = parser.parse_args().models
    try:
        import jsonschema
        import numpy  # noqa: F401  (the generator needs it)
    except ImportError as error:
        print(f"SKIPPED: {error.name} is missing; install python3-{error.name}")
        return 0

    problems = []
    hands = sorted(p for p in models.iterdir() if (p / f"{p.name}.urdf").is_file())
    if not hands:
        problems.append(f"no hands in {models}")
    with tempfile.TemporaryDirectory() as temporary:
        for run in ("first", "second"):
            fresh = Path(temporary) / run
            subprocess.run([sys.executable, models / "generate.py", "--out", fresh], check=True)
            for hand in hands:
                if files_below(hand) != files_below(fresh / hand.name):
                    problems.append(f"{hand.name}: committed and generated files are not the same set")
                    continue
                for name in files_below(hand):
                    if (hand / name).read_bytes() != (fresh / hand.name / name).read_bytes():
                        problems.append(f"{hand.name}/{name} differs from what generate.py writes")

    schema = json.loads((models / "hand_sidecar.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    for hand in hands:
        sidecar = json.loads((hand / f"{hand.name}.graspfit.json").read_text(encoding="utf-8"))
        problems += [f"{hand.name}: {e.json_path}: {e.message}" for e in validator.iter_errors(sidecar)]
    curved = [pad for hand in hands
              for pad in json.loads((hand / f"{hand.name}.graspfit.json").read_text(encoding="utf-8"))["pads"]
              if "surface_m" in pad]
    if not curved:
        problems.append("no hand has a curved pad")
    # The schema must also refuse: a misspelled field, a pad without an outline, a wrong version.
    def broken(change):
        value = json.loads(json.dumps(sidecar))
        change(value)
        return value

    for what, change in [
            ("a misspelled field", lambda v: v["fingers"][0].update(thumbs=True)),
            ("a pad without outline", lambda v: v["pads"][0].pop("outline_m")),
            ("another version", lambda v: v["format"].update(version=2)),
            ("a closing sign of 2", lambda v: v["closing"].update(thumb_proximal=2)),
            ("a surface behind its pad", lambda v: v["pads"][0].update(surface_m=[[0, 0, -0.001]])),
            ("an unknown kind of clip volume", lambda v: v["pads"][0]["clip"].update(kind="ball")),
            ("a clip volume of no thickness", lambda v: v["pads"][0]["clip"].update(thickness_m=0))]:
        if validator.is_valid(broken(change)):
            problems.append(f"the schema accepts {what}")

    if not validator.is_valid({"format": sidecar["format"], "closing": sidecar["closing"]}):
        problems.append("the schema refuses a sidecar that leaves members to be derived")

    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
