"""Human hand (right) with 20 joints, in three sizes, and with coupled end joints.

Numbers in millimeters and degrees. Frame H: origin at GraspIt!'s reference point of the approach
direction, z the palm direction, y toward the fingertips, x toward the thumb. Frames of finger
links: x along the bone from its joint, y the closing side, z the flexion axis.
"""

import math
from pathlib import Path

import numpy as np

from generator.hand_files import (Description, bulging_pad, json_text, markdown_table, mesh_sizes, meters, number,
                                  obj_text, quaternion, rounded, sidecar, table_rows, write_files)
from generator.ring_meshes import signed_volume
from generator.smooth_surface import (blend, cut, ellipsoid, half_space, heights_along, meshed, moved,
                                      normal_at, round_cone, stretched, turned_x)

# --------------------------------------------------------------------------------------------------
# Sources
#   [GS]   GraspIt! models/robots/HumanHand/HumanHand20DOF.xml: joints, bones, limits, approach
#   [GM]   extents measured on GraspIt!'s link meshes of that hand; only numbers were taken
#   [HMI]  hmi.neurophysics hand constraints: DIP = 2/3 PIP
#   [IJM]  International Journal of Morphology, art. 1830: male hand length 185 mm
#   [own]  our choice where no source says a number; the reason stands beside it
# Points and axes of [GS] are in its palm frame G: fingers along -x, palm direction -y, thumb side +z.
# --------------------------------------------------------------------------------------------------
HUMAN = {
    # Kinematics -----------------------------------------------------------------------------------
    "reference_G": (-130.0, -15.0, 0.0),              # [GS] approach reference: the origin of H
    "index_base_G": (-140.06, 11.20, 36.42),          # [GS]
    "middle_base_G": (-145.66, 11.20, 8.40),          # [GS]
    "ring_base_G": (-145.66, 5.60, -19.61),           # [GS]
    "little_base_G": (-134.46, -8.40, -42.02),        # [GS]
    "thumb_base_G": (-50.62, -11.51, 18.93),          # [GS]
    "index_bones": (43.19, 29.56, 25.35),             # [GS] proximal, middle, distal
    "middle_bones": (46.20, 30.99, 29.20),            # [GS]
    "ring_bones": (39.12, 28.31, 24.48),              # [GS]
    "little_bones": (29.91, 21.10, 23.16),            # [GS]
    "thumb_bones": (52.12, 40.76, 37.0),              # [GS] metacarpal, proximal; [GM] the distal one, to its tip
    "index_abduction": 20.0,                          # [GS] plus and minus; positive toward the thumb
    "middle_abduction": 10.0,                         # [GS]
    "ring_abduction": 20.0,                           # [GS]
    "little_abduction": 30.0,                         # [GS]
    "flexion": (-10.0, 90.0),                         # [GS] each of the three
    "thumb_axis_x_G": (-0.1486, -0.9003, 0.4089),     # [GS] rotation of the thumb's base
    "thumb_axis_y_G": (0.2665, 0.3618, 0.8933),       # [GS]
    "thumb_abduction": (-10.0, 70.0),                 # [GS] joint 1, positive away from the palm's middle
    "thumb_cmc": (-50.0, 25.0),                       # [GS] joint 2, positive toward the palm
    "thumb_cmc_offset": 49.5,                         # [GS]
    "thumb_twist": 44.0,                              # [GS] of the metacarpal
    "thumb_mcp": (0.0, 90.0),                         # [GS]
    "thumb_mcp_offset": 5.0,                          # [GS]
    "thumb_ip": (0.0, 100.0),                         # [GS]
    "thumb_ip_offset": -5.0,                          # [GS] 85 less the quarter turn between its frames
    "dip_ratio": 2.0 / 3.0,                           # [HMI] DIP = 2/3 PIP, hand with coupled end joints only
    # Sizes ------------------------------------------------------------------------------------------
    "wrist_crease_G": -40.0,                          # [GM] the palm's narrowest section
    "medium_length": 185.0,                           # [IJM] mean of men, wrist crease to middle fingertip
    "small_length": 165.0,                            # [own] about a tenth below the mean of men
    # Flesh: half widths at knuckle, PIP, DIP and tip ------------------------------------------------
    "index_radii": (12.8, 11.6, 10.2, 7.6),           # [GM] 13.0, 11.6, 10.6, 7.7
    "middle_radii": (13.0, 11.4, 9.9, 7.4),           # [GM] 13.1, 11.3, 10.1, 7.4
    "ring_radii": (12.2, 10.9, 9.6, 7.0),             # [GM] 12.1, 10.9, 9.5, 6.7
    "little_radii": (11.0, 9.6, 8.6, 6.0),            # [GM] 11, 9.1, 9.0, 5.6
    "thumb_radii": (19.0, 14.2, 12.4, 8.6),           # [GM] CMC, MCP 14 to 16, IP 12.4, tip 8
    "metacarpal_radius": 14.0,                        # [GM] knuckle to back of the hand, 14 to 18
    "wrist_half": (36.0, 26.0),                       # [GM] 74 wide, 54 thick
    "wrist_end_G": 0.0,                               # [GM] the palm ends flat there, behind the wrist
    "density_g_cm3": 1.1,                             # [own] about that of muscle and bone together
}

