"""Parallel grippers with one joint: stroke 85 mm, and the proportions of the Franka hand.

Numbers in millimeters. Frame H: origin in the middle of the body's top, z the palm direction, x the
direction in which the jaws travel. Jaw frames: origin at the middle of the pad, axes as H at the right
jaw; the left jaw's are turned by half a turn about z, so that both use one mesh.
"""

import math
from pathlib import Path

import numpy as np

from generator.hand_files import (Description, flat_pad, json_text, markdown_table, mesh_sizes, meters,
                                  number, obj_text, rectangle, sidecar, table_rows, write_files)
from generator.ring_meshes import MeshBuilder, circle, fillet_levels, rounded_rectangle, signed_volume

# --------------------------------------------------------------------------------------------------
# Sources
#   [2F]    Robotiq 2F-85: stroke by its name and the vendor's pages
#   [MM]    MuJoCo Menagerie's model of the 2F-85: pad 22 wide, 37.5 long
#   [FR]    frankaemika/franka_ros, franka_hand.xacro: travel, grasp point, rubber tip
#   [own]   our choice where no source says a number; the reason stands beside it
# --------------------------------------------------------------------------------------------------
PARALLEL_GRIPPER = {
    "stroke": 85.0,                     # [2F] opening between the pads
    "pad_width": 22.0,                  # [MM] across the travel
    "pad_length": 37.5,                 # [MM] along the fingers
    "pad_height": 62.0,                 # [own] middle of the pad over the body: fingers about as long as the 2F-85's
    "pad_step": 2.0,                    # [own] the pad stands out of its finger by this much
    "edge": 1.5,                        # [own] rounding beside the pad
    "finger_depth": (12.0, 9.0),        # [own] along the travel, at its root and at its tip
    "finger_end": 3.0,                  # [own] tip of the finger beyond the pad
    "carriage": (30.0, 40.0, 15.0),     # [own] along the travel, across, height
    "carriage_gap": 0.4,                # [own] the carriage slides so far over the body
    "slot": (16.0, 5.0, 5.0),           # [own] guides: distance from the middle, width, depth
    "tongue": (4.0, 4.0),               # [own] width and depth of what runs in them, with play
    "body": (160.0, 74.0, 66.0),        # [own] covers the carriages at full opening; wider than its flange
    "body_rounding": (9.0, 4.0),        # [own] of the upright edges and of the others
    "groove": (-24.0, 2.0, 1.2),        # [own] seam around the body: height, width, depth
    "flange": (31.5, 14.0),             # [own] radius and height: ISO 9409-1-50 flanges have 63 mm
    "effort_N": 125,                    # [own] order of such grippers; not used in planning
    "speed_m_s": 0.075,                 # [own] each jaw: half the 2F-85's 150 mm/s
    "masses_kg": {"body": 0.75, "jaw": 0.075},  # [own] together 0.9 kg, as the 2F-85 by its name plate
}

FRANKA_GRIPPER = {
    "stroke": 80.0,                     # [FR] two fingers, 0 to 40 each
    "pad_width": 17.5,                  # [FR] rubber tip 17.5 x 15.2 x 18.5: across the travel
    "pad_length": 18.5,                 # [FR] along the fingers
    "pad_height": 38.4,                 # [FR] grasp point 103.4 from the flange, less the body's 65
    "pad_step": 4.0,                    # [own] the rubber tip stands out, as on the hand
    "edge": 1.5,                        # [own] rounding beside the pad
    "finger_depth": (11.2, 8.2),        # [FR] 15.2 with its step; [own] at its tip
    "finger_end": 2.5,                  # [own] tip of the finger beyond the pad
    "carriage": (28.0, 36.0, 11.0),     # [own] along the travel, across, height
    "carriage_gap": 0.4,                # [own] the carriage slides so far over the body
    "slot": (10.0, 5.0, 5.0),           # [own] guides: distance from the middle, width, depth
    "tongue": (4.0, 4.0),               # [own] width and depth of what runs in them, with play
    "body": (204.0, 63.0, 65.0),        # [own] proportions of the hand; the sources used state none
    "body_rounding": (20.0, 8.0),       # [own] its body is rounder
    "groove": (-50.0, 1.5, 0.8),        # [own] seam around the body: height, width, depth
    "flange": (22.0, 6.0),              # [own] radius and height; narrower than the rounded body
    "effort_N": 70,                     # [own] order of such grippers; not used in planning
    "speed_m_s": 0.05,                  # [own] each jaw; not used in planning
    "masses_kg": {"body": 0.66, "jaw": 0.035},  # [own] together about 0.73 kg
}

