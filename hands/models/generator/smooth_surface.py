"""Smooth closed surfaces: fields whose zero set is the surface, blended, and meshed.

A field is a function of three arrays x, y, z (mm) that is negative inside. Only sums, products,
quotients, square roots and comparisons are used, so that every machine gets the same numbers.
"""

import math

import numpy as np


def round_cone(a, b, ra, rb):
    """The hull of two balls (centers `a` and `b`): exact distance."""
    bax, bay, baz = (float(q - p) for p, q in zip(a, b))
    l2 = bax * bax + bay * bay + baz * baz
    rr = ra - rb
    a2 = l2 - rr * rr

    def field(x, y, z):
        pax, pay, paz = x - a[0], y - a[1], z - a[2]
        along = pax * bax + pay * bay + paz * baz
        past = along - l2
        x2 = ((pax * l2 - bax * along) ** 2 + (pay * l2 - bay * along) ** 2
              + (paz * l2 - baz * along) ** 2)
        y2, z2 = along * along * l2, past * past * l2
        k = np.sign(rr) * rr * rr * x2
        side = (np.sqrt(x2 * (a2 / l2)) + along * rr) / l2 - ra
        end_b = np.sqrt(x2 + z2) / l2 - rb
        end_a = np.sqrt(x2 + y2) / l2 - ra
        return np.where(np.sign(past) * a2 * z2 > k, end_b, np.where(np.sign(along) * a2 * y2 < k, end_a, side))

    return field


def ellipsoid(center, radii):
    """Distance in first order, exact at zero."""
    def field(x, y, z):
        u, v, w = ((c - m) / r for c, m, r in zip((x, y, z), center, radii))
        k0 = np.sqrt(u * u + v * v + w * w)
        k1 = np.sqrt((u / radii[0]) ** 2 + (v / radii[1]) ** 2 + (w / radii[2]) ** 2)
        return k0 * (k0 - 1.0) / np.maximum(k1, 1e-9)

    return field


def half_space(point, outward):
    n = np.asarray(outward, dtype=float)
    n = n / math.sqrt(float(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]))
    return lambda x, y, z: (x - point[0]) * n[0] + (y - point[1]) * n[1] + (z - point[2]) * n[2]


def stretched(field, factors, center=(0.0, 0.0, 0.0)):
    """The field's body stretched along the axes about `center`."""
    smallest = min(factors)
    return lambda x, y, z: smallest * field(*(m + (c - m) / f
                                              for c, m, f in zip((x, y, z), center, factors)))


def moved(field, offset):
    return lambda x, y, z: field(x - offset[0], y - offset[1], z - offset[2])


def turned_x(field, angle_deg, center):
    """The field's body turned about the line through `center` along x."""
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    _, cy, cz = center
    return lambda x, y, z: field(x, cy + c * (y - cy) + s * (z - cz), cz + c * (z - cz) - s * (y - cy))


def blend(width, *fields):
    """Union whose inner edges are rounded over about `width`; zero: sharp edges."""
    def field(x, y, z):
        result = fields[0](x, y, z)
        for other in fields[1:]:
            value = other(x, y, z)
            overlap = np.maximum(width - np.abs(result - value), 0.0)
            result = np.minimum(result, value) - (overlap * overlap / (4.0 * width) if width else 0.0)
        return result

    return field


def cut(width, field, *by):
    """Intersection whose outer edges are rounded over about `width`."""
    inner = blend(width, *((lambda x, y, z, f=f: -f(x, y, z)) for f in (field, *by)))
    return lambda x, y, z: -inner(x, y, z)


def normal_at(field, point):
    """Unit outward normal of the zero set at a point on it."""
    g = np.array([float(c[0]) for c in gradient(field, *(np.array([v]) for v in point))])
    return g / math.sqrt(float(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]))


def gradient(field, x, y, z, step=1e-3):
    return ((field(x + step, y, z) - field(x - step, y, z)) / (2 * step),
            (field(x, y + step, z) - field(x, y - step, z)) / (2 * step),
            (field(x, y, z + step) - field(x, y, z - step)) / (2 * step))


def projected(field, points, most, steps):
    """Points moved onto the zero set along the gradient, at most `most` per step."""
    x, y, z = points
    for _ in range(steps):
        value = field(x, y, z)
        gx, gy, gz = gradient(field, x, y, z)
        slope2 = np.maximum(gx * gx + gy * gy + gz * gz, 1e-6)
        step = value / slope2
        length = np.abs(value) / np.sqrt(slope2)
        step = step * np.minimum(1.0, most / np.maximum(length, 1e-12))
        x, y, z = x - step * gx, y - step * gy, z - step * gz
    return x, y, z


