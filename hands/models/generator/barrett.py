"""Barrett hand BH8-280: with its four motors; the same with the round ends of its fingers as further
pads; and with free distal joints for comparison.

Numbers in millimeters and degrees. Frame H: origin at the palm reference point, z the palm
direction, y from the thumb toward fingers 1 and 2 at spread 0.
"""

import math
from pathlib import Path

import numpy as np

from generator.hand_files import (Description, bulging_pad, flat_pad, json_text, markdown_table, mesh_sizes, meters,
                                  number, obj_text, rectangle, rounded, sidecar, table_rows, write_files)
from generator.ring_meshes import (MeshBuilder, circle, fillet_levels, inset, rounded_rectangle,
                                   smooth_step)

# --------------------------------------------------------------------------------------------------
# Sources
#   [G280]  GraspIt! models/robots/BarrettBH8_280 (github graspit-simulator/graspit), the description
#           that the paper's own reference [18] ships
#   [GM]    extents measured on GraspIt!'s Barrett link meshes
#   [JHU]   jhu-lcsr/barrett_model models/hand.urdf.xacro (collision primitives, limits)
#   [OR]    OpenRAVE robots/barretthand.kinbody.xml (coupling)
#   [BW]    Barrett's support wiki, BH8-262 and BH8-280 (gear ratios, TorqueSwitch, D-H constants)
#   [own]   our choice where no source says a number; the reason stands beside it
# --------------------------------------------------------------------------------------------------
BARRETT = {
    # Kinematics -----------------------------------------------------------------------------------
    "finger_1_base": (25.0, 0.0, -3.32),    # [G280]
    "finger_2_base": (-25.0, 0.0, -3.32),   # [G280]
    "thumb_base": (0.8, -50.0, -3.05),      # [G280]; the proximal joint itself: no spread joint
    "spread_a": 50.0,                       # [G280], A1 of [BW]
    "spread_upper": 180.0,                  # [G280], [JHU]
    "proximal_offset": -2.46,               # [G280] theta = d - 2.46
    "proximal_a": 70.0,                     # [G280], A2 of [BW]
    "proximal_upper": 140.0,                # [G280], [JHU]
    "distal_offset": 42.46,                 # [G280] theta = d/3 + 42.46
    "distal_upper": 48.0,                   # [JHU]; 140/3 = 46.67 by coupling, the rest by breakaway
    "distal_ratio": 1.0 / 3.0,              # [G280], [OR], gears 125:1 and 93.75:1 of [BW]
    "tip_length": 56.0,                     # [G280] mesh, 56 to 59
    # Palm -----------------------------------------------------------------------------------------
    "wrist_to_knuckle_axis": 76.0,          # D_w of [BW]
    "wrist_radius": 44.5,                   # [GM] extent 89; [JHU] cylinder r 45
    "wrist_height": 42.0,                   # [JHU] cylinder 42
    "spine_half_width": 11.5,               # [JHU] box 24 less clearance for the swinging knuckles
    "spine_y": (-63.0, 39.0),               # [JHU] box 108 long, reaching under the thumb
    "plate_size": (76.0, 46.0),             # [JHU] palm box
    "plate_corner_cut": 12.0,               # [own] the palm plate's corners are cut off, as on the hand
    "plate_bottom": -13.0,                  # [JHU] palm box 12 high, below the palm surface z = 0
    "deck_top": -4.0,                       # [JHU] spine box ends 4 below the palm surface
    "deck_margin": 1.0,                     # [own] the rim around the raised palm plate
    "housing_half_width": 12.4,             # [JHU] knuckle 24 wide, plus the rim
    # Knuckle (spread link) --------------------------------------------------------------------------
    "knuckle_radius": 15.0,                 # [JHU] cylinder r 15 x 24
    "knuckle_half_width": 12.0,             # [JHU]
    "arm_bottom": -33.2,                    # [JHU] box 33 high below the knuckle axis
    "arm_top": -10.2,                       # [own] clears the palm plate, under which the arm swings
    # Proximal link: 92 x 26 x 20 overall [GM] ---------------------------------------------------------
    "proximal_x": (-14.0, 78.0),            # [GM] -14.04 and 77.74 from the proximal joint
    "proximal_y": (-11.75, 14.25),          # [GM] -11.75 and 14.99 to 12.99 (mean 14), 26 in all
    "proximal_half_width": 10.0,            # [GM] 19 to 21
    "tongue_half_width": 3.0,               # [JHU] spine box 6 wide, [GM] the same
    "proximal_body_x": (17.0, 55.0),        # [GM] the wide part, 14.3 to 57.8 with its shoulders
    "proximal_pad_x": (23.44, 54.44),       # [JHU] protrusion box 31 long, centered at 38.94
    "proximal_end_radius": 8.0,             # [GM] 77.74 - 70, hidden in the distal link's base
    # Distal link: 68 x 20 x 23 overall [GM] -----------------------------------------------------------
    "distal_base_radius": 9.5,              # [JHU] base cylinder; D3 of [BW]
    "distal_tip_radius": 6.5,               # [JHU] tip cylinder
    "distal_tip_y": -2.36,                  # [JHU] tip cylinder's offset to the back of the finger
    "distal_half_width": 11.5,              # [JHU] 23 wide
    "distal_thickness": 20.0,               # [GM]; the base cylinder alone gives 19
    "distal_pad_length": 52.0,              # [JHU] inner pad box 52 x 11 x 23
    "masses_kg": {"palm": 0.50573, "knuckle": 0.14109, "proximal": 0.062139, "distal": 0.041377},  # [JHU]
}

