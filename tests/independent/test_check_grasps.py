#!/usr/bin/python3
"""Tests the independent check itself, against closed forms and published values."""

import pathlib
import struct
import sys
import tempfile
import unittest

try:
    import numpy as np
    from scipy.spatial import ConvexHull
    from scipy.spatial.transform import Rotation
except ImportError as missing:
    print(f"SKIPPED: {missing.name} is not installed")
    sys.exit(0)

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import configurations  # noqa: E402
import hand_files  # noqa: E402
import measures  # noqa: E402
import mesh_files  # noqa: E402
import triangles  # noqa: E402


def ball(subdivisions=4, radius=1.0):
    """Returns an icosphere."""
    golden = (1 + 5**0.5) / 2
    vertices = np.array([(0, s, t * golden) for s in (-1, 1) for t in (-1, 1)], dtype=float)
    vertices = np.vstack([np.roll(vertices, k, axis=1) for k in range(3)])
    faces = vertices[ConvexHull(vertices).simplices]
    for _ in range(subdivisions):
        a, b, c = (faces[:, k] for k in range(3))
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        faces = np.concatenate([np.stack(t, axis=1) for t in
                                ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    faces = faces / np.linalg.norm(faces, axis=2)[..., None]
    outward = triangles.dot(triangles.area_vectors(faces), faces[:, 0]) > 0
    faces[~outward] = faces[~outward][:, ::-1]
    return radius * faces


def box_triangles(size, center=(0, 0, 0)):
    vertices, faces = mesh_files.box(size)
    return (vertices + center)[faces]


def solid_angles(points, faces):
    """Returns the solid angle of the surface as seen from each point [Van Oosterom & Strackee
    1983]."""
    result = []
    for point in points:
        corner = faces - point
        length = np.sqrt(triangles.dot(corner, corner))
        a, b, c = corner[:, 0], corner[:, 1], corner[:, 2]
        la, lb, lc = length.T
        below = (la * lb * lc + triangles.dot(a, b) * lc + triangles.dot(b, c) * la
                 + triangles.dot(c, a) * lb)
        result.append(2 * np.arctan2(triangles.dot(a, np.cross(b, c)), below).sum())
    return np.array(result)


def contact(point, normal, finger):
    return measures.Contact("pad", finger, np.array(point, dtype=float),
                            np.array(normal, dtype=float), 1.0, 1.0)


class Clipping(unittest.TestCase):
    def clipped_area(self, faces, normals, offsets):
        polygons, counts, _ = triangles.clip_polygons(
            faces, np.full(len(faces), 3), np.array(normals, dtype=float), offsets)
        pieces, _ = triangles.fan_triangles(polygons, counts)
        return np.linalg.norm(triangles.area_vectors(pieces), axis=1).sum() if len(pieces) else 0.0

    def test_square_cut_by_a_half_plane_and_a_corner(self):
        square = box_triangles([2, 2, 2])
        self.assertAlmostEqual(self.clipped_area(square, [[1, 0, 0]], [0.5]), 4 + 4 * 3, 12)
        self.assertAlmostEqual(
            # These are three half squares.
            self.clipped_area(square, [[-1, -1, -1]], [-2.0]), 3 / 2, 12)
        self.assertEqual(self.clipped_area(square, [[1, 0, 0]], [-1.5]), 0)

    def test_cap_of_a_ball_has_the_area_of_its_cylinder(self):  # Archimedes: it is 2 pi R h.
        area = self.clipped_area(ball(5), [[0, 0, -1]], [-0.7])
        self.assertAlmostEqual(area, 2 * np.pi * 0.3, delta=2e-3)

    def test_many_half_spaces_leave_the_polygon_that_they_bound(self):
        angles = 2 * np.pi * np.arange(12) / 12
        sides = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(12)])
        sheet = np.array([[[-9, -9, 0], [9, -9, 0], [9, 9, 0]],
                          [[-9, -9, 0], [9, 9, 0], [-9, 9, 0]]])
        self.assertAlmostEqual(self.clipped_area(sheet.astype(float), sides, np.ones(12)),
                               12 * np.tan(np.pi / 12), 12)


