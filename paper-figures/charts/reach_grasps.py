"""Closure, epsilon, distance from targets and attempts of the first valid grasps at targets that the hand can meet."""

from figure_style import CYCLE, MARKERS, panels
from object_names import note_for, short_name

COLUMNS = (
    "object", "size", "hand", "friction", "grasps", "attempts", "force_closed_share", "median_epsilon", "median_target_distance_m",
)  # fmt: skip
ROWS = (
    ("force_closed_share", 1.0, "share that closes", (0.0, 1.05)),
    ("median_epsilon", 1.0, "median epsilon", (0.0, None)),
    ("median_target_distance_m", 1000.0, "contact to target [mm]", (0.0, None)),
    ("attempts_per_grasp", 1.0, "attempts per grasp", (0.0, None)),
)


def draw(source):
    table = source.table("reach_grasps", COLUMNS)
    table["attempts_per_grasp"] = table["attempts"] / table["grasps"]
    table["size_m"] = [float(size.removesuffix("_m")) for size in table["size"]]
    friction = " and ".join(f"{value:g}" for value in sorted(set(table["friction"])))
    objects = list(dict.fromkeys(table["object"]))
    hands = list(dict.fromkeys(table["hand"]))
    figure, axes = panels(
        f"Targets that the hand can meet: the first {table['grasps'].max():.0f} valid grasps, all attempts counted", len(ROWS), len(objects), 9.0, 8.0,
        note_for(objects, f"Closure by contacts that touch, at friction {friction} (dotted: 80 %, asked for). Distances: median of a cell's contacts."),
        left=0.07, right=0.98, head=0.75, foot=0.35, wspace=0.08, hspace=0.14,
    )  # fmt: skip
    for i, (column, scale, words, limits) in enumerate(ROWS):
        most = scale * table[column].max()
        for j, name in enumerate(objects):
            ax = axes[i][j]
            for k, hand in enumerate(hands):
                rows = table[(table["object"] == name) & (table["hand"] == hand)].sort_values("size_m")
                ax.plot(rows["size_m"], scale * rows[column], color=CYCLE[k], marker=MARKERS[k], label=hand.capitalize())
            ax.set_ylim(limits[0], limits[1] or 1.08 * most)
            ax.set_xticks([0.1, 0.2, 0.3])
            if i == 0:
                ax.axhline(0.8, color="black", linewidth=0.8, linestyle=":")
                ax.set_title(short_name(name))
            if i < len(ROWS) - 1:
                ax.tick_params(labelbottom=False)
            else:
                ax.set_xlabel("longest edge [m]")
            if j == 0:
                ax.set_ylabel(words)
            else:
                ax.tick_params(labelleft=False)
    figure.legend(*axes[0][0].get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(0.06, 0.965), ncol=len(hands))
    return figure