HUMAN_SOURCES = {
    "GS": "GraspIt!, models/robots/HumanHand/HumanHand20DOF.xml (github graspit-simulator/graspit): bases, "
          "bones, joint limits, thumb frame, approach reference. The description that the paper's "
          "reference [18] ships.",
    "GM": "Extents measured on the link meshes of that hand. Only numbers were taken.",
    "HMI": "Hand project of hmi.neurophysics, table of hand constraints: DIP = 2/3 PIP as a natural coupling.",
    "IJM": "International Journal of Morphology, article 1830: mean length of the male hand, 185 mm.",
    "own": "Chosen here; the reason stands beside the number in generator/human_hand.py.",
}

FINGERS = ("index", "middle", "ring", "little")
DIGITS = (*FINGERS, "thumb")


def vector_H(v_G):
    return np.array([v_G[2], -v_G[0], -v_G[1]])


def point_H(p, name):
    return vector_H([a - b for a, b in zip(p[name], p["reference_G"])])


# --------------------------------------------------------------------------------------------------
# Kinematics
# --------------------------------------------------------------------------------------------------
def rotation_x(angle_deg):
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rotation_z(angle_deg):
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def roll_pitch_yaw(m):
    return (math.atan2(m[2][1], m[2][2]), -math.asin(max(-1.0, min(1.0, m[2][0]))),
            math.atan2(m[1][0], m[0][0]))


FINGER_AXES = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # x_L = y_H, y_L = z_H, z_L = x_H


def thumb_axes(p):
    """The thumb's base frame in H; the file's four digits made orthonormal, x kept."""
    x, y = vector_H(p["thumb_axis_x_G"]), vector_H(p["thumb_axis_y_G"])
    x = x / math.sqrt(x @ x)
    y = y - (x @ y) * x
    y = y / math.sqrt(y @ y)
    return np.column_stack([x, y, np.cross(x, y)])


def joints(p):
    """(name, parent, child, origin mm, rotation, axis, limits deg) from the palm outward."""
    result = []
    for f in FINGERS:
        a = p[f"{f}_abduction"]
        l1, l2, _ = p[f"{f}_bones"]
        result += [
            # About the palm's normal, turned so that positive is toward the thumb.
            (f"{f}_abduction", "palm", f"{f}_knuckle", point_H(p, f"{f}_base_G"), FINGER_AXES, (0, -1, 0),
             (-a, a)),
            (f"{f}_mcp", f"{f}_knuckle", f"{f}_proximal", (0, 0, 0), np.eye(3), (0, 0, 1), p["flexion"]),
            (f"{f}_pip", f"{f}_proximal", f"{f}_middle", (l1, 0, 0), np.eye(3), (0, 0, 1), p["flexion"]),
            (f"{f}_dip", f"{f}_middle", f"{f}_distal", (l2, 0, 0), np.eye(3), (0, 0, 1), p["flexion"])]
    l0, l1, _ = p["thumb_bones"]
    result += [
        ("thumb_abduction", "palm", "thumb_base", point_H(p, "thumb_base_G"), thumb_axes(p), (0, 0, 1),
         p["thumb_abduction"]),
        ("thumb_cmc", "thumb_base", "thumb_metacarpal", (0, 0, 0),
         rotation_x(90.0) @ rotation_z(p["thumb_cmc_offset"]), (0, 0, 1), p["thumb_cmc"]),
        ("thumb_mcp", "thumb_metacarpal", "thumb_proximal", (l0, 0, 0),
         rotation_x(p["thumb_twist"]) @ rotation_z(p["thumb_mcp_offset"]), (0, 0, 1), p["thumb_mcp"]),
        ("thumb_ip", "thumb_proximal", "thumb_distal", (l1, 0, 0), rotation_z(p["thumb_ip_offset"]),
         (0, 0, 1), p["thumb_ip"])]
    return result


