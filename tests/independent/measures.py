"""Computes the paper's measure M (its section 4) and epsilon of the grasp wrench space, from
contacts."""

import dataclasses

import numpy as np
from scipy.spatial import ConvexHull

EPS = 1e-3                 # least regularity
COLLINEAR = 1e-3           # second over first singular value
PLANAR = 0.1               # thickness over extent
FLAT = 1e-12  # Singular values below this over the largest count as zero.
SAME_FACE = np.radians(5)  # This is the dihedral angle of triangles that count as one face.


@dataclasses.dataclass
class Contact:
    pad: str
    finger: str
    point: np.ndarray
    normal: np.ndarray  # unit, into the object
    area: float
    boundary_distance: float
    weak: bool = False


def angle_between(a, b):
    return np.arctan2(np.linalg.norm(np.cross(a, b)), np.dot(a, b))


def merged(points, distance):
    """Replaces points linked by distances below `distance` by their mean."""
    points = np.asarray(points, dtype=float)
    near = np.linalg.norm(points[:, None] - points[None], axis=2) < distance
    label = np.arange(len(points))
    for _ in points:
        label = np.array([label[near[i] | (label == label[i])].min() for i in range(len(points))])
    return np.array([points[label == k].mean(axis=0) for k in np.unique(label)])


def shape_index(polygon):
    """Returns Q of a flat polygon [Park & Starr; Roa & Suarez]: 0 for a regular one, 1 for a
    collapsed one. Corners may bend inward, as where faces of a hull are one face."""
    n = len(polygon)
    polygon = np.column_stack([polygon, np.zeros((n, 3 - polygon.shape[1]))])
    normal = area_normal(polygon)
    angles = []
    for i in range(n):
        to_next, to_previous = polygon[(i + 1) % n] - polygon[i], polygon[i - 1] - polygon[i]
        angles.append(np.degrees(np.arctan2(np.dot(np.cross(to_next, to_previous), normal),
                                            np.dot(to_next, to_previous))) % 360)
    mean = 180 * (n - 2) / n
    return sum(abs(angle - mean) for angle in angles) / ((n - 2) * (180 - mean) + 2 * mean)


def area_normal(polygon):
    """Returns the direction of a polygon's area, zero if it has none."""
    normal = sum(np.cross(a, b) for a, b in zip(polygon, np.roll(polygon, -1, axis=0)))
    length = np.linalg.norm(normal)
    return normal / length if length > 0 else normal


def flattened(polygon):
    """Returns a slightly folded polygon as seen along its area vector."""
    normal = area_normal(polygon)
    return polygon - np.outer((polygon - polygon.mean(axis=0)) @ normal, normal)


def hull_polygon(points):
    """Returns corners of the hull of nearly planar points, in their best-fit plane, and its
    frame."""
    center = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - center)
    flat = (points - center) @ axes[:2].T
    return flat[ConvexHull(flat).vertices], center, axes


def hull_faces(points):
    """Returns faces of the hull of points in space, as ordered corners; triangles within 5
    degrees of their neighbors are one face."""
    hull = ConvexHull(points)
    group = np.arange(len(hull.simplices))
    normals = hull.equations[:, :3]
    for _ in group:
        for i, neighbors in enumerate(hull.neighbors):
            for j in neighbors:
                if angle_between(normals[i], normals[j]) < SAME_FACE:
                    group[group == max(group[i], group[j])] = min(group[i], group[j])
    faces = []
    for k in np.unique(group):
        count = {}
        for simplex in hull.simplices[group == k]:
            for i in range(3):
                edge = frozenset((simplex[i], simplex[(i + 1) % 3]))
                count[edge] = count.get(edge, 0) + 1
        border = [set(edge) for edge, times in count.items() if times == 1]
        corner = min(border[0])
        face = []
        while border:
            edge = next(edge for edge in border if corner in edge)
            border.remove(edge)
            face.append(points[corner])
            (corner,) = edge - {corner}
        faces.append(np.array(face))
    return faces


def flatness(points):
    """Returns (second over first singular value, thickness over extent) of three points or more.

    Thickness is the points' range along the normal of their best-fit plane, extent their range
    along their first principal axis.
    """
    centered = points - points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(centered)
    if sizes[0] == 0:
        return 0.0, 0.0
    ranges = np.ptp(centered @ axes.T, axis=0)
    return sizes[1] / sizes[0], ranges[2] / ranges[0]


def regularity(points, definition):
    if len(points) < 2:
        return 0.0
    if len(points) == 2:
        return 1.0
    line, plane = flatness(points)
    if line < COLLINEAR:
        return EPS
    faces = [hull_polygon(points)[0]] if plane < PLANAR else hull_faces(points)
    if faces[0].shape[1] == 2:
        faces = [np.column_stack([faces[0], np.zeros(len(faces[0]))])]
    angles = 1 - np.mean([shape_index(flattened(face)) for face in faces])
    lengths = np.concatenate([np.linalg.norm(np.roll(face, -1, axis=0) - face, axis=1)
                              for face in faces])
    edges = lengths.min() / lengths.max()
    return max(EPS, {"combined": np.sqrt(max(angles, 0) * edges), "angle-only": angles,
                     "edge-only": edges}[definition])


