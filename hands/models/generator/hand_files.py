"""The files of a hand: description (URDF), sidecar (JSON), meshes (OBJ), sources (SOURCE.md)."""

import json
import math

import numpy as np


def number(value, digits=12):
    """A number as text, without a negative zero."""
    text = repr(round(float(value), digits) + 0.0)
    return text[:-2] if text.endswith(".0") else text


def numbers(values, digits=12):
    return " ".join(number(v, digits) for v in values)


def obj_text(name, mesh):
    vertices, faces = mesh
    lines = [f"# {name}, written by generate.py; meters, link frame", f"o {name}"]
    lines += ["v " + " ".join(f"{c / 1000.0 + 0.0:.10f}" for c in v) for v in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in f) for f in faces]
    return "\n".join(lines).replace("-0.0000000000", "0.0000000000") + "\n"


def mass_properties(mesh, mass):
    """Center of mass [m] and inertia [kg m^2] about it of a closed mesh of uniform density."""
    vertices, faces = mesh
    v = np.asarray(vertices) / 1000.0
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for a, b, c in ((v[i], v[j], v[k]) for i, j, k in faces):
        d = float(np.dot(a, np.cross(b, c)))
        s = a + b + c
        volume += d / 6.0
        first += d / 24.0 * s
        second += d / 120.0 * (np.outer(a, a) + np.outer(b, b) + np.outer(c, c) + np.outer(s, s))
    center = first / volume
    covariance = second / volume - np.outer(center, center)
    return center, mass * (np.trace(covariance) * np.eye(3) - covariance)


def meters(values_mm):
    return [v / 1000.0 for v in values_mm]


def quaternion(columns):
    """[w, x, y, z] of the rotation whose columns are given, w >= 0."""
    m = np.column_stack(columns)
    w = math.sqrt(max(0.0, 1.0 + m[0, 0] + m[1, 1] + m[2, 2])) / 2
    if w > 0.1:
        q = [w, (m[2, 1] - m[1, 2]) / (4 * w), (m[0, 2] - m[2, 0]) / (4 * w), (m[1, 0] - m[0, 1]) / (4 * w)]
    else:
        x = math.sqrt(max(0.0, 1.0 + m[0, 0] - m[1, 1] - m[2, 2])) / 2
        q = [(m[2, 1] - m[1, 2]) / (4 * x), x, (m[0, 1] + m[1, 0]) / (4 * x), (m[0, 2] + m[2, 0]) / (4 * x)]
    return [round(c, 15) + 0.0 for c in q]


def rounded(values, digits=12):
    return [round(float(v), digits) + 0.0 for v in values]


def rectangle(length, width):
    x, y = length / 2000.0, width / 2000.0
    return [rounded(c) for c in [(x, -y), (x, y), (-x, y), (-x, -y)]]


def json_text(value, indent=0):
    """JSON with one line per list of plain values, so that a person can read and edit it."""
    pad = "  " * (indent + 1)
    if isinstance(value, dict):
        if not value:
            return "{}"
        body = ",\n".join(f"{pad}{json.dumps(k)}: {json_text(v, indent + 1)}" for k, v in value.items())
        return "{\n" + body + "\n" + "  " * indent + "}"
    if isinstance(value, list):
        one_line = json.dumps(value)
        if len(one_line) + 2 * indent <= 96 and not any(isinstance(v, dict) for v in value):
            return one_line
        return "[\n" + ",\n".join(pad + json_text(v, indent + 1) for v in value) + "\n" + "  " * indent + "]"
    return json.dumps(value)


def table_rows(file, name):
    """The lines of the table `name` in a Python file as (item, value, source), for SOURCE.md."""
    rows, inside = [], False
    for line in file.read_text(encoding="utf-8").splitlines():
        if line.startswith(f"{name} = {{"):
            inside = True
        elif inside and line.startswith("}"):
            break
        elif inside and line.strip().startswith('"'):
            item, rest = line.strip().split('":', 1)
            value, _, source = rest.partition("  #") if "  #" in rest else (rest, "", "")
            rows.append((item.strip('"'), value.strip().rstrip(","), source.strip()))
    return rows


def markdown_table(head, rows):
    return ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |",
            *("| " + " | ".join(row) + " |" for row in rows)]


def mesh_sizes(meshes, name="link"):
    """A table of the meshes' extents in mm and their numbers of triangles."""
    rows = []
    for mesh_name, (vertices, faces) in meshes.items():
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        rows.append([mesh_name, *(f"{h - l:.1f}" for l, h in zip(low, high)), str(len(faces))])
    return markdown_table([name, "x", "y", "z", "triangles"], rows)


