#!/usr/bin/python3
"""Pictures of a hand that moves objects about on a table, from the scene of `graspfit motion`.

SCENE is JSON after viewer::motion_scene_json: meshes, and the poses of objects and links in every
frame, in meters, in the world. FILE.gif plays the motion; FILE.png shows where each phase of each
move ends, a row per move. Pictures are written under a temporary name and renamed.

Uses Debian's python3-vtk9 and python3-pil, under xvfb-run where that is installed. Exit code 1 with
one line on bad input or a missing program.
"""

import argparse
import io
import pathlib
import sys

sys.dont_write_bytecode = True  # the folder may be the sources' or root's
from frame_picture import (  # noqa: E402
    decode_poses,
    decoded_pictures,
    gif,
    mapped,
    put,
)
from scene_file import decode_mesh, exit_code, read_scene  # noqa: E402
from vtk_picture import (  # noqa: E402
    COLORS,
    SUPERSAMPLING,
    BadInput,
    Canvas,
    go_under_xvfb,
    pixels,
    unit,
    write_atomically,
)

CAPTION = 44  # height of the strip above the view [pixels]
MOST_FRAMES = 260  # of an animated picture
LAST_FRAME = 2.5  # how long the last frame stays [s]
MARGIN = 0.08  # of the table around what stands on it [m]
BACK = [0.25, -1.0, 0.62]  # toward the eye
HANDLED = (0.86, 0.70, 0.44)  # color of the object that is moved
SHEET_PHASES = ("approach", "lift", "transport", "place", "retreat")


def decode(scene):
    """Decodes objects and poses."""
    for body in scene["objects"]:
        decode_mesh(body["mesh"])
    for key, bodies in (
        ("object_poses", len(scene["objects"])),
        ("link_poses", len(scene["hand"]["links"])),
    ):
        scene[key] = decode_poses(scene[key])
        if len(scene[key]) != bodies * scene["num_frames"]:
            raise ValueError(f"{key} does not fit the number of frames")
    if not scene["moves"]:
        raise ValueError("no move")


class Painter(Canvas):
    """Draws frames into one window."""

    def __init__(self, width, height, scene):
        super().__init__(width, height)
        self.scale = SUPERSAMPLING * min(1.0, width / 640)
        self.scene = scene
        self.scene_window = self.window()
        self.objects = [
            self.solid(o["mesh"]["vertices"], o["mesh"]["faces"], "object", 0.05)
            for o in scene["objects"]
        ]
        self.links = [
            self.solid(link["mesh"]["vertices"], link["mesh"]["faces"], "hand")
            for link in scene["hand"]["links"]
        ]
        low, high = self.extent()
        table = self.table(low, high)
        view = (0.0, 0.0, 1.0, 1.0 - CAPTION / height)
        aspect = width / (height - CAPTION)
        corners = [
            [(low, high)[i][0], (low, high)[j][1], z]
            for i in range(2)
            for j in range(2)
            for z in (0.0, high[2] + 0.12)
        ]
        camera, _ = self.camera(unit(BACK), [0.0, 0.0, 1.0], corners, aspect)
        # Links without a surface have nothing to draw.
        solids = [a for a, link in zip(self.links, scene["hand"]["links"]) if link["mesh"]["faces"]]
        self.add_view(self.scene_window, view, camera, [table, *self.objects, *solids], list)
        self.shaded = self.scene_window.GetRenderers().GetFirstRenderer()
        self.strip = self.renderer(self.scene_window, (0.0, 1.0 - CAPTION / height, 1.0, 1.0), 0)

    def pose(self, frame, i):
        return self.scene["object_poses"][frame * len(self.objects) + i]

    def extent(self):
        """Lowest and highest corner of the table, and of what stands on it."""
        frames = [0] + [move["last"] for move in self.scene["moves"]]
        points = [
            mapped(self.pose(frame, i), v)
            for frame in frames
            for i, o in enumerate(self.scene["objects"])
            for v in o["mesh"]["vertices"][::11]
        ]
        low = [min(p[k] for p in points) - MARGIN for k in range(3)]
        high = [max(p[k] for p in points) + MARGIN * (k < 2) for k in range(3)]
        return low, high

    def table(self, low, high):
        thickness = 0.012
        xs, ys, zs = (low[0], high[0]), (low[1], high[1]), (-thickness, -1e-4)
        vertices = [[x, y, z] for z in zs for y in ys for x in xs]
        faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [1, 3, 7, 5],
            [3, 2, 6, 7],
            [2, 0, 4, 6],
        ]
        return self.solid(vertices, faces, "surroundings", 0.0)

    def paint(self, frame):
        """PNG file of one frame as bytes."""
        move, number, phase = phase_at(self.scene, frame)
        for i, actor in enumerate(self.objects):
            put(self.vtk, actor, self.pose(frame, i))
            actor.GetProperty().SetColor(*(HANDLED if i == move["object"] else COLORS["object"]))
        for i, actor in enumerate(self.links):
            put(self.vtk, actor, self.scene["link_poses"][frame * len(self.links) + i])
        self.shaded.ResetCameraClippingRange()
        self.strip.RemoveAllViewProps()
        name = self.scene["objects"][move["object"]]["name"].replace("_", " ")
        s = self.scale
        shift = self.text(self.strip, f"{number}. {name}", 14 * s, 12 * s, 17, COLORS["ink"], True)
        self.text(self.strip, phase, 30 * s + shift, 12 * s, 17, COLORS["soft"])
        right = SUPERSAMPLING * self.width - 14 * s
        words = f"M {move['m']:.2f}"
        self.text(self.strip, words, right, 12 * s, 15, COLORS["soft"], align="right")
        return self.png(self.scene_window)


