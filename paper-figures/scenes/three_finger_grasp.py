"""A Barrett hand holds the bunny with three fingers; contacts as dots."""

from figure_style import panels, show_picture
from grasp_row import measures
from grasp_scene import Stage, grasp_panel


def draw(source):
    record = source.grasp_file("paper_grasps", "bunny_three_fingers")
    table = source.table("paper_grasps", ("case", "attempts")).set_index("case")
    attempts = int(table.loc["bunny_three_fingers", "attempts"])
    stage = Stage(760, 760)
    figure, axes = panels(
        f"BUNNY (12 cm), Barrett hand: the best of {attempts} attempts", 1, 2, 6.6, 3.95,
        "Left: across the palm direction; right: facing the contact polygon. Green: stable pairs.",
        head=0.42, foot=0.22,
    )  # fmt: skip
    for ax, facing in zip(axes[0], (False, True)):
        show_picture(ax, grasp_panel(stage, source, record, facing=facing))
    axes[0][0].text(1.0, -0.02, measures(record["grasps"][0]), transform=axes[0][0].transAxes, ha="center", va="top", fontsize=7)
    return figure
