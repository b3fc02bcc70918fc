#!/usr/bin/python3
"""Picture of a hand in some poses, from the scene that `graspfit hand show --png` writes.

SCENE is JSON after viewer::hand_scene_json: meshes of the links, joints, pads, palm and the poses, in
meters, in the palm's frame H. A column per pose, a row per view, all in one parallel projection, so that
every scale bar holds and poses compare. Links are shaded, joints are dots with their axes (gray where
they follow another joint), palm center and direction an arrow, pads plates, clip volumes seen through.
The picture is written under a temporary name and renamed.

Uses Debian's python3-vtk9, under xvfb-run where that is installed. Exit code 1 with one line on bad
input or a missing program.
"""

import argparse
import math
import pathlib
import sys

sys.dont_write_bytecode = True  # the folder may be the sources' or root's
from scene_file import exit_code, read_scene  # noqa: E402
from vtk_picture import (  # noqa: E402
    COLORS,
    SUPERSAMPLING,
    BadInput,
    Canvas,
    along,
    go_under_xvfb,
    pixels,
    unit,
    write_atomically,
)

CAPTION, LEGEND = 64, 40  # heights of the strips above and below [pixels]
STRIP = 40  # below each view: its name and scale bar [pixels]


def decode(scene):
    """Checks that there is something to draw."""
    if not (scene["poses"] and scene["views"] and scene["plates"] is not None):
        raise ValueError("no pose or no view")


# Poses are column-major 4x4.


def rotated(X, v):
    return [X[i] * v[0] + X[4 + i] * v[1] + X[8 + i] * v[2] for i in range(3)]


def mapped(X, p):
    return [a + X[12 + i] for i, a in enumerate(rotated(X, p))]