GRIPPER_SOURCES = {
    "2F": "Robotiq 2F-85: stroke 85 mm by its name and the vendor's pages. Its fingertips also move along "
          "the fingers while closing; this gripper's only translate, as in the paper.",
    "MM": "MuJoCo Menagerie, model of the Robotiq 2F-85: pad 22 mm wide, 37.5 mm long.",
    "FR": "frankaemika/franka_ros, franka_hand.xacro: two prismatic fingers of 0 to 40 mm, grasp point 103.4 "
          "mm from the flange, rubber tip 17.5 x 15.2 x 18.5 mm.",
    "own": "Chosen here; the reason stands beside the number in generator/parallel_gripper.py.",
}


def gripper_body(p):
    """Flange, rounded box with a seam, two slots in its top; stacked from below."""
    length, width, height = p["body"]
    corner, fillet = p["body_rounding"]
    b = MeshBuilder()
    radius, flange_height = p["flange"]
    bottom = -height
    edge = [(bottom - flange_height + 1.0 - math.sin(math.radians(a)), 1.0 - math.cos(math.radians(a)))
            for a in (90.0, 45.0, 0.0)]
    rings = [b.add_ring([(x, y, h) for x, y in circle(radius - d, 64)]) for h, d in [*edge, (bottom, 0.0)]]
    b.cap(rings[0], outward_up=False)
    for lower, upper in zip(rings, rings[1:]):
        b.strip(lower, upper)

    def outline(h, d):
        return b.add_ring([(x, y, h) for x, y in rounded_rectangle(
            -length / 2 + d, length / 2 - d, -width / 2 + d, width / 2 - d, corner - 0.6 * d, 6)])

    seam, seam_width, seam_depth = p["groove"]
    low_edge = [(bottom - h, d) for h, d in reversed(fillet_levels(0.0, fillet, 5))]
    levels = (low_edge
              + [(seam - seam_width, 0.0), (seam - seam_width + 0.3, seam_depth), (seam - 0.3, seam_depth),
                 (seam, 0.0)]
              + fillet_levels(0.0, fillet, 5))
    sides = [outline(h, d) for h, d in levels]
    b.flat(sides[0], [rings[-1]], outward_up=False)
    for lower, upper in zip(sides, sides[1:]):
        b.strip(lower, upper)
    # Slots: as long as the tongues travel, with play.
    offset, slot_width, depth = p["slot"]
    half = p["stroke"] / 2 + p["carriage"][0] - 0.5
    slots = []
    for y in (-offset, offset):
        shape = rounded_rectangle(-half, half, y - slot_width / 2, y + slot_width / 2, slot_width / 2, 4)
        floor, rim = (b.add_ring([(x, v, h) for x, v in shape]) for h in (-depth, 0.0))
        b.cap(floor, outward_up=True)
        b.strip(list(reversed(floor)), list(reversed(rim)))
        slots.append(rim)
    b.flat(sides[-1], slots, outward_up=True)
    return b.mesh()


