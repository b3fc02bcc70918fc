#!/usr/bin/python3
"""Recomputes what a grasp file records, from the files and meshes alone, and compares.

    check_grasps.py grasps.json [...]

Nothing of graspfit is used: what stands in this folder, with numpy and scipy, reads mesh and
hand files, clips and measures triangles, and takes hulls (Qhull). Only whether a contact is on a
weak feature is taken from the file. It prints one row per grasp; the exit code is 1 if a value
differs by more than its tolerance, 2 if a file cannot be checked.
"""

import argparse
import json
import pathlib
import sys

import numpy as np

import configurations
import hand_files
import measures
import recompute

# These are the largest differences that rounding explains. Coordinates are tenths of meters in
# doubles, so that lengths differ by 1e-16 m or so; what amplifies that is named.
TOLERANCE = {
    "volume": 1e-9,       # relative
    "center": 1e-10,      # [m]
    "radius": 1e-12,      # [m]
    "pose": 1e-9,         # [m] and [rad]: descriptions have 15 digits, poses are chained
    "coupling": 1e-9,     # [rad] or [m]
    "depth": 1e-9,        # [m]
    "gap": 1e-9,          # [m]
    "area": 1e-11,        # [m^2], a hundred-thousandth of a square millimeter
    "point": 1e-8,        # [m]
    "normal": 1e-6,       # [rad]: sums of areas over small areas
    "d": 1e-8,            # [m]
    "M": 1e-6,            # M, M1, M2, M3, R: no unit
    "D": 1e-8,            # [m]
    "epsilon": 1e-9,      # no unit
    "clearance": 1e-9,    # [m]
    "force": 1e-6,        # [N]
    "squeeze": 1e-7,      # [rad] or [m]: central differences
}

BEYOND = 1e-3  # What is so much farther than a stated clearance is not measured [m].
WAY_SAMPLES = 12  # These are on the straight way from the pre-grasp to the grasp.


class Comparison:
    """The differences of one grasp, or of what all grasps share."""

    def __init__(self):
        self.largest, self.failures = {}, []

    def equal(self, kind, what, mine, stored, tolerance=None):
        difference = float(np.max(np.abs(np.asarray(mine, dtype=float) - stored), initial=0.0))
        self.largest[kind] = max(self.largest.get(kind, 0.0), difference)
        if not difference <= (TOLERANCE[kind] if tolerance is None else tolerance):
            self.failures.append(f"{what}: recomputed {mine}, stored {stored}")

    def require(self, what, holds):
        if not holds:
            self.failures.append(what)


def check_shared(scene):
    """Compares object and pads, which all grasps have in common."""
    found, item = Comparison(), scene.record["object"]
    found.equal("volume", "volume_m3", scene.volume / item["volume_m3"], 1.0)
    found.equal("center", "center_of_mass_O_m", scene.center_of_mass, item["center_of_mass_O_m"])
    found.equal("radius", "normalizing_radius_m", scene.radius, item["normalizing_radius_m"])
    recorded = {pad["name"]: pad for pad in scene.record["hand"]["pads"]}
    found.require(f"pads: {sorted(scene.hand.pads)}, stored {sorted(recorded)}",
                  set(scene.hand.pads) == set(recorded))
    for name in set(recorded) & set(scene.hand.pads):
        pad, stored = scene.hand.pads[name], recorded[name]
        found.equal("area", f"{name} area_m2", pad.area(), stored["area_m2"])
        found.equal("d", f"{name} largest_boundary_distance_m", pad.largest_boundary_distance(),
                    stored["largest_boundary_distance_m"])
    stored = {frozenset(pair) for pair in scene.record["hand"]["collision_exclusions"]}
    found.require("collision_exclusions are not those of the hand's files",
                  stored <= scene.hand.exclusions)
    return found


