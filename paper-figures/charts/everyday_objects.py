"""Valid rate of everyday objects with five hands."""

import matplotlib
import numpy as np
from figure_style import panels
from heat_table import heat_table, why_empty

COLUMNS = ("object", "hand", "status", "attempts", "valid_rate", "best_m", "reason")
SHOWN = [
    ("valid_rate", "attempts that end in a valid grasp", "{:.0%}", 1.0),
    ("best_m", "M of the best grasp", "{:.2f}", 4.0),
]


def draw(source):
    table = source.table("planner_everyday", COLUMNS)
    objects = list(dict.fromkeys(table["object"]))
    hands = list(dict.fromkeys(table["hand"]))
    figure, axes = panels(
        f"Everyday objects with five hands: {table['attempts'].max():.0f} attempts each", 1, 2, 8.6, 3.9,
        "Gray: larger than the hand spans, or no valid grasp. Allegro and Shadow hands as others publish them.",
        left=0.17, head=0.75, wspace=0.05, foot=0.08,
    )  # fmt: skip
    for ax, (column, title, number, most) in zip(axes[0], SHOWN):
        values = np.full((len(objects), len(hands)), np.nan)
        reasons = [["none"] * len(hands) for _ in objects]
        for row in table.itertuples():
            i, j = objects.index(row.object), hands.index(row.hand)
            values[i, j] = getattr(row, column)
            reasons[i][j] = why_empty(row.status, row.reason)
        names = [name.replace("_", " ") for name in objects] if ax is axes[0][0] else [""] * len(objects)
        labels = [hand.replace("_", " ") for hand in hands]
        heat_table(ax, values, names, labels, matplotlib.colormaps["viridis"], most, number, reasons)
        ax.set_title(title, pad=20)
    return figure
