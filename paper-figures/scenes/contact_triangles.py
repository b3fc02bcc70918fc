"""The squirrel with two contact triangles: irregular or off center, and regular and centered."""

from figure_style import panels, show_picture
from grasp_scene import OBJECT, Stage, back_direction, grasp_marks, grasp_panel, span


def by_shape(record):
    """Indices of the grasps with the smallest and the largest M3."""
    order = sorted(range(len(record["grasps"])), key=lambda k: record["grasps"][k]["m3"])
    return order[0], order[-1]


def without_hand(stage, source, record, grasp):
    vertices, triangles = source.object_mesh(record)
    back, up = back_direction(record, grasp, facing=True)
    solids = [stage.mesh(vertices, triangles, OBJECT, opacity=0.45)]
    marks = grasp_marks(stage, record, grasp, 1.3 * span(vertices), arrows=False)
    return stage.panel(solids, back, up, vertices, marks)


def draw(source):
    record = source.grasp_file("paper_grasps", "squirrel_sets")
    stage = Stage(620, 620)
    figure, axes = panels(
        "SQUIRREL (15 cm), Barrett hand: contact polygons, bad and good by M3", 2, 2, 5.6, 5.75,
        f"Of the first {len(record['grasps'])} valid grasps those with the smallest and the largest M3 = R - 0.3 D.\n"
        "Right: regularity R, M3, and D: how far the polygon's centroid is from the center of mass (black),\n"
        "over half the diagonal of the object's bounding box.",
        head=0.42, foot=0.24, hspace=0.05,
    )  # fmt: skip
    for row, (index, words) in enumerate(zip(by_shape(record), ("irregular or off center", "regular and centered"))):
        grasp = record["grasps"][index]
        show_picture(axes[row][0], grasp_panel(stage, source, record, index, arrows=False), words)
        distance = grasp["centroid_distance_m"] / record["object"]["normalizing_radius_m"]
        below = f"R {grasp['regularity']:.2f}   D {distance:.2f}   M3 {grasp['m3']:.2f}"
        show_picture(axes[row][1], without_hand(stage, source, record, grasp), None)
        axes[row][1].set_title(below, pad=3, fontsize=7.5)
    return figure
