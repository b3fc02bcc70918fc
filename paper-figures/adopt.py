"""Takes from a finished run what figures need of its grasp files, small enough to be committed.

Run by `make --rerun`. Poses, contacts, measures and the hand's links and pads stay; options, joints
and timings go. The table's SHA-256 ties a file to the published run; the object's mesh is named by
its path in the data folder and its own SHA-256.
"""

import hashlib
import json
import os
import pathlib

KEPT_OF_GRASP = (
    "m", "m1", "m2", "m3", "regularity", "centroid_distance_m", "ideal_m", "usable", "valid",
    "sustainability_terms", "stable_pairs", "X_OH", "X_OL", "contacts", "targets",
)  # fmt: skip
KEPT_OF_OBJECT = ("sha256", "meters_per_file_unit", "center_of_mass_O_m", "normalizing_radius_m")
KEPT_OF_JOINT = (
    "name", "type", "lower", "upper", "parent_link", "child_link", "X_PJ", "axis_J", "closing_sign",
    "coupling",
)  # fmt: skip
KEPT_OF_PAD = ("name", "link", "finger", "X_LC", "outline_C_m", "largest_boundary_distance_m", "area_m2")


def pad_of(pad):
    """The part of a pad that is kept."""
    kept = {key: pad[key] for key in KEPT_OF_PAD}
    return {**kept, "is_flat": not pad["surface_C_m"], "clip_thickness_m": pad["clip_volume_L"]["thickness_m"]}


def adopted(grasps, table_sha256):
    """The part of a grasp file's JSON that is kept."""
    shape = grasps["object"]
    file = pathlib.PurePosixPath(shape["file"]).as_posix()
    at = file.rfind("meshes/")
    return {
        "table_sha256": table_sha256,
        "object": {
            "file": file[at:] if at >= 0 else file,
            "num_vertices": shape["mesh"]["num_vertices"],
            **{key: shape[key] for key in KEPT_OF_OBJECT},
        },
        "hand": {
            "name": grasps["hand"]["name"],
            "palm": grasps["hand"]["palm"],
            "links": [
                {"name": link["name"], "mesh_files": link["mesh_files"]}
                for link in grasps["hand"]["links"]
            ],
            "fingers": [
                {key: finger[key] for key in ("name", "is_thumb", "tip_pad")}
                for finger in grasps["hand"]["fingers"]
            ],
            "joints": [
                {key: joint[key] for key in KEPT_OF_JOINT} for joint in grasps["hand"]["joints"]
            ],
            "pads": [pad_of(pad) for pad in grasps["hand"]["pads"]],
        },
        "used": grasps["planner"]["used"],
        "grasps": [
            {key: grasp[key] for key in KEPT_OF_GRASP} for grasp in grasps["results"]["grasps"]
        ],
    }


def adopt(results, experiment, target):
    """Writes <target>/<experiment>/<cell>.json for every grasp file of a run; returns their number.

    Files of cells that the run no longer has are removed.
    """
    table_sha256 = hashlib.sha256((results / f"{experiment}.csv").read_bytes()).hexdigest()
    folder = target / experiment
    folder.mkdir(parents=True, exist_ok=True)
    written = set()
    for path in sorted((results / "cells").glob("*/grasps.json")):
        content = adopted(json.loads(path.read_text(encoding="utf-8")), table_sha256)
        file = folder / f"{path.parent.name}.json"
        part = file.with_name(f".{file.name}.{os.getpid()}")
        part.write_text(json.dumps(content, separators=(",", ":")) + "\n", encoding="utf-8")
        os.replace(part, file)
        written.add(file)
    for stale in set(folder.glob("*.json")) - written:
        stale.unlink()
    return len(written)