BARRETT_SOURCES = {
    "G280": "GraspIt!, models/robots/BarrettBH8_280 (github graspit-simulator/graspit): joints, "
            "offsets, ranges, palm reference. The description used by the paper's reference [18].",
    "GM": "Extents and stations measured on GraspIt!'s Barrett link meshes (palm 89 x 109 x 90 to 96, "
          "proximal 92 x 26 x 19 to 21, distal 68 x 20 x 23 mm). Only numbers were taken.",
    "JHU": "jhu-lcsr/barrett_model, models/hand.urdf.xacro: collision boxes and cylinders, limits, masses.",
    "OR": "OpenRAVE, robots/barretthand.kinbody.xml: distal joint = proximal/3.",
    "BW": "Barrett Technology's support wiki, BH8-262 and BH8-280: D-H constants, gear ratios 125:1 and "
          "93.75:1 (125/93.75 - 1 = 1/3), TorqueSwitch.",
    "own": "Chosen here; the reason stands beside the number in generator/barrett.py.",
}


# --------------------------------------------------------------------------------------------------
# Barrett hand: shapes
# --------------------------------------------------------------------------------------------------
def plate_outline(p, margin=0.0):
    """The palm plate seen from above: a rectangle with its corners cut."""
    x, y, c = p["plate_size"][0] / 2 + margin, p["plate_size"][1] / 2 + margin, p["plate_corner_cut"]
    return [(x, -y + c), (x, y - c), (x - c, y), (-x + c, y), (-x, y - c), (-x, -y + c), (-x + c, -y),
            (x - c, -y)]


PLATE_EDGE = 1.5  # [own] radius of the palm plate's upper edge, mm


