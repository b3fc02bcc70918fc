"""A ball in four modes of the human hand."""

from grasp_row import grasp_figure
from object_names import note_for

MODES = {
    "ball_pinch_2": "two-finger pinch",
    "ball_grip_3": "three-finger grip",
    "ball_power_4": "four-finger power",
    "ball_power_5": "five-finger power",
}


def draw(source):
    return grasp_figure(
        source, "BALL* (9.5 cm), human hand: four modes", [list(MODES)], [list(MODES.values())],
        note_for(["ball"]), size=2.2, arrows=False,
    )  # fmt: skip
