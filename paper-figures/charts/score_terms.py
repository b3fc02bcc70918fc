"""C_d and C_a on sharp, concave, uneven and smooth surface."""

import numpy as np
from figure_style import BLUE, CYCLE, ORANGE, SOFT, panels
from voxel_data import CENTROID, NORMAL, Voxels, window

# Where to look: object, and which of its partial voxels stands for the kind of surface.
PLACES = {
    "sharp": ("box", "a box's corner"),
    "concave": ("squirrel", "the squirrel's crease"),
    "uneven": ("armadillo", "the armadillo's skin"),
    "smooth": ("ball", "a ball"),
}
LEAST_NEIGHBORS = 20  # of a voxel on a sheet of surface; tips and edges have fewer


def on_sheets(voxels):
    """Per partial voxel on a sheet of surface: index, mean signed distance of its neighbors to its plane.

    Voxels with neighbors that look the other way (thin parts) are left out.
    """
    found = []
    normals = voxels.partial[NORMAL].fillna(0.0).to_numpy()
    centroids = voxels.partial[CENTROID].to_numpy()
    for index in range(len(voxels.partial)):
        near = window(voxels, index).index
        if len(near) < LEAST_NEIGHBORS or (normals[near] @ normals[index]).min() < -0.5:
            continue
        found.append((index, ((centroids[near] - centroids[index]) @ normals[index]).mean() / voxels.size))
    return found


def representative(kind, voxels):
    """Index of the partial voxel that stands for a kind of surface."""
    part = voxels.partial
    if kind == "sharp":  # the corner: the farthest from the center
        return int(np.linalg.norm(part[CENTROID].to_numpy(), axis=1).argmax())
    if kind == "concave":  # neighbors rise over its plane the most
        return max(on_sheets(voxels), key=lambda found: found[1])[0]
    if kind == "uneven":  # normals differ the most where neighbors lie on both sides of its plane
        both_sides = [index for index, offset in on_sheets(voxels) if abs(offset) < 0.1]
        return max(both_sides, key=lambda index: part["normal_angle_deg"][index])
    return int((part["normal_angle_deg"] - part["normal_angle_deg"].median()).abs().argmin())


def draw_section(ax, voxels, index):
    """Neighbors of a voxel in the plane of its normal and the direction in which they spread most."""
    near = window(voxels, index)
    center = voxels.partial.loc[index, CENTROID].to_numpy(dtype=float)
    normal = voxels.partial.loc[index, NORMAL].to_numpy(dtype=float)
    offset = (near[CENTROID].to_numpy() - center) / voxels.size
    other = near[NORMAL].fillna(0.0).to_numpy()
    _, _, directions = np.linalg.svd((other - np.outer(other @ normal, normal)))
    across = directions[0] - (directions[0] @ normal) * normal
    across /= np.linalg.norm(across)
    x, y = offset @ across, offset @ normal
    ax.axhline(0.0, color=SOFT, linewidth=0.9, linestyle="--")
    ax.quiver(x, y, other @ across, other @ normal, color=BLUE, scale=1.0, scale_units="xy", angles="xy", width=0.008)
    ax.plot(x, y, "o", color=BLUE, markersize=3)
    ax.quiver(0, 0, 0, 1.4, color="#D55E00", scale=1.0, scale_units="xy", angles="xy", width=0.014)
    ax.plot(0, 0, "o", color="#D55E00", markersize=5)
    ax.set_xlim(-4, 4)
    ax.set_ylim(-4, 3)
    ax.set_aspect("equal")
    ax.tick_params(labelsize=6)


def draw(source):
    found = {kind: Voxels(source, name) for kind, (name, _) in PLACES.items()}
    index = {kind: representative(kind, voxels) for kind, voxels in found.items()}
    figure, axes = panels(
        "Terms of the contact score: mean plane distance C_d and mean normal angle C_a of a voxel's neighbors", 2, 4, 9.4, 5.3,
        "Above: one voxel (red) and its neighbors in 5 x 5 x 5 voxels, seen in the plane of its normal and the direction in which normals vary most.\n"
        "Below: all partial voxels of four bodies (30 along the longest side), every one a dot; the voxel above is the cross. Box and ball are shapes of our own.",
        left=0.065, right=0.985, head=0.72, foot=0.4, hspace=0.3, wspace=0.24, height_ratios=(1.15, 1.0),
    )  # fmt: skip
    for k, (kind, voxels) in enumerate(found.items()):
        above, below = axes[0][k], axes[1][k]
        row = voxels.partial.loc[index[kind]]
        draw_section(above, voxels, index[kind])
        above.set_title(f"{kind}: {PLACES[kind][1]}\nC_d {row['plane_distance_voxels']:.2f} voxels, C_a {row['normal_angle_deg']:.0f}°", fontsize=7.5)
        part = voxels.partial
        below.plot(part["plane_distance_voxels"], part["normal_angle_deg"], ".", markersize=1.6, color=CYCLE[k], alpha=0.5)
        below.plot(row["plane_distance_voxels"], row["normal_angle_deg"], "X", color=ORANGE, markeredgecolor="black", markersize=8)
        below.set_xlim(0, 2.5)
        below.set_ylim(0, 120)
        below.set_xlabel("C_d [voxels]", labelpad=1)
        below.set_title(f"{PLACES[kind][0]}, {len(part)} voxels", fontsize=7)
        if k == 0:
            above.set_ylabel("along the normal [voxels]")
            below.set_ylabel("C_a [degrees]")
    return figure
