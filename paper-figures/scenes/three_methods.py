"""Typical grasps of the methods GS, MA and fitting on three objects."""

from grasp_row import grasp_figure, middle
from object_names import note_for, shown_name

OBJECTS = ("bowling", "max_planck", "kitten")
METHODS = {"gs": "GS", "ma": "MA", "ma_full_retreat": "MA, full retreat", "fitting": "fitting"}


def draw(source):
    table = source.table("paper_grasps", ("case", "grasps", "attempts")).set_index("case")
    rows = [[f"method_{method}_{name}" for method in METHODS] for name in OBJECTS]
    words = []
    for name, cells in zip(OBJECTS, rows):
        words.append([])
        for method, cell in zip(METHODS.values(), cells):
            found = table.loc[cell]
            words[-1].append(f"{shown_name(name)}, {method}\n{found['grasps']:.0f} grasps of {found['attempts']:.0f} attempts")
    return grasp_figure(
        source,
        "Typical grasps of three methods: Barrett hand, three fingers; pin 30 cm, the others 15 cm",
        rows,
        words,
        note_for(
            OBJECTS,
            "Of the first five grasps of each method (refined and free of penetration for all) the one with the median M.",
        ),
        size=2.2,
        arrows=False,
        pick=middle,
    )
