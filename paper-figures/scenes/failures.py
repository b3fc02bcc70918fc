"""The octopus and the cage, on which the paper's method fails, and how far ours gets."""

import numpy as np
from figure_style import BLUE, ORANGE, SOFT, VERMILION, panels
from grasp_row import grasp_panels, show_grasp
from object_names import NOTE

CELLS = ["octopus_barrett", "octopus_human_hand", "cage_barrett", "cage_human_hand"]
WORDS = ["OCTOPUS, Barrett", "OCTOPUS, human hand", "CAGE*, Barrett", "CAGE*, human hand"]
OUTCOMES = {
    "valid": ("attempts_valid", BLUE),
    "unstable or penetrating": (("attempts_usable_but_not_valid", "attempts_no_stable_pair", "attempts_poor_shape", "attempts_weak_features_only"), ORANGE),
    "no targets": ("attempts_no_target_set", "#c9cdd2"),
    "blocked, missed or colliding": (
        ("attempts_initial_collision", "attempts_blocked_finger", "attempts_missed_contact", "attempts_gap_left",
         "attempts_self_collision", "attempts_no_way_in", "attempts_iteration_limit"), VERMILION),
}  # fmt: skip


def names_of(columns):
    return (columns,) if isinstance(columns, str) else columns


def draw(source):
    columns = [name for columns, _ in OUTCOMES.values() for name in names_of(columns)]
    table = source.table("planner_paper_objects", ("object", "grip", "status", "attempts", "valid_rate", *columns))
    made = grasp_panels(source, "paper_grasps", [CELLS], arrows=False)[0]
    figure, axes = panels(
        "Objects that the paper's method fails on: best grasps, and how attempts end", 2, 4, 9.6, 5.3,
        NOTE + f"\nBars: {table['attempts'].max():.0f} attempts each of planner_paper_objects; number: valid ones, in brackets the median over all objects.",
        head=0.5, foot=0.3, height_ratios=(2.0, 1.0), hspace=0.3, left=0.02,
    )  # fmt: skip
    for ax, panel, words in zip(axes[0], made, WORDS):
        show_grasp(ax, panel, words)
    for ax in axes[1]:
        ax.remove()
    ax = figure.add_axes([0.2, 0.15, 0.72, 0.19])
    rows = [(name, grip) for name in ("octopus", "cage") for grip in ("barrett_3", "human_3")]
    for y, (name, grip) in enumerate(rows):
        found = table[(table["object"] == name) & (table["grip"] == grip)].iloc[0]
        start = 0.0
        for columns, color in OUTCOMES.values():
            share = sum(float(found[c]) for c in names_of(columns)) / float(found["attempts"])
            ax.barh(y, share, left=start, color=color, height=0.7)
            start += share
        usual = np.nanmedian(table[table["grip"] == grip]["valid_rate"])
        ax.text(1.01, y, f"{found['valid_rate']:.0%} ({usual:.0%})", va="center", fontsize=7, color=SOFT)
    ax.set_yticks(range(len(rows)), WORDS)
    ax.invert_yaxis()
    ax.set_xlim(0, 1)
    ax.set_xlabel("share of attempts", labelpad=1)
    ax.grid(axis="y", visible=False)
    handles = [ax.barh(0, 0, color=color, label=words) for words, (_, color) in OUTCOMES.items()]
    ax.legend(handles=handles, loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncol=4)
    return figure
