"""Valid rate, mean M and force closure of every object and grip."""

import matplotlib
import numpy as np
from figure_style import panels
from heat_table import heat_table, why_empty
from object_names import note_for, shown_name

COLUMNS = ("object", "grip", "status", "attempts", "valid_rate", "mean_m", "force_closed_share", "reason")
GRIPS = {
    "gripper_2": "gripper\n2 contacts",
    "barrett_3": "Barrett\n3 contacts",
    "barrett_power": "Barrett\npower",
    "human_3": "human\n3 contacts",
    "human_5": "human\n5 contacts",
}


def draw(source):
    table = source.table("planner_paper_objects", COLUMNS)
    objects = list(dict.fromkeys(table["object"]))
    figure, axes = panels(
        f"The paper's objects with five grips: {table['attempts'].max():.0f} attempts each", 1, 3, 10.5, 6.6,
        note_for(objects, "Gray: larger than the hand spans, or no grasp. Closure at friction 0.4."),
        left=0.155, head=0.95, wspace=0.06, foot=0.1,
    )  # fmt: skip
    shown = [
        ("valid_rate", "attempts that end in a valid grasp", "{:.0%}", 1.0),
        ("mean_m", "mean M of the distinct valid grasps", "{:.2f}", 3.0),
        ("force_closed_share", "share of these with force closure", "{:.0%}", 1.0),
    ]
    colormap = matplotlib.colormaps["viridis"]
    for k, (column, title, number, most) in enumerate(shown):
        values = np.full((len(objects), len(GRIPS)), np.nan)
        reasons = [[""] * len(GRIPS) for _ in objects]
        for row in table.itertuples():
            i, j = objects.index(row.object), list(GRIPS).index(row.grip)
            values[i, j] = getattr(row, column)
            reasons[i][j] = why_empty(row.status, row.reason)
        ax = axes[0][k]
        names = [shown_name(name) for name in objects] if k == 0 else []
        heat_table(ax, values, names or [""] * len(objects), GRIPS.values(), colormap, most, number, reasons)
        ax.set_title(title, pad=30)
        ax.tick_params(axis="x", labelsize=6.5)
    return figure
