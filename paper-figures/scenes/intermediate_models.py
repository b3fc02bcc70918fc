"""What each method looks at: surface samples (GS), medial balls (MA), contact scores (fitting)."""

import numpy as np
from figure_style import BLUE, GREEN, ORANGE, PURPLE, SKY, color_legend, panels, show_picture
from grasp_scene import OBJECT, Stage, level, up_of
from matplotlib.colors import to_rgb
from object_names import note_for, shown_name
from target_panels import score_bar, score_panel
from voxel_data import NORMAL, Voxels

OBJECTS = {"bowling": (20, 8), "max_planck": (60, 8), "kitten": (60, 12)}  # seen from: azimuth, elevation [degrees]
ROW = ("object", "planner", "points")
POINT = ("object", "planner", "x_m", "y_m", "z_m", *NORMAL, "radius_m", "kind")
KINDS = {
    "axis": ("axis of symmetry", BLUE),
    "rim": ("rim of a plane", GREEN),
    "interior": ("interior", "#a8aeb5"),
    "point": ("at one point", ORANGE),
    "alone": ("alone", PURPLE),
}


def sample_panel(stage, points, vertices, triangles, view):
    """The object with surface samples and their normals."""
    at = points[["x_m", "y_m", "z_m"]].to_numpy()
    normals = points[NORMAL].to_numpy()
    size = np.ptp(vertices, axis=0).max()
    solids = [
        stage.mesh(vertices, triangles, OBJECT),
        stage.boxes(at, 0.012 * size, np.tile(to_rgb("#0072B2"), (len(at), 1))),
        stage.colored_tubes(list(zip(at, at + 0.035 * size * normals)), 0.0016 * size, SKY),
    ]
    return stage.panel(solids, *view)


def ball_panel(stage, points, vertices, triangles, view):
    """The object, transparent, with the balls' centers in the colors of their symmetry, and some balls."""
    at = points[["x_m", "y_m", "z_m"]].to_numpy()
    size = np.ptp(vertices, axis=0).max()
    colors = np.array([to_rgb(KINDS[kind][1]) for kind in points["kind"]])
    solids = [
        stage.mesh(vertices, triangles, OBJECT, opacity=0.22),
        stage.boxes(at, 0.016 * size, colors),
    ]
    return stage.panel(solids, *view)


def draw(source):
    table = source.table("guidance_models", ROW)
    details = source.table("guidance_models.details", POINT)
    stage = Stage(560, 560)
    figure, axes = panels(
        "What each method looks at to guide hands (pin 30 cm, the others 15 cm)",
        3, 3, 7.2, 8.3,
        note_for(OBJECTS, "GS: samples and normals. MA: centers of inscribed balls, by the symmetry of their neighborhood. Fitting: partial voxels, 30 along the longest side."),
        head=0.62, foot=0.55, hspace=0.13,
    )  # fmt: skip
    for row, (name, angles) in zip(axes, OBJECTS.items()):
        voxels = Voxels(source, name)
        vertices, triangles = source.object_mesh(source.grasp_file("paper_grasps", f"method_fitting_{name}"))
        _, up = up_of(name)
        view = (level(*angles), up, vertices)
        points = {planner: details[(details["object"] == name) & (details["planner"] == planner)] for planner in ("gs", "ma")}
        counts = table[table["object"] == name].set_index("planner")["points"]
        label = shown_name(name)
        show_picture(row[0], sample_panel(stage, points["gs"], vertices, triangles, view), f"{label}, GS: {counts['gs']} samples")
        show_picture(row[1], ball_panel(stage, points["ma"], vertices, triangles, view), f"MA: {counts['ma']} balls")
        show_picture(row[2], score_panel(stage, voxels, *view), f"fitting: {int(voxels.row['partial'])} scores")
    color_legend(figure, [(color, words) for words, color in KINDS.values()], loc="lower left", bbox_to_anchor=(0.01, 0.035))
    score_bar(figure, figure.add_axes([0.7, 0.066, 0.25, 0.013]))
    return figure