def phase_at(scene, frame):
    """The move of a frame, its number from 1 and the name of its phase."""
    for number, move in enumerate(scene["moves"], 1):
        if frame > move["last"]:
            continue
        for phase in move["phases"]:
            if frame <= phase["last"]:
                return move, number, phase["name"]
    raise BadInput(f"frame {frame} is after the last move")


def animation(painter):
    """GIF file as bytes."""
    num_frames = painter.scene["num_frames"]
    stride = -(-num_frames // MOST_FRAMES)
    frames = list(range(0, num_frames, stride))
    delay = max(20, round(1000 * stride * painter.scene["frame_time"]))
    return gif([painter.paint(frame) for frame in frames], delay, round(1000 * LAST_FRAME), 8)


def sheet(painter):
    """PNG file as bytes: ends of the phases, of transport its middle; a row per move."""
    from PIL import Image

    scene = painter.scene
    rows = []
    for move in scene["moves"]:
        ends = {}
        starts = {}
        before = move["first"]
        for phase in move["phases"]:
            starts.setdefault(phase["name"], before)
            ends[phase["name"]] = before = phase["last"]
        ends["transport"] = (starts["transport"] + ends["transport"]) // 2
        rows.append(decoded_pictures([painter.paint(ends[name]) for name in SHEET_PHASES]))
    width, height = rows[0][0].size
    whole = Image.new("RGB", (width * len(SHEET_PHASES), height * len(rows)))
    for y, row in enumerate(rows):
        for x, picture in enumerate(row):
            whole.paste(picture, (x * width, y * height))
    file = io.BytesIO()
    whole.save(file, "PNG", optimize=True)
    return file.getvalue()


def main():
    parser = argparse.ArgumentParser(
        prog="render_motion.py", description="Draws a hand that moves objects about on a table."
    )
    parser.add_argument("scene", metavar="SCENE", type=pathlib.Path, help="JSON of graspfit motion")
    parser.add_argument("picture", metavar="FILE.gif|FILE.png", type=pathlib.Path)
    parser.add_argument("--width", type=pixels, help="of a frame (default 640, in a sheet 400)")
    parser.add_argument("--height", type=pixels, help="of a frame (default 460, in a sheet 290)")
    arguments = parser.parse_args()

    def work():
        kind = arguments.picture.suffix
        if kind not in (".gif", ".png"):
            raise BadInput(f"{arguments.picture}: is neither .gif nor .png")
        scene = read_scene(arguments.scene, "motion", decode)
        go_under_xvfb()
        is_sheet = kind == ".png"
        width = arguments.width or (400 if is_sheet else 640)
        height = arguments.height or (290 if is_sheet else 460)
        painter = Painter(width, height, scene)
        write_atomically(arguments.picture, (sheet if is_sheet else animation)(painter))

    return exit_code("render_motion.py", work)


if __name__ == "__main__":
    sys.exit(main())
