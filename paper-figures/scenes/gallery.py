"""Fifteen objects with three hands, in the paper's order."""

from grasp_row import grasp_figure
from object_names import GALLERY, note_for, shown_name


def draw(source):
    table = source.table("paper_grasps", ("case", "valid", "attempts")).set_index("case")
    rows = [[f"gallery_{name}" for name in names] for names in GALLERY.values()]
    attempts = int(table.loc[rows[0][0], "attempts"])
    words = [[shown_name(name) for name in names] for names in GALLERY.values()]
    return grasp_figure(
        source,
        f"Fifteen objects: gripper, Barrett hand, human hand; the best of {attempts} attempts each",
        rows,
        words,
        note_for([name for names in GALLERY.values() for name in names],
                 "For the gripper objects are scaled down to 7 cm of thickness, which it spans."),
        size=2.1,
        arrows=False,
    )  # fmt: skip
