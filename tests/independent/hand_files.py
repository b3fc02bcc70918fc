"""Reads a hand from its URDF, its sidecar and its link meshes, and poses it.

Poses are 4 x 4 matrices; X_AB takes coordinates in B to coordinates in A.
"""

import dataclasses
import json
import pathlib
import xml.etree.ElementTree as ElementTree

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

import mesh_files
import triangles

PAD_DEPTH = 1e-3  # Faces of the link entirely deeper than this below the pad are inner walls [m].


def pose(translation, rotation):
    """Returns the pose of a vector and a scipy Rotation."""
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = rotation.as_matrix(), translation
    return result


def pose_of_json(value):
    w, x, y, z = value["rotation_wxyz"]
    return pose(value["translation_m"], Rotation.from_quat([x, y, z, w]))


def pose_of_origin(element):
    """Returns the pose of URDF's <origin xyz rpy>: roll, pitch, yaw about fixed axes."""
    if element is None:
        return np.eye(4)
    xyz = [float(word) for word in element.get("xyz", "0 0 0").split()]
    rpy = [float(word) for word in element.get("rpy", "0 0 0").split()]
    return pose(xyz, Rotation.from_euler("xyz", rpy))


def inverse(X):
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = X[:3, :3].T, -X[:3, :3].T @ X[:3, 3]
    return result


def moved(X, points):
    return points @ X[:3, :3].T + X[:3, 3]


@dataclasses.dataclass
class Joint:
    name: str
    kind: str  # "revolute", "prismatic" or "fixed"
    parent: str
    child: str
    X_PJ: np.ndarray
    axis: np.ndarray
    lower: float
    upper: float

    def motion(self, value):
        if self.kind == "revolute":
            return pose(np.zeros(3), Rotation.from_rotvec(value * self.axis))
        return pose(value * self.axis if self.kind == "prismatic" else np.zeros(3),
                    Rotation.identity())


@dataclasses.dataclass
class Coupling:
    leader: str
    ratio: float
    offset: float
    breakaway: bool