class Distances(unittest.TestCase):
    def test_pairs_of_triangles_agree_with_dense_samples(self):
        random = np.random.default_rng(1)
        for _ in range(40):
            a, b = random.normal(size=(2, 1, 3, 3))
            b = b + [1.0, 0, 0]
            grid = [(i / 60, j / 60, 1 - (i + j) / 60) for i in range(61) for j in range(61 - i)]
            p, q = np.array(grid) @ a[0], np.array(grid) @ b[0]
            sampled = np.sqrt(((p[:, None] - q[None])**2).sum(axis=2).min())
            exact = triangles.triangle_distances(a, b)[0]
            self.assertLessEqual(exact, sampled + 1e-12)
            self.assertLess(sampled - exact, 0.15)

    def test_known_distances_and_crossings(self):
        flat = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], dtype=float)
        turned = flat[:, :, [2, 1, 0]]
        for shift, expected in (([0, 0, 2], 2), ([3, 0, 0], 2), ([0.2, 0.2, -0.5], 0)):
            with self.subTest(shift):
                self.assertAlmostEqual(
                    triangles.triangle_distances(flat, turned + np.array(shift))[0]
                    if expected == 0 else
                    triangles.triangle_distances(flat, flat + np.array(shift, float))[0],
                    expected, 12)

    def test_tree_finds_the_distance_that_all_pairs_have(self):
        random = np.random.default_rng(2)
        for shift in (1.0, 2.3, 4.0):
            one, other = ball(2), box_triangles([1, 2, 3], [shift, 0.3, 0.2])
            turn = Rotation.random(random_state=random.integers(1000)).as_matrix()
            tree = triangles.BoxTree(one).moved(turn, np.zeros(3))
            pairs = [(i, j) for i in range(len(one)) for j in range(len(other))]
            i, j = np.array(pairs).T
            brute = triangles.triangle_distances(tree.triangles[i], other[j]).min()
            found = triangles.surface_distance(tree, triangles.BoxTree(other))
            self.assertAlmostEqual(found, brute, 12)

    def test_nearest_points_of_a_ball(self):
        points = np.random.default_rng(3).normal(size=(50, 3)) * 2
        near = triangles.nearest_on_surface(points, triangles.BoxTree(ball(5)))
        expected = np.abs(np.linalg.norm(points, axis=1) - 1)
        np.testing.assert_allclose(np.linalg.norm(near - points, axis=1), expected, atol=1e-3)

    def test_winding_number_is_the_solid_angle_of_the_surface(self):
        points = np.random.default_rng(4).uniform(-1.3, 1.3, size=(60, 3))
        for faces in (ball(2), box_triangles([1, 2, 1.5]), -box_triangles([1, 2, 1.5])):
            angles = solid_angles(points, faces) / (4 * np.pi)
            self.assertGreater(np.ptp(angles.round()), 0)
            np.testing.assert_allclose(
                triangles.winding_numbers(points, triangles.BoxTree(faces)), angles, atol=1e-9)

    def test_winding_number_counts_an_edge_or_corner_above_once(self):
        # Diagonals, edges and corners are above the points.
        tree = triangles.BoxTree(box_triangles([2, 2, 2]))
        points = np.array([(0.0, 0, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0), (0, 0, -3), (0, 0, 3)])
        np.testing.assert_array_equal(triangles.winding_numbers(points, tree), [1, 1, 1, 0, 0])


class Solids(unittest.TestCase):
    def test_volume_and_center_of_a_box_that_is_off_the_origin(self):
        vertices, faces = mesh_files.box([1, 2, 3])
        volume, center = mesh_files.volume_and_center(vertices + [4, 5, 6], faces)
        self.assertAlmostEqual(volume, 6, 12)
        np.testing.assert_allclose(center, [4, 5, 6], atol=1e-12)

    def test_hull_of_cross_polytope_has_its_volume_and_ball(self):
        points = np.vstack([np.eye(6), -np.eye(6)])
        self.assertAlmostEqual(ConvexHull(points).volume, 64 / 720, 12)
        self.assertAlmostEqual(measures.wrench_space(points).epsilon, 1 / 6**0.5, 12)


