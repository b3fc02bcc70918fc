"""Reads triangle meshes (OFF, OBJ, PLY, STL) into arrays; nothing is repaired.

A mesh is (vertices, faces): float64 [n, 3] and int64 [m, 3], counter-clockwise seen from outside.
Polygons become fans from their first corner.
"""

import pathlib
import struct

import numpy as np


def fans(polygons):
    """Returns triangles of polygons, each as a fan from its first corner."""
    return np.array([(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)],
                    dtype=np.int64).reshape(-1, 3)


def read_off(text):
    lines = [line.split("#")[0].strip() for line in text.splitlines()]
    lines = [line for line in lines if line]
    if lines[0].split()[0] not in ("OFF", "COFF", "NOFF", "CNOFF"):
        raise ValueError("OFF: no header")
    rest = lines[0].split()[1:]
    body = lines[1:] if not rest else [" ".join(rest)] + lines[1:]
    num_vertices, num_faces = (int(word) for word in body[0].split()[:2])
    vertices = np.array([line.split()[:3] for line in body[1:1 + num_vertices]], dtype=float)
    polygons = []
    for line in body[1 + num_vertices:1 + num_vertices + num_faces]:
        words = line.split()
        polygons.append([int(word) for word in words[1:1 + int(words[0])]])
    return vertices, fans(polygons)


def read_obj(text):
    vertices, polygons = [], []
    for line in text.splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            vertices.append([float(word) for word in words[1:4]])
        elif words[0] == "f":
            corners = [int(word.split("/")[0]) for word in words[1:]]
            polygons.append([c - 1 if c > 0 else len(vertices) + c for c in corners])
    return np.array(vertices, dtype=float).reshape(-1, 3), fans(polygons)


PLY_TYPES = {"char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h",
             "ushort": "H", "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I",
             "float": "f", "float32": "f", "double": "d", "float64": "d"}


class PlyValues:
    """Reads the numbers of a PLY body one after the other, in text or binary."""

    def __init__(self, body, form):
        self.position = 0
        self.body = body.split() if form == "ascii" else body
        self.order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[form]

    def next(self, kind):
        if self.order is None:
            word = self.body[self.position]
            self.position += 1
            return float(word) if kind in "fd" else int(word)
        layout = self.order + kind
        (value,) = struct.unpack_from(layout, self.body, self.position)
        self.position += struct.calcsize(layout)
        return value


def read_ply(data):
    end = data.index(b"end_header")
    end = data.index(b"\n", end) + 1
    elements, form = [], None
    for line in data[:end].decode("ascii").splitlines():
        words = line.split()
        if words[0] == "format":
            form = words[1]
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    values = PlyValues(data[end:], form)
    vertices, polygons = [], []
    for name, count, properties in elements:
        for _ in range(count):
            item = {}
            for words in properties:
                if words[0] == "list":
                    length = values.next(PLY_TYPES[words[1]])
                    item[words[3]] = [values.next(PLY_TYPES[words[2]]) for _ in range(length)]
                else:
                    item[words[1]] = values.next(PLY_TYPES[words[0]])
            if name == "vertex":
                vertices.append((item["x"], item["y"], item["z"]))
            elif name == "face":
                polygons.append(item.get("vertex_indices", item.get("vertex_index")))
    return np.array(vertices, dtype=float).reshape(-1, 3), fans(polygons)


def read_stl(data):
    (count,) = struct.unpack_from("<I", data, 80) if len(data) >= 84 else (0,)
    if len(data) == 84 + 50 * count:
        record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
        corners = np.frombuffer(data, dtype=record, offset=84)["corners"].astype(float)
    else:
        rows = [line.split()[1:] for line in data.decode("ascii").splitlines()
                if line.split()[:1] == ["vertex"]]
        corners = np.array(rows, dtype=float)
    vertices, faces = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return vertices, faces.reshape(-1, 3).astype(np.int64)


def read_mesh(path):
    path = pathlib.Path(path)
    kind = path.suffix.lower()
    if kind == ".off":
        return read_off(path.read_text())
    if kind == ".obj":
        return read_obj(path.read_text())
    if kind == ".ply":
        return read_ply(path.read_bytes())
    if kind == ".stl":
        return read_stl(path.read_bytes())
    raise ValueError(f"{path}: reads OFF, OBJ, PLY and STL only")


def box(size):
    """Returns a closed outward box around the origin."""
    signs = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], dtype=float)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return signs * np.asarray(size, dtype=float) / 2, fans(quads)


def volume_and_center(vertices, faces):
    """Returns volume and center of mass of the solid that a closed outward surface bounds."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    # These are of the tetrahedra with the origin.
    sixfold = np.einsum("ij,ij->i", a, np.cross(b, c))
    volume = sixfold.sum() / 6
    return volume, (sixfold[:, None] * (a + b + c)).sum(axis=0) / 24 / volume


def parts(num_vertices, faces):
    """Returns one vertex of every connected part of a surface."""
    label = np.arange(num_vertices)
    while True:
        low = label[faces].min(axis=1)
        new = label.copy()
        for k in range(3):
            np.minimum.at(new, faces[:, k], low)
        new = new[new]
        if np.array_equal(new, label):
            return np.unique(label[np.unique(faces)])
        label = new


def is_closed(faces):
    """Returns whether every edge has its opposite, as often: there is no border, and one side
    all around."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forth = np.sort(edges[:, 0] * (edges.max(initial=0) + 1) + edges[:, 1])
    back = np.sort(edges[:, 1] * (edges.max(initial=0) + 1) + edges[:, 0])
    return np.array_equal(forth, back)


def welded(vertices, faces):
    """Returns the same mesh with equal vertices as one."""
    unique, which = np.unique(vertices, axis=0, return_inverse=True)
    return unique, which.reshape(-1)[faces]