def barrett_palm(p):
    """Wrist drum, spine between the knuckles, palm plate, knuckle of the thumb; one closed surface.

    Stacked from below: every outline lies strictly inside or outside the next, so that the level
    parts between them are polygons with holes."""
    b = MeshBuilder()
    bottom = p["finger_1_base"][2] - p["wrist_to_knuckle_axis"]
    drum_top = bottom + p["wrist_height"]
    # Drum with rounded edges; the lower one is an upper one upside down.
    radius = p["wrist_radius"]
    profile = [(bottom + (drum_top - h), d) for h, d in reversed(fillet_levels(drum_top, 2.0, 3))]
    profile += fillet_levels(drum_top, 3.0, 3)
    rings = [b.add_ring([(x, y, h) for x, y in circle(radius - d, 64)]) for h, d in profile]
    for lower, upper in zip(rings, rings[1:]):
        b.strip(lower, upper)
    b.cap(rings[0], outward_up=False)
    # Spine: leans out under the thumb.
    w, (y0, y1) = p["spine_half_width"], p["spine_y"]
    spine = [b.add_ring([(x, y, h) for x, y in rounded_rectangle(-w, w, y_low, y1, 4.0, 3)])
             for y_low, h in [(-38.0, drum_top), (-41.0, drum_top + 5.0), (y0, -21.0),
                              (y0, p["plate_bottom"])]]
    b.flat(rings[-1], [spine[0]], outward_up=True)
    for lower, upper in zip(spine, spine[1:]):
        b.strip(lower, upper)
    # Deck: plate, thumb housing and tail in one outline.
    hw, m = p["housing_half_width"], p["deck_margin"]
    thumb_y, r = p["thumb_base"][1], p["knuckle_radius"]
    plate = plate_outline(p, m)
    front, back = thumb_y - r - 0.4, y1 + 1.5
    corner = [(hw - 2.4 + 2.4 * math.sin(math.radians(30.0 * k)), 2.4 - 2.4 * math.cos(math.radians(30.0 * k)))
              for k in range(4)]
    deck = ([(x, front + y) for x, y in corner] + [(hw, plate[7][1])] + plate[7:8] + plate[0:3]
            + [(hw, plate[2][1])] + [(x, back - y) for x, y in reversed(corner)])
    deck += [(-x, y) for x, y in reversed(deck)]
    deck_rings = [b.add_ring([(x, y, h) for x, y in inset(deck, d)])
                  for h, d in [(p["plate_bottom"], 0.3), (p["plate_bottom"] + 0.3, 0.0),
                               (p["deck_top"] - 0.3, 0.0), (p["deck_top"], 0.3)]]
    b.flat(deck_rings[0], [spine[-1]], outward_up=False)
    for lower, upper in zip(deck_rings, deck_rings[1:]):
        b.strip(lower, upper)
    # Palm plate with its flat top at z = 0.
    levels = [(p["deck_top"], 0.0)] + fillet_levels(0.0, PLATE_EDGE, 4)
    plate_rings = [b.add_ring([(x, y, h) for x, y in inset(plate_outline(p), d)]) for h, d in levels]
    # Knuckle of the thumb: a cylinder along x, from the deck up.
    axis_x, axis_z = 0.0, p["thumb_base"][2]
    first = math.degrees(math.asin((p["deck_top"] - axis_z) / r))
    knuckle = []
    for k in range(11):
        a = math.radians(first + (86.0 - first) * k / 10)
        width = hw - 0.5 - 1.2 * max(math.sin(a), 0.0) ** 4
        knuckle.append(b.add_ring([(x, y, axis_z + r * math.sin(a)) for x, y in rounded_rectangle(
            axis_x - width, axis_x + width, thumb_y - r * math.cos(a), thumb_y + r * math.cos(a), 2.0, 3)]))
    b.flat(deck_rings[-1], [plate_rings[0], knuckle[0]], outward_up=True)
    for part in (plate_rings, knuckle):
        for lower, upper in zip(part, part[1:]):
            b.strip(lower, upper)
        b.cap(part[-1], outward_up=True)
    return b.mesh()


