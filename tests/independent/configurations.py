"""Computes pre-grasp and squeeze of a grasp: what the ways and forces of a file amount to."""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

import hand_files

# Steps of joints in central differences [rad] or [m] give errors of 1e-12 over lengths.
STEP = 1e-6
FOLLOWS = 1e-9  # A follower this near to where its leader puts it stands there [rad] or [m].


def way(first, last, shares):
    """Returns (X_OH, joint values) along the straight way: the palm's origin moves linearly, its
    rotation along the shortest arc, joints linearly."""
    X_first, X_last = (hand_files.pose_of_json(c["X_OH"]) for c in (first, last))
    turns = Slerp([0, 1], Rotation.from_matrix([X_first[:3, :3], X_last[:3, :3]]))(shares)
    for share, turn in zip(shares, turns):
        middle = (1 - share) * X_first[:3, 3] + share * X_last[:3, 3]
        yield hand_files.pose(middle, turn), {
            name: (1 - share) * value + share * last["joints"][name]
            for name, value in first["joints"].items()}


def coupled_value(joint, coupling, values):
    """Returns where its leader puts a follower, within its limits."""
    return np.clip(coupling.ratio * values[coupling.leader] + coupling.offset, joint.lower,
                   joint.upper)


def generalized_forces(hand, configuration, links, points_O, forces_O):
    """Returns d/dq of the sum of forces . points that move with their links, per independent
    joint (joint transpose J^T f), by central differences. A follower moves with its leader where
    it stands at its coupled value inside its limits."""
    X_OH = hand_files.pose_of_json(configuration["X_OH"])
    values = configuration["joints"]
    start = hand.link_poses(X_OH, values)
    local = [hand_files.moved(hand_files.inverse(start[link]), point)
             for link, point in zip(links, points_O)]
    joints = {joint.name: joint for joint in hand.joints if joint.kind != "fixed"}

    def work(changed):
        X_OL = hand.link_poses(X_OH, changed)
        return sum(force @ hand_files.moved(X_OL[link], point)
                   for link, point, force in zip(links, local, forces_O))

    result = {}
    for name in joints:
        if name in hand.couplings:
            continue
        moving = {name: 1.0}
        for follower, coupling in hand.couplings.items():
            if coupling.leader != name or follower not in joints:
                continue
            free = coupling.ratio * values[name] + coupling.offset
            if abs(values[follower] - free) <= FOLLOWS:
                moving[follower] = coupling.ratio
        ends = [work({**values, **{key: values[key] + sign * STEP * ratio
                                   for key, ratio in moving.items()}}) for sign in (1, -1)]
        result[name] = (ends[0] - ends[1]) / (2 * STEP)
    return result


def squeezed_joints(hand, configuration, generalized, stiffness, slide_stiffness, closing):
    """Returns joint values commanded so that joints press with the generalized forces, within
    limits.

    `closing` is +1 or -1 per joint. A breakaway follower that is further closed than its leader
    puts it stays.
    """
    values = dict(configuration["joints"])
    joints = {joint.name: joint for joint in hand.joints}
    for name, force in generalized.items():
        joint = joints[name]
        give = slide_stiffness if joint.kind == "prismatic" else stiffness
        values[name] = np.clip(values[name] + force / give, joint.lower, joint.upper)
    for name, coupling in hand.couplings.items():
        if name in joints:
            wanted = coupled_value(joints[name], coupling, values)
            further = (values[name] - wanted) * closing.get(name, 0) > 0
            if not (coupling.breakaway and further):
                values[name] = wanted
    return values


def residual(points_O, forces_O, center, torque_scale, normal_sum):
    """Returns the unbalanced wrench of contact forces over the sum of their normal parts."""
    torque = np.cross(points_O - center, forces_O).sum(axis=0) / torque_scale
    return np.linalg.norm(np.concatenate([forces_O.sum(axis=0), torque])) / normal_sum