def digit_links(digit):
    return ([f"{digit}_base", f"{digit}_metacarpal", f"{digit}_proximal", f"{digit}_distal"]
            if digit == "thumb" else
            [f"{digit}_knuckle", f"{digit}_proximal", f"{digit}_middle", f"{digit}_distal"])


# --------------------------------------------------------------------------------------------------
# Flesh
# --------------------------------------------------------------------------------------------------
NEST = 0.97  # [own] a link's ball at its joint sits inside its parent's, so that no gap opens


def phalanx(length, r0, r1):
    """A bone's flesh between two joints: a round cone with a cushion on the closing side."""
    mean = 0.5 * (r0 + r1)
    cushion = ellipsoid((0.5 * length, 0.16 * mean, 0.0), (0.42 * length, 0.98 * mean, 0.86 * mean))
    return blend(3.0, round_cone((0, 0, 0), (length, 0, 0), NEST * r0, r1), cushion)


def fingertip(length, r0, r1):
    """The end of a finger: flatter toward its tip at x = length, with the pulp on the closing side and
    the bed of the nail on the back."""
    core = round_cone((0, 0, 0), (length - r1, 0.12 * r0, 0), NEST * r0, r1)
    pulp = ellipsoid((0.54 * length, 0.22 * r0, 0.0), (0.37 * length, 0.84 * r0, 0.88 * r0))
    nail = half_space((0.72 * length, -0.56 * r0, 0.0), (0.2, -1.0, 0.0))
    return cut(1.2, blend(4.0, core, pulp), nail)


def metacarpal_of_thumb(p):
    """The thumb's root with its ball of muscle, which lies toward the palm's middle (+z)."""
    length, (r0, r1) = p["thumb_bones"][0], p["thumb_radii"][:2]
    bone = round_cone((2, 0, 0), (length, 0, 0), 0.8 * r0, r1)
    muscle = ellipsoid((0.34 * length, -1.5, 0.5 * r0), (0.6 * length, 0.84 * r0, 0.92 * r0))
    return blend(10.0, bone, muscle)


def palm_field(p):
    knuckles = {f: point_H(p, f"{f}_base_G") for f in FINGERS}
    carpus = {"index": (12.0, -84.0, -20.0), "middle": (3.0, -86.0, -20.0), "ring": (-8.0, -86.0, -19.0),
              "little": (-18.0, -84.0, -17.0)}
    r = p["metacarpal_radius"]
    bones = [round_cone(carpus[f], knuckles[f], r + 2.0, p[f"{f}_radii"][0] + 0.9) for f in FINGERS]
    back = blend(7.0, *bones)
    cushion = ellipsoid((1.0, -26.0, -15.0), (42.0, 50.0, 13.5))
    little_side = ellipsoid((-31.0, -58.0, -15.0), (16.0, 38.0, 15.0))
    wx, wz = p["wrist_half"]
    wrist = stretched(round_cone((0, -60, 0), (0, -170, 0), 30.0, 30.0),
                      ((wx - 3.0) / 30.0, 1.0, (wz - 3.0) / 30.0))
    wrist = moved(wrist, (-2.0, 0.0, -17.0))
    root = point_H(p, "thumb_base_G")
    thumb_root = round_cone(root + np.array([-1.0, -4.0, -5.0]), (22.0, -52.0, -18.0), 15.0, 13.0)
    web = round_cone(root + np.array([6.0, 14.0, -8.0]), (32.0, -26.0, -24.0), 11.0, 9.0)
    hand = blend(9.0, back, cushion, little_side, thumb_root, web)
    middle = (-1.0, -35.0, -13.2)  # of the palm: the only part that bulges where a pad can lie
    hand = blend(4.0, hand, turned_x(ellipsoid(middle, (33.0, 33.0, 18.5)), -10.0, middle))
    hand = blend(20.0, hand, wrist)
    return cut(10.0, hand, half_space((0.0, p["reference_G"][0] - p["wrist_end_G"], 0.0), (0.0, -1.0, 0.0)))


