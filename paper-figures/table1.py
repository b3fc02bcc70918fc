"""Mean M, time per usable grasp and overlap of hand and object of GS, MA and fitting, beside the paper's Table 1."""

import numpy as np
from figure_style import BLUE, GREEN, ORANGE, PURPLE, panels
from object_names import NOTE

KEYS = ("object", "size", "planner")
METHODS = {"gs": ("GS", ORANGE), "ma": ("MA", GREEN), "ma-full-retreat": ("MA, full retreat", PURPLE), "fitting": ("fitting", BLUE)}
OBJECTS = {
    "bowling_pin": ("BOWLING as a pin*", "bowling"),
    "bowling_ball": ("BOWLING as a ball*", "bowling"),
    "max_planck": ("MAX PLANCK", "max_planck"),
    "kitten": ("KITTEN", "kitten"),
}
# Object -> method -> (time [s], quality), the paper's Table 1.
PAPER = {
    "bowling": {"gs": (0.5, 0.96), "ma": (0.3, 1.18), "fitting": (0.6, 1.36)},
    "max_planck": {"gs": (2.6, 0.61), "ma": (1.7, 0.85), "fitting": (1.3, 1.22)},
    "kitten": {"gs": (3.7, 0.52), "ma": (1.2, 0.92), "fitting": (1.8, 1.06)},
}


def draw(source):
    table = source.table("table1", (*KEYS, "grasps", "mean_m"))
    timing = source.table("table1.timing", (*KEYS, "per_found_grasp_s"))
    table = table.merge(timing[[*KEYS, "per_found_grasp_s"]], on=list(KEYS))
    details = source.table("table1.details", (*KEYS, "deepest_overlap_m"))
    overlap = details.groupby(list(KEYS))["deepest_overlap_m"].mean().mul(1000.0).rename("overlap_mm")
    table = table.merge(overlap.reset_index(), on=list(KEYS), how="left")
    measures = (("mean_m", "mean M", 1), ("per_found_grasp_s", "time per usable grasp [s]", 0), ("overlap_mm", "deepest overlap, mean [mm]", None))
    sizes = list(dict.fromkeys(table["size"]))
    figure, axes = panels(
        f"Three methods, Barrett hand, up to {table['grasps'].max():.0f} usable grasps each, at the level of voxels", 3, len(OBJECTS), 10.0, 6.8,
        f"{NOTE}\nLeft of each panel: the paper's numbers (hatched). GS and MA are reconstructions; MA as published and with full retreat."
        "\nTimes by the clock, failures included, preparation apart; other machines. Overlap: of the true meshes, hand in object or in itself;"
        "\nthe methods work on voxels and none looks at it. MA as published stops at most 15 mm from where it began, inside the object.",
        left=0.06, right=0.99, head=0.8, foot=0.3, wspace=0.2, hspace=0.16,
    )  # fmt: skip
    for column, (name, (words, paper_name)) in enumerate(OBJECTS.items()):
        rows = table[table["object"] == name]
        for row, (measure, label, index) in enumerate(measures):
            ax = axes[row][column]
            for k, (method, (title, color)) in enumerate(METHODS.items()):
                shift = 0.2 * (k - 1.5)
                paper = PAPER[paper_name].get(method)
                if paper and index is not None:
                    ax.bar(shift, paper[index], width=0.18, color="white", edgecolor=color, hatch="//////")
                of_method = rows[rows["planner"] == method].set_index("size")[measure].reindex(sizes)
                ax.bar(np.arange(len(sizes)) + 1.2 + shift, of_method, width=0.18, color=color, label=title)
            ax.axvline(0.6, color="#c9cdd2", linewidth=0.8)
            ax.grid(axis="x", visible=False)
            if row == 1:
                ax.set_yscale("log")
                ax.set_ylim(0.008, 5)
            words_below = "paper" if index is not None else ""
            ax.set_xticks([0, *(np.arange(len(sizes)) + 1.2)], [words_below, *(f"{100 * float(size):g} cm" for size in sizes)])
            if column == 0:
                ax.set_ylabel(label)
        axes[0][column].set_title(words)
    figure.legend(*axes[0][0].get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(0.05, 0.955), ncol=len(METHODS))
    return figure
