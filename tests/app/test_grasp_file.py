"""The grasp file is what its schema says, and enough to compute every number without graspfit."""

import copy
import json
import math
import pathlib
import tempfile

import program

try:
    import numpy
    from scipy.spatial import ConvexHull
except ImportError:
    ConvexHull = None
try:
    import jsonschema
except ImportError:
    jsonschema = None


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rotate(quaternion_wxyz, v):
    w, *q = quaternion_wxyz
    t = [2 * x for x in cross(q, v)]
    return [a + w * b + c for a, b, c in zip(v, t, cross(q, t))]


def apply(pose, p):
    return [a + b for a, b in zip(rotate(pose["rotation_wxyz"], p), pose["translation_m"])]


def clip(polygon, normal, offset):
    """Returns the part of a polygon with normal . p <= offset (Sutherland and Hodgman)."""
    result = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1]):
        hp, hq = dot(normal, p) - offset, dot(normal, q) - offset
        if hp <= 0:
            result.append(p)
        if (hp < 0 < hq) or (hq < 0 < hp):
            result.append([a + (b - a) * hp / (hp - hq) for a, b in zip(p, q)])
    return result


def area_vector(polygon):
    total = [0.0, 0.0, 0.0]
    for p, q in zip(polygon[1:], polygon[2:]):
        doubled = cross(minus(p, polygon[0]), minus(q, polygon[0]))
        total = [a + b / 2 for a, b in zip(total, doubled)]
    return total