def check_configuration(scene, configuration, found, where):
    """Compares limits and couplings of joint values. Returns the link poses."""
    values = configuration["joints"]
    for joint in scene.hand.joints:
        if joint.kind == "fixed":
            continue
        value, slack = values[joint.name], TOLERANCE["coupling"]
        found.require(f"{where}{joint.name}: {value} is beyond its limits",
                      joint.lower - slack <= value <= joint.upper + slack)
        coupling = scene.hand.couplings.get(joint.name)
        if coupling and not coupling.breakaway:
            wanted = coupling.ratio * values[coupling.leader] + coupling.offset
            found.equal("coupling", f"{where}{joint.name}", value,
                        np.clip(wanted, joint.lower, joint.upper))
    return scene.poses(configuration)


def check_penetration(scene, grasp, links, found):
    """Compares whether links share a point with the object or one another, and how deep. Returns
    the smallest distance to the object."""
    stored = grasp["penetration"]
    near = scene.object_clearances(links, recompute.FAR)
    hits = [name for name, distance in near.items() if distance == 0]
    found.require(f"object_intersects: recomputed {hits or False}", bool(hits) ==
                  stored["object_intersects"])
    deepest = max((recompute.depth(links[name], scene.object) for name in hits), default=0.0)
    found.require(f"object_depth_bound_m: {stored['object_depth_bound_m']}, found a point "
                  f"{deepest} deep",
                  deepest <= stored["object_depth_bound_m"] + TOLERANCE["depth"])
    found.require(f"object_depth_m: {stored['object_depth_m']}, recomputed {deepest}",
                  stored["object_depth_m"] <= deepest + recompute.SAMPLE_SPACING)
    pairs = [pair for pair, distance in scene.self_clearances(links, recompute.TOUCHING).items()
             if distance == 0]
    found.require(f"self_intersects: recomputed {pairs or False}",
                  bool(pairs) == stored["self_intersects"])
    apart = scene.surroundings_clearance(links, recompute.FAR)
    found.require(f"surroundings_touched: recomputed distance {apart}",
                  (apart <= 0) == stored["surroundings_touched"])
    return min(near.values(), default=np.inf), deepest


def check_contacts(scene, grasp, X_OL, found):
    """Compares contacts of all pads. Returns them in the file's order, or None where the pads
    differ."""
    recomputed = scene.contacts(X_OL)
    stored = {contact["pad"]: contact for contact in grasp["contacts"]}
    found.require(f"pads with contact: recomputed {list(recomputed)}, stored {list(stored)}",
                  set(recomputed) == set(stored))
    if set(recomputed) != set(stored):
        return None
    for name, item in stored.items():
        mine = recomputed[name].contact
        found.equal("area", f"{name} area_m2", mine.area, item["area_m2"])
        found.equal("point", f"{name} point_O_m", mine.point, item["point_O_m"])
        angle = measures.angle_between(mine.normal, np.array(item["inward_normal_O"]))
        found.equal("normal", f"{name} inward_normal_O, angle", angle, 0.0)
        found.equal("d", f"{name} pad_boundary_distance_m", mine.boundary_distance,
                    item["pad_boundary_distance_m"])
        found.equal("gap", f"{name} gap_m", recomputed[name].gap, item["gap_m"])
        found.require(f"{name}: finger {item['finger']}", item["finger"] == mine.finger)
        mine.weak = bool(item["weak"])
    return {name: recomputed[name] for name in stored}


def check_measure(scene, grasp, contacts, found):
    quality = scene.quality(contacts)
    for key, mine in (("m", quality.m), ("m1", quality.m1), ("m2", quality.m2),
                      ("m3", quality.m3), ("regularity", quality.regularity)):
        found.equal("M", key, mine, grasp[key])
    found.equal("D", "centroid_distance_m", quality.centroid_distance,
                grasp["centroid_distance_m"])
    stored = [tuple(pair["contacts"]) for pair in grasp["stable_pairs"]]
    found.require(f"stable_pairs: recomputed {quality.pairs}, stored {stored}",
                  [pair[:2] for pair in quality.pairs] == stored)
    return quality