def fields(p):
    """{mesh: (field, low, high, cell)} in link frames."""
    result = {"palm": (palm_field(p), (-75, -145, -70), (75, 45, 45), 6.0)}
    for f in FINGERS:
        l, r = p[f"{f}_bones"], p[f"{f}_radii"]
        for k, part in enumerate(("proximal", "middle", "distal")):
            body = fingertip(l[k], r[k], r[k + 1]) if part == "distal" else phalanx(l[k], r[k], r[k + 1])
            result[f"{f}_{part}"] = (body, (-18, -20, -20), (l[k] + 20, 20, 20), 3.1)
    l, r = p["thumb_bones"], p["thumb_radii"]
    result["thumb_metacarpal"] = (metacarpal_of_thumb(p), (-40, -40, -40), (l[0] + 30, 45, 40), 4.4)
    result["thumb_proximal"] = (phalanx(l[1], r[1], r[2]), (-22, -24, -24), (l[1] + 22, 26, 24), 3.4)
    result["thumb_distal"] = (fingertip(l[2], r[2], r[3]), (-20, -22, -22), (l[2] + 20, 24, 22), 3.1)
    return result


# --------------------------------------------------------------------------------------------------
# Pads
# --------------------------------------------------------------------------------------------------
def dome(field, center, axes, half_length, half_width, sides, reach):
    """Origin (in the pad's plane), outline and bulge of the patch of surface under an ellipse that is
    laid on it from along the z axis (third column of `axes`): the plane goes through the lowest corner
    of its rim."""
    x, y, z = (axes[:, k] for k in range(3))
    # Corners left and right of the axes, so that the outline is symmetric.
    angles = [2.0 * math.pi * (k + 0.5) / sides for k in range(sides)]
    points = [(share * half_length * math.cos(a), share * half_width * math.sin(a))
              for share in (1.0, 0.82, 0.52) for a in angles] + [(0.0, 0.0)]
    heights = heights_along(field, [center + u * x + v * y for u, v in points], z, -reach, reach)
    base = float(heights[:sides].min())
    surface = [(u, v, float(h) - base) for (u, v), h in zip(points, heights)]
    return center + base * z, points[:sides], [s for s in surface if s[2] > 1e-6]


def tilted(angle_deg):
    """Axes of a pad on a finger link: x along the bone, z the closing side, turned toward the tip."""
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    x, z = np.array([c, -s, 0.0]), np.array([s, c, 0.0])
    return np.column_stack([x, np.cross(z, x), z])


def pads(p, bodies):
    """(name, link, finger, origin mm, axes, outline mm, bulge mm)."""
    result = []

    def add(name, link, finger, center, axes, half_length, half_width, sides=12, reach=40.0):
        origin, outline, surface = dome(bodies[link][0], np.asarray(center, dtype=float), axes, half_length,
                                        half_width, sides, reach)
        result.append((name, link, finger, origin, axes, outline, surface))

    for digit in DIGITS:
        l, r = p[f"{digit}_bones"], p[f"{digit}_radii"]
        parts = ("metacarpal", "proximal", "distal") if digit == "thumb" else ("proximal", "middle", "distal")
        for k, part in enumerate(parts):
            link = f"{digit}_{part}"
            if part == "distal":
                add(f"{link}_pad", link, digit, (0.58 * l[k], 0.0, 0.0), tilted(14.0), 0.3 * l[k], 0.68 * r[k])
            elif part != "metacarpal":
                add(f"{link}_pad", link, digit, (0.5 * l[k], 0.0, 0.0), tilted(0.0), 0.27 * l[k], 0.68 * r[k])
    # On the palm along the surface's own normal.
    u, v = -1.0, -30.0
    palm = bodies["palm"][0]
    top = float(heights_along(palm, [(u, v, 0.0)], (0.0, 0.0, 1.0), -40.0, 40.0)[0])
    z = normal_at(palm, (u, v, top))
    x = np.array([1.0, 0.0, 0.0]) - z[0] * z
    x = x / math.sqrt(float(x @ x))
    add("palm_pad", "palm", "palm", (u, v, top), np.column_stack([x, np.cross(z, x), z]), 17.0, 15.0)
    return result


