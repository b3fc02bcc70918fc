"""The three hands with joints, palm centers and palm directions."""

import numpy as np
from figure_data import BadData, posed, rotation, turned
from figure_style import color_legend, panels, show_picture
from grasp_scene import HAND, PALM, Stage, hand_points, span

# A cell with a grasp of each hand: its record describes the hand.
HANDS = {
    "parallel gripper": ("gallery_kitten", (1.0, 0.35, 0.25)),
    "Barrett hand": ("gallery_duck", (0.9, -0.75, 0.35)),
    "human hand": ("gallery_mug", (0.95, 0.3, 0.75)),
}
INDEPENDENT, COUPLED = "#D55E00", "#56B4E9"
OPENING = 0.15  # joints stand so far from where they are most open, as a share of their range


def pose_matrix(pose):
    matrix = np.eye(4)
    matrix[:3, :3] = rotation(pose["rotation_wxyz"])
    matrix[:3, 3] = pose["translation_m"]
    return matrix


def joint_motion(joint, value):
    """Pose of the child link in the joint frame at a joint's value."""
    motion = np.eye(4)
    axis = np.asarray(joint["axis_J"], dtype=float)
    if joint["type"] == "prismatic":
        motion[:3, 3] = value * axis
    else:
        motion[:3, :3] = rotation([np.cos(value / 2), *(np.sin(value / 2) * axis)])
    return motion


def nearly_open(joints):
    """Joint values by name; coupled joints follow their leaders."""
    values = {}
    for joint in joints:
        low, high = joint["lower"], joint["upper"]
        opened = {1: low + OPENING * (high - low), -1: high - OPENING * (high - low), 0: np.clip(0.0, low, high)}
        values[joint["name"]] = float(opened[joint["closing_sign"]])
    for joint in joints:
        if joint["coupling"]:
            follow = joint["coupling"]
            values[joint["name"]] = follow["ratio"] * values[follow["leader"]] + follow["offset"]
    return values


def forward_kinematics(hand):
    """Pose matrices of links and joints (name -> 4 x 4) in H, joints nearly open."""
    values = nearly_open(hand["joints"])
    links, joints = {hand["palm"]["link"]: np.eye(4)}, {}
    waiting = list(hand["joints"])
    while waiting:
        ready = [joint for joint in waiting if joint["parent_link"] in links]
        if not ready:
            names = ", ".join(joint["name"] for joint in waiting)
            raise BadData(f"hand {hand['name']}: joints that do not come after the palm's link: {names}")
        joint = ready[0]
        waiting.remove(joint)
        joints[joint["name"]] = links[joint["parent_link"]] @ pose_matrix(joint["X_PJ"])
        links[joint["child_link"]] = joints[joint["name"]] @ joint_motion(joint, values[joint["name"]])
    return links, joints


def as_pose(matrix):
    """The pose of a grasp file from a 4 x 4 matrix."""
    r = matrix[:3, :3]
    w = np.sqrt(max(0.0, 1 + r[0, 0] + r[1, 1] + r[2, 2])) / 2
    x = np.copysign(np.sqrt(max(0.0, 1 + r[0, 0] - r[1, 1] - r[2, 2])) / 2, r[2, 1] - r[1, 2])
    y = np.copysign(np.sqrt(max(0.0, 1 - r[0, 0] + r[1, 1] - r[2, 2])) / 2, r[0, 2] - r[2, 0])
    z = np.copysign(np.sqrt(max(0.0, 1 - r[0, 0] - r[1, 1] + r[2, 2])) / 2, r[1, 0] - r[0, 1])
    return {"translation_m": matrix[:3, 3].tolist(), "rotation_wxyz": [w, x, y, z]}


def draw(source):
    stage = Stage(620, 620)
    figure, axes = panels(
        "The three hands: joints, palm centers, palm directions", 1, 3, 9.3, 3.95,
        "Nearly open. Each hand in a scale of its own. Dots: joint axes start there.",
        head=0.5, foot=0.25,
    )  # fmt: skip
    for ax, (name, (cell, back)) in zip(axes[0], HANDS.items()):
        record = source.grasp_file("paper_grasps", cell)
        hand = record["hand"]
        links, joints = forward_kinematics(hand)
        poses = {link: as_pose(matrix) for link, matrix in links.items()}
        meshes = source.link_meshes(record)
        points = hand_points(meshes, poses)
        size = span(points)
        palm_pose = poses[hand["palm"]["link"]]
        center = posed([hand["palm"]["center_H_m"]], palm_pose)[0]
        direction = turned(hand["palm"]["direction_H"], palm_pose)

        def marks(hand=hand, joints=joints, size=size, center=center, direction=direction):
            made = []
            for joint in hand["joints"]:
                at = joints[joint["name"]]
                color = COUPLED if joint["coupling"] else INDEPENDENT
                axis = at[:3, :3] @ np.asarray(joint["axis_J"])
                made.append(stage.colored_ball(at[:3, 3], 0.013 * size, color))
                made += stage.colored_arrow(at[:3, 3], axis, 0.07 * size, 0.0035 * size, color)
            made.append(stage.colored_ball(center, 0.016 * size, PALM))
            return made + stage.colored_arrow(center, direction, 0.22 * size, 0.0055 * size, PALM)

        up = [0.0, 0.0, 1.0] if name == "Barrett hand" else [0.0, 1.0, 0.0]
        back = np.asarray(back) / np.linalg.norm(back)
        solids = stage.hand(meshes, poses, HAND)
        panel = stage.panel(solids, back, up, points, marks)
        independent = sum(1 for joint in hand["joints"] if not joint["coupling"])
        plural = "s" if independent > 1 else ""
        words = f"{len(hand['fingers'])} fingers, {independent} independent joint{plural}"
        show_picture(ax, panel, name, words)
    entries = [(INDEPENDENT, "independent joint"), (COUPLED, "coupled joint"), (PALM, "palm center and direction")]
    color_legend(figure, entries, loc="lower right", bbox_to_anchor=(0.99, 0.0))
    return figure
