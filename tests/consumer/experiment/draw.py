#!/usr/bin/python3
"""Draws the table of own_experiment: how far apart the palms are, by what was varied.

Usage: draw.py grasp_spread.csv FIGURE.png
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import pandas

table = pandas.read_csv(sys.argv[1])
assert list(table["varied"]) == ["defaults", "resolution_16", "alpha_4", "beta_0.6",
                                 "score_threshold_0.4"], "not the rows of the sweep"
assert (table["status"] == "ok").all(), "a cell has no result"
figure, axes = plt.subplots(figsize=(6, 3), layout="constrained")
bars = axes.bar(table["varied"], table["palm_spread_m"] * 1000)
axes.bar_label(bars, ["%d grasps\nM %.3f" % row for row in zip(table["grasps"], table["best_m"])])
axes.margins(y=0.25)
axes.set_ylabel("largest distance of palms (mm)")
axes.set_title("Grasps of the %s, the best M" % table["object"][0])
axes.tick_params(axis="x", labelrotation=15)
figure.savefig(sys.argv[2], dpi=100)
