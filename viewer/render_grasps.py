#!/usr/bin/python3
"""Pictures of grasps: DIR/grasp_001.png and so on, from the files that `graspfit plan` wrote.

Reads DIR/grasps.json and, for each of its grasps, DIR/grasp_NNN.obj: the object (`o object`) and the
posed links (`o link NAME`), in meters, in the object frame O. Each picture shows the grasp across the
palm direction and facing the contact polygon, and its pre-grasp, if it has one, across the palm direction;
all in parallel projection, so that the scale bar holds everywhere. Of an object that is much larger than
the hand, the views of the grasp show what is near the hand, that of the pre-grasp all. Table and
obstacles (DIR/obstacle_1.ply, ...) are seen through. Pictures are written under a temporary name and renamed.

Uses Debian's python3-vtk9, under xvfb-run where that is installed. Exit code 1 with one line on bad
input or a missing program.
"""

import argparse
import json
import math
import pathlib
import sys

sys.dont_write_bytecode = True  # the folder may be the sources' or root's
from vtk_picture import (  # noqa: E402
    COLORS,
    SEEN_THROUGH,
    SUPERSAMPLING,
    BadInput,
    Canvas,
    cross,
    dot,
    go_under_xvfb,
    minus,
    perpendicular,
    pixels,
    unit,
    write_atomically,
)

BOTTOM, TOP = 0.115, 0.9  # of the two views, as parts of the picture's height
LYING = 0.3  # Upward part of the normal of a polygon that a table hides from below.
MUCH_LARGER = 2.5  # An object so many times the size of the hand is not shown whole.
ROUNDED_EPSILON = 1e-9  # Contacts that are opposite each other but for rounding close with less.


# ------------------------------------------------------------------------------------------- input


