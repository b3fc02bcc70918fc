"""Voxels of an object and stages of a fitting, as the tables of their experiments give them."""

import math

import numpy as np
from figure_data import BadData

VOXELS = "object_voxels"
CENTROID = ["centroid_x_m", "centroid_y_m", "centroid_z_m"]
NORMAL = ["normal_x", "normal_y", "normal_z"]
ROW = ("object", "voxel_size_m", "grid_x_m", "grid_y_m", "grid_z_m", "slice", "partial", "full", "eligible_share")
DETAILS = ("object", "i", "j", "k", "class", "distance_voxels", *CENTROID, *NORMAL, "plane_distance_voxels",
           "normal_angle_deg", "score", "weak")  # fmt: skip
STAGE = ("object", "stage", "iterations", "link", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")


def voxel_centers(low, high, count):
    """Centers of so many voxels side by side between two borders."""
    return low + (np.arange(count) + 0.5) * (high - low) / count


class Voxels:
    """One object's voxels: `row` about all of it, `partial` a table of those that hold surface."""

    def __init__(self, source, name):
        table = source.table(VOXELS, ROW)
        self.row = table[table["object"] == name].iloc[0]
        details = source.table(f"{VOXELS}.details", DETAILS)
        details = details[details["object"] == name]
        self.partial = details[details["class"] == "partial"].reset_index(drop=True)
        self.details = details
        self.size = float(self.row["voxel_size_m"])
        self.origin = self.row[["grid_x_m", "grid_y_m", "grid_z_m"]].to_numpy(dtype=float)

    def centers(self):
        """Centers of the partial voxels [n, 3] in O."""
        return self.origin + self.size * (self.partial[["i", "j", "k"]].to_numpy() + 0.5)

    def distance_slice(self):
        """Signed distances [rows, columns] in the slice, the names of its axes, and its extent [m]."""
        if math.isnan(self.row["slice"]):
            raise BadData(f"{VOXELS}.csv: has no slice of {self.row['object']}")
        slices = {axis: self.details[self.details[axis] == self.row["slice"]] for axis in "ijk"}
        across = max(slices, key=lambda axis: (slices[axis]["class"] != "partial").sum())
        others = [axis for axis in "ijk" if axis != across]
        image = slices[across].pivot(index=others[1], columns=others[0], values="distance_voxels")
        low = [self.origin["ijk".index(axis)] for axis in others]
        extent = []
        for start, count in zip(low, image.shape[::-1]):
            extent += [start, start + count * self.size]
        return image.to_numpy(), ["xyz"["ijk".index(axis)] for axis in others], extent


def stages(source, name):
    """Stage -> (iterations, link poses as in a grasp file), in order."""
    table = source.table("fitting_stages.details", STAGE)
    found = {}
    for row in table[table["object"] == name].itertuples():
        iterations, poses = found.setdefault(row.stage, (row.iterations, {}))
        poses[row.link] = {
            "translation_m": [row.x_m, row.y_m, row.z_m],
            "rotation_wxyz": [row.qw, row.qx, row.qy, row.qz],
        }
    return found


def window(voxels, index, reach=2):
    """The partial voxels in the cube of 2 reach + 1 voxels around one, it included."""
    at = voxels.partial[["i", "j", "k"]].to_numpy()
    return voxels.partial[np.all(np.abs(at - at[index]) <= reach, axis=1)]