def touching(scene, contacts):
    """Returns the contacts that bear forces: of refined grasps those within the largest gap."""
    limit = scene.options["refinement"]["largest_gap_m"]
    is_refined = scene.options["refine"] and not scene.record.get("imported")
    return [contact.contact for contact in contacts.values()
            if not is_refined or contact.gap <= limit]


def check_wrench(scene, stored, contacts, found):
    """Compares epsilon in the convention of the file, which must be GraspIt!'s. Returns None
    where it is not recorded."""
    if stored is None:
        return None
    convention = stored["convention"]
    found.equal("center", "reference_point_O_m", scene.center_of_mass,
                convention["reference_point_O_m"])
    found.equal("radius", "torque_scale_m", scene.largest_radius, convention["torque_scale_m"])
    found.require(f"convention {convention}", (
        convention["tool"], convention["num_cone_edges"], convention["norm"],
        convention["force_scaling"], convention["force_limit"], convention["friction"]) ==
        ("graspit", 8, "l1", "unit-normal", 1, scene.options["friction"]))
    space = measures.wrench_space(measures.contact_wrenches(
        contacts, scene.center_of_mass, scene.largest_radius, scene.options["friction"], 8))
    epsilon = space.epsilon
    outside = {"zero": 0.0, "minus-one": -1.0}[convention["outside"]]
    # Nearer to the border rounding decides on which side of it the origin is.
    is_on_border = abs(epsilon) <= TOLERANCE["epsilon"]
    if epsilon < -TOLERANCE["epsilon"] or (is_on_border and stored["epsilon"] == outside):
        epsilon = outside
    found.equal("epsilon", "epsilon", epsilon, stored["epsilon"])
    found.equal("wrench volume", "wrench volume", space.volume, stored["volume"],
                1e-6 * abs(space.volume) + 1e-15)
    if not is_on_border:
        found.require(f"is_force_closure, epsilon {epsilon}",
                      stored["is_force_closure"] == (epsilon > 0))
        found.require(f"rank: recomputed {space.rank}", stored["rank"] == space.rank)
    return epsilon


def check_pre_grasp(scene, grasp, found):
    """Checks that the pre-grasp is clear by what the file says, back along the palm's direction,
    and that samples of the way are free."""
    stored = grasp["pre_grasp"]
    if stored is None:
        return None
    options = scene.options["pre_grasp"]
    X_OL = check_configuration(scene, stored, found, "pre-grasp ")
    check_poses(X_OL, stored, found, "pre-grasp ")
    links = scene.posed_links(X_OL)
    enough = stored["clearance_m"] + BEYOND
    apart = min([*scene.object_clearances(links, enough).values(),
                 scene.surroundings_clearance(links, enough)])
    found.equal("clearance", "pre-grasp clearance_m", apart, stored["clearance_m"])
    found.require(f"pre-grasp is clear by {apart} only",
                  apart >= options["clearance_m"] - TOLERANCE["clearance"])
    found.require("pre-grasp overlaps itself",
                  not scene.self_clearances(links, recompute.TOUCHING))
    X_grasp = hand_files.pose_of_json(grasp["X_OH"])
    direction = X_grasp[:3, :3] @ scene.record["hand"]["palm"]["direction_H"]
    X_OH = hand_files.pose_of_json(stored["X_OH"])
    found.equal("pose", "pre-grasp X_OH", X_OH[:3, :3], X_grasp[:3, :3])
    found.equal("pose", "pre-grasp retreat_m", X_OH[:3, 3],
                X_grasp[:3, 3] - stored["retreat_m"] * direction)
    if grasp["penetration"]["object_intersects"] or grasp["penetration"]["self_intersects"]:
        return apart
    shares = np.linspace(0, 1, WAY_SAMPLES + 1)[1:-1]
    touching = []
    for share, (X, values) in zip(shares, configurations.way(stored, grasp, shares)):
        links = scene.posed_links(scene.hand.link_poses(X, values))
        if (scene.object_clearances(links, recompute.TOUCHING)
                or scene.surroundings_clearance(links, recompute.TOUCHING) <= 0
                or scene.self_clearances(links, recompute.TOUCHING)):
            touching.append(round(float(share), 2))
    found.require(f"the way from the pre-grasp touches at shares {touching}", not touching)
    return apart


