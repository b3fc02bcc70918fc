"""Mean M, time per usable grasp and overlap of hand and object of GS, MA and fitting, beside the paper's Table 1."""

import numpy as np
from figure_style import BLUE, GREEN, ORANGE, PURPLE, panels
from object_names import NOTE

KEYS = ("object", "size", "planner")
METHODS = {"gs": ("GS", ORANGE), "ma": ("MA", GREEN), "ma-full-retreat": ("MA, full retreat", PURPLE), "fitting": ("fitting", BLUE)}
OBJECTS = {
    "bowling_pin": "BOWLING as a pin*",
    "bowling_ball": "BOWLING as a ball*",
    "max_planck": "MAX PLANCK",
    "kitten": "KITTEN",
}
OF_PAPER = {f"{method.replace('-', '_')}_paper_{what}" for method in METHODS for what in ("m", "time_s")}


def draw(source):
    table = source.table("table1", (*KEYS, "grasps", "mean_m"))
    timing = source.table("table1.timing", (*KEYS, "per_found_grasp_s"))
    table = table.merge(timing[[*KEYS, "per_found_grasp_s"]], on=list(KEYS))
    details = source.table("table1.details", (*KEYS, "deepest_overlap_m"))
    overlap = details.groupby(list(KEYS))["deepest_overlap_m"].mean().mul(1000.0).rename("overlap_mm")
    table = table.merge(overlap.reset_index(), on=list(KEYS), how="left")
    paper = source.table("table1.summary", ("object", *sorted(OF_PAPER))).drop_duplicates("object").set_index("object")
    measures = (("mean_m", "mean M", "m"), ("per_found_grasp_s", "time per usable grasp [s]", "time_s"), ("overlap_mm", "deepest overlap, mean [mm]", None))
    sizes = list(dict.fromkeys(table["size"]))
    figure, axes = panels(
        f"Three methods, Barrett hand, up to {table['grasps'].max():.0f} usable grasps each, at the level of voxels", 3, len(OBJECTS), 10.0, 6.8,
        f"{NOTE}\nLeft of each panel: the paper's numbers (hatched). GS and MA are reconstructions; MA as published and with full retreat."
        "\nTimes by the clock, failures included, preparation apart; other machines. Overlap: of the true meshes, hand in object or in itself;"
        "\nthe methods work on voxels and none looks at it. MA as published stops at most 15 mm from where it began, inside the object.",
        left=0.06, right=0.99, head=0.8, foot=0.3, wspace=0.2, hspace=0.16,
    )  # fmt: skip
    for column, (name, words) in enumerate(OBJECTS.items()):
        rows = table[table["object"] == name]
        for row, (measure, label, of_paper) in enumerate(measures):
            ax = axes[row][column]
            for k, (method, (title, color)) in enumerate(METHODS.items()):
                shift = 0.2 * (k - 1.5)
                if of_paper and method != "ma-full-retreat":  # its MA is drawn once
                    ax.bar(shift, paper.loc[name, f"{method}_paper_{of_paper}"], width=0.18, color="white", edgecolor=color, hatch="//////")
                of_method = rows[rows["planner"] == method].set_index("size")[measure].reindex(sizes)
                ax.bar(np.arange(len(sizes)) + 1.2 + shift, of_method, width=0.18, color=color, label=title)
            ax.axvline(0.6, color="#c9cdd2", linewidth=0.8)
            ax.grid(axis="x", visible=False)
            if row == 1:
                ax.set_yscale("log")
                ax.set_ylim(0.008, 5)
            words_below = "paper" if of_paper else ""
            ax.set_xticks([0, *(np.arange(len(sizes)) + 1.2)], [words_below, *(f"{100 * float(size):g} cm" for size in sizes)])
            if column == 0:
                ax.set_ylabel(label)
        axes[0][column].set_title(words)
    figure.legend(*axes[0][0].get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(0.05, 0.955), ncol=len(METHODS))
    return figure