# --------------------------------------------------------------------------------------------------
# Files
# --------------------------------------------------------------------------------------------------
def hand_length(p):
    """Wrist crease to the tip of the middle finger."""
    return p["wrist_crease_G"] - p["middle_base_G"][0] + sum(p["middle_bones"])


def human_urdf(p, meshes, name, scale, mesh_folder):
    urdf = Description(name, {"skin": "0.93 0.76 0.65 1"},
                       "sources in SOURCE.md" if name == "human_hand" else "sources in ../human_hand/SOURCE.md")

    def link(link_name):
        if link_name not in meshes:  # between the two axes of a base joint
            urdf.link(link_name)
            return
        mass = p["density_g_cm3"] * 1e-6 * scale ** 3 * signed_volume(meshes[link_name])
        urdf.link(link_name, f"{mesh_folder}/{link_name}.obj", "skin", round(mass, 6), meshes[link_name], scale)

    link("palm")
    for joint_name, parent, child, origin, rotation, axis, limits in joints(p):
        link(child)
        urdf.joint(joint_name, parent, child, [scale * c for c in origin], roll_pitch_yaw(rotation), axis,
                   [math.radians(d) for d in limits])
    return urdf.text()


def human_sidecar(p, pad_list, name, scale, is_coupled):
    closing = {}
    exclusions = []
    for digit in DIGITS:
        links = digit_links(digit)
        bases = ["thumb_cmc", "thumb_mcp", "thumb_ip"] if digit == "thumb" else [
            f"{digit}_mcp", f"{digit}_pip", f"{digit}_dip"]
        closing.update({joint: 1 for joint in bases})
        exclusions += [["palm", links[1]], [links[1], links[2]], [links[2], links[3]]]
    couplings = [{"joint": f"{f}_dip", "leader": f"{f}_pip", "ratio": p["dip_ratio"], "offset": 0.0,
                  "breakaway": False} for f in FINGERS] if is_coupled else []
    text = (f"Right human hand of {number(round(scale * hand_length(p), 1))} mm from wrist crease to middle "
            "fingertip, after GraspIt!'s; ")
    text += ("16 independent joints: the end joint of each finger follows the middle one by two thirds."
             if is_coupled else "20 independent joints: 4 per finger.")
    return sidecar(
        name, text,
        [{"name": digit, "thumb": digit == "thumb", "links": digit_links(digit),
          "joints": [j[0] for j in joints(p) if j[0].startswith(digit)],
          "swing_joint": f"{digit}_abduction", "tip_pad": f"{digit}_distal_pad"} for digit in DIGITS],
        [bulging_pad(pad, link, finger, scale * origin, [axes[:, k] for k in range(3)],
                     [[scale * c for c in corner] for corner in outline],
                     [[scale * c for c in point] for point in surface])
         for pad, link, finger, origin, axes, outline, surface in pad_list],
        {"link": "palm", "center_m": [0.0, 0.0, 0.0], "direction": [0.0, 0.0, 1.0], "pad": "palm_pad"},
        closing, couplings, exclusions)


SIZES = (("human_hand", None, False), ("human_hand_medium", "medium_length", False),
         ("human_hand_small", "small_length", False), ("human_hand_coupled", None, True))


