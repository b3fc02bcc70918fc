#!/usr/bin/python3
"""Animated picture of a hold test, from the scene that `graspfit hold --gif` writes.

SCENE is JSON after viewer::replay_scene_json: meshes, and per load the poses of object and links in
every frame, in meters, in the object frame O. FILE.gif shows one load (the one that says most, or
--load NAME) at half speed: hand and object, the commanded load as an arrow once it pulls, the way of the
center of mass, and below shift and turn over their limits as time goes on. A load that is lost ends
shortly after it passed a limit. The picture is written under a temporary name and renamed.

Uses Debian's python3-vtk9 and python3-pil, under xvfb-run where that is installed. Exit code 1 with one
line on bad input or a missing program.
"""

import argparse
import math
import pathlib
import sys
import textwrap

sys.dont_write_bytecode = True  # the folder may be the sources' or root's
from frame_picture import decode_poses, gif, mapped, put, rotated  # noqa: E402
from scene_file import decode_mesh, exit_code, read_scene  # noqa: E402
from vtk_picture import (  # noqa: E402
    COLORS,
    SUPERSAMPLING,
    BadInput,
    Canvas,
    along,
    cross,
    go_under_xvfb,
    perpendicular,
    pixels,
    unit,
    write_atomically,
)

CAPTION, CHART = 62, 92  # heights of the strips above and below the view [pixels]
NOTE_LINE = 16  # height of each line of a note in the strip above [pixels]
NOTE_LETTER = 5  # width of its letters on average [pixels]
FRAME_TIME = 0.04  # of the test per frame of the picture [s]
SLOWNESS = 2.0  # of the picture, over real time
AFTERWARDS = 0.2  # shown after a limit was passed [s]
LAST_FRAME = 2.0  # how long the last frame stays [s]
ABOVE_TABLE = 0.35  # of the eye, over its distance along the table
ARROW = 0.55  # length of the load's arrow, over the object's diagonal


def decode(scene):
    """Decodes object and poses."""
    decode_mesh(scene["object"])
    for load in scene["directions"]:
        for key, bodies in (("object_poses", 1), ("link_poses", len(scene["hand"]["links"]))):
            load[key] = decode_poses(load[key])
            if len(load[key]) != bodies * len(load["times"]) or not load["times"]:
                raise ValueError(f"{key} of load {load['name']} does not fit its times")
    if not 0 <= scene["shown"] < len(scene["directions"]):
        raise ValueError("no load to show")


def frames_to_show(scene, load):
    """Indices of the load's frames: FRAME_TIME apart, not long after a limit is passed."""
    protocol = scene["protocol"]
    end = load["times"][-1]
    for i, t in enumerate(load["times"]):
        is_lost = (
            load["shifts"][i] >= protocol["largest_shift"]
            or load["turns"][i] >= protocol["largest_turn"]
        )
        if is_lost and load["stage"] != "held":
            end = min(end, t + AFTERWARDS)
            break
    shown, wanted = [], 0.0
    for i, t in enumerate(load["times"]):
        if wanted - 1e-9 <= t <= end + 1e-9:
            shown.append(i)
            wanted = t + FRAME_TIME
    return shown