def barrett_knuckle(p):
    """Spread link: hub on the spread axis (z), arm along x under the palm plate, knuckle at x = 50."""
    a, r, w = p["spread_a"], p["knuckle_radius"], p["knuckle_half_width"]
    low, top = p["arm_bottom"], p["arm_top"]

    def circle_z(x):
        return math.sqrt(max(r * r - (x - a) ** 2, 0.0))

    stations = []  # (x, half width, z low, z high)
    for k in range(7):  # the hub's round end
        beta = math.radians(12.0 + 78.0 * k / 6)
        stations.append((-w * math.cos(beta), w * math.sin(beta), low, top))
    stations.append((26.5, w, low, top))
    for x in (29.0, 32.0, a - r + 0.6):
        t = (x - 26.5) / (a - r + 0.6 - 26.5)
        stations.append((x, w, low, top + (circle_z(a - r + 0.6) - top) * smooth_step(t)))
    for k in range(1, 13):
        x = a - r * math.cos(math.radians(16.3 + (172.0 - 16.3) * k / 12))
        slope = low + (x - 43.0) / (62.0 - 43.0) * (-circle_z(62.0) - low)
        stations.append((x, w, low if x <= 43.0 else (slope if x < 62.0 else -circle_z(x)), circle_z(x)))
    b = MeshBuilder()
    b.loft([[(x, y, z) for y, z in rounded_rectangle(-hw, hw, z0, z1, 2.5)] for x, hw, z0, z1 in stations])
    return b.mesh()


def barrett_proximal(p):
    """Proximal link: x from the proximal to the distal joint, y the closing side."""
    (x0, x1), (y0, y1) = p["proximal_x"], p["proximal_y"]
    body0, body1 = p["proximal_body_x"]
    a, end = p["proximal_a"], p["proximal_end_radius"]
    tongue, wide = p["tongue_half_width"], p["proximal_half_width"]
    r = -x0

    stations = []  # (x, y low, y high, half width, edge radius)
    for k in range(8):  # round the proximal joint, inside the knuckle
        beta = math.radians(14.0 + 76.0 * k / 7)
        x, y = -r * math.cos(beta), r * math.sin(beta)
        stations.append((x if k else x0, max(y0, -y), y, tongue, 1.0))
    for x in (11.0, 12.5, 14.0, 15.5, body0):  # shoulders
        t = smooth_step((x - 11.0) / (body0 - 11.0))
        stations.append((x, y0, r + (y1 - r) * t, tongue + (wide - tongue) * t, 1.0 + 1.0 * t))
    for x in (22.0, 36.0, body1):  # body; its inner side is flat
        stations.append((x, y0 + (-9.0 - y0) * (x - body0) / (body1 - body0), y1, wide, 2.0))
    for x in (56.5, 58.0, 59.5, 61.0):
        t = smooth_step((x - body1) / (61.0 - body1))
        stations.append((x, -9.0 + (9.0 - end) * t, y1 + (end - y1) * t, wide + (tongue - wide) * t,
                         2.0 - 1.0 * t))
    for k in range(7):  # round the distal joint, inside the distal link
        beta = math.radians(90.0 * k / 6 * 0.9)
        x, y = a + end * math.sin(beta), end * math.cos(beta)
        stations.append((x if k < 6 else x1, -y, y, tongue, 1.0))
    b = MeshBuilder()
    b.loft([[(x, y, z) for y, z in rounded_rectangle(lo, hi, -hw, hw, edge)]
            for x, lo, hi, hw, edge in stations])
    return b.mesh()


def distal_pad(p):
    """(foot, direction, normal) of the pad plane in the distal link's x-y plane: the tangent of base and
    tip cylinder on the closing side; the pad runs from `foot` (above the joint) by its length."""
    r0, r1, ty, length = (p["distal_base_radius"], p["distal_tip_radius"], p["distal_tip_y"],
                          p["distal_pad_length"])
    # Tip center such that the tangent between the two circles is exactly the pad's length.
    tx = math.sqrt(length ** 2 + (r0 - r1) ** 2 - ty ** 2)
    tilt = math.asin((r0 - r1) / math.hypot(tx, ty)) - math.atan2(ty, tx)
    normal = np.array([math.sin(tilt), math.cos(tilt)])
    return r0 * normal, np.array([normal[1], -normal[0]]), normal, np.array([tx, ty]), tilt