@dataclasses.dataclass
class Pad:
    """A contact surface: an outline in the x-y plane of its frame C, and what bulges over it."""

    name: str
    link: str
    finger: str
    X_LC: np.ndarray
    outline: np.ndarray           # [n, 2], counter-clockwise
    surface: np.ndarray           # [k, 3], empty for a flat pad
    clip_thickness: float | None  # of its own, or the planner's

    def edges(self):
        """Returns unit outward normals and offsets of the outline's edges."""
        way = np.roll(self.outline, -1, axis=0) - self.outline
        normals = np.stack([way[:, 1], -way[:, 0]], axis=1)
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        return normals, np.einsum("ij,ij->i", normals, self.outline)

    def boundary_distance(self, point_C):
        """Returns the distance from the outline, in the pad's plane; 0 outside."""
        normals, offsets = self.edges()
        return max(0.0, (offsets - normals @ point_C[:2]).min())

    def largest_boundary_distance(self):
        """Returns the inradius of the outline: the largest r with normal . p + r <= offset for
        every edge."""
        from scipy.optimize import linprog
        normals, offsets = self.edges()
        program = linprog([0, 0, -1], A_ub=np.column_stack([normals, np.ones(len(normals))]),
                          b_ub=offsets, bounds=[(None, None)] * 2 + [(0, None)], method="highs")
        return program.x[2]

    def area(self):
        x, y = self.outline.T
        return (x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2

    def base_points(self):
        """Returns the corners of the pad in C: of its outline, and of its bulge."""
        flat = np.column_stack([self.outline, np.zeros(len(self.outline))])
        return np.vstack([flat, self.surface]) if len(self.surface) else flat

    def clip_volume(self, thickness):
        """Returns half-spaces normal . p <= offset, in C, of the pad's surface offset along z
        (paper section 10): a prism over a flat pad, else the hull of the bulge here and there."""
        depth = self.clip_thickness or thickness
        if not len(self.surface):
            normals, offsets = self.edges()
            normals = np.column_stack([normals, np.zeros(len(normals))])
            return (np.vstack([normals, [0, 0, -1], [0, 0, 1]]),
                    np.concatenate([offsets, [0, depth]]))
        base = self.base_points()
        planes = np.unique(ConvexHull(np.vstack([base, base + [0, 0, depth]])).equations, axis=0)
        return planes[:, :3], -planes[:, 3]

    def upper_side(self):
        """Returns triangles of the surface that is meant to touch, in C."""
        base = self.base_points()
        if not len(self.surface):
            return np.array([base[[0, k, k + 1]] for k in range(1, len(base) - 1)])
        hull = ConvexHull(base)
        return base[hull.simplices[hull.equations[:, 2] > 0]]

    def heights(self, points):
        """Returns heights over the surface along z, in C; beside the outline over its planes,
        extended."""
        if not len(self.surface):
            return points[..., 2]
        planes = ConvexHull(self.base_points()).equations
        planes = planes[planes[:, 2] > 0]
        return ((points @ planes[:, :3].T + planes[:, 3]) / planes[:, 2]).max(axis=-1)

    def part_of_link(self, faces_L):
        """Returns the faces of a link's mesh that are this pad, [n, 3, 3] in L: those that look
        along the pad's z, cut along the prism over the outline, without any that is entirely
        deeper than PAD_DEPTH below the pad. Where there is none, it returns the modeled surface."""
        faces_C = moved(inverse(self.X_LC), faces_L)
        faces_C = faces_C[triangles.area_vectors(faces_C)[:, 2] > 0]
        normals, offsets = self.edges()
        polygons, counts, _ = triangles.clip_polygons(
            faces_C, np.full(len(faces_C), 3),
            np.column_stack([normals, np.zeros(len(normals))]), offsets)
        used = np.arange(polygons.shape[1]) < counts[:, None]
        near = (used & (self.heights(polygons) >= -PAD_DEPTH)).any(axis=1)
        pieces, _ = triangles.fan_triangles(polygons[near], counts[near])
        return moved(self.X_LC, pieces if len(pieces) else self.upper_side())


def geometry_mesh(geometry, folder):
    """Returns the mesh of a URDF <geometry>, in meters."""
    mesh = geometry.find("mesh")
    if mesh is not None:
        name = mesh.get("filename")
        path = folder / name.removeprefix("file://")
        if name.startswith("package://"):
            inner = pathlib.PurePath(name.removeprefix("package://"))
            inner = pathlib.PurePath(*inner.parts[1:])
            path = next((parent / inner for parent in [folder, *folder.parents]
                         if (parent / inner).exists()), None)
            if path is None:
                raise ValueError(f"{name}: not found above {folder}")
        vertices, faces = mesh_files.read_mesh(path)
        scale = np.array([float(word) for word in mesh.get("scale", "1 1 1").split()])
        return vertices * scale, faces if scale.prod() > 0 else faces[:, ::-1]
    box = geometry.find("box")
    if box is not None:
        return mesh_files.box([float(word) for word in box.get("size").split()])
    raise ValueError("a cylinder, sphere or capsule has no mesh of its own to check against")


class Hand:
    """Links with meshes, joints, pads, couplings and what may overlap."""

    def __init__(self, description, sidecar, recorded, used_meshes):
        """Reads the hand. `sidecar` is None where there is none; pads and the like then come
        from `recorded`, the grasp file's own hand. `used_meshes` has paths of the planner's own
        link meshes by name."""
        description = pathlib.Path(description)
        root = ElementTree.parse(description).getroot()
        if root.tag != "robot" or root.find("link") is None:
            raise ValueError(f"{description}: reads URDF only")
        side = json.loads(pathlib.Path(sidecar).read_text()) if sidecar else {}
        self.joints = [self._joint(element) for element in root.findall("joint")]
        self.palm = side.get("palm", recorded["palm"])["link"]
        self.meshes = {element.get("name"): self._mesh(element, description.resolve().parent,
                                                          used_meshes.get(element.get("name")))
                       for element in root.findall("link")}
        self._keep_what_hangs_on_the_palm()
        self.couplings = self._couplings(root, side)
        self.pads = (self._pads_of_sidecar(side) if "pads" in side
                     else self._pads_of_grasp_file(recorded))
        listed = side.get("exclusions", recorded["collision_exclusions"])
        self.exclusions = {frozenset(pair) for pair in listed} | self._fixed_to_each_other()

    @staticmethod
    def _joint(element):
        kind, limit, axis = element.get("type"), element.find("limit"), element.find("axis")
        if kind not in ("revolute", "continuous", "prismatic", "fixed"):
            raise ValueError(f"joint {element.get('name')} is {kind}")
        direction = np.array([float(word) for word in
                              (axis.get("xyz") if axis is not None else "1 0 0").split()])
        bounded = limit is not None and kind != "continuous"
        return Joint(element.get("name"), "revolute" if kind == "continuous" else kind,
                     element.find("parent").get("link"), element.find("child").get("link"),
                     pose_of_origin(element.find("origin")),
                     direction / np.linalg.norm(direction),
                     float(limit.get("lower", 0)) if bounded else -np.inf,
                     float(limit.get("upper", 0)) if bounded else np.inf)

    @staticmethod
    def _mesh(link, folder, used):
        """Returns the collision geometry, or visual where there is none; several are one
        surface. `used` is the path of the mesh that the planner used, which is taken for
        primitives and where the files' surface is open and was closed."""
        shapes = link.findall("collision") or link.findall("visual")
        shapes = [shape for shape in shapes if shape.find("geometry") is not None]
        if used and any(shape.find("geometry").find("mesh") is None for shape in shapes):
            return mesh_files.read_mesh(used)
        vertices, faces, count = [], [], 0
        for shape in shapes:
            corners, triangles = geometry_mesh(shape.find("geometry"), folder)
            vertices.append(moved(pose_of_origin(shape.find("origin")), corners))
            faces.append(triangles + count)
            count += len(corners)
        if not vertices:
            return None
        vertices, faces = mesh_files.welded(np.vstack(vertices), np.vstack(faces))
        if used and not mesh_files.is_closed(faces):
            return mesh_files.read_mesh(used)
        return vertices, faces

    def _keep_what_hangs_on_the_palm(self):
        kept, rest, ordered = {self.palm}, list(self.joints), []
        while True:
            found = [joint for joint in rest if joint.parent in kept]
            if not found:
                break
            ordered += found
            kept |= {joint.child for joint in found}
            rest = [joint for joint in rest if joint not in found]
        self.joints = ordered
        self.meshes = {name: mesh for name, mesh in self.meshes.items() if name in kept}

    def _couplings(self, root, side):
        result = {}
        for element in root.findall("joint"):
            mimic = element.find("mimic")
            if mimic is not None:
                result[element.get("name")] = Coupling(
                    mimic.get("joint"), float(mimic.get("multiplier", 1)),
                    float(mimic.get("offset", 0)), False)
        for item in side.get("couplings", []):
            result[item["joint"]] = Coupling(item["leader"], item.get("ratio", 1),
                                             item.get("offset", 0), item.get("breakaway", False))
        return result

    @staticmethod
    def _pads_of_sidecar(side):
        return {pad["name"]: Pad(pad["name"], pad["link"], pad["finger"],
                                 pose_of_json(pad["frame"]), np.array(pad["outline_m"]),
                                 np.array(pad.get("surface_m", [])).reshape(-1, 3),
                                 pad.get("clip", {}).get("thickness_m"))
                for pad in side["pads"]}

    @staticmethod
    def _pads_of_grasp_file(recorded):
        return {pad["name"]: Pad(pad["name"], pad["link"], pad["finger"],
                                 pose_of_json(pad["X_LC"]), np.array(pad["outline_C_m"]),
                                 np.array(pad.get("surface_C_m") or []).reshape(-1, 3),
                                 pad["clip_volume_L"]["thickness_m"])
                for pad in recorded["pads"]}

    def _fixed_to_each_other(self):
        group = {name: name for name in self.meshes}
        for joint in self.joints:  # Parents come first.
            if joint.kind == "fixed":
                group[joint.child] = group[joint.parent]
        names = list(self.meshes)
        return {frozenset((a, b)) for a in names for b in names
                if a != b and group[a] == group[b]}

    def link_poses(self, X_OH, values):
        """Returns X_OL of every link by its name, from joint values by name."""
        result = {self.palm: X_OH}
        for joint in self.joints:
            result[joint.child] = (result[joint.parent] @ joint.X_PJ
                                   @ joint.motion(values.get(joint.name, 0.0)))
        return result