def planned_file():
    """Returns a grasp file as the program writes it."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        mesh = folder / "torus.off"
        mesh.write_text(program.off_text(*program.torus()))
        done = program.run("plan", mesh, "--count", "2", "--accept", "usable", "--search",
                           "first", "--out", folder / "out")
        assert done.returncode == 0, done.stderr
        return json.loads((folder / "out/grasps.json").read_text())


class Schema(program.ProgramTest):
    def test_valid_against_the_schema_and_the_schema_is_strict(self):
        if jsonschema is None:
            self.skipTest("python3-jsonschema is not installed")
        data = planned_file()
        schema = json.loads((program.SOURCE_DIR / "grasp/grasps.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        validator = jsonschema.Draft202012Validator(schema)
        self.assertEqual([error.message for error in validator.iter_errors(data)], [])

        def objects(value, place=()):
            if isinstance(value, dict):
                yield place
                for key, item in value.items():
                    yield from objects(item, place + (key,))
            elif isinstance(value, list):
                for i, item in enumerate(value[:1]):
                    yield from objects(item, place + (i,))

        # The program writes every option.
        def keys_of(options, described):
            described = described.get("anyOf", [described])[0]
            self.assertEqual(list(options), list(described["properties"]))
            for key, value in options.items():
                if isinstance(value, dict):
                    keys_of(value, described["properties"][key])

        keys_of(data["planner"]["options"], schema["$defs"]["options"])

        open_maps = {"conventions", "outcomes", "target_failures", "guidance", "joints", "X_OL"}
        for place in objects(data):
            changed = copy.deepcopy(data)
            target = changed
            for key in place:
                target = target[key]
            is_map = place and place[-1] in open_maps
            if not is_map:
                target["surprise"] = {}
                self.assertFalse(validator.is_valid(changed), f"unknown key in {place}")
                del target["surprise"]
                for key in list(target):
                    if place and place[-1] == "readings":
                        break
                    if place[:2] == ("planner", "options"):
                        continue  # One that is missing has its default.
                    if (*place, key) == ("planner", "preset"):
                        continue  # Programs of others begin with none.
                    if "targets" in place and key == "pad":
                        continue  # Only targets that are not for a fingertip have one.
                    value = target.pop(key)
                    self.assertFalse(validator.is_valid(changed), f"no {key} in {place}")
                    target[key] = value


class GraspFile(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.data = planned_file()

    def test_every_link_has_a_pose_and_every_joint_a_value_within_its_limits(self):
        hand = self.data["hand"]
        for grasp in self.data["results"]["grasps"]:
            self.assertEqual(list(grasp["joints"]), [joint["name"] for joint in hand["joints"]])
            self.assertEqual(list(grasp["X_OL"]), [link["name"] for link in hand["links"]])
            self.assertEqual(grasp["X_OL"][hand["palm"]["link"]], grasp["X_OH"])
            for joint in hand["joints"]:
                value = grasp["joints"][joint["name"]]
                self.assertGreaterEqual(value, joint["lower"] - 1e-9)
                self.assertLessEqual(value, joint["upper"] + 1e-9)
                # Link poses follow from the joints: X_OL(child) = X_OL(parent) X_PJ motion.
                parent, child = (grasp["X_OL"][joint[key]] for key in ("parent_link", "child_link"))
                half = value / 2
                spin = [math.cos(half), *(math.sin(half) * x for x in joint["axis_J"])]
                point = [0.03, -0.02, 0.01]
                moved = (rotate(spin, point) if joint["type"] == "revolute"
                         else [p + value * a for p, a in zip(point, joint["axis_J"])])
                expected = apply(parent, apply(joint["X_PJ"], moved))
                for a, b in zip(apply(child, point), expected):
                    self.assertAlmostEqual(a, b, delta=1e-14)

    def test_contacts_follow_from_object_and_clip_volumes_alone(self):
        vertices, faces = program.torus()
        scale = self.data["object"]["meters_per_file_unit"]
        pads = {pad["name"]: pad for pad in self.data["hand"]["pads"]}
        for grasp in self.data["results"]["grasps"]:
            touching = {}
            for name, pad in pads.items():
                pose = grasp["X_OL"][pad["link"]]
                volume = []
                for half_space in pad["clip_volume_L"]["half_spaces"]:
                    normal = rotate(pose["rotation_wxyz"], half_space["normal_L"])
                    volume.append((normal, half_space["offset_m"]
                                   + dot(normal, pose["translation_m"])))
                area, weighted = 0.0, [0.0] * 3
                for face in faces:
                    piece = [[scale * x for x in vertices[i]] for i in face]
                    for normal, offset in volume:
                        piece = clip(piece, normal, offset)
                        if len(piece) < 3:
                            break
                    if len(piece) < 3:
                        continue
                    vector = area_vector(piece)
                    size = math.sqrt(dot(vector, vector))
                    area += size
                    weighted = [a + b for a, b in zip(weighted, vector)]
                if area > 0:
                    touching[name] = (area, weighted)
            contacts = {contact["pad"]: contact for contact in grasp["contacts"]}
            self.assertEqual(set(contacts), set(touching))
            for name, (area, weighted) in touching.items():
                self.assertAlmostEqual(contacts[name]["area_m2"], area, delta=1e-12)
                length = math.sqrt(dot(weighted, weighted))
                for a, b in zip(contacts[name]["inward_normal_O"], weighted):
                    self.assertAlmostEqual(a, -b / length, delta=1e-6)

    def test_measure_follows_from_contacts_alone(self):
        options = self.data["planner"]["options"]["quality"]
        center = self.data["object"]["center_of_mass_O_m"]
        radius = self.data["object"]["normalizing_radius_m"]
        pads = {pad["name"]: pad for pad in self.data["hand"]["pads"]}
        for grasp in self.data["results"]["grasps"]:
            contacts = grasp["contacts"]
            m1 = 0.0
            for c in contacts:
                pad = pads[c["pad"]]
                d = c["pad_boundary_distance_m"] / pad["largest_boundary_distance_m"]
                m1 += min(1, d) + options["alpha"] * min(1, c["area_m2"] / pad["area_m2"])
            m1 /= len(contacts)
            self.assertAlmostEqual(grasp["m1"], m1, delta=1e-12)

            m2, pairs = 0.0, []
            for i, a in enumerate(contacts):
                for j in range(i + 1, len(contacts)):
                    b = contacts[j]
                    line = minus(b["point_O_m"], a["point_O_m"])
                    length = math.sqrt(dot(line, line))
                    cosines = [s * dot(c["inward_normal_O"], line) / length
                               for s, c in ((1, a), (-1, b))]
                    angles = [math.acos(max(-1, min(1, cosine))) for cosine in cosines]
                    if a["finger"] != b["finger"] and max(angles) < options["theta_max_rad"]:
                        pairs.append([i, j])
                        m2 += 1 - sum(angles) / 2 / options["theta_max_rad"]
            self.assertEqual([pair["contacts"] for pair in grasp["stable_pairs"]], pairs)
            self.assertAlmostEqual(grasp["m2"], m2, delta=1e-7)

            distance = grasp["centroid_distance_m"]
            if len(contacts) == 3:
                centroid = [sum(c["point_O_m"][k] for c in contacts) / 3 for k in range(3)]
                offset = minus(centroid, center)
                self.assertAlmostEqual(distance, math.sqrt(dot(offset, offset)), delta=1e-12)
            m3 = grasp["regularity"] - options["beta"] * distance / radius
            self.assertAlmostEqual(grasp["m3"], m3, delta=1e-12)
            m = grasp["m1"] ** options["w1"] * grasp["m2"] ** options["w2"]
            m *= max(grasp["m3"], 0) ** options["w3"]
            self.assertAlmostEqual(grasp["m"], m, delta=1e-12)
            self.assertEqual(grasp["usable"], grasp["m"] > 0)
            self.assertEqual(grasp["largest_contact_gap_m"], max(c["gap_m"] for c in contacts))

    def test_epsilon_follows_from_contacts_and_convention_alone(self):
        if ConvexHull is None:
            self.skipTest("python3-scipy is not installed")
        for grasp in self.data["results"]["grasps"]:
            wrench = grasp["wrench"]
            self.assertIsNotNone(wrench)
            convention = wrench["convention"]
            self.assertEqual((convention["tool"], convention["force_scaling"], convention["norm"],
                              convention["outside"]), ("graspit", "unit-normal", "l1", "minus-one"))
            wrenches = []
            largest_gap = self.data["planner"]["options"]["refinement"]["largest_gap_m"]
            for contact in grasp["contacts"]:
                if contact["gap_m"] > largest_gap:
                    continue  # It bears no force.
                n = contact["inward_normal_O"]
                t1 = cross(n, [1, 0, 0] if abs(n[0]) < 0.9 else [0, 1, 0])
                t1 = [x / math.sqrt(dot(t1, t1)) for x in t1]
                t2 = cross(n, t1)
                arm = minus(contact["point_O_m"], convention["reference_point_O_m"])
                for i in range(convention["num_cone_edges"]):
                    angle = 2 * math.pi * i / convention["num_cone_edges"]
                    edge = [a + convention["friction"] * (math.cos(angle) * b + math.sin(angle) * c)
                            for a, b, c in zip(n, t1, t2)]
                    torque = [x / convention["torque_scale_m"] for x in cross(arm, edge)]
                    wrenches.append([convention["force_limit"] * x for x in edge + torque])
            if numpy.linalg.matrix_rank(numpy.subtract(wrenches, wrenches[0]), tol=1e-9) < 6:
                self.assertLessEqual(wrench["epsilon"], 0)
                continue
            nearest = -ConvexHull(wrenches).equations[:, -1].max()
            self.assertAlmostEqual(wrench["epsilon"], nearest if nearest > 0 else -1, delta=1e-9)
            self.assertEqual(wrench["is_force_closure"], bool(nearest > 0))

    def test_pre_grasp_and_squeeze_have_the_poses_that_their_joints_give(self):
        hand = self.data["hand"]
        shown = [grasp[key] for grasp in self.data["results"]["grasps"]
                 for key in ("pre_grasp", "squeeze") if grasp[key]]
        for configuration in shown:
            self.assertEqual(configuration["X_OL"][hand["palm"]["link"]], configuration["X_OH"])
            self.assertEqual(list(configuration["joints"]), [j["name"] for j in hand["joints"]])
        for grasp in self.data["results"]["grasps"]:
            if grasp["squeeze"]:
                self.assertEqual(len(grasp["squeeze"]["forces_O_N"]), len(grasp["contacts"]))
                self.assertEqual(grasp["squeeze"]["X_OH"], grasp["X_OH"])
            if grasp["pre_grasp"]:
                options = self.data["planner"]["options"]["pre_grasp"]
                self.assertGreaterEqual(grasp["pre_grasp"]["clearance_m"], options["clearance_m"])

    def test_statistics_add_up(self):
        statistics = self.data["results"]["statistics"]
        self.assertEqual(sum(statistics["outcomes"].values()), statistics["attempts"])
        self.assertIsNone(self.data["planner"]["options"]["wall_clock_limit_s"])

    def test_every_reading_has_its_row_on_the_readings_page(self):
        page = (program.SOURCE_DIR / "docs/readings.md").read_text()
        rows = {point for line in page.splitlines() if line.startswith("| A")
                for point in line.split("|")[1].split()}
        of_tables = {"A38"}
        self.assertEqual(set(self.data["planner"]["readings"]) | of_tables, rows)


if __name__ == "__main__":
    program.main()