def polygon_centroid(polygon):
    x, y = polygon.T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    return ((polygon + np.roll(polygon, -1, axis=0)) * cross[:, None]).sum(axis=0) / 3 / cross.sum()


def hull_centroid(points, definition):
    """Returns the centroid of the area of the polygon, the volume of the polyhedron, or the
    corners of either."""
    if len(points) <= 2:
        return points.mean(axis=0)
    line, plane = flatness(points)
    if line < COLLINEAR:
        axis = np.linalg.svd(points - points.mean(axis=0))[2][0]
        along = points @ axis
        return (points[along.argmin()] + points[along.argmax()]) / 2
    if plane < PLANAR:
        polygon, center, axes = hull_polygon(points)
        flat = polygon.mean(axis=0) if definition == "vertices" else polygon_centroid(polygon)
        return center + flat @ axes[:2]
    hull = ConvexHull(points)
    if definition == "vertices":
        return points[hull.vertices].mean(axis=0)
    inner = points.mean(axis=0)
    corners = points[hull.simplices] - inner
    volumes = np.abs(np.linalg.det(corners))
    return inner + (volumes[:, None] * corners.sum(axis=1)).sum(axis=0) / 4 / volumes.sum()


def stable_pairs(contacts, theta_max):
    """Returns (i, j, mean angle) of contacts of different fingers whose line lies in both cones."""
    pairs = []
    for i, a in enumerate(contacts):
        for j in range(i + 1, len(contacts)):
            b = contacts[j]
            line = b.point - a.point
            if a.finger == b.finger or np.linalg.norm(line) < 1e-9:
                continue
            one, other = angle_between(a.normal, line), angle_between(b.normal, -line)
            if one < theta_max and other < theta_max:
                pairs.append((i, j, (one + other) / 2))
    return pairs


@dataclasses.dataclass
class Quality:
    m: float
    m1: float
    m2: float
    m3: float
    regularity: float
    centroid_distance: float
    pairs: list


def measure(contacts, pads, center_of_mass, radius, options, merge_distance):
    """Returns M of contacts; `pads` by name have area() and largest_boundary_distance()."""
    if not contacts:
        return Quality(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, [])
    normalized = options["units"] == "normalized"
    m1 = 0.0
    for contact in contacts:
        pad = pads[contact.pad]
        if normalized:
            d = min(1.0, contact.boundary_distance / pad.largest_boundary_distance())
            a = min(1.0, contact.area / pad.area())
        else:
            d, a = 1e2 * contact.boundary_distance, 1e4 * contact.area
        m1 += 0.0 if contact.weak else d + options["alpha"] * a
    m1 /= len(contacts)
    pairs = stable_pairs(contacts, options["theta_max_rad"])
    m2 = sum(1 - angle / options["theta_max_rad"] for _, _, angle in pairs)
    all_points = np.array([contact.point for contact in contacts])
    points = merged(all_points, merge_distance)
    if 3 <= len(all_points) and len(points) < 3:
        r = EPS
    else:
        r = regularity(points, options["regularity"])
    distance = np.linalg.norm(hull_centroid(points, options["centroid"]) - center_of_mass)
    m3 = r - options["beta"] * (distance / radius if normalized else 1e2 * distance)
    usable = len(contacts) >= 2 and pairs and m1 > 0 and m3 > 0
    m = m1**options["w1"] * m2**options["w2"] * m3**options["w3"] if usable else 0.0
    return Quality(m, m1, m2, m3, r, distance, pairs)


def cone_edges(normal, friction, count):
    """Returns edges of the pyramid in the friction cone, of unit normal part, [count, 3]."""
    first = np.cross(normal, [1, 0, 0] if abs(normal[0]) < 0.9 else [0, 1, 0])
    first /= np.linalg.norm(first)
    second = np.cross(normal, first)
    angles = 2 * np.pi * np.arange(count) / count
    return normal + friction * (np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second))


def contact_wrenches(contacts, center, torque_scale, friction, count):
    """Returns [force; torque / torque_scale] of every cone edge of every contact, [n, 6]."""
    rows = []
    for contact in contacts:
        forces = cone_edges(contact.normal, friction, count)
        torques = np.cross(contact.point - center, forces) / torque_scale
        rows.append(np.column_stack([forces, torques]))
    return np.vstack(rows)


@dataclasses.dataclass
class WrenchSpace:
    rank: int        # dimension of the hull of the wrenches
    epsilon: float   # radius of the largest ball around the origin in it, 0 without interior; where
    volume: float    # the origin is outside, minus its distance from the farthest facet's plane


def wrench_space(wrenches):
    """Returns the wrench space of the convex hull of rows, by Qhull."""
    points = np.asarray(wrenches)
    sizes = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    rank = int((sizes > FLAT * sizes[0]).sum())
    if rank < points.shape[1]:
        return WrenchSpace(rank, 0.0, 0.0)
    hull = ConvexHull(points)
    return WrenchSpace(rank, -hull.equations[:, -1].max(), hull.volume)