class Description:
    """The lines of a URDF. Lengths are given in mm, angles in radians."""

    def __init__(self, name, materials, note="sources in SOURCE.md"):
        self.lines = ['<?xml version="1.0" encoding="utf-8"?>',
                      f"<!-- Written by generate.py; {note}. Meters, radians, kilograms. -->",
                      f'<robot name="{name}">']
        self.lines += [f'  <material name="{m}"><color rgba="{color}"/></material>'
                       for m, color in materials.items()]

    def link(self, name, mesh_file=None, material=None, mass=None, mesh=None, scale=1.0):
        """A link; `mass` with center and inertia of the scaled `mesh` at uniform density."""
        if mesh_file is None:
            self.lines.append(f'  <link name="{name}"/>')
            return
        center, inertia = mass_properties((scale * np.asarray(mesh[0]), mesh[1]), mass)
        i = [number(inertia[r][c]) for r, c in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]]
        size = "" if scale == 1.0 else f' scale="{numbers([scale] * 3, 15)}"'
        geometry = f'<geometry><mesh filename="{mesh_file}"{size}/></geometry>'
        self.lines += [
            f'  <link name="{name}">',
            "    <inertial>",
            f'      <origin xyz="{numbers(center, 9)}" rpy="0 0 0"/>',
            f'      <mass value="{number(mass)}"/>',
            f'      <inertia ixx="{i[0]}" ixy="{i[1]}" ixz="{i[2]}" iyy="{i[3]}" iyz="{i[4]}" izz="{i[5]}"/>',
            "    </inertial>",
            f'    <visual>{geometry}<material name="{material}"/></visual>',
            f"    <collision>{geometry}</collision>",
            "  </link>"]

    def joint(self, name, parent, child, xyz, rpy, axis, limits, mimic=None, kind="revolute", effort=5,
              velocity=2.5):
        """`limits` in radians or meters; `mimic` is (leader, ratio)."""
        self.lines += [
            f'  <joint name="{name}" type="{kind}">',
            f'    <parent link="{parent}"/>',
            f'    <child link="{child}"/>',
            f'    <origin xyz="{numbers(meters(xyz))}" rpy="{numbers(rpy, 15)}"/>',
            f'    <axis xyz="{numbers(axis)}"/>',
            f'    <limit lower="{number(limits[0], 15)}" upper="{number(limits[1], 15)}" effort="{effort}" '
            f'velocity="{velocity}"/>']
        if mimic:
            self.lines.append(
                f'    <mimic joint="{mimic[0]}" multiplier="{number(mimic[1], 15)}" offset="0"/>')
        self.lines.append("  </joint>")

    def text(self):
        return "\n".join([*self.lines, "</robot>"]) + "\n"


CONVENTIONS = ("Lengths in meters, angles in radians, rotations as unit quaternions [w, x, y, z]. "
               "Pad frames are given in their link's frame: origin {origin}, z "
               "leaving the link toward what it touches; outlines are convex and counter-clockwise "
               "in the pad frame's x-y plane{surface}. Palm center and direction are in the palm link's frame.")


def sidecar(hand, description, fingers, pads, palm, closing, couplings, exclusions):
    """A sidecar's fields in the order of the format."""
    curved = any("surface_m" in pad for pad in pads)
    conventions = CONVENTIONS.format(
        origin="in the pad's plane" if curved else "at the middle of the pad",
        surface="; surfaces bulge over them toward z" if curved else "")
    return {"format": {"name": "graspfit hand sidecar", "version": 1}, "hand": hand,
            "description": description, "conventions": conventions, "fingers": fingers, "pads": pads,
            "palm": palm, "closing": closing, "couplings": couplings, "exclusions": exclusions}


def flat_pad(name, link, finger, center_mm, axes, outline):
    return {"name": name, "link": link, "finger": finger,
            "frame": {"translation_m": rounded(meters(center_mm)), "rotation_wxyz": quaternion(axes)},
            "outline_m": outline, "clip": {"kind": "prism", "thickness_m": None}}


def bulging_pad(name, link, finger, center_mm, axes, outline_mm, surface_mm):
    return {"name": name, "link": link, "finger": finger,
            "frame": {"translation_m": rounded(meters(center_mm)), "rotation_wxyz": quaternion(axes)},
            "outline_m": [rounded(meters(corner), 9) for corner in outline_mm],
            "surface_m": [rounded(meters(point), 9) for point in surface_mm],
            "clip": {"kind": "offset", "thickness_m": None}}


def write_files(folder, files):
    """Writes {relative path: text} below a folder."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8", newline="\n")
