"""The bunny at three widths with three kinds of grasp."""

from grasp_row import grasp_figure

WIDTHS = (9, 15, 30)
MODES = {"pinch": "pinch", "grip": "three fingers", "power": "power"}


def draw(source):
    return grasp_figure(
        source,
        "BUNNY, Barrett hand: width against kind of grasp",
        [[f"bunny_{width}cm_{mode}" for mode in MODES] for width in WIDTHS],
        [[f"{width} cm, {words}" for words in MODES.values()] for width in WIDTHS],
        "The paper shows the diagonal: pinch at 9 cm, three fingers at 15 cm, power at 30 cm.",
        size=2.3,
        arrows=False,
    )
