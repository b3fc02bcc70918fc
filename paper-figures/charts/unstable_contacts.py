"""Contact sets on a ball that the measure should punish, beside a good one."""

import numpy as np
from figure_style import BLUE, GREEN, SOFT, VERMILION, panels

SETS = {
    "good": "good: three contacts\nspread evenly",
    "fragile_part": "one contact on a\nfragile part (open)",
    "finger_edge": "one finger touches\nwith its edge (small)",
    "no_stable_pair": "no stable pair:\nfree to leave",
    "irregular": "irregular triangle",
    "off_center": "triangle above the center\nof mass (out of all cones)",
}
COLUMNS = ("set", "m", "m1", "m2", "m3", "stable_pairs")
DETAILS = ("set", "contact", "x_m", "y_m", "z_m", "boundary_distance", "strength", "paired_with")


def partners(field):
    """Contacts of the pairs in a field such as "1 2"; pandas reads a single one as a number."""
    text = "" if field != field else str(field)
    return [int(float(word)) for word in text.split()]


def draw_set(ax, contacts):
    radius = float(np.hypot(np.hypot(contacts["x_m"], contacts["y_m"]), contacts["z_m"]).max())
    turn = np.linspace(0, 2 * np.pi, 200)
    ax.plot(radius * np.cos(turn), radius * np.sin(turn), color="#b9b2a3", linewidth=1.2)
    ax.fill(radius * np.cos(turn), radius * np.sin(turn), color="#efe9dc")
    points = contacts[["x_m", "y_m"]].to_numpy()
    lines = {tuple(sorted((i, j))) for i, field in enumerate(contacts["paired_with"]) for j in partners(field)}
    for i in range(len(points)):
        for j in range(i + 1, len(points)):
            stable = (i, j) in lines
            ax.plot(*points[[i, j]].T, color=GREEN if stable else SOFT, linewidth=2.0 if stable else 0.9, linestyle="-" if stable else ":")
    for (x, y), row in zip(points, contacts.itertuples()):
        size = 3.5 + 5.5 * row.boundary_distance
        ax.plot(x, y, "o", markersize=size, markerfacecolor=VERMILION if row.strength > 0 else "white", markeredgecolor=VERMILION)
        inward = np.array([-row.x_m, -row.y_m]) * 0.28
        ax.annotate("", (x + inward[0], y + inward[1]), (x, y), arrowprops={"arrowstyle": "-|>", "color": VERMILION, "lw": 0.9})
    ax.plot(0, 0, "+", color="black", markersize=6)
    ax.set_xlim(-1.3 * radius, 1.3 * radius)
    ax.set_ylim(-1.3 * radius, 1.3 * radius)
    ax.set_aspect("equal")
    ax.set_axis_off()


def draw(source):
    table = source.table("measured_contacts", COLUMNS).set_index("set")
    details = source.table("measured_contacts.details", DETAILS)
    figure, axes = panels(
        "What the measure notices: contacts on a ball, each set worse than the first in one respect", 2, len(SETS), 10.0, 3.9,
        "Seen along z; plus: center of mass; green: stable pair; dotted: other edges. M and its terms as computed by the library, Barrett fingertips.",
        left=0.05, right=0.99, head=0.75, foot=0.25, hspace=0.12, wspace=0.25, height_ratios=(1.35, 1),
    )  # fmt: skip
    most = max(1.0, table.loc[list(SETS), ["m", "m1", "m2", "m3"]].to_numpy().max())
    for (name, words), above, below in zip(SETS.items(), *axes):
        draw_set(above, details[details["set"] == name].reset_index(drop=True))
        above.set_title(words, fontsize=7.5)
        values = table.loc[name, ["m1", "m2", "m3", "m"]].astype(float)
        below.bar(range(4), values, color=[BLUE, BLUE, BLUE, VERMILION], width=0.65)
        for x, value in enumerate(values):
            below.text(x, max(value, 0) + 0.02 * most, f"{value:.2f}", ha="center", va="bottom", fontsize=6.5)
        below.set_xticks(range(4), ["M1", "M2", "M3", "M"])
        below.set_ylim(0, 1.18 * most)
        below.grid(axis="x", visible=False)
        if name != "good":
            below.set_yticklabels([])
    return figure
