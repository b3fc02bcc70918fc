"""Computes with triangles in space: clipping by half-spaces, distances, crossings, winding
numbers.

It is plain double arithmetic, all of it vectorized. Distances are right to about 1e-15 times the
size of the coordinates, and to 1e-9 times the edges' length where two edges are nearly parallel.
"""

import numpy as np

PARALLEL_SINE_SQUARED = 1e-14  # Edges nearer to parallel than this are left to their end points.
CHUNK = 40_000  # So many pairs of triangles are taken at a time, to limit memory.


def dot(a, b):
    return np.einsum("...i,...i->...", a, b)


def clip_polygons(polygons, counts, normals, offsets):
    """Cuts convex polygons by the half-spaces normal . p <= offset [Sutherland & Hodgman 1974].

    The polygons are [n, v, 3] with the first counts[i] corners in use. Returns (polygons,
    counts, which): what is left of those that are not empty, and their indices.
    """
    which = np.arange(len(polygons))
    for normal, offset in zip(normals, offsets):
        if not len(polygons):
            break
        n, v = polygons.shape[:2]
        used = np.arange(v) < counts[:, None]
        height = polygons @ normal - offset
        inside = (height <= 0) & used
        keep_all = inside.sum(axis=1) == counts
        if keep_all.all():
            continue
        follower = np.where(np.arange(v) + 1 < counts[:, None], np.arange(v) + 1, 0)
        next_height = np.take_along_axis(height, follower, axis=1)
        next_corner = np.take_along_axis(polygons, follower[..., None], axis=1)
        crosses = used & (((height < 0) & (next_height > 0)) | ((height > 0) & (next_height < 0)))
        share = np.where(crosses, height / np.where(crosses, height - next_height, 1), 0)
        cut = polygons + share[..., None] * (next_corner - polygons)
        # Every corner makes up to two: itself if it is inside, then the cut of the edge that
        # follows.
        corners = np.stack([polygons, cut], axis=2).reshape(n, 2 * v, 3)
        flags = np.stack([inside, crosses], axis=2).reshape(n, 2 * v)
        order = np.argsort(~flags, axis=1, kind="stable")
        counts = flags.sum(axis=1)
        corners = np.take_along_axis(corners, order[..., None], axis=1)
        alive = counts >= 3
        counts, which = counts[alive], which[alive]
        polygons = corners[alive][:, :max(counts.max(initial=3), 3)]
    return polygons, counts, which


def fan_triangles(polygons, counts):
    """Returns fans of convex polygons, [k, 3, 3], and the polygon that each triangle is of."""
    triangles, owners = [], []
    for k in range(1, polygons.shape[1] - 1):
        alive = np.flatnonzero(counts > k + 1)
        triangles.append(polygons[alive][:, [0, k, k + 1]])
        owners.append(alive)
    if not triangles:
        return np.zeros((0, 3, 3)), np.zeros(0, dtype=int)
    return np.concatenate(triangles), np.concatenate(owners)


def split(triangles, longest):
    """Returns the same surface in triangles whose edges are at most `longest`: longest edges are
    halved, with the middle rounded."""
    small = []
    while len(triangles):
        edges = np.linalg.norm(np.roll(triangles, -1, axis=1) - triangles, axis=2)
        fine = edges.max(axis=1) <= longest
        small.append(triangles[fine])
        triangles, first = triangles[~fine], edges[~fine].argmax(axis=1)
        turned = np.take_along_axis(triangles, ((first[:, None] + [0, 1, 2]) % 3)[..., None], 1)
        a, b, c = (turned[:, k] for k in range(3))
        triangles = np.concatenate([np.stack([a, (a + b) / 2, c], axis=1),
                                    np.stack([(a + b) / 2, b, c], axis=1)])
    return np.concatenate(small)


def area_vectors(triangles):
    """Returns normals with the triangles' areas as lengths."""
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) / 2


def nearest_on_triangles(points, triangles):
    """Returns the nearest point of triangle i to point i, [n, 3]."""
    best = np.full(len(points), np.inf)
    nearest = np.zeros_like(points)
    for k in range(3):
        a, edge = triangles[:, k], triangles[:, (k + 1) % 3] - triangles[:, k]
        length = dot(edge, edge)
        share = np.clip(dot(points - a, edge) / np.where(length > 0, length, 1), 0, 1)
        candidate = a + share[:, None] * edge
        squared = dot(points - candidate, points - candidate)
        closer = squared < best
        best[closer], nearest[closer] = squared[closer], candidate[closer]
    normal = 2 * area_vectors(triangles)
    doubled = dot(normal, normal)
    flat = doubled > 0
    over = flat.copy()
    for k in range(3):
        edge = triangles[:, (k + 1) % 3] - triangles[:, k]
        over &= dot(np.cross(edge, points - triangles[:, k]), normal) >= 0
    height = dot(points - triangles[:, 0], normal) / np.where(flat, doubled, 1)
    nearest[over] = (points - height[:, None] * normal)[over]
    return nearest


