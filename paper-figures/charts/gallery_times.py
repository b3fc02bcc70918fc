"""What stands above each grasp of the gallery: vertices, time, contacts, quality."""

import numpy as np
from figure_style import BLUE, GREEN, ORANGE, panels
from object_names import GALLERY, note_for, shown_name

COLUMNS = ("case", "attempts", "valid", "best_m", "best_num_contacts")


def draw(source):
    table = source.table("paper_grasps", COLUMNS).set_index("case")
    timing = source.table("paper_grasps.timing", ("case", "cpu_s")).set_index("case")
    names = [name for of_hand in GALLERY.values() for name in of_hand]
    colors = [color for of_hand, color in zip(GALLERY.values(), (BLUE, ORANGE, GREEN)) for _ in of_hand]
    cells = [f"gallery_{name}" for name in names]
    vertices = [source.grasp_file("paper_grasps", cell)["object"]["num_vertices"] for cell in cells]
    valid = table.loc[cells, "valid"]
    per_grasp = timing.loc[cells, "cpu_s"] / valid.where(valid > 0)  # not a number without grasps
    figure, axes = panels(
        "Fifteen objects: mesh, time per valid grasp, contacts and quality of the best grasp", 1, 4, 10.0, 4.0,
        note_for(names, "Time: processor time of the cell, one thread, failures included, over its valid grasps;\nthe object's model, found once and kept in a cache, apart;"
                        " the machine is named in paper_grasps.manifest.json."),
        left=0.155, right=0.985, head=0.62, foot=0.35, wspace=0.09,
    )  # fmt: skip
    shown = [
        (np.array(vertices) / 1000, "vertices [thousands]", "{:.1f}"),
        (per_grasp, "time per valid grasp [s]", "{:.2f}"),
        (table.loc[cells, "best_num_contacts"], "contacts N'", "{:.0f}"),
        (table.loc[cells, "best_m"], "quality M", "{:.2f}"),
    ]
    y = np.arange(len(names))
    for ax, (values, words, number) in zip(axes[0], shown):
        values = np.asarray(values, dtype=float)
        ax.barh(y, np.nan_to_num(values), color=colors, height=0.7)
        for at, value in zip(y, values):
            shown_value = "no valid grasp" if np.isnan(value) else number.format(value)
            ax.text(np.nan_to_num(value), at, f" {shown_value}", va="center", fontsize=6.5)
        ax.set_yticks(y, [shown_name(name) for name in names] if ax is axes[0][0] else [""] * len(y))
        ax.set_xlim(0, 1.22 * np.max(np.nan_to_num(values)) or 1.0)
        ax.set_ylim(-0.6, len(y) - 0.4)
        ax.invert_yaxis()
        ax.grid(axis="y", visible=False)
        ax.set_xlabel(words)
    for k, (hand, color) in enumerate(zip(GALLERY, (BLUE, ORANGE, GREEN))):
        figure.text(0.16 + 0.09 * k, 0.885, f"■ {hand}", color=color, fontsize=8)
    return figure