TIP_STEPS = 12  # of the round tip, from the back to the pad's end


def tip_arc(p):
    """(point, normal) of the round tip's outline, from the back to the pad, without the pad's end."""
    _, _, _, tip, tilt = distal_pad(p)
    angles = [math.radians(-90.0 + (180.0 - math.degrees(tilt)) * k / TIP_STEPS) for k in range(TIP_STEPS)]
    normals = [np.array([math.cos(a), math.sin(a)]) for a in angles]
    return [(tip + p["distal_tip_radius"] * n, n) for n in normals]


EDGE_FILLET = 4.0  # [own] radius of the distal link's rounded edges, mm
# [own] The end pad lies about the step that leans 58 degrees from the flat pad: on what is narrower than
# 60 mm fingertips lean by 50 to 75 (`graspfit hand reach`). It goes on for three steps on both sides.
END_PAD_STEP, END_PAD_STEPS = 8, 3


def end_pad(p):
    """(origin, axes, outline, bulge) of the pad on the round tip, mm; the bulge is the mesh's surface."""
    arc = tip_arc(p)
    half_width = p["distal_half_width"] - EDGE_FILLET  # where the edges' rounding ends
    first, last = END_PAD_STEP - END_PAD_STEPS, END_PAD_STEP + END_PAD_STEPS
    origin = 0.5 * (arc[first][0] + arc[last][0])
    normal = arc[END_PAD_STEP][1]
    z = np.append(normal, 0.0)
    x = np.array([normal[1], -normal[0], 0.0])
    y = np.cross(z, x)
    points = [np.append(q - origin, 0.0) for q, _ in arc[first:last + 1]]
    half_length = abs(points[0] @ x)
    outline = [(half_length, -half_width), (half_length, half_width), (-half_length, half_width),
               (-half_length, -half_width)]
    bulge = [(q @ x, side * half_width, q @ z) for q in points[1:-1] for side in (1, -1)]
    return np.append(origin, 0.0), [x, y, z], outline, bulge


def barrett_distal(p):
    """Distal link: its outline in the plane of motion, extruded over the width; edges rounded on the
    back and around the tip, sharp along the pad, so that the pad is one flat rectangle."""
    foot, direction, normal, tip, tilt = distal_pad(p)
    r0, r1, w = p["distal_base_radius"], p["distal_tip_radius"], p["distal_half_width"]

    outline = []  # (point, outward normal, share of the rounding)
    tilt_deg = math.degrees(tilt)
    outline.append((foot + p["distal_pad_length"] * direction, normal, 0.0))
    outline.append((foot, normal, 0.0))
    for k in range(1, 13):  # round the base
        a = math.radians(90.0 - tilt_deg + (180.0 + tilt_deg) * k / 12)
        n = np.array([math.cos(a), math.sin(a)])
        outline.append((r0 * n, n, smooth_step(k / 8)))
    # Back, arched so that the finger is as thick as stated.
    start, stop = np.array([0.0, -r0]), tip + np.array([0.0, -r1])
    lowest = r0 - p["distal_thickness"]
    back = [start + (stop - start) * s for s in np.linspace(0.0, 1.0, 10)]
    arch = [math.sin(math.pi * s) ** 1.2 for s in np.linspace(0.0, 1.0, 10)]
    scale = min((q[1] - lowest) / h for q, h in zip(back[1:-1], arch[1:-1]))
    for q, h in zip(back[1:-1], arch[1:-1]):
        outline.append((q - np.array([0.0, scale * h]), np.array([0.0, -1.0]), 1.0))
    for k, (q, n) in enumerate(tip_arc(p)):  # up to the pad's end
        outline.append((q, n, smooth_step((TIP_STEPS - k) / 7)))

    levels = fillet_levels(w, EDGE_FILLET, 5)
    rings = []
    for h, d in [(-h, d) for h, d in reversed(levels)] + levels:
        rings.append([(*(q - share * d * n), h) for q, n, share in outline])
    b = MeshBuilder()
    b.loft(rings)
    return b.mesh()