def human_source(p, meshes):
    native = hand_length(p)
    lines = ["# Human hand: where every number comes from", "",
             "Written by `generate.py` together with the description, the sidecar and the meshes; edit "
             "that, not these.", "",
             "A right hand with the 20 joints of GraspIt!'s human hand, which are the paper's. All shapes are our "
             "own: smooth closed bodies around the bones, built from the numbers below; no mesh was copied.", "",
             "## Sources", ""]
    lines += [f"- **{key}**: {text}" for key, text in HUMAN_SOURCES.items()]
    lines += ["", "## Numbers (mm, degrees)", ""]
    lines += markdown_table(["item", "value", "source"],
                            [(f"`{item}`", value, source)
                             for item, value, source in table_rows(Path(__file__), "HUMAN")])
    lines += ["", "What shapes the flesh besides (cushions, blends, cuts) stands in the functions of "
              "generator/human_hand.py and is our own: fitted by eye to the extents above."]
    rows = []
    for name, length, is_coupled in SIZES:
        size = p[length] if length else native
        rows.append([f"`{name}`", number(round(size, 1)), f"{size / native:.4f}", "16" if is_coupled else "20"])
    lines += ["", "## Hands", "",
              *markdown_table(["hand", "wrist crease to middle fingertip (mm)", "scale", "independent joints"], rows),
              "",
              "All use the meshes of `human_hand`, scaled. GraspIt!'s hand is a large one: its middle finger "
              f"measures {number(round(sum(p['middle_bones']), 1))} mm from the knuckle joint. The coupled hand is "
              "of that size too; its index, middle, ring and little end joints follow the middle joints by two "
              "thirds, clamped to their own limits.",
              "", "## Frames and joints", "",
              "- H is the palm link's frame: origin at GraspIt!'s reference point of the approach direction, z the "
              "palm direction, y toward the fingertips, x toward the thumb. From GraspIt!'s palm frame G: x_H = z_G, "
              "y_H = -x_G - 130, z_H = -y_G - 15.",
              "- Finger links: x along the bone from its joint, y the closing side, z the flexion axis. The joint "
              "positions are GraspIt!'s; its link frames stand at the far ends of the bones.",
              "- `*_abduction` are the swing joints, 0 with the fingers parallel, positive toward the thumb. "
              "`*_mcp`, `*_pip`, `*_dip` close with growing position.",
              "- Thumb: `thumb_abduction` and `thumb_cmc` are GraspIt!'s first two joints. The first turns the thumb "
              "around an axis about along the hand, -10 under the index finger, 70 beside the palm; the second "
              "lifts it out of the palm (-50) or lays it to the index finger (25), so that it closes with growing "
              "position. `thumb_mcp` and `thumb_ip` flex. `thumb_ip` contains GraspIt!'s offset of 85 degrees less "
              "the 90 between its two frames.",
              "- Between the two axes of a base joint stands a link without a mesh (`*_knuckle`, `thumb_base`).",
              "", "## Pads", "",
              "Convex patches of skin, about regular (12 corners): on the closing side of every "
              "finger link, and one on the middle of the palm. Each is the surface under an ellipse laid on it along "
              "the pad's z; the pad's plane goes through the lowest corner of its rim, and 2 inner rings and the "
              "middle follow the skin. Fingertip pads lean 14 degrees toward the tip, where a pinch touches. Corners "
              "lie on the smooth surface from which the meshes are made, the meshes' vertices too: between them both "
              "run a little below it, each on its own; they differ by less than 0.4 mm.",
              "- The palm's pad is the only part of the palm that bulges; it leans 18 degrees from the palm "
              "direction toward the fingers.",
              "", "## Sizes of the meshes (mm)", "", *mesh_sizes(meshes),
              "", "Links that share a joint overlap there, each with its ball inside its parent's, so that no gap "
              "opens when they flex; they are excluded from collision with each other.",
              "", "## Masses", "", "Volume of the mesh times the density, at uniform density.", ""]
    return "\n".join(lines)


def write(out):
    p = HUMAN
    bodies = fields(p)
    meshes = {name: meshed(*body) for name, body in bodies.items()}
    pad_list = pads(p, bodies)
    files = {f"meshes/{mesh}.obj": obj_text(mesh, meshes[mesh]) for mesh in meshes}
    files["SOURCE.md"] = human_source(p, meshes)
    native = hand_length(p)
    for name, size, is_coupled in SIZES:
        length = p[size] if size else native
        folder = "meshes" if name == "human_hand" else "../human_hand/meshes"
        files[f"{name}.urdf"] = human_urdf(p, meshes, name, length / native, folder)
        files[f"{name}.graspfit.json"] = json_text(
            human_sidecar(p, pad_list, name, length / native, is_coupled)) + "\n"
        write_files(out / name, files)
        files = {}
