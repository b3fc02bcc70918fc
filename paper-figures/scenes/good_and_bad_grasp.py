"""An undesired grasp, one contact far from its target, beside a good one."""

import numpy as np
from figure_style import panels, show_picture
from grasp_row import measures
from grasp_scene import Stage, grasp_panel


def largest_miss(grasp):
    """Largest distance of a target from the contact of its finger [m]."""
    misses = []
    for target in grasp["targets"]["contacts"]:
        own = [c["point_O_m"] for c in grasp["contacts"] if c["finger"] == target["finger"] and c["target"]]
        if own:
            misses.append(min(np.linalg.norm(np.subtract(p, target["point_O_m"])) for p in own))
    return max(misses)


def draw(source):
    record = source.grasp_file("paper_grasps", "squirrel_sets")
    grasps = record["grasps"]
    bad = max(range(len(grasps)), key=lambda k: largest_miss(grasps[k]))
    good = min(range(len(grasps)), key=lambda k: largest_miss(grasps[k]))
    stage = Stage(620, 620)
    figure, axes = panels(
        "SQUIRREL (15 cm), Barrett hand: contacts (red) and targets (blue)", 1, 2, 6.4, 4.0,
        f"Of the first {len(grasps)} valid grasps those whose farthest contact is farthest from and nearest to its target.",
        head=0.42, foot=0.26,
    )  # fmt: skip
    for ax, index in zip(axes[0], (bad, good)):
        grasp = grasps[index]
        words = f"farthest contact {1000 * largest_miss(grasp):.0f} mm from its target"
        show_picture(ax, grasp_panel(stage, source, record, index, arrows=False, targets=True), words, measures(grasp))
    return figure