# Corners of a cell by number (bits: x, y, z), and its twelve edges.
CORNERS = [(k & 1, (k >> 1) & 1, (k >> 2) & 1) for k in range(8)]
EDGES = [(a, b) for a in range(8) for b in range(a + 1, 8)
         if sum(p != q for p, q in zip(CORNERS[a], CORNERS[b])) == 1]


def meshed(field, low, high, cell, relaxations=8):
    """Triangle mesh of the zero set inside a box, with about equal triangles: surface nets (a vertex
    per cell that the surface crosses), relaxed within the surface. Vertices lie on the surface."""
    counts = [max(2, math.ceil((h - l) / cell)) + 1 for l, h in zip(low, high)]
    axes = [np.arange(n) * cell + l for n, l in zip(counts, low)]
    values = field(*np.meshgrid(*axes, indexing="ij"))
    if min(values[0].min(), values[-1].min(), values[:, 0].min(), values[:, -1].min(),
           values[:, :, 0].min(), values[:, :, -1].min()) <= 0.0:
        raise ValueError("the surface leaves its box")
    inside = values < 0.0

    cells = tuple(n - 1 for n in counts)

    def corner(array, k):
        i, j, l = CORNERS[k]
        return array[i:i + cells[0], j:j + cells[1], l:l + cells[2]]

    total = np.zeros((3, *cells))
    crossings = np.zeros(cells, dtype=int)
    for a, b in EDGES:
        va, vb = corner(values, a), corner(values, b)
        crosses = corner(inside, a) != corner(inside, b)
        share = np.where(crosses, va / np.where(crosses, va - vb, 1.0), 0.0)
        for axis in range(3):
            at = CORNERS[a][axis] + share * (CORNERS[b][axis] - CORNERS[a][axis])
            total[axis] += np.where(crosses, at, 0.0)
        crossings += crosses
    active = crossings > 0
    number = np.full(cells, -1)
    number[active] = np.arange(int(active.sum()))
    where = np.argwhere(active)
    points = [low[axis] + cell * (where[:, axis] + total[axis][active] / crossings[active])
              for axis in range(3)]

    # A quad around every grid edge that the surface crosses.
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        shifted = [slice(1, None) if k == axis else slice(None) for k in range(3)]
        unshifted = [slice(None, -1) if k == axis else slice(None) for k in range(3)]
        start, end = inside[tuple(unshifted)], inside[tuple(shifted)]
        for index in np.argwhere(start != end):
            around = []
            for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                c = [int(i) for i in index]
                c[u] -= 1 - du
                c[v] -= 1 - dv
                around.append(int(number[tuple(c)]))
            quads.append(around if start[tuple(index)] else around[::-1])
    quads = np.array(quads)

    points = projected(field, points, cell / 2, 4)
    ends = np.concatenate([quads, np.roll(quads, 1, axis=1)]).ravel()
    others = np.concatenate([np.roll(quads, 1, axis=1), quads]).ravel()
    degree = np.zeros(len(where))
    np.add.at(degree, ends, 1.0)
    for _ in range(relaxations):
        gx, gy, gz = gradient(field, *points)
        scale = 1.0 / np.sqrt(np.maximum(gx * gx + gy * gy + gz * gz, 1e-12))
        normal = (gx * scale, gy * scale, gz * scale)
        means = []
        for c in points:
            mean = np.zeros(len(where))
            np.add.at(mean, ends, c[others])
            means.append(mean / degree - c)
        off = means[0] * normal[0] + means[1] * normal[1] + means[2] * normal[2]
        points = projected(field, [c + 0.5 * (m - off * n) for c, m, n in zip(points, means, normal)],
                           cell / 2, 1)
    points = projected(field, points, cell / 2, 6)

    vertices = np.stack(points, axis=1)
    faces = []
    for a, b, c, d in quads.tolist():
        if math.dist(vertices[a], vertices[c]) <= math.dist(vertices[b], vertices[d]) + 1e-9:
            faces += [(a, b, c), (a, c, d)]
        else:
            faces += [(a, b, d), (b, c, d)]
    return vertices, faces


def heights_along(field, origins, direction, low, high):
    """For each origin the largest t in [low, high] with origin + t direction on the surface, by scanning
    and halving."""
    origins = np.asarray(origins, dtype=float)

    def values(t):
        return field(*(origins[:, k][:, None] + t * direction[k] for k in range(3)))

    steps = np.linspace(high, low, 161)[None, :]
    inside = values(steps) <= 0.0
    if inside[:, 0].any() or not inside.any(axis=1).all():
        raise ValueError("a line starts inside the surface or misses it")
    first = inside.argmax(axis=1)
    inner, outer = steps[0][first][:, None], steps[0][first - 1][:, None]
    for _ in range(50):
        middle = 0.5 * (inner + outer)
        is_inside = values(middle) <= 0.0
        inner, outer = np.where(is_inside, middle, inner), np.where(is_inside, outer, middle)
    return (0.5 * (inner + outer))[:, 0]
