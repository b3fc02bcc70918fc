"""The squirrel's voxels: centroids and normals, score map, three targets."""

from figure_style import panels, show_picture
from grasp_scene import Stage, level, span, up_of
from target_panels import normal_panel, score_bar, score_panel, target_panel
from voxel_data import Voxels


def draw(source):
    voxels = Voxels(source, "squirrel")
    record = source.grasp_file("fitting_stages", "squirrel")
    vertices, triangles = source.object_mesh(record)
    stage = Stage(640, 640)
    _, up = up_of("squirrel")
    view = (level(65, 12), up, vertices)
    figure, axes = panels(
        f"SQUIRREL (15 cm): {int(voxels.row['partial'])} partial voxels, 30 along the longest side", 1, 3, 7.6, 3.75,
        f"The paper counts 2478. {voxels.row['eligible_share']:.0%} of the voxels pass the threshold of 0.6.",
        head=0.5, foot=0.42,
    )  # fmt: skip
    show_picture(axes[0][0], normal_panel(stage, voxels, vertices, triangles, *view), "centroids and normals")
    show_picture(axes[0][1], score_panel(stage, voxels, *view), "contact scores")
    targets = target_panel(stage, record, record["grasps"][0], vertices, triangles, *view, span(vertices))
    show_picture(axes[0][2], targets, "three targets")
    score_bar(figure, figure.add_axes([0.38, 0.115, 0.25, 0.028]))
    return figure