FINGERS = ("finger_1", "finger_2", "thumb")


def barrett_urdf(p, meshes, name, mesh_folder, has_free_distal_joints):
    urdf = Description(name, {"shell": "0.62 0.64 0.67 1", "finger": "0.80 0.81 0.83 1"},
                       "sources in SOURCE.md" if name == "barrett" else "sources in ../barrett/SOURCE.md")

    def link(link_name, mesh, material):
        urdf.link(link_name, f"{mesh_folder}/{mesh}.obj", material, p["masses_kg"][mesh], meshes[mesh])

    def limits(upper_deg):
        return 0.0, math.radians(upper_deg)

    quarter = math.pi / 2
    tilt = math.radians(-p["proximal_offset"])
    link("palm", "palm", "shell")
    for finger, sign in (("finger_1", -1), ("finger_2", 1)):
        link(f"{finger}_knuckle", "knuckle", "shell")
        # At spread 0 the finger points to +y; finger_1 swings over +x, finger_2 over -x, to -y.
        urdf.joint(f"{finger}_spread", "palm", f"{finger}_knuckle", p[f"{finger}_base"], (0, 0, quarter),
                   (0, 0, sign), limits(p["spread_upper"]),
                   ("finger_1_spread", 1.0) if finger == "finger_2" else None)
    for finger in FINGERS:
        link(f"{finger}_proximal_link", "proximal", "finger")
        link(f"{finger}_distal_link", "distal", "finger")
        if finger == "thumb":
            parent, origin, yaw = "palm", p["thumb_base"], -quarter
        else:
            parent, origin, yaw = f"{finger}_knuckle", (p["spread_a"], 0, 0), 0.0
        # x outward from the palm, y the closing side, z the joint axis; the offset of -2.46 degrees about
        # that axis is the pitch of +2.46 degrees.
        urdf.joint(f"{finger}_proximal", parent, f"{finger}_proximal_link", origin, (quarter, tilt, yaw),
                   (0, 0, 1), limits(p["proximal_upper"]))
        urdf.joint(f"{finger}_distal", f"{finger}_proximal_link", f"{finger}_distal_link",
                   (p["proximal_a"], 0, 0), (0, 0, math.radians(p["distal_offset"])), (0, 0, 1),
                   limits(p["distal_upper"]),
                   None if has_free_distal_joints else (f"{finger}_proximal", p["distal_ratio"]))
    return urdf.text()


