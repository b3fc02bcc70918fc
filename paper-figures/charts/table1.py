"""Mean M, time per usable grasp and overlap of hand and object of GS, MA and fitting, beside the paper's Table 1."""

import numpy as np
from figure_style import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, YELLOW, panels
from object_names import NOTE

KEYS = ["object", "size", "planner"]
METHODS = {
    "gs-targets": ("GS, random targets", YELLOW),
    "gs": ("GS, random approach", ORANGE),
    "ma": ("MA", GREEN),
    "ma-full-retreat": ("MA, full retreat", PURPLE),
    "fitting": ("fitting", SKY),
    "fitting-reject-deviation": ("fitting, far contacts rejected", BLUE),
    "fitting-reject-m": ("fitting, small M rejected", VERMILION),
}
OF_PAPER = ("gs", "ma", "fitting-reject-deviation")  # by which each of the paper's three is drawn once
OBJECTS = {
    "bowling_pin": "BOWLING as a pin*",
    "bowling_ball": "BOWLING as a ball*",
    "max_planck": "MAX PLANCK",
    "kitten": "KITTEN",
}


def draw(source):
    table = source.table("table1.summary", (*KEYS, "grasps", "mean_m", "se_m", "overlap_mean_m", "paper_m", "paper_time_s"))
    timing = source.table("table1.timing", (*KEYS, "per_found_grasp_s"))
    seconds = timing.groupby(KEYS)["per_found_grasp_s"].mean().reset_index()  # over the seeds
    table = table.merge(seconds, on=KEYS, how="left")
    table["overlap_mm"] = 1000.0 * table["overlap_mean_m"]
    measures = (
        ("mean_m", "mean M", "paper_m", "se_m"),
        ("per_found_grasp_s", "time per usable grasp [s]", "paper_time_s", None),
        ("overlap_mm", "deepest overlap, mean [mm]", None, None),
    )
    sizes = list(dict.fromkeys(table["size"]))
    figure, axes = panels(
        f"Three methods, Barrett hand (4 DOF), up to {table['grasps'].max():.0f} usable grasps each, at the level of voxels", 3, len(OBJECTS), 10.0, 7.0,
        f"{NOTE}\nLeft of each panel: the paper's numbers (hatched). GS and MA are reconstructions; MA as published and with full retreat. Bars: one standard error."
        "\nTimes by the clock, failures included, preparation apart; other machines. Overlap: of the true meshes, hand in object or in itself;"
        "\nin the object at most a voxel's edge, but for MA as published: it closes at most 15 mm from where it began, even inside the object.",
        left=0.06, right=0.99, head=0.95, foot=0.3, wspace=0.2, hspace=0.16,
    )  # fmt: skip
    width = 0.9 / len(METHODS)
    for column, (name, words) in enumerate(OBJECTS.items()):
        rows = table[table["object"] == name]
        for row, (measure, label, of_paper, error) in enumerate(measures):
            ax = axes[row][column]
            for k, (method, (title, color)) in enumerate(METHODS.items()):
                shift = width * (k - (len(METHODS) - 1) / 2)
                of_method = rows[rows["planner"] == method].set_index("size").reindex(sizes)
                if of_paper and method in OF_PAPER:
                    center = 0.25 * (OF_PAPER.index(method) - 1)
                    ax.bar(center, of_method[of_paper].iloc[0], width=0.22, color="white", edgecolor=color, hatch="//////")
                ax.bar(np.arange(len(sizes)) + 1.2 + shift, of_method[measure], width=0.9 * width, color=color, label=title,
                       yerr=of_method[error] if error else None, error_kw={"elinewidth": 0.7})  # fmt: skip
            ax.axvline(0.6, color="#c9cdd2", linewidth=0.8)
            ax.grid(axis="x", visible=False)
            if row == 1:
                ax.set_yscale("log")
                ax.set_ylim(0.008, 40)
            words_below = "paper" if of_paper else ""
            ax.set_xticks([0, *(np.arange(len(sizes)) + 1.2)], [words_below, *(f"{100 * float(size):g} cm" for size in sizes)])
            if column == 0:
                ax.set_ylabel(label)
        axes[0][column].set_title(words)
    figure.legend(*axes[0][0].get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(0.05, 0.965), ncol=4)
    return figure
