"""Computes what a grasp is, from the object's mesh, the hand's files and joint values alone."""

import dataclasses
import hashlib
import os
import pathlib
import urllib.parse

import numpy as np
from scipy.spatial.transform import Rotation

import hand_files
import measures
import mesh_files
import triangles

SHIPPED_HANDS = pathlib.Path(__file__).resolve().parents[2] / "hands/models"
TOUCHING = 1e-12       # surfaces nearer than this share a point as far as doubles can tell [m]
FAR = 0.02             # links farther than this from the object do not matter [m]
LEAST_NORMAL = 0.1  # Mean normals shorter than this are none, as on both sides of a plate.
LEAST_AREA = 1e-14     # less of the object in a clip volume than this is touching at an edge [m^2]
SAMPLE_SPACING = 1e-3  # Points on a surface whose depth is computed are this far apart [m].
# Triangles in search trees have no longer edges, as boxes around them are wide [m].
LONGEST_EDGE = 4e-3
CHUNK = 2000  # Nearest points are searched of so many at a time, to limit memory.


@dataclasses.dataclass
class PadContact:
    """A contact with the gap of its pad."""

    contact: measures.Contact
    gap: float


class Solid:
    """A closed surface, with one vertex of every part, and a search tree over small triangles."""

    def __init__(self, vertices, faces):
        self.vertices, self.faces = vertices, faces
        self.triangles = vertices[faces]
        self.tree = triangles.BoxTree(triangles.split(self.triangles, LONGEST_EDGE))
        self.part_points = vertices[mesh_files.parts(len(vertices), faces)]

    def moved(self, X):
        result = object.__new__(Solid)
        result.vertices, result.faces = hand_files.moved(X, self.vertices), self.faces
        result.triangles = result.vertices[self.faces]
        result.tree = self.tree.moved(X[:3, :3], X[:3, 3])
        result.part_points = hand_files.moved(X, self.part_points)
        return result

    def contains(self, points):
        points = np.atleast_2d(points)
        lower, upper = self.tree.corners_of_box()
        inside = ((points >= lower) & (points <= upper)).all(axis=1)
        inside[inside] = triangles.winding_numbers(points[inside], self.tree) > 0
        return inside

    def samples(self, lower, upper):
        """Returns points of the surface in a box, not farther apart than SAMPLE_SPACING along
        edges of the grid on each triangle."""
        near = triangles.near_box(self.tree.triangles, lower, upper)
        longest = np.linalg.norm(near - np.roll(near, 1, axis=1), axis=2).max(axis=1, initial=0)
        steps = np.maximum(1, np.ceil(longest / SAMPLE_SPACING).astype(int))
        points = [np.zeros((0, 3))]
        for n in np.unique(steps):
            grid = np.array([(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)]) / n
            points.append((grid @ near[steps == n]).reshape(-1, 3))
        points = np.vstack(points)
        return points[((points >= lower) & (points <= upper)).all(axis=1)]


def clearance(first, second, limit=np.inf):
    """Returns the smallest distance of two solids: 0 where they share a point, infinity above
    `limit`."""
    boxes = (*first.tree.corners_of_box(), *second.tree.corners_of_box())
    if np.linalg.norm(np.maximum(0, np.maximum(boxes[2] - boxes[1], boxes[0] - boxes[3]))) > limit:
        return np.inf
    distance = triangles.surface_distance(first.tree, second.tree, limit)
    if distance <= TOUCHING:
        return 0.0
    if second.contains(first.part_points).any() or first.contains(second.part_points).any():
        return 0.0
    return distance


def depth(first, second):
    """Returns the depth of the deepest sampled point of either surface inside the other: at most
    the true depth, and less by SAMPLE_SPACING at most."""
    deepest = 0.0
    low = np.maximum(first.tree.corners_of_box()[0], second.tree.corners_of_box()[0])
    high = np.minimum(first.tree.corners_of_box()[1], second.tree.corners_of_box()[1])
    for one, other in ((first, second), (second, first)):
        points = one.samples(low, high)
        points = points[other.contains(points)]
        for start in range(0, len(points), CHUNK):
            near = triangles.nearest_on_surface(points[start:start + CHUNK], other.tree)
            apart = np.linalg.norm(near - points[start:start + CHUNK], axis=1)
            deepest = max(deepest, apart.max())
    return deepest