class Painter(Canvas):
    """Draws the poses of one hand."""

    def __init__(self, width, height, scene):
        super().__init__(width, height)
        self.scale = SUPERSAMPLING * 0.9
        self.scene = scene
        self.hand = scene["hand"]

    def paint(self, views):
        """PNG file as bytes."""
        window = self.window()
        poses = self.scene["poses"]
        parts = [self.parts(pose["X_HL"]) for pose in poses]
        points = [v for part in parts for vertices, _ in part for v in vertices]
        palm = self.palm(poses[0]["X_HL"])
        points = points or [along(palm[0], d, 0.1) for d in ([1, 1, 1], [-1, -1, -1])]
        low, high = ([pick(p[k] for p in points) for k in range(3)] for pick in (min, max))
        size = math.dist(low, high)
        points.append(along(*palm, self.arrow_length(size)))

        body = self.height - CAPTION - LEGEND
        row_height = body / len(views)
        for row, view in enumerate(views):
            top = LEGEND + body - row * row_height
            for column, pose in enumerate(poses):
                left, right = column / len(poses), (column + 1) / len(poses)
                bottom = (top - row_height + STRIP) / self.height
                aspect = (right - left) * self.width / (row_height - STRIP)
                camera, height_m = self.camera(view["back"], view["up"], points, aspect)
                self.add_view(
                    window,
                    (left, bottom, right, top / self.height),
                    camera,
                    self.solids(pose["X_HL"], parts[column]),
                    lambda: self.marks(pose["X_HL"], size),
                )
                if column == 0:
                    self.add_axes(window, (0.004, (top - row_height) / self.height), camera)
                strip = (left, (top - row_height) / self.height, right, bottom)
                name = pose["name"] if len(views) == 1 else f"{pose['name']}, {view['name']}"
                per_pixel = height_m / (SUPERSAMPLING * (row_height - STRIP))
                self.add_scale_bar(window, strip, name, per_pixel)
        self.add_caption(window)
        return self.png(window)

    @staticmethod
    def arrow_length(size):
        return 0.22 * size

    def parts(self, X_HL):
        return [
            ([mapped(X, v) for v in link["mesh"]["vertices"]], link["mesh"]["faces"])
            for link, X in zip(self.hand["links"], X_HL)
        ]

    def palm(self, X_HL):
        palm = self.hand["palm"]
        X = X_HL[palm["link"]]
        return mapped(X, palm["center"]), unit(rotated(X, palm["direction"]))

    def pad_points(self, pad, points, X_HL):
        return [mapped(X_HL[pad["link"]], mapped(pad["X_LC"], p)) for p in points]

    def solids(self, X_HL, parts):
        solids = [self.solid(vertices, faces, "hand") for vertices, faces in parts if faces]
        for pad, plate in zip(self.hand["pads"], self.scene["plates"]):
            points = self.pad_points(pad, plate["points"], X_HL)
            solids.append(self.flat(self.solid(points, plate["faces"], "pad")))
        for pad in self.hand["pads"]:
            if not pad["clip"]:
                continue
            points = self.pad_points(pad, pad["clip"]["points"], X_HL)
            volume = self.flat(self.solid(points, pad["clip"]["faces"], "clip"))
            volume.GetProperty().SetOpacity(0.3)
            solids.append(volume)
        return solids

    def marks(self, X_HL, size):
        """Joints with their axes, palm center and direction, edges of clip volumes."""
        marks = []
        for joint in self.hand["joints"]:
            X = X_HL[joint["child"]]
            center, axis = mapped(X, [0.0, 0.0, 0.0]), unit(rotated(X, joint["axis"]))
            color = COLORS["follower" if joint["is_coupled"] else "joint"]
            marks.append(self.ball(center, 0.011 * size, color))
            start = along(center, axis, -0.045 * size)
            if joint["is_angle"]:
                end = along(center, axis, 0.045 * size)
                marks.append(self.tube(start, end, 0.003 * size, color))
            else:
                marks += self.arrow(start, axis, 0.09 * size, 0.003 * size, color)
        center, direction = self.palm(X_HL)
        marks.append(self.ball(center, 0.014 * size, COLORS["palm"]))
        marks += self.arrow(
            center, direction, self.arrow_length(size), 0.0055 * size, COLORS["palm"]
        )
        for pad in self.hand["pads"]:
            if not pad["clip"]:
                continue
            points = self.pad_points(pad, pad["clip"]["points"], X_HL)
            edges = [(points[i], points[j]) for i, j in pad["clip"]["edges"]]
            marks.append(self.tubes(edges, 0.0009 * size, COLORS["clip"]))
        return marks

    def add_caption(self, window):
        s = self.scale
        joints = self.hand["joints"]
        free = sum(not joint["is_coupled"] for joint in joints)
        counts = (
            f"{len(self.hand['fingers'])} fingers, {len(joints)} joints, {free} independent, "
            f"{len(self.hand['pads'])} pads"
        )
        top = self.renderer(window, (0.0, 1.0 - CAPTION / self.height, 1.0, 1.0), 0)
        self.text(top, self.hand["name"], 24 * s, 34 * s, 19, COLORS["ink"], bold=True)
        self.text(top, counts, 24 * s, 10 * s, 15, COLORS["ink"])
        bottom = self.renderer(window, (0.0, 0.0, 1.0, LEGEND / self.height), 0)
        entries = [("joint", "joint and its axis")]
        if free < len(joints):
            entries.append(("follower", "coupled joint"))
        entries += [("palm", "palm center and direction"), ("pad", "pad"), ("clip", "clip volume")]
        self.add_legend(bottom, 24 * s, 12 * s, entries)


def main():
    parser = argparse.ArgumentParser(
        prog="render_hand.py", description="Writes a picture of a hand in some poses."
    )
    parser.add_argument("scene", metavar="SCENE", type=pathlib.Path, help="JSON of hand show")
    parser.add_argument("picture", metavar="FILE.png", type=pathlib.Path)
    parser.add_argument("--views", metavar="NAME,...", default="oblique,side", help="rows, from the top")
    parser.add_argument("--panel-width", type=pixels, default=460, help="pixels (default 460)")
    parser.add_argument("--panel-height", type=pixels, default=400, help="pixels (default 400)")
    arguments = parser.parse_args()

    def work():
        scene = read_scene(arguments.scene, "hand", decode)
        known = {view["name"]: view for view in scene["views"]}
        views = []
        for name in arguments.views.split(","):
            if name not in known:
                raise BadInput(f"no view named {name}; there are {', '.join(known)}")
            views.append(known[name])
        go_under_xvfb()
        width = max(760, arguments.panel_width * len(scene["poses"]))
        height = arguments.panel_height * len(views) + CAPTION + LEGEND
        picture = Painter(width, height, scene).paint(views)
        write_atomically(arguments.picture, picture)

    return exit_code("render_hand.py", work)


if __name__ == "__main__":
    sys.exit(main())
