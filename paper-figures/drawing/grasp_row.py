"""Figures that are panels of grasps: one of each of some cells of one experiment, as a rule the best."""

from figure_data import BadData
from figure_style import panels, show_picture
from grasp_scene import Stage, grasp_panel


def measures(grasp):
    """The lines under a panel."""
    parts = f"M1 {grasp['m1']:.2f}, M2 {grasp['m2']:.2f}, M3 {grasp['m3']:.2f}"
    return f"M {grasp['m']:.2f}, N' {len(grasp['contacts'])}\n{parts}"


def best(grasps):
    """Index of the grasp with the largest M: files hold that one first."""
    return 0


def middle(grasps):
    """Index of the grasp with the median M, of an even number the better of the middle two."""
    return (len(grasps) - 1) // 2


def grasp_panels(source, experiment, rows, width=430, height=430, pick=best, **marks):
    """Panels [rows][columns] of (panel, grasp); None where the table says that no grasp was found.

    `pick` chooses among the grasps of a cell, which come in the order of falling M.
    """
    stage = Stage(width, height)
    table = source.table(experiment, ("case", "grasps")).set_index("case")
    made = []
    for row in rows:
        made.append([])
        for cell in row:
            if cell not in table.index:
                raise BadData(f"{experiment}.csv: has no case {cell}")
            if not table.loc[cell, "grasps"] > 0:  # empty where the planner refused the object
                made[-1].append(None)
                continue
            record = source.grasp_file(experiment, cell)
            index = pick(record["grasps"])
            made[-1].append((grasp_panel(stage, source, record, index, **marks), record["grasps"][index]))
    return made


def show_grasp(axes, made, words):
    """One of `grasp_panels` with its title and measures."""
    if made is None:
        axes.set_axis_off()
        axes.set_title(words, pad=3)
        axes.text(0.5, 0.5, "no valid grasp found", ha="center", va="center", transform=axes.transAxes)
        return
    show_picture(axes, made[0], words, measures(made[1]))


def grasp_figure(source, title, rows, words, note=None, experiment="paper_grasps", size=2.45, **marks):
    """A figure of panels: `rows` of cells, `words` the titles in the same places."""
    columns = max(len(row) for row in rows)
    made = grasp_panels(source, experiment, rows, **marks)
    explained = "Below: the measure M with its terms, and the number of contacts N'. Parallel projection.\n"
    explained += "Red: contacts with inward normals; green: stable pairs; gray: other edges; black: center of mass."
    figure, axes = panels(
        title, len(rows), columns, columns * size, len(rows) * (size + 0.5) + 0.7,
        explained + (f"\n{note}" if note else ""),
        head=0.55, foot=0.2, hspace=0.34, wspace=0.03,
    )  # fmt: skip
    for i, row in enumerate(axes):
        for j, ax in enumerate(row):
            if j < len(rows[i]):
                show_grasp(ax, made[i][j], words[i][j])
            else:
                ax.set_axis_off()
    return figure