def path_of_text(text):
    """Returns a recorded path; where it is not UTF-8, it is recorded as file: and
    percent-encoded bytes."""
    if not text.startswith("file:"):
        return text
    return os.fsdecode(urllib.parse.unquote_to_bytes(text.removeprefix("file:")))


def found_file(text, places):
    """Returns a recorded path as it is, or below one of the folders."""
    name = path_of_text(text)
    for place in (pathlib.Path("."), *places):
        if (place / name).exists():
            return place / name
    raise ValueError(f"{name}: not found, nor below {', '.join(map(str, places))}")


def require_sha256(path, expected):
    if hashlib.sha256(path.read_bytes()).hexdigest() != expected:
        raise ValueError(f"{path}: other bytes than those the grasps were made with (SHA-256)")


class Scene:
    """The object, surroundings and hand of a grasp file."""

    def __init__(self, record, folder):
        if record["version"] not in (4, 5, 6):
            raise ValueError(f"is of version {record['version']}, not 4 to 6")
        if record["version"] < 6:
            for grasp in record["results"]["grasps"]:
                grasp["largest_requested_gap_m"] = grasp.pop("largest_claimed_gap_m")
        self.record, self.folder = record, folder
        self.options = record["planner"]["options"]
        self.used = record["planner"]["used"]
        self.object = self._solid(record["object"])
        used = self.object.vertices[np.unique(self.object.faces)]
        self.volume, self.center_of_mass = mesh_files.volume_and_center(self.object.vertices,
                                                                        self.object.faces)
        self.radius = np.linalg.norm(np.ptp(used, axis=0)) / 2
        self.largest_radius = np.linalg.norm(used - self.center_of_mass, axis=1).max()
        self.table_z = record["surroundings"]["table_z_O_m"]
        self.obstacles = [self._solid(item) for item in record["surroundings"]["obstacles"]]
        self._read_hand(record["hand"])

    def _solid(self, item):
        """Reads a mesh from the file and its scale; where it was repaired, the mesh that was
        used."""
        if item["repair"]["steps"]:
            if not item["used_mesh_file"]:
                raise ValueError(f"{item['file']} was repaired, and the result is not beside this")
            return Solid(*mesh_files.read_mesh(self.folder / item["used_mesh_file"]))
        path = found_file(item["file"], [self.folder, self.folder.parent])
        require_sha256(path, item["sha256"])
        vertices, faces = mesh_files.read_mesh(path)
        return Solid(vertices * item["meters_per_file_unit"], faces)

    def _read_hand(self, item):
        places = [self.folder, self.folder.parent, SHIPPED_HANDS]
        description = found_file(item["description_file"], places)
        require_sha256(description, item["description_sha256"])
        sidecar = found_file(item["sidecar_file"], places) if item["sidecar_file"] else None
        if sidecar:
            require_sha256(sidecar, item["sidecar_sha256"])
        used = {link["name"]: self.folder / link["used_mesh_file"] for link in item["links"]
                if link["used_mesh_file"]}
        self.hand = hand_files.Hand(description, sidecar, item, used)
        self.links = {name: Solid(*mesh) for name, mesh in self.hand.meshes.items() if mesh}
        self.pad_surfaces = {
            name: triangles.BoxTree(triangles.split(pad.part_of_link(
                self.links[pad.link].triangles if pad.link in self.links
                else np.zeros((0, 3, 3))), LONGEST_EDGE))
            for name, pad in self.hand.pads.items()}

    def poses(self, configuration):
        return self.hand.link_poses(hand_files.pose_of_json(configuration["X_OH"]),
                                    configuration["joints"])

    def posed_links(self, X_OL):
        return {name: solid.moved(X_OL[name]) for name, solid in self.links.items()}

    def object_clearances(self, links, limit):
        """Returns the distance of every link from the object by its name; those above `limit`
        are left out."""
        found = {name: clearance(link, self.object, limit) for name, link in links.items()}
        return {name: distance for name, distance in found.items() if distance <= limit}

    def surroundings_clearance(self, links, limit):
        """Returns the distance of the hand from table and obstacles; infinity above `limit`."""
        distances = [np.inf]
        for link in links.values():
            if self.table_z is not None:
                distances.append(max(0.0, link.vertices[:, 2].min() - self.table_z))
            distances += [clearance(link, obstacle, limit) for obstacle in self.obstacles]
        return min(distances)

    def self_clearances(self, links, limit):
        names = sorted(links)
        found = {}
        for i, a in enumerate(names):
            for b in names[i + 1:]:
                if frozenset((a, b)) not in self.hand.exclusions:
                    distance = clearance(links[a], links[b], limit)
                    if distance <= limit:
                        found[a, b] = distance
        return found

    def contact(self, pad, X_OL):
        """Returns the contact of one pad (paper section 10) with its gap, or None."""
        X_OC = X_OL[pad.link] @ pad.X_LC
        normals, offsets = pad.clip_volume(self.used["clip_thickness_m"])
        normals_O = normals @ X_OC[:3, :3].T
        offsets_O = offsets + normals_O @ X_OC[:3, 3]
        corners = pad.base_points()
        top = pad.clip_thickness or self.used["clip_thickness_m"]
        corners = hand_files.moved(X_OC, np.vstack([corners, corners + [0, 0, top]]))
        near = triangles.near_box(self.object.triangles, corners.min(axis=0), corners.max(axis=0))
        polygons, counts, _ = triangles.clip_polygons(near, np.full(len(near), 3), normals_O,
                                                      offsets_O)
        if not len(polygons):
            return None
        pieces, owner = triangles.fan_triangles(polygons, counts)
        vectors = triangles.area_vectors(pieces)
        areas = np.linalg.norm(vectors, axis=1)
        total = areas.sum()
        if total < LEAST_AREA:
            return None
        middles = pieces.mean(axis=1)
        if self.options["averaging"] == "plain":
            mean, normal = self._plain_means(owner, areas, middles, vectors)
        else:
            mean, normal = areas @ middles / total, vectors.sum(axis=0) / total
        if np.linalg.norm(normal) < LEAST_NORMAL:
            return None
        nearest = triangles.nearest_on_triangles(np.tile(mean, (len(pieces), 1)), pieces)
        point = nearest[np.nanargmin(np.linalg.norm(nearest - mean, axis=1))]
        contact = measures.Contact(
            pad.name, pad.finger, point, -normal / np.linalg.norm(normal), total,
            pad.boundary_distance(hand_files.moved(hand_files.inverse(X_OC), point)))
        return PadContact(contact, self.gap(pad, X_OL[pad.link]))

    @staticmethod
    def _plain_means(owner, areas, middles, vectors):
        """Returns averages in which every clipped triangle counts alike."""
        middle, direction = [], []
        for k in np.unique(owner):
            own = owner == k
            if areas[own].sum() > 0:
                middle.append(areas[own] @ middles[own] / areas[own].sum())
                vector = vectors[own].sum(axis=0)
                direction.append(vector / np.linalg.norm(vector))
        return np.mean(middle, axis=0), np.mean(direction, axis=0)

    def gap(self, pad, X_OL):
        """Returns the distance of the pad's part of the link's mesh from the object's surface."""
        surface = self.pad_surfaces[pad.name].moved(X_OL[:3, :3], X_OL[:3, 3])
        return triangles.surface_distance(surface, self.object.tree)

    def contacts(self, X_OL):
        """Returns contacts of all pads that count and have one, by the pad's name, in the hand's
        order."""
        if self.options["contact_pieces"] != "joined":
            raise ValueError("contacts of several pieces are not recomputed")
        counted = self.options["counted_pads"] or (
            "tips-and-palm" if self.options["style"] == "precision" else "all")
        tips = {finger["tip_pad"] for finger in self.record["hand"]["fingers"]}
        found = {name: self.contact(pad, X_OL) for name, pad in self.hand.pads.items()
                 if counted == "all" or name in tips or pad.finger == "palm"}
        return {name: contact for name, contact in found.items() if contact}

    def quality(self, contacts):
        return measures.measure(contacts, self.hand.pads, self.center_of_mass, self.radius,
                                self.options["quality"], self.used["merge_distance_m"])


def pose_difference(a, b):
    """Returns the distance of two poses' origins [m] and the angle between them [rad]."""
    turn = Rotation.from_matrix(a[:3, :3].T @ b[:3, :3]).magnitude()
    return np.linalg.norm(a[:3, 3] - b[:3, 3]), turn
