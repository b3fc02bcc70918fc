"""Meshes built from rings of vertices and flat regions between them.

A mesh is (vertices [n x 3] in mm, faces [list of index triples]), counter-clockwise from outside.
"""

import math

import numpy as np


class MeshBuilder:
    """Collects rings of vertices and the faces between them."""

    def __init__(self):
        self.vertices = []
        self.faces = []

    def add_ring(self, points):
        """Adds a closed ring of points; returns its indices."""
        first = len(self.vertices)
        self.vertices.extend(tuple(float(c) for c in p) for p in points)
        return list(range(first, len(self.vertices)))

    def strip(self, lower, upper):
        """The band between two rings of equal length, both counter-clockwise seen from `upper`'s side.

        Each quad is cut along its shorter diagonal (the first one where they are equal)."""
        n = len(lower)
        v = self.vertices
        for i in range(n):
            a, b, c, d = lower[i], lower[(i + 1) % n], upper[(i + 1) % n], upper[i]
            if math.dist(v[a], v[c]) <= math.dist(v[b], v[d]) + 1e-9:
                self.faces += [(a, b, c), (a, c, d)]
            else:
                self.faces += [(a, b, d), (b, c, d)]

    def cap(self, ring, outward_up):
        """Closes a planar ring by a fan around its centroid."""
        center = self.add_ring([np.mean([self.vertices[i] for i in ring], axis=0)])[0]
        for i, j in zip(ring, ring[1:] + ring[:1]):
            self.faces.append((i, j, center) if outward_up else (j, i, center))

    def flat(self, outer, holes, outward_up):
        """Fills the horizontal region inside ring `outer` and outside the rings `holes` (all
        counter-clockwise in x-y)."""
        for a, b, c in triangulate({i: self.vertices[i][:2] for ring in [outer, *holes] for i in ring},
                                   outer, holes):
            self.faces.append((a, b, c) if outward_up else (a, c, b))

    def loft(self, rings):
        """Rings joined in order and closed at both ends; each counter-clockwise seen from the last."""
        ids = [self.add_ring(r) for r in rings]
        for lower, upper in zip(ids, ids[1:]):
            self.strip(lower, upper)
        self.cap(ids[0], outward_up=False)
        self.cap(ids[-1], outward_up=True)

    def mesh(self):
        return np.array(self.vertices), self.faces


def cross2(o, a, b):
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def triangulate(points, outer, holes):
    """Ear clipping of a polygon whose holes are joined to it by bridges. Ties go to the first."""
    polygon = list(outer)
    # Join each hole by its rightmost vertex to the nearest polygon vertex that sees it.
    for hole in sorted(holes, key=lambda h: -max(points[i][0] for i in h)):
        start = max(range(len(hole)), key=lambda k: (points[hole[k]][0], -points[hole[k]][1]))
        bridge = list(reversed(hole[:start] + hole[start:]))
        k = bridge.index(hole[start])
        bridge = bridge[k:] + bridge[:k]
        others = [h for h in holes if h is not hole]
        edges = [(r[i - 1], r[i]) for r in [polygon, hole, *others] for i in range(len(r))]

        def sees(i, j):
            for a, b in edges:
                if {a, b} & {i, j}:
                    continue
                if (cross2(points[i], points[j], points[a]) * cross2(points[i], points[j], points[b]) <= 0
                        and cross2(points[a], points[b], points[i])
                        * cross2(points[a], points[b], points[j]) <= 0):
                    return False
            return True

        candidates = sorted(range(len(polygon)),
                            key=lambda c: math.dist(points[polygon[c]], points[hole[start]]))
        at = next(c for c in candidates
                  if sees(hole[start], polygon[c]) and points[polygon[c]][0] >= points[hole[start]][0])
        polygon = polygon[:at + 1] + bridge + [bridge[0]] + polygon[at:]

    triangles = []
    while len(polygon) > 3:
        best = None
        n = len(polygon)
        for i in range(n):
            a, b, c = polygon[i - 1], polygon[i], polygon[(i + 1) % n]
            pa, pb, pc = points[a], points[b], points[c]
            area = cross2(pa, pb, pc)
            if area <= 1e-9:
                continue
            if any(cross2(pa, pb, points[p]) >= -1e-9 and cross2(pb, pc, points[p]) >= -1e-9
                   and cross2(pc, pa, points[p]) >= -1e-9
                   for p in polygon if p not in (a, b, c)):
                continue
            # Of all ears the one whose longest side is shortest: fewer slivers.
            size = max(math.dist(pa, pb), math.dist(pb, pc), math.dist(pc, pa))
            if best is None or size < best[0] - 1e-9:
                best = (size, i, (a, b, c))
        triangles.append(best[2])
        del polygon[best[1]]
    triangles.append(tuple(polygon))
    return triangles


def rounded_rectangle(u0, u1, v0, v1, radius, segments=4):
    """Points of a rectangle with rounded corners, counter-clockwise from the corner (u1, v0)."""
    radius = min(radius, 0.49 * (u1 - u0), 0.49 * (v1 - v0))
    points = []
    for cu, cv, start in [(u1 - radius, v0 + radius, -90), (u1 - radius, v1 - radius, 0),
                          (u0 + radius, v1 - radius, 90), (u0 + radius, v0 + radius, 180)]:
        for k in range(segments + 1):
            a = math.radians(start + 90.0 * k / segments)
            points.append((cu + radius * math.cos(a), cv + radius * math.sin(a)))
    return points


def circle(radius, segments):
    return [(radius * math.cos(2 * math.pi * k / segments), radius * math.sin(2 * math.pi * k / segments))
            for k in range(segments)]


def inset(points, distance):
    """A polygon with every side moved inward by `distance`."""
    result = []
    n = len(points)
    for i in range(n):
        p, q, r = (np.array(points[k % n], dtype=float) for k in (i - 1, i, i + 1))
        u, v = (q - p) / np.linalg.norm(q - p), (r - q) / np.linalg.norm(r - q)
        nu, nv = np.array([-u[1], u[0]]), np.array([-v[1], v[0]])
        result.append(tuple(q + distance * (nu + nv) / (1.0 + nu @ nv)))
    return result


def fillet_levels(top, radius, steps):
    """(height, inset) pairs that round an upper edge at height `top`."""
    return [(top - radius * (1.0 - math.sin(math.radians(90.0 * k / steps))),
             radius * (1.0 - math.cos(math.radians(90.0 * k / steps)))) for k in range(steps + 1)]


def smooth_step(t):
    t = min(max(t, 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def signed_volume(mesh):
    """Volume of a closed mesh [mm^3], positive if its faces are counter-clockwise from outside."""
    v, volume = np.asarray(mesh[0]), 0.0
    for a, b, c in mesh[1]:
        volume += float(np.dot(v[a], np.cross(v[b], v[c])))
    return volume / 6.0