def check_squeeze(scene, grasp, contacts, found):
    """Checks that forces are in their cones and as balanced as stated, and joints by J^T f / kp."""
    stored = grasp["squeeze"]
    if stored is None:
        return
    options, friction = scene.options["squeeze"], scene.options["squeeze_friction"]
    X_OL = check_configuration(scene, stored, found, "squeeze ")
    check_poses(X_OL, stored, found, "squeeze ")
    found.equal("pose", "squeeze X_OH", hand_files.pose_of_json(stored["X_OH"]),
                hand_files.pose_of_json(grasp["X_OH"]))
    forces = np.array(stored["forces_O_N"]).reshape(-1, 3)
    bearing = touching(scene, contacts)
    contacts = [contact.contact for contact in contacts.values()]
    idle = [force for force, contact in zip(forces, contacts)
            if not any(contact is other for other in bearing)]
    found.require(f"forces {idle} on pads that do not touch", not np.any(idle))
    points = np.array([contact.point for contact in contacts])
    normals = np.array([contact.normal for contact in contacts])
    pressing = (forces * normals).sum(axis=1)
    sliding = np.linalg.norm(forces - pressing[:, None] * normals, axis=1)
    found.require(f"forces outside their cones: {sliding} over {pressing}",
                  (sliding <= friction * pressing + TOLERANCE["force"]).all())
    found.equal("force", "sum of normal forces", pressing.sum(), options["normal_sum_N"])
    residual = configurations.residual(points, forces, scene.center_of_mass, scene.largest_radius,
                                       options["normal_sum_N"])
    found.equal("force", "squeeze residual", residual, stored["residual"])
    found.require("is_balanced", stored["is_balanced"] ==
                  (stored["residual"] <= options["largest_residual"]))
    links = [scene.hand.pads[contact.pad].link for contact in contacts]
    torques = configurations.generalized_forces(scene.hand, grasp, links, points, forces)
    closing = {joint["name"]: joint["closing_sign"] for joint in scene.record["hand"]["joints"]}
    stiffness = options["stiffness_N_m_per_rad"]
    wanted = configurations.squeezed_joints(
        scene.hand, grasp, torques, stiffness,
        options["slide_stiffness_N_per_m"], closing)
    for name, value in stored["joints"].items():
        found.equal("squeeze", f"squeeze {name}", wanted[name], value)


def check_poses(X_OL, stored, found, where):
    for name, pose in stored["X_OL"].items():
        apart = recompute.pose_difference(X_OL[name], hand_files.pose_of_json(pose))
        found.equal("pose", f"{where}X_OL of {name}", max(apart), 0.0)


def check_requested(scene, grasp, contacts, quality, found):
    """Compares what follows from contacts and penetration: gaps of requested parts, usable,
    valid."""
    targets = grasp["targets"]["contacts"]
    if scene.options["style"] == "auto" and targets:
        # Which parts are to touch is each grasp's own matter.
        requested = {target.get("finger", "palm") for target in targets}
    else:
        requested = set(scene.used["fingers"]) | ({"palm"} if scene.used["palm"] else set())
    requested_pads = {c["pad"] for c in grasp["contacts"] if c["target"]}
    gaps = [contacts[name].gap for name in requested_pads]
    found.equal("gap", "largest_contact_gap_m", max(c.gap for c in contacts.values()),
                grasp["largest_contact_gap_m"])
    found.equal("gap", "largest_requested_gap_m", max(gaps, default=0.0),
                grasp["largest_requested_gap_m"])
    touching = {scene.hand.pads[name].finger for name in requested_pads}
    near = not scene.options["refine"] or (
        max(gaps, default=0.0) <= scene.options["refinement"]["largest_gap_m"])
    found.require(f"has_all_contacts: {sorted(touching)} of {sorted(requested)}, gaps {gaps}",
                  grasp["has_all_contacts"] == (touching >= requested and near))
    penetration = grasp["penetration"]
    free = not any(penetration[key] for key in ("object_intersects", "self_intersects",
                                                "surroundings_touched"))
    found.require(f"usable: M {quality.m}", grasp["usable"] == (quality.m > 0))
    found.require("valid", grasp["valid"] == (quality.m > 0 and free
                                              and grasp["has_all_contacts"]))
    return max(gaps, default=0.0)


