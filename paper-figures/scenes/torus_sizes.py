"""A small torus from outside, a large one through its hole."""

import numpy as np
from figure_style import panels, show_picture
from grasp_row import measures
from grasp_scene import Stage, grasp_panel, view_of
from object_names import note_for

SIZES = {"torus_7cm": "7 cm wide", "torus_16cm": "16 cm wide"}


def along_hole(record, grasp):
    """Looking nearly along the axis of the hole (y), from the side away from the palm."""
    palm = view_of(record, grasp)["palm_direction"]
    side = 1.0 if palm[1] >= 0.0 else -1.0
    back = np.array([0.22, side, 0.32])
    return (back / np.linalg.norm(back)).tolist(), [0.0, 0.0, 1.0]


def draw(source):
    stage = Stage(620, 560)
    figure, axes = panels(
        "TORUS*, Barrett hand: outside or through the hole", 2, 2, 6.0, 6.3,
        note_for(["torus"], "Power grasps with the largest M. Above: across the palm direction; below: along the hole, from beyond.\n"
                            "How often each kind comes out over seeds: figure special_cases."),
        head=0.45, foot=0.35, hspace=0.06,
    )  # fmt: skip
    for column, (cell, words) in enumerate(SIZES.items()):
        record = source.grasp_file("paper_grasps", cell)
        grasp = record["grasps"][0]
        show_picture(axes[0][column], grasp_panel(stage, source, record, arrows=False), words)
        view = along_hole(record, grasp)
        show_picture(axes[1][column], grasp_panel(stage, source, record, view=view, arrows=False), None, measures(grasp))
    return figure
