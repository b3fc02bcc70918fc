"""Time and quality of grasps against their number of contacts N'."""

import numpy as np
from figure_style import CYCLE, MARKERS, SOFT, panels
from object_names import note_for, shown_name

COUNTS = {2: "2", 3: "3", 4: "4", 5: "5", 6: "6", 7: "7_or_more"}
KEYS = ("object", "grip")
LEAST = 5  # grasps behind a point of a curve; fewer say little


def of_hand(table, hand):
    return table[table["grip"].str.startswith(hand + "_")]


def time_curve(timing):
    """Processor time per attempt that ended in a grasp with N' contacts, mean over all grasps."""
    points = []
    for count, name in COUNTS.items():
        weights = timing[f"grasps_{name}"].fillna(0).to_numpy()
        if weights.sum() >= LEAST:
            points.append((count, np.average(timing[f"cpu_s_{name}"].fillna(0), weights=weights)))
    return points


def draw(source):
    details = source.table("contacts_and_time.details", (*KEYS, "num_contacts", "stable_pairs", "m", "m1", "m2", "m3"))
    timing = source.table(
        "contacts_and_time.timing",
        [*KEYS, *(f"{what}_{name}" for name in COUNTS.values() for what in ("cpu_s", "grasps"))],
    )
    objects = list(dict.fromkeys(details["object"]))
    figure, axes = panels(
        "Time and quality of usable grasps against their number of contacts N'", 2, 4, 10.0, 4.9,
        note_for(objects, f"Points are means of {LEAST} grasps or more; bars: interquartile range. 7 stands for 7 and more."
                 " Time: one thread of the machine of contacts_and_time.manifest.json, attempts that failed left out."),
        left=0.09, right=0.985, head=0.75, foot=0.38, wspace=0.3, hspace=0.32,
    )  # fmt: skip
    for row, (hand, label) in enumerate((("barrett", "Barrett hand"), ("human", "human hand"))):
        grasps = of_hand(details, hand).copy()
        grasps["num_contacts"] = grasps["num_contacts"].clip(upper=max(COUNTS))
        for k, name in enumerate(objects):
            color, marker = CYCLE[k], MARKERS[k]
            of_object = grasps[grasps["object"] == name]
            times = time_curve(of_hand(timing[timing["object"] == name], hand))
            axes[row][0].plot(*zip(*times), color=color, marker=marker, label=shown_name(name))
            for ax, measure in zip(axes[row][1:], ("m", "m2", "m1")):
                groups = [(n, g[measure]) for n, g in of_object.groupby("num_contacts") if len(g) >= LEAST]
                if not groups:
                    continue
                at = np.array([n for n, _ in groups]) + 0.09 * (k - 1.5)
                low, middle, high = zip(*(
                    (values.quantile(0.25), values.mean(), values.quantile(0.75)) for _, values in groups
                ))  # fmt: skip
                ax.vlines(at, low, high, color=color, linewidth=1.0, alpha=0.5)
                ax.plot(at, middle, color=color, marker=marker)
        axes[row][0].set_ylabel(f"{label}\nprocessor time [s]")
        for ax, words in zip(axes[row][1:], ("M", "M2 (stable pairs)", "M1 (pads)")):
            ax.set_ylabel(words, labelpad=1)
        for ax in axes[row]:
            ax.set_xticks(list(COUNTS))
            ax.set_ylim(bottom=0)
            ax.set_xlim(1.6, 7.4)
            if row == 1:
                ax.set_xlabel("number of contacts N'")
    figure.legend(*axes[0][0].get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(0.08, 0.95), ncol=4)
    axes[0][3].set_title(f"{len(details)} grasps", loc="right", color=SOFT, fontsize=7)
    return figure