def check_grasp(scene, grasp):
    """Returns a row of the table and what failed."""
    found = Comparison()
    X_OL = check_configuration(scene, grasp, found, "")
    check_poses(X_OL, grasp, found, "")
    links = scene.posed_links(X_OL)
    nearest, deepest = check_penetration(scene, grasp, links, found)
    contacts = check_contacts(scene, grasp, X_OL, found)
    row = {"nearest_mm": 1e3 * nearest, "depth_mm": 1e3 * deepest,
           "depth_file": 1e3 * grasp["largest_penetration_m"]}
    if contacts is not None:
        plain = [c.contact for c in contacts.values()]
        quality = check_measure(scene, grasp, plain, found)
        gap = check_requested(scene, grasp, contacts, quality, found)
        epsilon = check_wrench(scene, grasp["wrench"], touching(scene, contacts), found)
        check_squeeze(scene, grasp, contacts, found)
        row |= {"gap_mm": 1e3 * gap, "gap_file": 1e3 * grasp["largest_requested_gap_m"],
                "area_mm2": 1e6 * sum(contact.area for contact in plain),
                "area_file": 1e6 * sum(c["area_m2"] for c in grasp["contacts"]),
                "M": quality.m, "M_file": grasp["m"]}
        if epsilon is not None:
            row |= {"epsilon": epsilon, "eps_file": grasp["wrench"]["epsilon"]}
    clear = check_pre_grasp(scene, grasp, found)
    if clear is not None:
        row |= {"clear_mm": 1e3 * clear, "clear_file": 1e3 * grasp["pre_grasp"]["clearance_m"]}
    return row, found


def check_file(path):
    """Prints the table of one file. Returns the number of grasps that differ."""
    record = json.loads(path.read_text())
    scene = recompute.Scene(record, path.parent)
    shared = check_shared(scene)
    print(f"{path}: {record['object']['file']}, {record['hand']['name']}")
    failed, largest, header = [("shared", text) for text in shared.failures], {}, None
    for grasp in record["results"]["grasps"]:
        row, found = check_grasp(scene, grasp)
        if header is None:
            header = list(row)
            print("rank " + " ".join(f"{name:>10}" for name in header) + "  verdict")
        print(f"{grasp['rank']:4} " + " ".join(
            f"{row[name]:10.6f}" if name in row else f"{'-':>10}" for name in header)
            + ("  agrees" if not found.failures else "  DIFFERS"))
        failed += [(f"grasp {grasp['rank']}", text) for text in found.failures]
        for kind, value in found.largest.items():
            largest[kind] = max(largest.get(kind, 0.0), value)
    print("largest differences: " + ", ".join(
        f"{kind} {value:.1e}" for kind, value in largest.items()))
    for where, text in failed:
        print(f"  {where}: {text}")
    return len(failed)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=pathlib.Path, metavar="grasps.json")
    failures = 0
    for path in parser.parse_args().files:
        try:
            failures += check_file(path)
        except (OSError, ValueError, KeyError) as error:
            print(f"{path}: cannot be checked: {error}", file=sys.stderr)
            return 2
    print("all agree" if not failures else f"{failures} differences")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