def gripper_jaw(p):
    """Two tongues, carriage, finger with its pad in the plane x = 0 facing -x; stacked from below."""
    b = MeshBuilder()
    base = -p["pad_height"]  # the body's top
    length, width, height = p["carriage"]
    gap, edge = p["carriage_gap"], p["edge"]
    tongue_width, tongue_depth = p["tongue"]
    root, tip = p["finger_depth"]
    half_pad, half_width = p["pad_length"] / 2, p["pad_width"] / 2 + edge
    step = p["pad_step"]

    def ring(h, x0, x1, half, radius):
        return b.add_ring([(x, y, h) for x, y in rounded_rectangle(x0, x1, -half, half, radius)])

    # The carriage begins behind the pad's plane, so that carriages do not meet before the pads.
    x0, x1 = 1.0, 1.0 + length
    tongues = []
    for y in (-p["slot"][0], p["slot"][0]):
        shape = rounded_rectangle(x0 + 3.0, x1 - 3.0, y - tongue_width / 2, y + tongue_width / 2, 1.5, 3)
        low, high = (b.add_ring([(x, v, h) for x, v in shape]) for h in (base - tongue_depth, base + gap))
        b.cap(low, outward_up=False)
        b.strip(low, high)
        tongues.append(high)
    carriage = [ring(h, x0 + d, x1 - d, width / 2 - d, 3.0 - 0.5 * d)
                for h, d in [(base + gap, 0.5), (base + gap + 0.5, 0.0),
                             *fillet_levels(base + height, 2.0, 4)]]
    b.flat(carriage[0], tongues, outward_up=False)
    for lower, upper in zip(carriage, carriage[1:]):
        b.strip(lower, upper)
    # Finger: a foot that flares into the carriage, then the shank, then the pad a step inward.
    inner = step
    foot = [ring(base + height, inner + 1.4, inner + root + 8.0, half_width + 4.0, edge + 1.0)]
    for h, d in ((1.5, 3.6), (4.0, 1.6), (8.0, 0.0)):
        foot.append(ring(base + height + h, inner + 0.4 * (d > 1.0), inner + root + 0.9 * d,
                         half_width + 0.5 * d, edge))
    end = half_pad + p["finger_end"]

    def depth_at(h):
        low = base + height + 8.0
        return root + (tip - root) * max(0.0, (h - low) / (end - low))

    # Height, inner side, how much the other sides are rounded off.
    levels = [(-half_pad - step, inner, 0.0), (-half_pad, 0.0, 0.0), (half_pad, 0.0, 0.0),
              (end - 1.5, 0.2 + inner * 0.3, 0.0), (end - 0.4, 0.8 + inner * 0.4, 0.5),
              (end, 2.0 + inner * 0.5, 1.6)]
    shank = foot + [ring(h, x, max(x + 3.0, inner + depth_at(h) - 1.2 * d), half_width - d, edge)
                    for h, x, d in levels]
    b.flat(carriage[-1], [shank[0]], outward_up=True)
    for lower, upper in zip(shank, shank[1:]):
        b.strip(lower, upper)
    b.cap(shank[-1], outward_up=True)
    return b.mesh()


SIDES = ("right", "left")


def gripper_urdf(p, meshes, name, colors):
    urdf = Description(name, colors)
    urdf.link("body", "meshes/body.obj", "body", p["masses_kg"]["body"], meshes["body"])
    for side in SIDES:
        turn = 0.0 if side == "right" else math.pi
        urdf.link(f"{side}_jaw", "meshes/jaw.obj", "jaw", p["masses_kg"]["jaw"], meshes["jaw"])
        # The joint reads the distance of the pad from the middle: the opening is twice that.
        urdf.joint(f"{side}_slide", "body", f"{side}_jaw", (0, 0, p["pad_height"]), (0, 0, turn), (1, 0, 0),
                   (0.0, p["stroke"] / 2000.0), ("right_slide", 1.0) if side == "left" else None,
                   kind="prismatic", effort=p["effort_N"], velocity=p["speed_m_s"])
    return urdf.text()