class Epsilon(unittest.TestCase):
    """Tests values in Ferrari & Canny's sense: unit normal forces, L1, torque scale 1."""

    def test_six_faces_of_a_cube(self):
        normals = np.vstack([np.eye(3), -np.eye(3)])
        contacts = [contact(-n, n, str(k)) for k, n in enumerate(normals)]
        for friction, volume in ((0.2, 0.0249923943), (0.5, 0.598633733), (1, 10.6159516)):
            wrenches = measures.contact_wrenches(contacts, np.zeros(3), 1.0, friction, 8)
            space = measures.wrench_space(wrenches)
            self.assertAlmostEqual(space.epsilon, friction * (2 / 3)**0.5, 9)
            self.assertAlmostEqual(space.volume / volume, 1, 7)
            four = measures.contact_wrenches(contacts, np.zeros(3), 1.0, friction, 4)
            self.assertAlmostEqual(measures.wrench_space(four).epsilon, friction / 3**0.5, 9)

    def test_tetrahedral_contacts_on_a_ball(self):
        normals = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) / 3**0.5
        contacts = [contact(n, -n, str(k)) for k, n in enumerate(normals)]
        for friction, expected in ((0.2, 0.137258387), (0.5, 0.343027459), (1, 0.689185670)):
            wrenches = measures.contact_wrenches(contacts, np.zeros(3), 1.0, friction, 8)
            self.assertAlmostEqual(measures.wrench_space(wrenches).epsilon, expected, 8)

    def test_two_hard_contacts_resist_no_torque_about_their_line(self):
        contacts = [contact([-1, 0, 0], [1, 0, 0], "a"), contact([1, 0, 0], [-1, 0, 0], "b")]
        wrenches = measures.contact_wrenches(contacts, np.zeros(3), 1.0, 0.5, 8)
        self.assertEqual(measures.wrench_space(wrenches), measures.WrenchSpace(5, 0.0, 0.0))


class Measure(unittest.TestCase):
    def test_regularity_of_regular_and_other_polygons_and_solids(self):
        apex = np.radians(20)
        pole = np.array([[0, 0, 1], [0, 0, -1]])
        girdle = np.array([[np.cos(a), np.sin(a), 0] for a in 2 * np.pi * np.arange(3) / 3])
        cases = (([[0, 0, 0], [1, 0, 0], [0.5, 3**0.5 / 2, 0]], 1),
                 ([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], 1),
                 ([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], 1),
                 (np.vstack([np.eye(3), -np.eye(3)]), 1),
                 (mesh_files.box([1, 1, 1])[0], 1),
                 ([[0, 0, 0], [np.cos(apex), np.sin(apex), 0], [1, 0, 0]], 0.48),
                 (np.vstack([pole, girdle]), 0.84),
                 ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1e-3))
        for points, expected in cases:
            with self.subTest(points):
                self.assertAlmostEqual(
                    measures.regularity(np.array(points, dtype=float), "combined"), expected,
                    delta=5e-3 if expected in (0.48, 0.84) else 1e-9)

    def test_a_corner_that_bends_inward_has_more_than_180_degrees(self):
        # A quadrilateral with angles of 90, 18.4, 233.1 and 18.4 degrees.
        dart = np.array([[0, 0], [4, 0], [1, 1], [0, 4]], dtype=float)
        expected = 4 * (90 - np.degrees(np.arctan(1 / 3))) / 360
        for polygon in (dart, dart[::-1], np.roll(dart, 1, axis=0)):
            self.assertAlmostEqual(measures.shape_index(polygon), expected, 12)

    def test_pairs_on_a_ball(self):
        tetrahedron = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) / 3**0.5
        equator = [[np.cos(a), np.sin(a), 0] for a in 2 * np.pi * np.arange(3) / 3]
        pyramid = np.vstack([[[0, 0, 1], [0, 0, -1]], equator])
        for points, expected in (([[1, 0, 0], [-1, 0, 0]], 1.0), (equator, 1.0),
                                 (tetrahedron, 1.298), (np.vstack([np.eye(3), -np.eye(3)]), 3.0),
                                 (pyramid, 2.0)):
            contacts = [contact(p, -np.array(p), str(k)) for k, p in enumerate(points)]
            # The strict test leaves out pairs 90 degrees apart, whose angle is 45.
            pairs = measures.stable_pairs(contacts, np.pi / 4 - 1e-9)
            m2 = sum(1 - angle / (np.pi / 4) for _, _, angle in pairs)
            self.assertAlmostEqual(m2, expected, delta=5e-4)

    def test_centroids_are_of_area_and_volume(self):
        triangle = np.array([[0, 0, 0], [3, 0, 0], [0, 3, 0]], dtype=float)
        np.testing.assert_allclose(measures.hull_centroid(triangle, "measure"), [1, 1, 0],
                                   atol=1e-12)
        simplex = np.vstack([np.zeros(3), 4 * np.eye(3)])
        np.testing.assert_allclose(measures.hull_centroid(simplex, "measure"), [1, 1, 1],
                                   atol=1e-12)
        house = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 3, 0]], dtype=float)
        # The shape is a square of area 4 at height 1 and a triangle of area 1 at height 7/3.
        np.testing.assert_allclose(measures.hull_centroid(house, "measure"),
                                   [1, (4 + 7 / 3) / 5, 0], atol=1e-12)


