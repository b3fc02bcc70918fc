"""Panels of voxels, score maps and targets."""

import matplotlib
import numpy as np
from figure_style import SCORE_MAP
from grasp_scene import OBJECT, TARGET, score_colors

THRESHOLD = 0.6  # the paper's S_thres
PARTIAL = "#8fa3b5"


def voxel_panel(stage, voxels, back, up, points):
    """Partial voxels as cubes."""
    rgb = np.tile(matplotlib.colors.to_rgb(PARTIAL), (len(voxels.partial), 1))
    solid = stage.boxes(voxels.centers(), 0.94 * voxels.size, rgb)
    return stage.panel([solid], back, up, points)


def score_panel(stage, voxels, back, up, points):
    """Partial voxels as cubes in the colors of their scores."""
    rgb = score_colors(voxels.partial["score"], matplotlib.colormaps[SCORE_MAP])
    solid = stage.boxes(voxels.centers(), 1.0 * voxels.size, rgb)
    return stage.panel([solid], back, up, points)


def normal_panel(stage, voxels, vertices, triangles, back, up, points):
    """Centroids of the partial voxels' surface with their normals, over the object."""
    centroids = voxels.partial[["centroid_x_m", "centroid_y_m", "centroid_z_m"]].to_numpy()
    normals = voxels.partial[["normal_x", "normal_y", "normal_z"]].fillna(0.0).to_numpy()
    segments = list(zip(centroids, centroids + 1.3 * voxels.size * normals))
    solids = [
        stage.mesh(vertices, triangles, OBJECT),
        stage.colored_tubes(segments, 0.06 * voxels.size, "#0072B2"),
    ]
    return stage.panel(solids, back, up, points)


def target_panel(stage, record, grasp, vertices, triangles, back, up, points, size):
    """The object with the target contacts, their normals and polygon."""
    targets = grasp["targets"]["contacts"]
    at = [np.asarray(target["point_O_m"]) for target in targets]

    def marks():
        made = [stage.colored_ball(p, 0.02 * size, TARGET) for p in at]
        pairs = [(at[i], at[j]) for i in range(len(at)) for j in range(i + 1, len(at))]
        made.append(stage.colored_tubes(pairs, 0.0045 * size, TARGET))
        for target in targets:
            made += stage.colored_arrow(target["point_O_m"], target["outward_normal_O"], 0.13 * size, 0.005 * size, TARGET)
        made.append(stage.colored_ball(record["object"]["center_of_mass_O_m"], 0.013 * size, "#22252a"))
        return made

    return stage.panel([stage.mesh(vertices, triangles, OBJECT)], back, up, points, marks)


def score_bar(figure, axes):
    """The color bar of scores with the threshold."""
    colors = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0.0, 1.0), matplotlib.colormaps[SCORE_MAP])
    bar = figure.colorbar(colors, cax=axes, orientation="horizontal")
    bar.set_label("contact score (line: threshold of targets)", fontsize=6.5, labelpad=1)
    bar.ax.tick_params(labelsize=6)
    bar.ax.axvline(THRESHOLD, color="white", linewidth=1.5)
    bar.outline.set_visible(False)