def read_grasps(path):
    """The object and list of grasps of a grasp file, checked as far as pictures need them."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise BadInput(f"{path}: not JSON: {error}") from error

    def entry(value, *keys):
        trail = ""
        for key in keys:
            trail += f"/{key}"
            try:
                value = value[key]
            except (KeyError, IndexError, TypeError):
                raise BadInput(f"{path}: no {trail}") from None
        return value

    def vector(value, what):
        if (
            not isinstance(value, list)
            or len(value) != 3
            or not all(isinstance(x, (int, float)) and math.isfinite(x) for x in value)
        ):
            raise BadInput(f"{path}: {what} is {json.dumps(value)}, not three numbers")
        return value

    found = entry(data, "results", "grasps")
    if not isinstance(found, list):
        raise BadInput(f"{path}: /results/grasps is no list")
    palm = entry(data, "hand", "palm")
    grasps = []
    for i, item in enumerate(found):
        where = f"/results/grasps/{i}"
        pose = entry(item, "X_OH")
        rotation = entry(pose, "rotation_wxyz")
        if not isinstance(rotation, list) or len(rotation) != 4:
            raise BadInput(f"{path}: {where}/X_OH/rotation_wxyz is {json.dumps(rotation)}")
        translation = vector(entry(pose, "translation_m"), f"{where}/X_OH/translation_m")
        direction = rotate(rotation, vector(entry(palm, "direction_H"), "/hand/palm/direction_H"))
        center = rotate(rotation, vector(entry(palm, "center_H_m"), "/hand/palm/center_H_m"))
        contacts = []
        for j, contact in enumerate(entry(item, "contacts")):
            at = f"{where}/contacts/{j}"
            contacts.append(
                {
                    "point": vector(entry(contact, "point_O_m"), f"{at}/point_O_m"),
                    "normal": vector(entry(contact, "inward_normal_O"), f"{at}/inward_normal_O"),
                    "finger": str(entry(contact, "finger")),
                }
            )
        pairs = [tuple(sorted(entry(pair, "contacts"))) for pair in entry(item, "stable_pairs")]
        measures = {name: entry(item, name) for name in ("m", "m1", "m2", "m3")}
        for name, value in measures.items():
            if not isinstance(value, (int, float)):
                raise BadInput(f"{path}: {where}/{name} is {json.dumps(value)}, not a number")
        wrench = item.get("wrench")
        if wrench:
            wrench = {"epsilon": entry(wrench, "epsilon"),
                      "closes": bool(wrench.get("is_force_closure", True))}
        grasps.append(
            {
                "number": i + 1,
                "wrench": wrench,
                "motions": pre_grasp_motions(item, entry, vector, where),
                "contacts": contacts,
                "stable_pairs": pairs,
                "palm_center": [a + b for a, b in zip(translation, center)],
                "palm_direction": direction,
                "state": "valid" if item.get("valid") else "usable" if item.get("usable") else "unusable",
                "penetration": float(item.get("largest_penetration_m") or 0.0),
                **measures,
            }
        )
    surroundings = data.get("surroundings") or {"table_z_O_m": None, "obstacles": []}
    names = [obstacle.get("used_mesh_file") for obstacle in entry(surroundings, "obstacles")]
    return {
        "table_z": entry(surroundings, "table_z_O_m"),
        "obstacles": [path.parent / name for name in names if name],
        "object_name": pathlib.PurePath(str(entry(data, "object", "file"))).stem,
        "center_of_mass": vector(
            entry(data, "object", "center_of_mass_O_m"), "/object/center_of_mass_O_m"
        ),
        "hand_name": str(entry(data, "hand", "name")),
        "grasps": grasps,
    }


def pre_grasp_motions(item, entry, vector, where):
    """Per link what takes its points from the grasp to the pre-grasp; None if there is none."""
    pre_grasp = item.get("pre_grasp")
    if not pre_grasp:
        return None

    def pose(owner, path, link):
        found = entry(owner, "X_OL", link)
        return entry(found, "rotation_wxyz"), vector(
            entry(found, "translation_m"), f"{where}{path}/X_OL/{link}/translation_m"
        )

    motions = {}
    for link in entry(pre_grasp, "X_OL"):
        turn, shift = pose(item, "", link)
        new_turn, new_shift = pose(pre_grasp, "/pre_grasp", link)
        motions[link] = ([turn[0], *(-x for x in turn[1:])], shift, new_turn, new_shift)
    return motions


def moved(motion, point):
    """A point of a link, in O, where the motion takes it."""
    back, shift, turn, new_shift = motion
    local = rotate(back, minus(point, shift))
    return [a + b for a, b in zip(rotate(turn, local), new_shift)]


def rotate(quaternion_wxyz, v):
    """v turned by a unit quaternion."""
    w, *q = quaternion_wxyz
    t = [2.0 * x for x in cross(q, v)]
    return [a + w * b + c for a, b, c in zip(v, t, cross(q, t))]


def read_parts(path):
    """Named parts of an OBJ file: [(name, vertices, faces)], faces indexing the part's vertices."""
    vertices = []
    parts = []
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            for number, line in enumerate(file, start=1):
                words = line.split()
                if not words or words[0] not in ("v", "f", "o", "g"):
                    continue
                try:
                    if words[0] == "v":
                        point = tuple(float(word) for word in words[1:4])
                        if len(point) != 3 or not all(map(math.isfinite, point)):
                            raise ValueError
                        vertices.append(point)
                    elif words[0] == "f":
                        face = [int(word.partition("/")[0]) for word in words[1:]]
                        face = [k - 1 if k > 0 else len(vertices) + k for k in face]
                        if len(face) < 3 or min(face) < 0 or max(face) >= len(vertices):
                            raise ValueError
                        if not parts:
                            parts.append(("object", []))
                        parts[-1][1].append(face)
                    else:
                        parts.append((" ".join(words[1:]), []))
                except ValueError:
                    raise BadInput(f"{path}: line {number} makes no sense: {line.strip()[:60]}") from None
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    result = []
    for name, faces in parts:
        used = sorted({k for face in faces for k in face})
        new_index = {k: i for i, k in enumerate(used)}
        result.append(
            (name, [vertices[k] for k in used], [[new_index[k] for k in face] for face in faces])
        )
    if not any(name == "object" and faces for name, _, faces in result):
        raise BadInput(f"{path}: holds no faces of a part named object")
    return result


# ------------------------------------------------------------------------------------------ vectors


def polygon_normal(grasp, above=None):
    """Unit normal of the contacts' polygon, on the side that the palm does not cover.

    Over a table, whose axis `above` is, a polygon that lies is seen from above.
    """
    points = [contact["point"] for contact in grasp["contacts"]]
    palm = grasp["palm_direction"]
    normal = None
    if len(points) == 2:
        normal = unit(cross(minus(points[1], points[0]), palm))
    elif len(points) > 2:
        # Newell's: right for any polygon, close for contacts that are not in a plane.
        total = [0.0, 0.0, 0.0]
        for a, b in zip(points, points[1:] + points[:1]):
            total = [x + y for x, y in zip(total, cross(a, b))]
        normal = unit(total)
    if normal is None:
        return perpendicular(palm)
    if above is not None and abs(normal[above]) > LYING:
        return [-x for x in normal] if normal[above] < 0.0 else normal
    return [-x for x in normal] if dot(normal, palm) < 0.0 else normal