ARM = """<robot name="arm">
  <link name="base"/><link name="upper"/><link name="lower"/><link name="tip"/><link name="slide"/>
  <joint name="a" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2"/></joint>
  <joint name="b" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="2 0 0"/><axis xyz="0 0 2"/><limit lower="-2" upper="2"/>
    <mimic joint="a" multiplier="0.5" offset="0.1"/></joint>
  <joint name="c" type="fixed"><parent link="lower"/><child link="tip"/>
    <origin xyz="1 0 0"/></joint>
  <joint name="d" type="prismatic"><parent link="base"/><child link="slide"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.5"/></joint>
</robot>"""


class Hands(unittest.TestCase):
    def setUp(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "arm.urdf"
            path.write_text(ARM)
            recorded = {"palm": {"link": "base"}, "pads": [], "collision_exclusions": []}
            self.hand = hand_files.Hand(path, None, recorded, {})
        self.values = {"a": 0.4, "b": 0.3, "d": 0.2}
        self.configuration = {"joints": self.values, "X_OH": {"translation_m": [0, 0, 0],
                                                              "rotation_wxyz": [1, 0, 0, 0]}}

    def test_links_stand_where_plane_trigonometry_has_them(self):
        X_OL = self.hand.link_poses(np.eye(4), self.values)
        first, second = np.pi / 2 + 0.4, np.pi / 2 + 0.7
        tip = [2 * np.cos(first) + np.cos(second), 2 * np.sin(first) + np.sin(second), 1]
        np.testing.assert_allclose(X_OL["tip"][:3, 3], tip, atol=1e-14)
        np.testing.assert_allclose(X_OL["slide"][:3, 3], [0, 0.2, 0], atol=1e-14)
        self.assertIn(frozenset(("lower", "tip")), self.hand.exclusions)

    def test_joints_press_with_force_times_lever_and_followers_with_their_ratio(self):
        points = np.array([[0.3, 0.4, 1.0], [0, 0.2, 0]])
        forces = np.array([[1.0, 2.0, 3.0], [5.0, 6.0, 7.0]])
        found = configurations.generalized_forces(self.hand, self.configuration,
                                                  ["tip", "slide"], points, forces)
        elbow = 2 * np.array([np.cos(np.pi / 2 + 0.4), np.sin(np.pi / 2 + 0.4)])

        def lever(center):
            x, y = points[0, :2] - center
            return x * forces[0, 1] - y * forces[0, 0]
        self.assertAlmostEqual(found["a"], lever([0, 0]) + 0.5 * lever(elbow), 8)
        self.assertAlmostEqual(found["d"], 6.0, 8)
        joints = configurations.squeezed_joints(self.hand, self.configuration, found, 5, 2000, {})
        self.assertAlmostEqual(joints["a"], 0.4 + found["a"] / 5, 12)
        self.assertAlmostEqual(joints["b"], 0.5 * joints["a"] + 0.1, 12)
        self.assertAlmostEqual(joints["d"], 0.2 + 6 / 2000, 10)

    def test_way_is_linear_and_turns_along_the_shortest_arc(self):
        last = {"joints": {"a": 0.8, "b": 0.5, "d": 0.0},
                "X_OH": {"translation_m": [1, 2, 3],
                         "rotation_wxyz": [np.cos(0.5), 0, 0, -np.sin(0.5)]}}
        ((X, values),) = configurations.way(self.configuration, last, [0.25])
        np.testing.assert_allclose(X[:3, 3], [0.25, 0.5, 0.75], atol=1e-14)
        self.assertAlmostEqual(np.arctan2(X[1, 0], X[0, 0]), -0.25, 12)
        self.assertAlmostEqual(values["a"], 0.5, 12)


class MeshFiles(unittest.TestCase):
    def test_every_format_brings_back_the_box(self):
        vertices, faces = mesh_files.box([1, 2, 4])
        corners = vertices[faces]
        lines = ["ply", "format binary_little_endian 1.0", "element vertex 8",
                 *(f"property double {axis}" for axis in "xyz"), "element face 12",
                 "property list uchar int vertex_indices", "end_header", ""]
        texts = {
            "off": "OFF # box\n8 12 0\n" + "".join(f"{a} {b} {c}\n" for a, b, c in vertices)
                   + "".join(f"3 {a} {b} {c}\n" for a, b, c in faces),
            "obj": "".join(f"v {a} {b} {c}\n" for a, b, c in vertices)
                   + "".join(f"f {a + 1}//1 {b - 8} {c + 1}/2/3\n" for a, b, c in faces),
            "ply": "\n".join(lines).encode() + vertices.tobytes() + b"".join(
                struct.pack("<B3i", 3, *face) for face in faces),
            "stl": b" " * 80 + struct.pack("<I", 12) + b"".join(
                struct.pack("<12fH", 0, 0, 0, *triangle.ravel(), 0) for triangle in corners)}
        for kind, text in texts.items():
            with self.subTest(kind), tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / f"box.{kind}"
                path.write_bytes(text if isinstance(text, bytes) else text.encode())
                read, indices = mesh_files.read_mesh(path)
                np.testing.assert_array_equal(read[indices], corners)
                self.assertTrue(mesh_files.is_closed(indices))
                self.assertFalse(mesh_files.is_closed(indices[1:]))
                self.assertEqual(len(mesh_files.parts(len(read), indices)), 1)


class Pads(unittest.TestCase):
    def pad(self, surface=()):
        outline = np.array([[2, 1], [-2, 1], [-2, -1], [2, -1]], dtype=float)
        return hand_files.Pad("pad", "link", "finger", np.eye(4), outline,
                              np.array(surface, dtype=float).reshape(-1, 3), None)

    def test_outline_has_its_area_inradius_and_distances(self):
        pad = self.pad()
        self.assertAlmostEqual(pad.area(), 8, 12)
        self.assertAlmostEqual(pad.largest_boundary_distance(), 1, 9)
        self.assertAlmostEqual(pad.boundary_distance(np.array([1.5, 0.0, 7])), 0.5, 12)
        self.assertEqual(pad.boundary_distance(np.array([2.5, 0.0, 0])), 0)

    def test_clip_volume_of_flat_and_bulging_pads(self):
        for surface, depth, inside, outside in (
                ((), 0.5, [0, 0, 0.4], [0, 0, 0.6]), (((0, 0, 1),), 0.5, [0, 0, 1.4], [0, 0, 1.6])):
            normals, offsets = self.pad(surface).clip_volume(depth)
            self.assertTrue((normals @ np.array(inside) <= offsets).all())
            self.assertFalse((normals @ np.array(outside) <= offsets).all())


if __name__ == "__main__":
    unittest.main(verbosity=1)