def barrett_sidecar(p, name, has_free_distal_joints, has_end_pads):
    foot, direction, normal, _, _ = distal_pad(p)
    pads = []
    for finger in FINGERS:
        center = foot + 0.5 * p["distal_pad_length"] * direction
        x, z = np.append(direction, 0.0), np.append(normal, 0.0)
        pads.append(flat_pad(f"{finger}_distal_pad", f"{finger}_distal_link", finger, [*center, 0.0],
                             [x, np.cross(z, x), z],
                             rectangle(p["distal_pad_length"], 2 * p["distal_half_width"])))
        px0, px1 = p["proximal_pad_x"]
        x, z = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
        # The body is 20 wide; its edges are rounded by 2 on each side.
        pads.append(flat_pad(f"{finger}_proximal_pad", f"{finger}_proximal_link", finger,
                             [(px0 + px1) / 2, p["proximal_y"][1], 0.0], [x, np.cross(z, x), z],
                             rectangle(px1 - px0, 2 * (p["proximal_half_width"] - 2.0))))
        if has_end_pads:
            pads.append(bulging_pad(f"{finger}_end_pad", f"{finger}_distal_link", finger, *end_pad(p)))
    pads.append(flat_pad("palm_pad", "palm", "palm", [0.0, 0.0, 0.0], np.eye(3),
                         [rounded(meters(c)) for c in inset(plate_outline(p), PLATE_EDGE)]))
    # Links that share a joint overlap at it.
    exclusions = [["palm", "finger_1_knuckle"], ["palm", "finger_2_knuckle"],
                  ["palm", "thumb_proximal_link"]]
    for finger in ("finger_1", "finger_2"):
        exclusions.append([f"{finger}_knuckle", f"{finger}_proximal_link"])
    for finger in FINGERS:
        exclusions.append([f"{finger}_proximal_link", f"{finger}_distal_link"])
    couplings = [{"joint": "finger_2_spread", "leader": "finger_1_spread", "ratio": 1.0, "offset": 0.0,
                  "breakaway": False}]
    if has_free_distal_joints:
        description = ("Barrett hand BH8-280 with 7 independent joints, for comparison: spread (fingers 1 "
                       "and 2 together), and proximal and distal joint of each finger, which on the real "
                       "hand share a motor.")
    else:
        couplings += [{"joint": f"{finger}_distal", "leader": f"{finger}_proximal",
                       "ratio": p["distal_ratio"], "offset": 0.0, "breakaway": True} for finger in FINGERS]
        description = ("Barrett hand BH8-280 with 4 independent joints: spread (fingers 1 and 2 together) "
                       "and one per finger; each distal joint follows its proximal joint by one third "
                       "until that is blocked, then goes on alone (TorqueSwitch).")
        if has_end_pads:
            description += " The round ends of its fingers are pads, too."
    fingers = [
        {"name": finger, "thumb": finger == "thumb",
         "links": ([] if finger == "thumb" else [f"{finger}_knuckle"])
                  + [f"{finger}_proximal_link", f"{finger}_distal_link"],
         "joints": ([] if finger == "thumb" else [f"{finger}_spread"])
                   + [f"{finger}_proximal", f"{finger}_distal"],
         "swing_joint": None if finger == "thumb" else f"{finger}_spread",
         "tip_pad": f"{finger}_distal_pad"}
        for finger in FINGERS]
    return sidecar(
        name, description, fingers, pads,
        {"link": "palm", "center_m": [0.0, 0.0, 0.0], "direction": [0.0, 0.0, 1.0], "pad": "palm_pad"},
        {f"{finger}_{joint}": 1 for finger in FINGERS for joint in ("proximal", "distal")},
        couplings, exclusions)