class Painter(Canvas):
    """Draws one load, frame by frame, into one window."""

    def __init__(self, width, height, scene, load):
        super().__init__(width, height)
        self.scale = SUPERSAMPLING * 0.9 * min(1.0, width / 640)
        self.scene, self.load = scene, load
        self.num_links = len(scene["hand"]["links"])
        vertices = scene["object"]["vertices"]
        low, high = ([pick(v[k] for v in vertices) for k in range(3)] for pick in (min, max))
        self.size = math.dist(low, high)
        self.note = textwrap.wrap(self.scene.get("note", ""), (self.width - 32) // NOTE_LETTER)
        self.caption = CAPTION + NOTE_LINE * len(self.note)
        self.scene_window = self.window()
        self.build()

    def build(self):
        """What stands in every frame; poses and marks are set anew for each."""
        window = self.scene_window
        self.body_actors = [
            self.solid(mesh["vertices"], mesh["faces"], color, specular)
            for mesh, color, specular in [(self.scene["object"], "object", 0.05)]
            + [(link["mesh"], "hand", 0.18) for link in self.scene["hand"]["links"]]
        ]
        frame = (0.0, CHART / self.height, 1.0, 1.0 - self.caption / self.height)
        aspect = self.width / (self.height - CHART - self.caption)
        back = self.side()
        up = [0.0, 0.0, 1.0] if abs(back[2]) < 0.97 else [0.0, 1.0, 0.0]
        camera, _ = self.camera(back, up, self.points_in_view(), aspect)
        solids = [
            actor for actor in self.body_actors if actor.GetMapper().GetInputAlgorithm() is not None
        ]
        around = []
        if self.scene["table_z"] is not None:
            around.append(self.table(self.scene["object"]["vertices"], self.scene["table_z"]))
        self.add_view(window, frame, camera, [*solids, *around], list)
        renderers = window.GetRenderers()
        self.shaded, self.above = (renderers.GetItemAsObject(i) for i in (0, 1))
        self.add_axes(window, (0.004, CHART / self.height), camera)
        self.marks = []
        self.add_caption(window)
        self.strip = self.renderer(window, (0.0, 0.0, 1.0, CHART / self.height), 0)

    def pose(self, frame, body):
        """Of the object (body 0) or of a link."""
        if body == 0:
            return self.load["object_poses"][frame]
        return self.load["link_poses"][frame * self.num_links + body - 1]

    def side(self):
        """Toward the eye: across palm direction and load, a little from the palm's front or above a table."""
        palm = self.scene["hand"]["palm"]
        direction = unit(rotated(self.pose(0, 1 + palm["link"]), palm["direction"]))
        across = unit(cross(direction, self.load["direction"]))
        if across is None or abs(sum(x * y for x, y in zip(direction, self.load["direction"]))) > 0.98:
            across = perpendicular(direction)
        if self.scene["table_z"] is not None:
            return unit(along([across[0], across[1], 0.0], [0.0, 0.0, 1.0], ABOVE_TABLE))
        return unit(along(across, direction, 0.25))

    def points_in_view(self):
        points = [list(v) for v in self.scene["object"]["vertices"]]
        center = self.scene["center_of_mass"]
        points += [along(center, self.load["direction"], s * self.size) for s in (ARROW, -0.2)]
        times = self.load["times"]
        grasped = next(
            (i for i, t in enumerate(times) if t >= self.scene["protocol"]["approach_time"] - 1e-9), 0
        )
        for frame in (0, grasped):
            for i, link in enumerate(self.scene["hand"]["links"]):
                pose = self.pose(frame, 1 + i)
                points += [mapped(pose, v) for v in link["mesh"]["vertices"][::7]]
        return points

    def paint(self, frame, shown):
        """PNG file of one frame as bytes; `shown`: the frames of the whole picture."""
        for body, actor in enumerate(self.body_actors):
            put(self.vtk, actor, self.pose(frame, body))
        for renderer, mark in self.marks:
            renderer.RemoveActor(mark)
        self.marks = []
        for opacity, renderer in ((1.0, self.shaded), (0.6, self.above)):
            for mark in self.frame_marks(frame, shown):
                mark.GetProperty().SetOpacity(opacity)
                renderer.AddActor(mark)
                self.marks.append((renderer, mark))
        self.shaded.ResetCameraClippingRange()
        self.draw_chart(frame, shown)
        return self.png(self.scene_window)

    def frame_marks(self, frame, shown):
        """Center of mass, its way so far, and the load once it pulls."""
        protocol, s = self.scene["protocol"], self.size
        ways = [mapped(self.pose(i, 0), self.scene["center_of_mass"]) for i in shown if i <= frame]
        marks = [self.ball(ways[-1], 0.014 * s, COLORS["center"])]
        segments = [(a, b) for a, b in zip(ways, ways[1:]) if math.dist(a, b) > 1e-6]
        if segments:
            marks.append(self.tubes(segments, 0.004 * s, COLORS["edge"]))
        if protocol["is_lift"] or self.load["times"][frame] > protocol["load_start"] + 1e-9:
            marks += self.arrow(
                ways[-1], self.load["direction"], ARROW * s, 0.009 * s, COLORS["contact"]
            )
        return marks

    def add_caption(self, window):
        s = self.scale
        top = self.renderer(window, (0.0, 1.0 - self.caption / self.height, 1.0, 1.0), 0)
        below = NOTE_LINE * len(self.note) * s
        protocol, load = self.scene["protocol"], self.load
        self.text(top, self.scene["title"], 16 * s, 36 * s + below, 17, COLORS["ink"], bold=True)
        pull = "lifted" if protocol["is_lift"] else f"{protocol['force']:g} N along {load['name']}"
        ends = {"held": "held", "load": "lost under load", "approach": "lost before the load"}
        words = f"{protocol['name']}, {pull}: {ends.get(load['stage'], load['stage'])}"
        if load["stage"] == "load" and load["failed_at"] is not None:
            words += f" within {load['failed_at']:.3g} s"
        color = COLORS["stable" if load["stage"] == "held" else "contact"]
        self.text(top, words, 16 * s, 12 * s + below, 15, color)
        for row, line in enumerate(reversed(self.note)):
            self.text(top, line, 16 * s, (8 + NOTE_LINE * row) * s, 12, COLORS["ink"])

    def draw_chart(self, frame, shown):
        """Shift and turn over their limits, up to now; the line is the limit."""
        s = self.scale
        self.strip.RemoveAllViewProps()
        protocol, load = self.scene["protocol"], self.load
        width = SUPERSAMPLING * self.width
        left, right, bottom, top = 24 * s, width - 24 * s, 12 * s, 62 * s
        end = load["times"][shown[-1]] or 1.0
        most = 1.4  # limits; more is cut off

        def pixel(t, share):
            return left + (right - left) * t / end, bottom + (top - bottom) * min(share, most) / most

        start = pixel(min(protocol["load_start"], end), 0.0)[0]
        shade = [(start, bottom), (right, bottom), (right, top), (start, top)]
        self.flat_shape(self.strip, shade, (0.95, 0.96, 0.97))
        self.flat_shape(self.strip, [pixel(0.0, 0.0), pixel(end, 0.0)], COLORS["soft"], s)
        self.flat_shape(self.strip, [pixel(0.0, 1.0), pixel(end, 1.0)], COLORS["contact"], s)
        for key, color in (("shift", "hand"), ("turn", "palm")):
            limit = protocol[f"largest_{key}"]
            points = [pixel(load["times"][i], load[f"{key}s"][i] / limit) for i in shown if i <= frame]
            if len(points) > 1:
                self.flat_shape(self.strip, points, COLORS[color], 2.4 * s)
        x, y = left, 70 * s
        for words, color in (
            (f"{load['times'][frame]:.2f} s", "ink"),
            (
                f"shift {1000 * load['shifts'][frame]:.1f} of {1000 * protocol['largest_shift']:g} mm",
                "hand",
            ),
            (
                f"turn {math.degrees(load['turns'][frame]):.1f} of "
                f"{math.degrees(protocol['largest_turn']):.3g}°",
                "palm",
            ),
            ("limit", "contact"),
        ):
            self.text(self.strip, words, x, y, 13, COLORS[color])
            x += (70 if color == "ink" else 190) * s


def animation(painter, shown):
    """GIF file as bytes."""
    pictures = [painter.paint(frame, shown) for frame in shown]
    return gif(pictures, round(1000 * FRAME_TIME * SLOWNESS), round(1000 * LAST_FRAME))


def main():
    parser = argparse.ArgumentParser(
        prog="render_hold.py", description="Writes an animated picture of a hold test."
    )
    parser.add_argument("scene", metavar="SCENE", type=pathlib.Path, help="JSON of graspfit hold")
    parser.add_argument("picture", metavar="FILE.gif", type=pathlib.Path)
    parser.add_argument("--load", metavar="NAME", help="+x ... -z or lift (default: what says most)")
    parser.add_argument("--width", type=pixels, default=640, help="pixels (default 640)")
    parser.add_argument("--height", type=pixels, default=620, help="pixels (default 620)")
    arguments = parser.parse_args()

    def work():
        scene = read_scene(arguments.scene, "hold test", decode)
        loads = {load["name"]: load for load in scene["directions"]}
        name = arguments.load or scene["directions"][scene["shown"]]["name"]
        if name not in loads:
            raise BadInput(f"no load named {name}; there are {', '.join(loads)}")
        go_under_xvfb()
        load = loads[name]
        painter = Painter(arguments.width, arguments.height, scene, load)
        write_atomically(arguments.picture, animation(painter, frames_to_show(scene, load)))

    return exit_code("render_hold.py", work)


if __name__ == "__main__":
    sys.exit(main())