def gripper_sidecar(p, name, description):
    pads = [flat_pad(f"{side}_pad", f"{side}_jaw", side, [0.0, 0.0, 0.0],
                     # z = -x of the jaw, x along the finger
                     [np.array([0.0, 0, 1]), np.array([0, 1.0, 0]), np.array([-1.0, 0, 0])],
                     rectangle(p["pad_length"], p["pad_width"])) for side in SIDES]
    # The strip of the top between the slots and between the open carriages.
    pads.append(flat_pad("palm_pad", "body", "palm", [0.0, 0.0, 0.0], np.eye(3),
                         rectangle(p["stroke"], 2 * p["slot"][0] - p["slot"][1] - 2.0)))
    return sidecar(
        name, description,
        [{"name": side, "thumb": False, "links": [f"{side}_jaw"], "joints": [f"{side}_slide"],
          "swing_joint": None, "tip_pad": f"{side}_pad"} for side in SIDES],
        pads,
        {"link": "body", "center_m": [0.0, 0.0, 0.0], "direction": [0.0, 0.0, 1.0], "pad": "palm_pad"},
        {f"{side}_slide": -1 for side in SIDES},
        [{"joint": "left_slide", "leader": "right_slide", "ratio": 1.0, "offset": 0.0, "breakaway": False}],
        [["body", f"{side}_jaw"] for side in SIDES])


def gripper_source(p, meshes, title, table, about):
    lines = [f"# {title}: where every number comes from", "",
             "Written by `generate.py` together with the description, the sidecar and the meshes; edit "
             "that, not these.", "", about, "", "## Sources", ""]
    lines += [f"- **{key}**: {text}" for key, text in GRIPPER_SOURCES.items()]
    lines += ["", "## Numbers (mm, kg)", ""]
    lines += markdown_table(["item", "value", "source"],
                            [(f"`{item}`", value, source)
                             for item, value, source in table_rows(Path(__file__), table)])
    lines += ["", "## Frames, joint and pads", "",
              "- H is the body link's frame: origin in the middle of its top, z the palm direction, x the "
              "direction of travel.",
              f"- One joint: `right_slide` is the distance of the right pad from the middle, 0 to "
              f"{number(p['stroke'] / 2)} mm; `left_slide` follows with ratio 1 along the opposite axis. The "
              "opening is twice the joint's position; growing it opens the hand (closing sign -1). At 0 the pads "
              "touch.",
              f"- Jaw pads: the flat {number(p['pad_length'])} x {number(p['pad_width'])} mm in the plane x = 0 of "
              "their links. Palm pad: the strip of the body's top between the two slots, as long as the stroke.",
              "- Both jaws use one mesh; the left one is turned by half a turn about z.", "",
              "## Sizes of the meshes (mm)", "", *mesh_sizes(meshes), "",
              "A jaw's tongues run in the body's slots without touching; body and jaws are excluded from "
              "collision with each other all the same.", "", "## Masses", "",
              "Center of mass and inertia are those of the mesh at uniform density.", ""]
    return "\n".join(lines)


def write(out):
    for name, p, table, title, description, about, colors in (
            ("parallel_gripper", PARALLEL_GRIPPER, "PARALLEL_GRIPPER", "Parallel gripper",
             "Parallel gripper with 1 joint: stroke 85 mm, pads of 22 x 37.5 mm; both jaws move symmetrically.",
             "A gripper of our own with the stroke and the pads of a Robotiq 2F-85. No mesh was copied.",
             {"body": "0.27 0.29 0.32 1", "jaw": "0.72 0.74 0.76 1"}),
            ("franka_gripper", FRANKA_GRIPPER, "FRANKA_GRIPPER", "Gripper with the proportions of the Franka hand",
             "Parallel gripper with 1 joint after the Franka hand: stroke 80 mm, pads of 17.5 x 18.5 mm.",
             "A gripper of our own with the stroke, fingertips and grasp point of the Franka hand. No mesh was "
             "copied.", {"body": "0.92 0.93 0.94 1", "jaw": "0.30 0.31 0.33 1"})):
        meshes = {"body": gripper_body(p), "jaw": gripper_jaw(p)}
        for mesh in meshes.values():
            assert signed_volume(mesh) > 0.0
        files = {f"meshes/{mesh}.obj": obj_text(mesh, meshes[mesh]) for mesh in meshes}
        files[f"{name}.urdf"] = gripper_urdf(p, meshes, name, colors)
        files[f"{name}.graspfit.json"] = json_text(gripper_sidecar(p, name, description)) + "\n"
        files["SOURCE.md"] = gripper_source(p, meshes, title, table, about)
        write_files(out / name, files)
