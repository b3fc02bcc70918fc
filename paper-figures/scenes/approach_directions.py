"""The squirrel grasped from three directions."""

from grasp_row import grasp_figure

FROM = {"top": "from the top", "side": "from the side", "front": "from the front"}


def draw(source):
    return grasp_figure(
        source,
        "SQUIRREL (15 cm), Barrett hand: three approach directions",
        [[f"squirrel_from_{name}" for name in FROM]],
        [list(FROM.values())],
        "Palm direction (violet) within 45 degrees of the direction asked for; the paper's three poses amount to the same.",
        palm=True,
    )