def barrett_source(p, meshes):
    foot, direction, normal, tip, tilt = distal_pad(p)
    lines = ["# Barrett hand: where every number comes from", "",
             "Written by `generate.py` together with the description, the sidecar and the meshes; edit "
             "that, not these.", "",
             "The hand is the BH8-280 with 4 independent joints. All shapes are our own, built from the "
             "numbers below; no mesh was copied.", "", "## Sources", ""]
    lines += [f"- **{key}**: {text}" for key, text in BARRETT_SOURCES.items()]
    lines += ["", "## Numbers (mm, degrees, kg)", ""]
    lines += markdown_table(["item", "value", "source"],
                            [(f"`{item}`", value, source)
                             for item, value, source in table_rows(Path(__file__), "BARRETT")])
    lines += ["", "## Frames and joints", "",
              "- H is the palm link's frame: origin at GraspIt!'s palm reference point in the palm surface, "
              "z the palm direction, the thumb on the side of -y.",
              "- At spread 0 fingers 1 and 2 point to +y, opposite the thumb. `finger_1_spread` (0 to pi) "
              "turns finger 1 over +x to -y, beside the thumb; `finger_2_spread` follows with ratio 1 about "
              "the opposite axis, so finger 2 is the mirror image in the plane x = 0.",
              "- Finger links: x along the link, y the closing side, z the joint axis. Proximal angle to the "
              "palm plane: q - 2.46. Distal angle to the proximal link: q_distal + 42.46, where q_distal = "
              "q/3 while coupled. The bend of 42.46 belongs to the fixed part of the joint, so the distal "
              "joint reads 0 to 48: 0 to 46.67 by coupling, the rest only after breakaway.",
              "", "## Pads", "",
              f"- Distal: the plane tangent to the base cylinder (r {number(p['distal_base_radius'])}) and the "
              f"tip cylinder (r {number(p['distal_tip_radius'])}) on the closing side. Its distance from the "
              f"distal joint axis is {number(p['distal_base_radius'])} mm, Barrett's constant D3, and it leans "
              f"{math.degrees(tilt):.2f} degrees toward the tip; JHU's inner box leans 6. The tip cylinder's "
              f"center, at x = {tip[0]:.2f} (JHU: 50.47), is where the flat between the two tangent lines has "
              f"exactly the pad's {number(p['distal_pad_length'])} mm; with the tip radius that makes the "
              f"link {p['distal_base_radius'] + tip[0] + p['distal_tip_radius']:.2f} mm long (stated: 68). "
              "Width: the link's whole 23 mm, so the edges beside the pad are sharp and those at the back "
              "round.",
              f"- The tip point of the check table lies on the link's x axis at {number(p['tip_length'])} mm, "
              "inside the fingertip.",
              "- Proximal: the flat inner side of the link's body over the 31 mm of JHU's protrusion box, 16 mm "
              "wide (20 less two rounded edges).",
              "- Palm: the flat top of the palm plate in the plane z = 0: the 76 x 46 mm of JHU's palm box with "
              "cut corners, less its rounded edge.",
              "", "## Sizes of the meshes (mm)", "", *mesh_sizes(meshes),
              "", "Links that share a joint overlap there and are excluded from collision.",
              "", "## Masses", "",
              "JHU's masses; center of mass and inertia are those of the mesh at uniform density.", "",
              "## The hand with 7 independent joints", "",
              "`barrett_7dof` is the same hand, with the same meshes, whose distal joints are free; the spread "
              "stays common to fingers 1 and 2. No such hand is built: it is there to see what the coupling "
              "costs.", "",
              "## The hand with its fingers' ends as pads", "",
              "`barrett_ends` is the same hand, with the same meshes and four independent joints, whose fingers "
              "have one pad more each: the round end of the distal link, which touches what is too narrow "
              "for the flat pads. The paper's hand has flat pads alone. An end pad is the mesh's own surface: "
              f"{2 * END_PAD_STEPS} of the {TIP_STEPS} facets of the tip cylinder, about the direction that leans "
              f"{math.degrees(math.acos(normal @ tip_arc(p)[END_PAD_STEP][1])):.0f} degrees from the flat pad's, "
              f"{number(2 * (p['distal_half_width'] - EDGE_FILLET))} mm wide (23 less the rounded edges).", ""]
    return "\n".join(lines)


def write(out):
    """The Barrett hands; the others use the meshes of the first."""
    p = BARRETT
    meshes = {"palm": barrett_palm(p), "knuckle": barrett_knuckle(p), "proximal": barrett_proximal(p),
              "distal": barrett_distal(p)}
    files = {f"meshes/{mesh}.obj": obj_text(mesh, meshes[mesh]) for mesh in meshes}
    files["SOURCE.md"] = barrett_source(p, meshes)
    for name, mesh_folder, is_free, has_ends in (("barrett", "meshes", False, False),
                                                 ("barrett_ends", "../barrett/meshes", False, True),
                                                 ("barrett_7dof", "../barrett/meshes", True, False)):
        files[f"{name}.urdf"] = barrett_urdf(p, meshes, name, mesh_folder, is_free)
        files[f"{name}.graspfit.json"] = json_text(barrett_sidecar(p, name, is_free, has_ends)) + "\n"
        write_files(out / name, files)
        files = {}
