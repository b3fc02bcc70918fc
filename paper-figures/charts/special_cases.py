"""How often the planner's best grasp is of the kind that the paper shows, per case."""

import numpy as np
from figure_style import BLUE, ORANGE, SOFT, panels
from object_names import NOTE, short_name

COLUMNS = ("case", "seed", "status", "satisfied", "satisfying_grasps", "grasps")
# By case: the object, and what is claimed of its grasps.
CLAIMS = {
    "bunny_9cm": ("bunny", " 9 cm wide: pinch, ears left alone"),
    "bunny_15cm": ("bunny", " 15 cm wide: three-finger grip"),
    "bunny_30cm": ("bunny", " 30 cm wide: power grasp, palm on"),
    "torus_7cm": ("torus", " 7 cm wide: all contacts on the outer side"),
    "torus_16cm": ("torus", " 16 cm wide: a finger through the hole"),
    "squirrel_from_top": ("squirrel", " from the top"),
    "squirrel_from_side": ("squirrel", " from the side"),
    "squirrel_from_front": ("squirrel", " from the front"),
    "ball_pinch_2": ("ball", ": two-finger pinch"),
    "ball_grip_3": ("ball", ": three-finger grip"),
    "ball_power_4": ("ball", ": four-finger power grasp"),
    "ball_power_5": ("ball", ": five-finger power grasp"),
    "mug_four_contacts": ("mug", ": four contacts or more"),
    "teddy_six_contacts": ("teddy", ": six contacts or more"),
    "horse_legs": ("horse", ": no contact on the legs"),
    "horse_legs_rejection": ("horse", ": the same, far contacts rejected instead"),
    "shark_fins": ("shark", ": no contact on the fins"),
}


def label(case):
    """The object, with its star, and the claim."""
    if case not in CLAIMS:
        return case
    name, claim = CLAIMS[case]
    return short_name(name) + claim


def wilson(successes, count, z=1.96):
    """95 % interval of a share [Wilson 1927]."""
    share = successes / count
    center = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z * np.sqrt(share * (1 - share) / count + z * z / (4 * count * count)) / (1 + z * z / count)
    return center - half, center + half


def draw(source):
    table = source.table("special_cases", COLUMNS)
    figure, axes = panels(
        "Grasps that the paper shows: how often the best grasp of a seed is of that kind", 1, 1, 7.6, 4.6,
        f"{NOTE}\nLines: 95 % intervals over seeds. Light: share of all grasps found.",
        left=0.44, right=0.91, head=0.4, foot=0.35,
    )  # fmt: skip
    ax = axes[0][0]
    cases = list(dict.fromkeys(table["case"]))
    for y, case in enumerate(cases):
        rows = table[table["case"] == case]
        satisfied = int((rows["satisfied"].astype(str).str.lower() == "true").sum())
        found = rows["grasps"].fillna(0).sum()
        if found > 0:
            ax.barh(y, rows["satisfying_grasps"].fillna(0).sum() / found, height=0.78, color=ORANGE, alpha=0.3)
        ax.barh(y, satisfied / len(rows), height=0.42, color=BLUE)
        low, high = wilson(satisfied, len(rows))
        ax.plot([low, high], [y, y], color="black", linewidth=1.0)
        ax.text(1.03, y, f"{satisfied}/{len(rows)}", va="center", fontsize=7, color=SOFT, clip_on=False)
    ax.set_ylim(-0.6, len(cases) - 0.4)
    ax.set_yticks(range(len(cases)), [label(case) for case in cases])
    ax.invert_yaxis()
    ax.grid(axis="y", visible=False)
    ax.set_xlim(0, 1)
    ax.set_xlabel("share of seeds")
    return figure