def side_direction(grasp, up):
    """Toward the eye: across the palm direction, close to level, showing the polygon's face."""
    palm = grasp["palm_direction"]
    normal = polygon_normal(grasp)
    start = perpendicular(palm)
    other = cross(palm, start)
    best, best_score = start, -math.inf
    for i in range(48):
        angle = 2.0 * math.pi * i / 48
        candidate = [math.cos(angle) * a + math.sin(angle) * b for a, b in zip(start, other)]
        score = abs(dot(candidate, normal)) - 0.8 * abs(candidate[up] - 0.2)
        if score > best_score + 1e-9:
            best, best_score = candidate, score
    return best


def hull_edges(points):
    """Edges of the convex hull of a few points: pairs with all others on one side of a plane."""
    edges = []
    n = len(points)
    for i in range(n):
        for j in range(i + 1, n):
            is_edge = n <= 3
            for k in range(n):
                if is_edge or k in (i, j):
                    continue
                normal = cross(minus(points[j], points[i]), minus(points[k], points[i]))
                sides = [dot(normal, minus(points[l], points[i])) for l in range(n) if l not in (i, j, k)]
                is_edge = all(s > 0 for s in sides) or all(s <= 0 for s in sides)
            if is_edge:
                edges.append((i, j))
    return edges


def points_of(parts, with_object=True):
    return [v for name, vertices, _ in parts if with_object or name != "object" for v in vertices]


def diagonal(points):
    """Length of the diagonal of the points' box."""
    return math.dist(*([pick(p[k] for p in points) for k in range(3)] for pick in (min, max)))


def pre_grasp_parts(grasp, parts):
    """The parts of the scene with the hand in its pre-grasp."""
    result = []
    for name, vertices, faces in parts:
        motion = grasp["motions"].get(name.removeprefix("link "))
        if motion and name != "object":
            vertices = [moved(motion, vertex) for vertex in vertices]
        result.append((name, vertices, faces))
    return result


# ------------------------------------------------------------------------------------------ picture


def measures_text(grasp):
    """Returns the line below a picture's title."""
    text = f"M {grasp['m']:.3f}   (M1 {grasp['m1']:.3f}, M2 {grasp['m2']:.3f}, M3 {grasp['m3']:.3f})"
    wrench = grasp["wrench"]
    if wrench:
        # Whatever a convention gives then, it is no strength.
        closes = wrench["closes"] and wrench["epsilon"] > ROUNDED_EPSILON
        text += f"   epsilon {wrench['epsilon']:.3f}" if closes else "   no force closure"
    text += f"   {grasp['state']}"
    if grasp["penetration"] > 0.0:
        text += f"   penetration {1000 * grasp['penetration']:.2f} mm"
    return text