def edges_inner_distance(p, p_edge, q, q_edge):
    """Returns the distance of the lines of two edges where both feet lie within the edges, else
    infinity."""
    a, b, c = dot(p_edge, p_edge), dot(p_edge, q_edge), dot(q_edge, q_edge)
    d, e = dot(p_edge, p - q), dot(q_edge, p - q)
    determinant = a * c - b * b
    skew = determinant > PARALLEL_SINE_SQUARED * a * c
    safe = np.where(skew, determinant, 1)
    s, t = (b * e - c * d) / safe, (a * e - b * d) / safe
    within = skew & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    gap = p + s[:, None] * p_edge - q - t[:, None] * q_edge
    return np.where(within, np.sqrt(dot(gap, gap)), np.inf)


def edge_crosses(p, q, triangles):
    """Returns whether the segment p q meets the plane of the triangle inside the triangle."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = np.cross(b - a, c - a)
    hp, hq = dot(p - a, normal), dot(q - a, normal)
    crosses = ((hp > 0) & (hq < 0)) | ((hp < 0) & (hq > 0))
    way = q - p
    sides = [dot(way, np.cross(u - p, v - p)) for u, v in ((a, b), (b, c), (c, a))]
    same = np.all([s >= 0 for s in sides], axis=0) | np.all([s <= 0 for s in sides], axis=0)
    return crosses & same


def triangle_distances(first, second):
    """Returns the distance of triangle i of the one to triangle i of the other; 0 where they
    cross."""
    result = np.full(len(first), np.inf)
    for start in range(0, len(first), CHUNK):
        a, b = first[start:start + CHUNK], second[start:start + CHUNK]
        best = np.full(len(a), np.inf)
        crosses = np.zeros(len(a), dtype=bool)
        for one, other in ((a, b), (b, a)):
            for k in range(3):
                corner = one[:, k]
                gap = corner - nearest_on_triangles(corner, other)
                best = np.minimum(best, np.sqrt(dot(gap, gap)))
                crosses |= edge_crosses(corner, one[:, (k + 1) % 3], other)
        for i in range(3):
            for j in range(3):
                best = np.minimum(best, edges_inner_distance(
                    a[:, i], a[:, (i + 1) % 3] - a[:, i], b[:, j], b[:, (j + 1) % 3] - b[:, j]))
        result[start:start + CHUNK] = np.where(crosses, 0, best)
    return result


def spread_bits(values):
    """Spreads bits three digits apart, for Morton codes of 21 bits an axis."""
    values = values.astype(np.uint64)
    for shift, mask in ((32, 0x1F00000000FFFF), (16, 0x1F0000FF0000FF), (8, 0x100F00F00F00F00F),
                        (4, 0x10C30C30C30C30C3), (2, 0x1249249249249249)):
        values = (values | (values << np.uint64(shift))) & np.uint64(mask)
    return values


class BoxTree:
    """A complete binary tree of boxes over triangles in the order of their Morton codes.

    Level k has 2^k boxes; the last level has one triangle in each, or none (an empty box).
    """

    def __init__(self, triangles, order=None):
        if order is None:
            middle = triangles.mean(axis=1)
            low, extent = middle.min(axis=0), np.ptp(middle, axis=0)
            cell = ((middle - low) / np.where(extent > 0, extent, 1) * (2**21 - 1))
            code = spread_bits(cell[:, 0])
            for k in (1, 2):
                code |= spread_bits(cell[:, k]) << np.uint64(k)
            order = np.argsort(code, kind="stable")
        self.order, self.triangles = order, triangles
        size = 1 << max(0, int(len(order) - 1).bit_length())
        lower, upper = np.full((size, 3), np.inf), np.full((size, 3), -np.inf)
        lower[:len(order)] = triangles[order].min(axis=1)
        upper[:len(order)] = triangles[order].max(axis=1)
        corner = np.full((size, 3), np.inf)
        corner[:len(order)] = triangles[order][:, 0]
        # These are of the box: lower, upper corner; a surface point.
        self.levels = [(lower, upper, corner)]
        while len(lower) > 1:
            lower, upper = np.minimum(lower[::2], lower[1::2]), np.maximum(upper[::2], upper[1::2])
            # Empty boxes come last, so that the first of two is the fuller one.
            corner = corner[::2]
            self.levels.insert(0, (lower, upper, corner))

    def moved(self, rotation, translation):
        return BoxTree(self.triangles @ rotation.T + translation, self.order)

    def child_level(self, level, node):
        """Returns children of nodes, or the nodes themselves on the last level, [n, 1 or 2]."""
        if level + 1 < len(self.levels):
            return level + 1, np.stack([2 * node, 2 * node + 1], axis=1)
        return level, node[:, None]

    def corners_of_box(self):
        return self.levels[0][0][0], self.levels[0][1][0]


def box_distances(first, i, second, j):
    apart = np.maximum(0, np.maximum(second[0][j] - first[1][i], first[0][i] - second[1][j]))
    return np.sqrt(dot(apart, apart))


def near_pairs(first, second, limit, tighten=True):
    """Returns triangles (i, j) of two trees whose boxes are within `limit` of each other.

    With `tighten` it returns only pairs that may be the nearest ones: the limit falls to the
    smallest distance seen between points of the two surfaces.
    """
    a, b, level_a, level_b = np.zeros(1, dtype=int), np.zeros(1, dtype=int), 0, 0
    while True:
        one, other = first.levels[level_a], second.levels[level_b]
        near = box_distances(one, a, other, b)
        if tighten and len(a):
            with np.errstate(invalid="ignore"):  # Empty boxes have their points at infinity.
                seen = one[2][a] - other[2][b]
                limit = np.fmin(limit, np.fmin.reduce(np.sqrt(dot(seen, seen))))
        keep = near <= limit
        a, b = a[keep], b[keep]
        done = level_a + 1 == len(first.levels) and level_b + 1 == len(second.levels)
        if done or not len(a):
            return first.order[a], second.order[b]
        level_a, children_a = first.child_level(level_a, a)
        level_b, children_b = second.child_level(level_b, b)
        a = np.repeat(children_a, children_b.shape[1], axis=1).ravel()
        b = np.tile(children_b, (1, children_a.shape[1])).ravel()


def surface_distance(first, second, limit=np.inf):
    """Returns the smallest distance of two surfaces; 0 where they cross, infinity if above
    `limit`."""
    i, j = near_pairs(first, second, limit)
    apart = np.maximum(first.triangles[i].min(axis=1) - second.triangles[j].max(axis=1),
                       second.triangles[j].min(axis=1) - first.triangles[i].max(axis=1))
    least = np.linalg.norm(np.maximum(apart, 0), axis=1)
    order = np.argsort(least, kind="stable")
    best, start, size = np.inf, 0, 256
    while start < len(order) and least[order[start]] <= min(best, limit) and best > 0:
        chosen = order[start:start + size]
        chosen = chosen[least[chosen] <= best]
        best = min(best, triangle_distances(first.triangles[i[chosen]],
                                            second.triangles[j[chosen]]).min())
        start, size = start + size, min(2 * size, CHUNK)
    return best if best <= limit else np.inf


def near_box(triangles, lower, upper):
    """Returns those triangles whose boxes meet the box."""
    return triangles[((triangles.min(axis=1) <= upper)
                      & (triangles.max(axis=1) >= lower)).all(axis=1)]


def nearest_on_surface(points, tree):
    """Returns the nearest points of the surface to points, [n, 3]."""
    who, node, level = np.arange(len(points)), np.zeros(len(points), dtype=int), 0
    limit = np.full(len(points), np.inf)
    while True:
        low, high, corner = tree.levels[level]
        apart = np.maximum(0, np.maximum(low[node] - points[who], points[who] - high[node]))
        seen = points[who] - corner[node]
        np.minimum.at(limit, who, np.sqrt(dot(seen, seen)))
        keep = np.sqrt(dot(apart, apart)) <= limit[who]
        who, node = who[keep], node[keep]
        if level + 1 == len(tree.levels):
            break
        level, children = tree.child_level(level, node)
        who, node = np.repeat(who, children.shape[1]), children.ravel()
    candidates = nearest_on_triangles(points[who], tree.triangles[tree.order[node]])
    distance = np.sqrt(dot(points[who] - candidates, points[who] - candidates))
    order = np.lexsort((distance, who))
    _, first = np.unique(who[order], return_index=True)
    return candidates[order[first]]


def side_of_edge(points, a, b):
    """Returns whether the ray from each point along +x crosses the edge a b, all seen along z.
    It is the same for both directions of an edge, so that neighbors agree."""
    swap = (a[:, 1] > b[:, 1])[:, None]
    low, high = np.where(swap, b, a), np.where(swap, a, b)
    x, y = points[:, 0], points[:, 1]
    spans = (low[:, 1] > y) != (high[:, 1] > y)
    share = (y - low[:, 1]) / np.where(spans, high[:, 1] - low[:, 1], 1)
    return spans & (x < low[:, 0] + share * (high[:, 0] - low[:, 0]))


def winding_numbers(points, tree):
    """Returns how often a closed surface winds around each point: the faces that a ray along +z
    meets, +1 where it leaves and -1 where it enters. It is 1 inside an outward surface, 0
    outside."""
    who, node, level = np.arange(len(points)), np.zeros(len(points), dtype=int), 0
    while True:
        low, high, _ = tree.levels[level]
        keep = ((low[node, :2] <= points[who, :2]).all(axis=1)
                & (high[node] >= points[who]).all(axis=1))
        who, node = who[keep], node[keep]
        if level + 1 == len(tree.levels):
            break
        level, children = tree.child_level(level, node)
        who, node = np.repeat(who, children.shape[1]), children.ravel()
    faces, start = tree.triangles[tree.order[node]], points[who]
    over = np.logical_xor.reduce([side_of_edge(start, faces[:, k], faces[:, (k + 1) % 3])
                                  for k in range(3)])
    normal = area_vectors(faces)
    over &= normal[:, 2] != 0
    # The ray meets the face above the point if the point is on the lower side of its plane.
    above = over & (dot(start - faces[:, 0], normal) * normal[:, 2] < 0)
    return np.bincount(who[above], np.sign(normal[above, 2]), minlength=len(points))
