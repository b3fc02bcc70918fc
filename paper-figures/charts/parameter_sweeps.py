"""Quality, usable and valid rate, and time against one option of the planner at a time."""

import numpy as np
from figure_style import CYCLE, MARKERS, SOFT, panels
from object_names import note_for, shown_name

KEYS = ("object", "option")
OPTIONS = {
    "resolution": ("resolution [voxels]", 30, "log"),
    "alpha": ("alpha", 2, "linear"),
    "beta": ("beta", 0.3, "linear"),
    "score_threshold": ("S_thres", 0.6, "linear"),
    "theta_max_deg": ("theta_max [degrees]", 45, "linear"),
}
MEASURES = {
    "mean_m": "mean M",
    "usable_rate": "usable per attempt",
    "valid_rate": "valid per attempt",
    "cpu_per_attempt_s": "time per attempt [s]",
}


def parts(label):
    """("score_threshold", 0.6) for score_threshold_0.6."""
    name, _, value = label.rpartition("_")
    return name, float(value)


def draw(source):
    table = source.table("parameter_sweeps", (*KEYS, "attempts", "mean_m", "usable_rate", "valid_rate"))
    timing = source.table("parameter_sweeps.timing", (*KEYS, "cpu_s"))
    table = table.merge(timing[[*KEYS, "cpu_s"]], on=list(KEYS))
    table["cpu_per_attempt_s"] = table["cpu_s"] / table["attempts"]
    table["parameter"], table["value"] = zip(*table["option"].map(parts))
    objects = list(dict.fromkeys(table["object"]))
    figure, axes = panels(
        f"One option at a time, Barrett hand, {table['attempts'].max():.0f} attempts each", len(MEASURES), len(OPTIONS), 10.4, 7.0,
        note_for(objects, "Dotted: the paper's value, our default. M changes its meaning with alpha and beta: curves of M compare within, not across, their values.\n"
                          "Time: processor time of one thread; the object's model, found once and kept in a cache, apart; the machine is named in parameter_sweeps.manifest.json."),
        left=0.06, right=0.99, head=0.75, foot=0.38, wspace=0.28, hspace=0.16,
    )  # fmt: skip
    for column, (parameter, (words, default, scale)) in enumerate(OPTIONS.items()):
        rows = table[table["parameter"] == parameter].sort_values("value")
        for row, (measure, label) in enumerate(MEASURES.items()):
            ax = axes[row][column]
            for k, name in enumerate(objects):
                of_object = rows[rows["object"] == name].groupby("value")[measure].mean()
                ax.plot(of_object.index, of_object, color=CYCLE[k], marker=MARKERS[k], label=shown_name(name.removeprefix("shape_")))
            ax.axvline(default, color=SOFT, linestyle=":", linewidth=1.0)
            ax.set_xscale(scale)
            most = np.nanmax(rows[measure]) if rows[measure].notna().any() else 1.0
            ax.set_ylim(0, 1.05 if measure.endswith("rate") else 1.08 * most)
            if column == 0:
                ax.set_ylabel(label)
            values = sorted(rows["value"].unique())
            ticks = [10, 20, 30, 60, 120] if parameter == "resolution" else values
            ax.set_xticks(ticks, [f"{v:g}" for v in ticks] if row == len(MEASURES) - 1 else [""] * len(ticks))
            ax.minorticks_off()
            ax.tick_params(axis="x", labelsize=6.5)
        axes[-1][column].set_xlabel(words)
    figure.legend(*axes[0][0].get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(0.05, 0.965), ncol=len(objects))
    return figure
