"""How often attempts end in a grasp that holds in physics, per object and grip."""

import matplotlib
import numpy as np
from figure_style import CYCLE, page
from heat_table import heat_table
from object_names import note_for, shown_name

PROTOCOLS = {"normal": "dexgraspbench-100g", "hard": "dexonomy-hard", "multidex": "gendexgrasp"}
COLUMNS = ("object", "grip", "status", "attempts", "valid", *(f"{name}_held" for name in PROTOCOLS))


def draw(source):
    table = source.table("hold_rates", COLUMNS)
    objects = list(dict.fromkeys(table["object"]))
    grips = list(dict.fromkeys(table["grip"]))
    figure = page(
        f"Grasps that hold in physics: {table['attempts'].max():.0f} attempts per object and grip", 10.0, 7.4,
        note_for(objects, "Left: share of attempts whose grasp holds under dexgraspbench-100g; gray: too large for the hand or not run."
                          " Right: the same over all objects, for three protocols."),
    )  # fmt: skip
    left = figure.add_axes([0.17, 0.09, 0.5, 0.81])
    values = np.full((len(objects), len(grips)), np.nan)
    for row in table.itertuples():
        if row.attempts > 0:
            values[objects.index(row.object), grips.index(row.grip)] = row.normal_held / row.attempts
    words = [grip.replace("_", "\n") for grip in grips]
    heat_table(left, values, [shown_name(name) for name in objects], words, matplotlib.colormaps["viridis"])
    left.tick_params(axis="x", labelsize=6)
    right = figure.add_axes([0.79, 0.09, 0.19, 0.81])
    sums = table.groupby("grip")[["attempts", *(f"{name}_held" for name in PROTOCOLS)]].sum().loc[grips]
    y = np.arange(len(grips))
    for k, (name, label) in enumerate(PROTOCOLS.items()):
        right.barh(y + 0.26 * (k - 1), sums[f"{name}_held"] / sums["attempts"], height=0.24, color=CYCLE[k], label=label)
    right.set_yticks(y, [grip.replace("_", " ") for grip in grips])
    right.invert_yaxis()
    right.set_xlim(0, 1)
    right.set_xlabel("held per attempt")
    right.grid(axis="y", visible=False)
    right.legend(loc="lower center", bbox_to_anchor=(0.35, 1.0))
    return figure
