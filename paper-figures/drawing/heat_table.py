"""A table of shares as colored cells with their numbers; empty cells say why."""

import numpy as np
from matplotlib.colors import to_rgb


def why_empty(status, reason):
    """What stands where a run has no number."""
    if status == "ok":
        return "none"
    too_large = status == "failed" and str(reason).startswith("the object measures ")
    return "too large" if too_large else status


def heat_table(axes, values, rows, columns, colormap, most=1.0, number="{:.0%}", reasons=None):
    """`values` [rows, columns] with NaN where there is none; `reasons` texts for those.

    Numbers are black on bright cells and white on dark ones.
    """
    axes.grid(False)
    axes.set_facecolor("#f1f2f4")
    image = axes.imshow(np.ma.masked_invalid(values), cmap=colormap, vmin=0.0, vmax=most, aspect="auto")
    for i, row in enumerate(values):
        for j, value in enumerate(row):
            if np.isnan(value):
                axes.text(j, i, reasons[i][j] if reasons else "-", ha="center", va="center", fontsize=6, color="#6b7178")
                continue
            red, green, blue = to_rgb(colormap(value / most))
            bright = 0.299 * red + 0.587 * green + 0.114 * blue > 0.5
            axes.text(j, i, number.format(value), ha="center", va="center", fontsize=6.5, color="black" if bright else "white")
    axes.set_xticks(range(len(columns)), columns)
    axes.set_yticks(range(len(rows)), rows)
    axes.tick_params(length=0)
    axes.xaxis.tick_top()
    for spine in axes.spines.values():
        spine.set_visible(False)
    return image
