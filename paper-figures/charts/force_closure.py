"""Force closure and epsilon of the first valid grasps of the bunny, as found and selected."""

import numpy as np
from figure_style import BLUE, GREEN, panels

COLUMNS = (
    "grip", "friction", "closed_share", "median_epsilon", "attempts", "selected_median_epsilon",
    "selected_attempts", "grasps", "selected_grasps",
)  # fmt: skip


def draw(source):
    table = source.table("force_closure", COLUMNS)
    labels = [grip.replace("_", " ") for grip in table["grip"]]
    figure, axes = panels(
        f"BUNNY, 12 cm: force closure of the first {table['grasps'].max()} valid grasps", 1, 3, 9.0, 2.9,
        f"Friction {table['friction'].iloc[0]:g}. Selected: only grasps with an epsilon above the threshold of the experiment.",
        left=0.2, right=0.97, head=0.55, foot=0.4, wspace=0.16,
    )  # fmt: skip
    y = np.arange(len(table))
    share, epsilon, attempts = axes[0]
    share.barh(y, table["closed_share"], color=BLUE)
    share.axvline(0.6, color="black", linewidth=0.8, linestyle=":")
    share.set_xlim(0, 1)
    share.set_xlabel("share with closure (dotted: aim)")
    epsilon.barh(y - 0.2, table["median_epsilon"], height=0.38, color=BLUE, label="as found")
    epsilon.barh(y + 0.2, table["selected_median_epsilon"], height=0.38, color=GREEN, label="selected")
    epsilon.set_xlabel("median epsilon")
    per_grasp = table["attempts"] / table["grasps"]
    attempts.barh(y - 0.2, per_grasp, height=0.38, color=BLUE, label="as found")
    attempts.barh(y + 0.2, table["selected_attempts"] / table["selected_grasps"], height=0.38, color=GREEN, label="selected")
    attempts.set_xscale("log")
    attempts.set_xlim(left=0.9)
    attempts.set_xlabel("attempts per grasp")
    for ax in axes[0]:
        ax.set_yticks(y, labels if ax is share else [""] * len(y))
        ax.invert_yaxis()
        ax.grid(axis="y", visible=False)
    epsilon.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=2)
    attempts.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=2)
    return figure
