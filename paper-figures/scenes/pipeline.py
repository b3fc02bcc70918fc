"""From mesh to grasp on the bunny, in seven steps."""

import matplotlib
import numpy as np
from figure_style import panels, show_picture
from fitting_stages import stage_panel
from grasp_scene import OBJECT, Stage, hand_points, level, span, up_of
from target_panels import score_bar, score_panel, target_panel, voxel_panel
from voxel_data import Voxels, stages, voxel_centers


def draw_distances(ax, voxels):
    """The slice of the signed distance map through the center of mass."""
    image, names, extent = voxels.distance_slice()
    most = np.abs(image).max()
    cm = [100 * x for x in extent]
    shown = ax.imshow(
        image, origin="lower", extent=cm, cmap=matplotlib.colormaps["RdBu"], vmin=-most, vmax=most,
        interpolation="nearest",
    )  # fmt: skip
    ax.contour(
        voxel_centers(*cm[:2], image.shape[1]), voxel_centers(*cm[2:], image.shape[0]), image, levels=[-0.5, 0.5],
        colors="black", linewidths=0.5,
    )  # fmt: skip
    ax.set_xlabel(f"{names[0]} [cm]", labelpad=0)
    ax.set_ylabel(f"{names[1]} [cm]", labelpad=0)
    ax.grid(False)
    ax.tick_params(labelsize=6)
    return shown


def draw(source):
    voxels = Voxels(source, "bunny")
    record = source.grasp_file("fitting_stages", "bunny")
    found = stages(source, "bunny")
    vertices, triangles = source.object_mesh(record)
    links = source.link_meshes(record)
    stage = Stage(560, 560)
    _, up = up_of("bunny")
    view = (level(70, 12), up, vertices)
    figure, axes = panels(
        "BUNNY (12 cm), Barrett hand: from mesh to grasp", 2, 4, 8.8, 5.6,
        f"Slice of the distance map through the center of mass; black: the partial voxels ({int(voxels.row['partial'])} in all)."
        " The hand is shown as its meshes (purple), of which the loop keeps the voxels clear.",
        head=0.5, foot=0.15, hspace=0.3, wspace=0.08,
    )  # fmt: skip
    one, two = axes
    solid = stage.mesh(vertices, triangles, OBJECT)
    show_picture(one[0], stage.panel([solid], *view), "1  mesh")
    show_picture(one[1], voxel_panel(stage, voxels, *view), "2  voxels")
    show_picture(one[2], score_panel(stage, voxels, *view), "3  contact scores")
    shown = draw_distances(one[3], voxels)
    one[3].set_title("4  signed distances [voxels]", pad=3)
    box = one[3].get_position()
    one[3].set_position([box.x0 + 0.035, box.y0 + 0.045, box.width - 0.07, box.height - 0.045])
    bar = figure.colorbar(shown, cax=figure.add_axes([0.955, box.y0 + 0.08, 0.008, box.height - 0.11]))
    bar.ax.tick_params(labelsize=6)
    bar.outline.set_visible(False)
    targets = target_panel(stage, record, record["grasps"][0], vertices, triangles, *view, span(vertices))
    show_picture(two[0], targets, "5  three targets")
    points = np.concatenate([vertices, *(hand_points(links, found[name][1]) for name in ("initial", "loop_2", "grasp"))])
    for ax, name, words in zip(two[1:], ("initial", "loop_2", "grasp"), ("6  fitting: start", "6  fitting: on its way", "7  grasp")):
        show_picture(ax, stage_panel(stage, source, record, found[name][1], points, name == "grasp"), words)
    score_bar(figure, figure.add_axes([0.545, 0.522, 0.15, 0.011]))
    return figure
