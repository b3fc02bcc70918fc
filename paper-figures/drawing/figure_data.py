"""What figures are drawn from: published tables, adopted grasp files, hands' and objects' meshes.

Every reader checks what it needs and says in one line what is missing.
"""

import hashlib
import json
import os
import pathlib

import numpy as np
import pandas as pd

ROOT = pathlib.Path(__file__).resolve().parents[2]


class BadData(Exception):
    """What is wrong with data that should be there, in one line."""


class MissingData(Exception):
    """What is not there, so that a figure cannot be drawn here, in one line."""


class Source:
    """Folders that figures read; nothing else is read.

    tables: CSV files of experiments. grasps: adopted grasp files, <experiment>/<cell>.json. meshes:
    the folder that holds meshes/, or None. hands: models of the shipped hands.
    """

    def __init__(self, tables=None, grasps=None, meshes=None, hands=None):
        self.tables = pathlib.Path(tables or ROOT / "notebooks-data")
        self.grasps = pathlib.Path(grasps or ROOT / "paper-figures" / "data")
        self.hands = pathlib.Path(hands or ROOT / "hands" / "models")
        meshes = meshes or os.environ.get("GRASPFIT_DATA") or ROOT.parent / "shared"
        self.meshes = pathlib.Path(meshes)

    def table(self, name, columns):
        """Table <name>.csv with at least these columns; empty fields are NaN or ""."""
        path = self.tables / f"{name}.csv"
        if not path.exists():
            experiment = name.partition(".")[0]
            raise MissingData(
                f"{path.name} is not published: graspfit experiment run {experiment} --publish"
            )
        try:
            frame = pd.read_csv(path, keep_default_na=True)
        except (OSError, ValueError) as error:
            raise BadData(f"{path}: {error}") from error
        missing = [column for column in columns if column not in frame.columns]
        if missing:
            raise BadData(
                f"{path}: has no column {', '.join(missing)}; it has {', '.join(frame.columns)}"
            )
        return frame

    def run_sha256(self, experiment):
        """SHA-256 of a published table, by which pictures and numbers are held together."""
        path = self.tables / f"{experiment}.csv"
        if not path.exists():
            raise MissingData(
                f"{path.name} is not published: graspfit experiment run {experiment} --publish"
            )
        return hashlib.sha256(path.read_bytes()).hexdigest()

    def grasp_file(self, experiment, cell):
        """The adopted grasp file of a cell (see adopt.py), of the run that is published."""
        path = self.grasps / experiment / f"{cell}.json"
        published = self.run_sha256(experiment)
        if not path.exists():
            raise MissingData(f"{path.relative_to(self.grasps)} is not there: make --rerun")
        try:
            record = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise BadData(f"{path}: {error}") from error
        if record.get("table_sha256") != published:
            raise BadData(
                f"{path}: belongs to another run than {experiment}.csv; make --rerun adopts again"
            )
        return record

    def object_mesh(self, record):
        """Vertices [n, 3] in meters in frame O and triangles [m, 3] of a record's object."""
        described = record["object"]
        vertices, triangles = self.mesh(described["file"], described["sha256"])
        return vertices * described["meters_per_file_unit"], triangles

    def mesh(self, name, sha256=None):
        """A mesh of the data folder in the file's own unit."""
        path = self.meshes / name
        if not path.exists():
            raise MissingData(f"{name} is not in {self.meshes} (GRASPFIT_DATA)")
        if sha256 and hashlib.sha256(path.read_bytes()).hexdigest() != sha256:
            raise BadData(f"{path}: is not the file that the grasps were planned for")
        return read_mesh(path)

    def link_meshes(self, record):
        """Per link of the record's hand that has a shape: vertices [n, 3] in L, triangles [m, 3]."""
        hand = record["hand"]
        folder = self.hands / hand["name"]
        meshes = {}
        for link in hand["links"]:
            parts = [read_mesh(folder / name) for name in link["mesh_files"]]
            if not parts:
                continue
            offsets = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
            meshes[link["name"]] = (
                np.concatenate([vertices for vertices, _ in parts]),
                np.concatenate([tris + offset for (_, tris), offset in zip(parts, offsets)]),
            )
        return meshes


def read_mesh(path):
    """Vertices [n, 3] and triangles [m, 3] of an OFF, OBJ or STL file; polygons as fans."""
    readers = {".off": read_off, ".obj": read_obj, ".stl": read_stl}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise BadData(f"{path}: figures read {', '.join(readers)} files")
    try:
        vertices, polygons = reader(path)
        if isinstance(polygons, list):
            polygons = [(p[0], p[i], p[i + 1]) for p in polygons for i in range(1, len(p) - 1)]
        return np.asarray(vertices, dtype=float), np.asarray(polygons, dtype=np.int64)
    except FileNotFoundError as error:
        raise MissingData(f"{path} is not there") from error
    except (OSError, ValueError, IndexError) as error:
        raise BadData(f"{path}: {error}") from error


def read_off(path):
    lines = (line.partition("#")[0].split() for line in path.read_text().splitlines())
    lines = [words for words in lines if words]
    header = lines[0][1:] if len(lines[0]) > 1 else lines[1]
    body = lines[1:] if len(lines[0]) > 1 else lines[2:]
    num_vertices, num_faces = int(header[0]), int(header[1])
    vertices = [[float(x) for x in words[:3]] for words in body[:num_vertices]]
    faces = body[num_vertices : num_vertices + num_faces]
    return vertices, [[int(x) for x in words[1 : 1 + int(words[0])]] for words in faces]


def read_obj(path):
    vertices, polygons = [], []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("v "):
            vertices.append([float(x) for x in line.split()[1:4]])
        elif line.startswith("f "):
            corners = [int(word.partition("/")[0]) for word in line.split()[1:]]
            polygons.append([k - 1 if k > 0 else len(vertices) + k for k in corners])
    return vertices, polygons


def read_stl(path):
    content = path.read_bytes()
    if content.lstrip()[:5] == b"solid" and b"vertex" in content:
        words = content.split()
        at = [i for i, word in enumerate(words) if word == b"vertex"]
        corners = np.array([[float(x) for x in words[i + 1 : i + 4]] for i in at])
    else:
        count = int(np.frombuffer(content, "<u4", 1, 80)[0])
        record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        corners = np.frombuffer(content, record, count, 84)["corners"].reshape(-1, 3)
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    return vertices.astype(float), index.reshape(-1, 3)


def rotation(quaternion_wxyz):
    """Rotation matrix of a unit quaternion."""
    w, x, y, z = quaternion_wxyz
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def posed(points, pose):
    """Points of a frame, in O, given its pose in a grasp file."""
    turned = np.asarray(points, dtype=float) @ rotation(pose["rotation_wxyz"]).T
    return turned + np.asarray(pose["translation_m"])


def turned(vector, pose):
    """A direction of a frame, in O."""
    return rotation(pose["rotation_wxyz"]) @ np.asarray(vector, dtype=float)