class Painter(Canvas):
    """Draws grasps into pictures of one size."""

    def __init__(self, width, height, up, scene, note=""):
        super().__init__(width, height)
        self.up, self.scene, self.note = up, scene, note

    def paint(self, grasp, parts):
        """PNG file of one grasp as bytes."""
        window = self.window()
        side = side_direction(grasp, self.up)
        marks = self.marks
        above = None if self.scene["table_z"] is None else 2
        views = [
            ("across the palm direction", side, parts, marks),
            ("facing the contact polygon", polygon_normal(grasp, above), parts, marks),
        ]
        if grasp["motions"]:
            # The marks are the grasp's: what the open hand is going to.
            views.append(("pre-grasp", side, pre_grasp_parts(grasp, parts), self.contact_marks))
        near = points_of(parts, with_object=False)
        if not near or diagonal(points_of(parts)) < MUCH_LARGER * diagonal(near):
            near = None
        for column, (name, back, shown, make_marks) in enumerate(views):
            left, right = column / len(views), (column + 1) / len(views)
            up = [float(k == self.up) for k in range(3)]
            if abs(dot(up, back)) > 0.97:
                up = up[-1:] + up[:-1]
            aspect = self.width / (len(views) * (TOP - BOTTOM) * self.height)
            points = near if near and shown is parts else points_of(shown)
            camera, height_m = self.camera(back, up, points, aspect)
            size = diagonal(points)
            self.add_view(
                window,
                (left, BOTTOM, right, TOP),
                camera,
                self.solids(shown),
                lambda make_marks=make_marks, size=size: make_marks(grasp, size),
            )
            self.add_axes(window, (left + 0.008, 0.056), camera)
            view_pixels = (TOP - BOTTOM) * SUPERSAMPLING * self.height
            self.add_scale_bar(
                window, (left, 0.055, right, BOTTOM), name, height_m / view_pixels
            )
        self.add_caption(window, grasp)
        return self.png(window)

    def solids(self, parts):
        """Object, links and what stands around them."""
        made = [
            self.solid(vertices, faces, "object", specular=0.05)
            if name == "object"
            else self.solid(vertices, faces, "hand")
            for name, vertices, faces in parts
            if faces
        ]
        for file in self.scene["obstacles"]:
            reader = self.vtk.vtkPLYReader()
            reader.SetFileName(str(file))
            made.append(self.actor(reader, COLORS["surroundings"]))
            made[-1].GetProperty().SetOpacity(SEEN_THROUGH)  # A bin's walls hide the hand in it.
        if self.scene["table_z"] is not None:
            made.append(self.table(next(v for name, v, _ in parts if name == "object"), self.scene["table_z"]))
        return made

    def contact_marks(self, grasp, size):
        """Where the contacts will be."""
        return [
            self.ball(contact["point"], 0.0115 * size, COLORS["contact"])
            for contact in grasp["contacts"]
        ]

    def marks(self, grasp, size):
        """Contacts with their inward normals, the polygon's edges, palm direction, center of mass."""
        marks = [self.ball(self.scene["center_of_mass"], 0.010 * size, COLORS["center"])]
        points = [contact["point"] for contact in grasp["contacts"]]
        edges = set(hull_edges(points)) | set(grasp["stable_pairs"])
        for i, j in sorted(edges):
            if not (0 <= i < j < len(points)):
                raise BadInput(f"grasp {grasp['number']}: no contacts {i} and {j}")
            stable = (i, j) in grasp["stable_pairs"]
            color = COLORS["stable" if stable else "edge"]
            marks.append(self.tube(points[i], points[j], (0.0032 if stable else 0.0022) * size, color))
        marks += self.contact_marks(grasp, size)
        for contact in grasp["contacts"]:
            marks += self.arrow(
                contact["point"], contact["normal"], 0.085 * size, 0.003 * size, COLORS["contact"]
            )
        marks += self.arrow(
            grasp["palm_center"], grasp["palm_direction"], 0.16 * size, 0.0036 * size, COLORS["palm"]
        )
        return marks

    def add_caption(self, window, grasp):
        s = self.scale
        top = self.renderer(window, (0.0, 0.9, 1.0, 1.0), 0)
        scene = self.scene
        title = f"{scene['object_name']}, {scene['hand_name']} hand, grasp {grasp['number']}"
        measures = measures_text(grasp)
        self.text(top, title, 24 * s, 40 * s, 19, COLORS["ink"], bold=True)
        self.text(top, measures, 24 * s, 12 * s, 16, COLORS["ink"])
        if self.note:
            self.text(top, self.note, (self.width - 24) * s, 42 * s, 13, COLORS["ink"], align="right")
        bottom = self.renderer(window, (0.0, 0.0, 1.0, 0.055), 0)
        self.add_legend(
            bottom,
            24 * s,
            13 * s,
            (
                ("contact", "contact and inward normal"),
                ("stable", "stable pair of contacts"),
                ("edge", "other edge of the contact polygon"),
                ("palm", "palm direction"),
                ("center", "center of mass"),
            ),
        )


# --------------------------------------------------------------------------------------------- main


def main():
    parser = argparse.ArgumentParser(
        prog="render_grasps.py",
        description="Writes DIR/grasp_001.png and so on: pictures of the grasps in DIR/grasps.json.",
    )
    parser.add_argument(
        "folder", metavar="DIR", type=pathlib.Path, help="folder of a plan, or its grasps.json"
    )
    parser.add_argument("--out", metavar="DIR", type=pathlib.Path, help="for pictures (default: the same)")
    parser.add_argument("--width", type=pixels, default=1400, help="pixels (default 1400)")
    parser.add_argument("--height", type=pixels, default=800, help="pixels (default 800)")
    parser.add_argument(
        "--up",
        choices="xyz",
        help="axis of O that points up in the picture (default: y, over a table z)",
    )
    parser.add_argument("--note", metavar="TEXT", default="", help="a line at the upper right")
    arguments = parser.parse_args()
    try:
        file = arguments.folder
        if file.suffix != ".json":
            file = file / "grasps.json"
        out = arguments.out or file.parent
        if not out.is_dir():
            raise BadInput(f"{out}: no such folder")
        scene = read_grasps(file)
        for grasp in scene["grasps"]:
            path = file.parent / f"grasp_{grasp['number']:03d}.obj"
            if not path.is_file():
                raise BadInput(f"{path}: No such file")
        for path in scene["obstacles"]:
            if not path.is_file():
                raise BadInput(f"{path}: No such file")
        go_under_xvfb()
        up = arguments.up or ("y" if scene["table_z"] is None else "z")
        painter = Painter(arguments.width, arguments.height, "xyz".index(up), scene, arguments.note)
        for grasp in scene["grasps"]:
            name = f"grasp_{grasp['number']:03d}"
            picture = painter.paint(grasp, read_parts(file.parent / f"{name}.obj"))
            write_atomically(out / f"{name}.png", picture)
    except BadInput as error:
        print(f"render_grasps.py: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
