"""`graspfit convert` writes grasps for other tools, read back here by parsers of other projects: PyYAML,
NumPy, ElementTree, and for GLB the few lines below."""

import json
import pathlib
import shutil
import struct
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree

import program

try:
    import numpy
except ImportError:
    numpy = None
try:
    import yaml
except ImportError:
    yaml = None

# These are moveit_msgs/Grasp and the messages in it, by their definitions (ROS 2 "jazzy"; ROS 1 has
# `seq` in headers besides, and `secs`, `nsecs` in times).
MESSAGES = {
    "Grasp": {"id": str, "pre_grasp_posture": "JointTrajectory", "grasp_posture": "JointTrajectory",
              "grasp_pose": "PoseStamped", "grasp_quality": float,
              "pre_grasp_approach": "GripperTranslation", "post_grasp_retreat": "GripperTranslation",
              "post_place_retreat": "GripperTranslation", "max_contact_force": float,
              "allowed_touch_objects": [str]},
    "JointTrajectory": {"header": "Header", "joint_names": [str], "points": ["JointTrajectoryPoint"]},
    "JointTrajectoryPoint": {"positions": [float], "velocities": [float], "accelerations": [float],
                             "effort": [float], "time_from_start": "Duration"},
    "GripperTranslation": {"direction": "Vector3Stamped", "desired_distance": float,
                           "min_distance": float},
    "Vector3Stamped": {"header": "Header", "vector": "Vector3"},
    "PoseStamped": {"header": "Header", "pose": "Pose"},
    "Pose": {"position": "Vector3", "orientation": "Quaternion"},
    "Header": {"stamp": "Time", "frame_id": str},
    "Vector3": {"x": float, "y": float, "z": float},
    "Quaternion": {"x": float, "y": float, "z": float, "w": float},
    "Time": {"sec": int, "nanosec": int},
    "Duration": {"sec": int, "nanosec": int},
}


def rotation(wxyz):
    w, x, y, z = wxyz
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def glb_bodies(data):
    """Returns, by name, vertices in the root frame and faces, by the glTF 2.0 specification."""
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    json_length, json_type = struct.unpack_from("<I4s", data, 12)
    assert json_type == b"JSON" and json_length % 4 == 0
    document = json.loads(data[20:20 + json_length])
    binary_length, binary_type = struct.unpack_from("<I4s", data, 20 + json_length)
    assert binary_type == b"BIN\0" and binary_length % 4 == 0
    binary = data[28 + json_length:]
    assert len(binary) == binary_length == document["buffers"][0]["byteLength"]

    def array(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        width = {"VEC3": 3, "SCALAR": 1}[accessor["type"]]
        kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        assert view["byteOffset"] % 4 == 0 and view["byteLength"] == 4 * width * accessor["count"]
        values = numpy.frombuffer(binary, kind, width * accessor["count"], view["byteOffset"])
        values = values.reshape(-1, width)
        if "min" in accessor:
            assert accessor["min"] == values.min(axis=0).tolist()
            assert accessor["max"] == values.max(axis=0).tolist()
        return values

    bodies = {}
    root = document["nodes"][document["scenes"][document["scene"]]["nodes"][0]]
    for child in root["children"]:
        node = document["nodes"][child]
        (primitive,) = document["meshes"][node["mesh"]]["primitives"]
        assert primitive.get("mode", 4) == 4
        x, y, z, w = node["rotation"]
        vertices = array(primitive["attributes"]["POSITION"]).astype(float)
        faces = array(primitive["indices"]).reshape(-1, 3)
        assert faces.max() < len(vertices)
        bodies[node["name"]] = (vertices @ rotation((w, x, y, z)).T + node["translation"], faces)
    return bodies


def obj_bodies(text):
    """Returns the same of the OBJ file that `plan` writes."""
    bodies, first, vertices = {}, 0, []
    for line in text.splitlines():
        kind, _, rest = line.partition(" ")
        if kind == "o":
            first += len(vertices)
            vertices, faces = [], []
            bodies[rest.removeprefix("link ")] = (vertices, faces)
        elif kind == "v":
            vertices.append([float(x) for x in rest.split()])
        elif kind == "f":
            faces.append([int(i) - 1 - first for i in rest.split()])
    return {name: (numpy.array(v), numpy.array(f)) for name, (v, f) in bodies.items() if f}


class ConvertTest(program.ProgramTest):
    """Tests on grasps of a torus, planned once: the file has a pre-grasp and a squeeze for each."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.planned = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.planned.cleanup)
        folder = pathlib.Path(cls.planned.name)
        vertices, faces = program.torus()
        inches = [[x / 0.0254 for x in vertex] for vertex in vertices]
        (folder / "torus.off").write_text(program.off_text(inches, faces))
        done = program.run("plan", "torus.off", "--mesh-unit", "in", "--count", "3", "--preset", "exact",
                           "--out", "out", cwd=folder)
        assert done.returncode == 0, done.stderr

    def setUp(self):
        super().setUp()
        shutil.copytree(self.planned.name, self.folder, dirs_exist_ok=True)
        self.file = self.folder / "out/grasps.json"
        self.record = json.loads(self.file.read_text())
        self.grasps = self.record["results"]["grasps"]
        self.joints = [joint["name"] for joint in self.record["hand"]["joints"]]

    def convert(self, *arguments, env=None):
        done = program.run("convert", *arguments, cwd=self.folder, env=env)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        return done.stdout

    def assert_near(self, found, expected, tolerance):
        numpy.testing.assert_allclose(found, expected, rtol=0, atol=tolerance)

    def planned_changed(self, change):
        data = json.loads(self.file.read_text())
        change(data["results"]["grasps"])
        return self.write("changed.json", json.dumps(data))


class Written(ConvertTest):
    def setUp(self):
        super().setUp()
        if numpy is None or yaml is None:
            self.skipTest("python3-numpy or python3-yaml is not installed")

    def test_isaac_grasp(self):
        printed = self.convert("out/grasps.json", "grasps.yaml")
        self.assertIn("3 of 3 grasps written to grasps.yaml", printed)
        self.assertIn("note: confidence is M / (1 + M)", printed)
        self.assertIn("note: the object's file is multiplied by 0.0254", printed)
        data = yaml.safe_load((self.folder / "grasps.yaml").read_text())
        self.assertEqual((data["format"], data["format_version"]), ("isaac_grasp", 1.0))
        self.assertEqual(data["object_frame_link"], "torus")
        self.assertEqual(data["gripper_frame_link"], self.record["hand"]["links"][0]["name"])
        self.assertEqual(list(data["grasps"]), ["grasp_0", "grasp_1", "grasp_2"])
        for grasp, ours in zip(data["grasps"].values(), self.grasps):
            self.assertEqual(grasp["confidence"], ours["m"] / (1 + ours["m"]))
            self.assertEqual(grasp["position"], ours["X_OH"]["translation_m"])
            self.assertEqual(grasp["cspace_position"], ours["joints"])
            self.assertEqual(grasp["pregrasp_cspace_position"], ours["pre_grasp"]["joints"])
            self.assert_near([grasp["orientation"]["w"], *grasp["orientation"]["xyz"]],
                             ours["X_OH"]["rotation_wxyz"], 1e-15)

    def test_small_and_whole_numbers_are_numbers_in_yaml(self):
        def shrink(grasps):
            grasps[0]["X_OH"]["translation_m"] = [1e-17, 0, -2]

        self.convert(self.planned_changed(shrink), "grasps.yaml")
        self.convert(self.planned_changed(shrink), "moveit.yaml", "--format", "moveit")
        grasp = yaml.safe_load((self.folder / "grasps.yaml").read_text())["grasps"]["grasp_0"]
        self.assertEqual(grasp["position"], [1e-17, 0, -2])
        message = yaml.safe_load((self.folder / "moveit.yaml").read_text())[0]
        self.assertEqual(message["grasp_pose"]["pose"]["position"], {"x": 1e-17, "y": 0, "z": -2})

    def test_dexgraspbench(self):
        printed = self.convert("out/grasps.json", "grasps.npz")
        self.assertIn("note: joints stand in the order of joint_names", printed)
        with numpy.load(self.folder / "grasps.npz", allow_pickle=False) as data:
            self.assertEqual(set(data), {"obj_path", "obj_scale", "obj_pose", "pregrasp_qpos",
                                         "grasp_qpos", "squeeze_qpos", "joint_names"})
            self.assertEqual(str(data["obj_path"]), "torus.off")
            self.assertEqual(float(data["obj_scale"]), 0.0254)
            self.assertEqual(data["obj_pose"].tolist(), [0, 0, 0, 1, 0, 0, 0])
            self.assertEqual(data["joint_names"].tolist(), self.joints)
            for key, part in (("pregrasp_qpos", "pre_grasp"), ("grasp_qpos", None),
                              ("squeeze_qpos", "squeeze")):
                qpos = data[key]
                self.assertEqual((qpos.shape, qpos.dtype), ((3, 7 + len(self.joints)), "<f8"))
                for row, grasp in zip(qpos, self.grasps):
                    ours = grasp[part] if part else grasp
                    self.assertEqual(row[:3].tolist(), ours["X_OH"]["translation_m"])
                    self.assert_near(row[3:7], ours["X_OH"]["rotation_wxyz"], 1e-15)
                    self.assertEqual(row[7:].tolist(), [ours["joints"][j] for j in self.joints])

        def strip(grasps):
            grasps[1]["squeeze"] = grasps[1]["pre_grasp"] = None

        printed = self.convert(self.planned_changed(strip), "grasps.npz")
        self.assertIn("note: grasp 2: no squeeze, its row of squeeze_qpos is NaN", printed)
        with numpy.load(self.folder / "grasps.npz") as data:
            for key in ("pregrasp_qpos", "squeeze_qpos"):
                self.assertEqual(numpy.isnan(data[key]).all(axis=1).tolist(), [False, True, False])

    def test_names_in_other_scripts(self):
        (self.folder / "torus.off").rename(self.folder / "Kränzchen 環.off")
        text = self.file.read_text().replace('"torus.off"', '"Kränzchen 環.off"')
        self.file.write_text(text)
        self.convert("out/grasps.json", "grasps.npz")
        with numpy.load(self.folder / "grasps.npz") as data:
            self.assertEqual(str(data["obj_path"]), "Kränzchen 環.off")
        self.convert("out/grasps.json", "grasps.yaml")
        data = yaml.safe_load((self.folder / "grasps.yaml").read_text())
        self.assertEqual(data["object_frame_link"], "Kränzchen 環")

    def check_message(self, value, kind, place="Grasp"):
        """Checks that a value is what its message's definition allows; the top message is whole."""
        if isinstance(kind, list):
            self.assertIsInstance(value, list, place)
            for item in value:
                self.check_message(item, kind[0], place + "[]")
        elif isinstance(kind, str):
            self.assertIsInstance(value, dict, place)
            self.assertLessEqual(set(value), set(MESSAGES[kind]), place)
            for key, item in value.items():
                self.check_message(item, MESSAGES[kind][key], f"{place}.{key}")
        else:
            self.assertIs(type(value), kind, place)

    def test_moveit_grasps(self):
        printed = self.convert("out/grasps.json", "grasps.yaml", "--format", "moveit")
        self.assertIn("note: post_grasp_retreat and post_place_retreat are not planned", printed)
        messages = yaml.safe_load((self.folder / "grasps.yaml").read_text())
        self.assertEqual(len(messages), 3)
        hand = self.record["hand"]
        independent = [joint["name"] for joint in hand["joints"] if joint["coupling"] is None]
        for message, ours in zip(messages, self.grasps):
            self.check_message(message, "Grasp")
            self.assertEqual(set(message), set(MESSAGES["Grasp"]))
            self.assertEqual(message["grasp_quality"], ours["m"])
            self.assertEqual(message["allowed_touch_objects"], ["torus"])
            self.assertEqual(message["grasp_pose"]["header"]["frame_id"], "torus")
            pose = message["grasp_pose"]["pose"]
            self.assertEqual([pose["position"][k] for k in "xyz"], ours["X_OH"]["translation_m"])
            self.assert_near([pose["orientation"][k] for k in "wxyz"],
                             ours["X_OH"]["rotation_wxyz"], 1e-15)
            for key, joints in (("grasp_posture", ours["joints"]),
                                ("pre_grasp_posture", ours["pre_grasp"]["joints"])):
                self.assertEqual(message[key]["joint_names"], independent)
                self.assertEqual(message[key]["points"],
                                 [{"positions": [joints[name] for name in independent]}])
            approach = message["pre_grasp_approach"]
            self.assertEqual(approach["direction"]["header"]["frame_id"], hand["palm"]["link"])
            # The palm of the pre-grasp stands back along this direction from the grasp.
            direction = rotation(ours["X_OH"]["rotation_wxyz"]) @ [
                approach["direction"]["vector"][k] for k in "xyz"]
            self.assert_near(
                numpy.array(ours["X_OH"]["translation_m"]) - approach["desired_distance"] * direction,
                ours["pre_grasp"]["X_OH"]["translation_m"], 1e-12)

    def test_graspit_world(self):
        printed = self.convert("out/grasps.json", "world.xml", "--grasp", "2")
        self.assertIn("1 of 3 grasps written to world.xml", printed)
        self.assertIn("which GraspIt! does not read", printed)
        world = ElementTree.parse(self.folder / "world.xml").getroot()
        self.assertEqual((world.tag, [child.tag for child in world]),
                         ("world", ["graspableBody", "robot"]))
        body, robot = world
        self.assertEqual(body.find("body/geometryFile").text, "torus.off")
        self.assertEqual(body.find("body/geometryFile").get("type"), "off")
        self.assertAlmostEqual(float(body.find("body/geometryScaling").text), 25.4, places=13)
        self.assertEqual(body.find("transform/fullTransform").text, "(1 0 0 0)[0 0 0]")
        quaternion, position = robot.find("transform/fullTransform").text.rstrip("]").split(")[")
        ours = self.grasps[1]
        self.assert_near([float(x) for x in quaternion.lstrip("(").split()],
                         ours["X_OH"]["rotation_wxyz"], 1e-15)
        self.assert_near([float(x) / 1000 for x in position.split()],
                         ours["X_OH"]["translation_m"], 1e-15)
        independent = [joint["name"] for joint in self.record["hand"]["joints"]
                       if joint["coupling"] is None]
        self.assertEqual([float(x) for x in robot.find("dofValues").text.split()],
                         [ours["joints"][name] for name in independent])

        self.convert("out/grasps.json", "worlds", "--format", "graspit", "--body-file",
                     "models/objects/torus.xml", "--robot-file", "models/robots/Barrett.xml")
        worlds = sorted((self.folder / "worlds").iterdir())
        self.assertEqual([path.name for path in worlds],
                         ["grasp_001.xml", "grasp_002.xml", "grasp_003.xml"])
        for path in worlds:
            world = ElementTree.parse(path).getroot()
            self.assertEqual(world.find("graspableBody/filename").text, "models/objects/torus.xml")
            self.assertEqual(world.find("robot/filename").text, "models/robots/Barrett.xml")

    def test_glb(self):
        self.convert("out/grasps.json", "all", "--format", "glb", "--quiet")
        for rank in (1, 2, 3):
            found = glb_bodies((self.folder / f"all/grasp_00{rank}.glb").read_bytes())
            posed = obj_bodies((self.folder / f"out/grasp_00{rank}.obj").read_text())
            self.assertEqual(list(found), list(posed))
            for name, (vertices, faces) in posed.items():
                self.assertEqual(found[name][1].tolist(), faces.tolist())
                # Coordinates below 0.2 m in links' frames have single precision.
                self.assert_near(found[name][0], vertices, 3e-8)
        self.convert("out/grasps.json", "best.glb")
        self.assertEqual((self.folder / "best.glb").read_bytes(),
                         (self.folder / "all/grasp_001.glb").read_bytes())
        self.convert("out/grasps.json", "all", "--format", "glb", "--grasp", "3,1")
        self.assertEqual(sorted(path.name for path in (self.folder / "all").iterdir()),
                         ["grasp_001.glb", "grasp_002.glb"])
        # Files of two formats are beside each other in one folder, and files of others stay.
        (self.folder / "all/grasp_009.glb.txt").write_text("mine")
        self.convert("out/grasps.json", "all", "--format", "graspit")
        self.convert("out/grasps.json", "all", "--format", "glb", "--grasp", "2")
        self.assertEqual(sorted(path.name for path in (self.folder / "all").iterdir()),
                         ["grasp_001.glb", "grasp_001.xml", "grasp_002.xml", "grasp_003.xml",
                          "grasp_009.glb.txt"])


class Imported(ConvertTest):
    IMPORT = ("--hand", "barrett", "--object", "torus.off", "--mesh-unit", "in")

    def test_there_and_back_has_the_same_grasps_and_measures(self):
        self.convert("out/grasps.json", "grasps.yaml")
        printed = self.convert("grasps.yaml", "back.json", *self.IMPORT)
        self.assertIn("grasp_0", printed)
        back = json.loads((self.folder / "back.json").read_text())
        self.assertEqual(back["imported"]["format"], "isaac_grasp 1.0")
        self.assertEqual(back["imported"]["file"], "grasps.yaml")
        for key in ("object", "hand"):
            mine, theirs = dict(self.record[key]), dict(back[key])
            for record in (mine, theirs):
                record.pop("used_mesh_file", None)
                for link in record.get("links", []):
                    link.pop("used_mesh_file")
            self.assertEqual(mine, theirs)
        self.assertEqual(len(back["results"]["grasps"]), len(self.grasps))
        for grasp, ours in zip(back["results"]["grasps"], self.grasps):
            self.assertEqual(grasp["X_OH"]["translation_m"], ours["X_OH"]["translation_m"])
            self.assertEqual(grasp["joints"], ours["joints"])
            for a, b in zip(grasp["X_OH"]["rotation_wxyz"], ours["X_OH"]["rotation_wxyz"]):
                self.assertAlmostEqual(a, b, delta=1e-15)
            for key in ("m", "m1", "m2", "m3", "largest_requested_gap_m"):
                self.assertAlmostEqual(grasp[key], ours[key], delta=1e-9)
            self.assertAlmostEqual(grasp["wrench"]["epsilon"], ours["wrench"]["epsilon"], delta=1e-9)
            self.assertEqual(grasp["valid"], ours["valid"])
            self.assertTrue(grasp["valid"])
            self.assertIsNotNone(grasp["pre_grasp"])
            for name, value in ours["squeeze"]["joints"].items():
                self.assertAlmostEqual(grasp["squeeze"]["joints"][name], value, delta=1e-9)

        done = program.run("evaluate", "back.json", cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        self.convert("back.json", "again.yaml")
        self.convert("again.yaml", "again.json", *self.IMPORT)
        again = json.loads((self.folder / "again.json").read_text())
        for grasp, ours in zip(again["results"]["grasps"], back["results"]["grasps"]):
            self.assertEqual(grasp["joints"], ours["joints"])

    def test_arrays_there_and_back_have_the_same_grasps_and_measures(self):
        self.convert("out/grasps.json", "grasps.npz")
        # The size is in the file.
        printed = self.convert("grasps.npz", "back.json", *self.IMPORT[:-2])
        self.assertIn("grasp_0", printed)
        back = json.loads((self.folder / "back.json").read_text())
        self.assertEqual(back["imported"]["format"], "DexGraspBench arrays")
        self.assertEqual(back["object"]["meters_per_file_unit"], 0.0254)
        self.assertEqual(len(back["results"]["grasps"]), len(self.grasps))
        for grasp, ours in zip(back["results"]["grasps"], self.grasps):
            self.assertEqual(grasp["joints"], ours["joints"])
            for key in ("translation_m", "rotation_wxyz"):
                for a, b in zip(grasp["X_OH"][key], ours["X_OH"][key]):
                    self.assertAlmostEqual(a, b, delta=1e-12)
            self.assertAlmostEqual(grasp["m"], ours["m"], delta=1e-12)
            self.assertAlmostEqual(grasp["wrench"]["epsilon"], ours["wrench"]["epsilon"], delta=1e-9)
            self.assertEqual(grasp["valid"], ours["valid"])

    def test_imported_grasps_can_be_tested_in_physics(self):
        self.convert("out/grasps.json", "grasps.yaml")
        self.convert("grasps.yaml", "back.json", *self.IMPORT)
        tables = []
        for file in ("out/grasps.json", "back.json"):
            done = program.run("hold", file, "--grasp", "1", cwd=self.folder)
            if "MuJoCo" in done.stderr:
                self.skipTest("built without MuJoCo")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            tables.append(done.stdout)
        self.assertIn(" held ", tables[0])
        self.assertIn(" held ", tables[1])

    def test_the_file_is_what_its_schema_says(self):
        try:
            import jsonschema
        except ImportError:
            self.skipTest("python3-jsonschema is not installed")
        self.convert("out/grasps.json", "grasps.yaml")
        self.convert("grasps.yaml", "back.json", *self.IMPORT)
        schema = json.loads((program.SOURCE_DIR / "grasp/grasps.schema.json").read_text())
        jsonschema.validate(json.loads((self.folder / "back.json").read_text()), schema)

    def test_measures_are_computed_and_not_believed(self):
        self.convert("out/grasps.json", "grasps.yaml")
        text = (self.folder / "grasps.yaml").read_text()
        lines = text.splitlines()
        # The second grasp is 5 cm aside and has the best confidence there is.
        at = [i for i, line in enumerate(lines) if line.startswith("    confidence")][1]
        x, *rest = lines[at + 1].split("[")[1].rstrip("]").split(", ")
        lines[at] = "    confidence: 1.0"
        lines[at + 1] = f"    position: [{float(x) + 0.05}, {', '.join(rest)}]"
        self.write("moved.yaml", "\n".join(lines) + "\n")
        printed = self.convert("moved.yaml", "back.json", *self.IMPORT)
        rows = [line.split() for line in printed.splitlines()[1:4]]
        self.assertEqual([row[1] for row in rows], ["grasp_0", "grasp_2", "grasp_1"])
        self.assertEqual([row[-1] for row in rows], ["yes", "yes", "no"])
        grasps = json.loads((self.folder / "back.json").read_text())["results"]["grasps"]
        self.assertEqual([grasp["attempt"] for grasp in grasps], [0, 2, 1])

    def test_fingers_and_palm_that_must_touch(self):
        self.convert("out/grasps.json", "grasps.yaml")
        self.convert("grasps.yaml", "back.json", *self.IMPORT, "--fingers", "thumb,finger_1")
        back = json.loads((self.folder / "back.json").read_text())
        self.assertEqual(back["planner"]["used"]["fingers"], ["thumb", "finger_1"])
        self.convert("grasps.yaml", "palm.json", *self.IMPORT, "--palm")
        self.assertTrue(json.loads((self.folder / "palm.json").read_text())
                        ["planner"]["used"]["palm"])

    def test_straight_to_another_tool(self):
        self.convert("out/grasps.json", "grasps.yaml")
        self.convert("grasps.yaml", "grasps.npz", *self.IMPORT)
        self.convert("grasps.yaml", "best.glb", *self.IMPORT)
        self.assertEqual((self.folder / "best.glb").read_bytes()[:4], b"glTF")


class BadInput(ConvertTest):
    def refused(self, *arguments, says):
        return self.assert_refused("convert", *arguments, says=says, cwd=self.folder)

    def test_command_lines(self):
        self.convert("out/grasps.json", "grasps.yaml")
        ours, theirs = "out/grasps.json", "grasps.yaml"
        hand, mesh = ("--hand", "barrett"), ("--object", "torus.off", "--mesh-unit", "in")
        for arguments, says in (
                ((), "no IN given"),
                ((ours,), "no OUT given"),
                ((ours, "a.yaml", "b.yaml"), "more than IN and OUT"),
                ((ours, "a.txt"), "--format graspfit|isaac"),
                ((ours, "a"), "--format graspfit|isaac"),
                ((ours, "a.yaml", "--format", "openrave"), "openrave"),
                ((ours, "b.json"), "nothing to convert"),
                ((ours, "out", "--format", "isaac"), "is a folder"),
                ((ours, "a.yaml", *hand), "--hand is for .yaml and .npz files"),
                ((ours, "a.yaml", "--longest", "0.1"), "--longest is for .yaml and .npz files"),
                ((ours, "a.yaml", "--repair", "bogus"), "--repair is for .yaml and .npz files"),
                ((ours, "a.yaml", "--weld", "0.001"), "--weld is for .yaml and .npz files"),
                ((ours, "a.yaml", "--wrap"), "--wrap is for .yaml and .npz files"),
                ((ours, "a.yaml", "--robot-file", "x.xml"), "--robot-file is for --format graspit"),
                ((ours, "a.yaml", "--object", "torus.off"), "--object is for .yaml and .npz files"),
                ((ours, "a.glb", "--object", "none.off"), "none.off"),
                ((ours, ours, "--format", "isaac"), "is IN, which would be lost"),
                ((theirs, "./" + theirs, *hand, *mesh, "--format", "moveit"), "is IN"),
                ((ours, "a.glb", "--grasp", "4"), "there are 3 grasps"),
                ((ours, "a.glb", "--grasp", "0"), "does not list ranks"),
                ((ours, "no/where/a.yaml"), "no/where"),
                (("none.json", "a.yaml"), "none.json"),
                (("grasps.xml", "a.json"), "are written, not read"),
                (("grasps.npz", "a.json"), "--hand NAME|FILE says which"),
                (("grasps.npz", "a.json", *hand, *mesh), "grasps.npz"),
                ((theirs, "a.json"), "--hand NAME|FILE says which"),
                ((theirs, "a.json", *hand), "--object FILE says which"),
                ((theirs, "a.json", "--hand", "elbow", *mesh), "elbow"),
                ((theirs, "a.json", "--hand", "human_hand", *mesh), "has no such joint"),
                ((theirs, "a.json", *hand, "--object", "none.off"), "none.off"),
                ((theirs, "a.json", *hand, *mesh, "--fingers", "thumb,pinky"), "pinky"),
                ((theirs, "a.json", *hand, *mesh, "--longest", "0.1"), "exclude each other")):
            with self.subTest(arguments):
                self.refused(*arguments, says=says)

    def test_object_that_is_another_one(self):
        self.write("torus.off", program.off_text(*program.torus(0.051)))
        self.refused("out/grasps.json", "a.glb", says=["torus.off", "SHA-256"])
        # Without its mesh the grasps can still be written.
        self.convert("out/grasps.json", "a.yaml")

    def test_damaged_files_leave_what_was_there(self):
        self.convert("out/grasps.json", "good.yaml")
        text = (self.folder / "good.yaml").read_text()
        self.write("a.json", "mine")
        for old, new, says in (
                ("format: isaac_grasp", "format: isaac", "/format"),
                ("format_version: 1.0", "format_version: 3", "version 1.0 is read"),
                ("grasps:", "graps:", "/grasps: is missing"),
                ("orientation: {w: ", "orientation: {w: 2", "no unit quaternion"),
                ("position: [", "position: [0.0, ", "three numbers"),
                ('"thumb_distal"', '"thumb_distant"', "no such joint"),
                ("confidence: ", "confidence: x", "not a finite number"),
                ("{w:", "{w", "/orientation"),
                ("  \"grasp_1\":", "  \"grasp_0\":", "has grasp_0 twice")):
            damaged = text.replace(old, new, 1)
            if old == '"thumb_distal"' and damaged == text:
                name = f'"{self.joints[-1]}"'
                damaged = text.replace(name, '"thumb_distant"', 1)
            with self.subTest(new):
                self.assertNotEqual(damaged, text)
                self.write("bad.yaml", damaged)
                self.refused("bad.yaml", "a.json", *Imported.IMPORT, says=["bad.yaml: ", says])
        for data in (b"", b"\x00\x01", b"[", b"a: *b\n", b"{" * 100000):
            with self.subTest(data[:9]):
                self.write("bad.yaml", data)
                self.refused("bad.yaml", "a.json", *Imported.IMPORT, says="bad.yaml")
        self.assertEqual((self.folder / "a.json").read_text(), "mine")


class Locale(ConvertTest):
    def test_locale_does_not_change_the_bytes(self):
        environment = program.german_environment(self.folder)
        if environment is None:
            self.skipTest("no German locale, and none could be compiled; install the package "
                          "locales")
        comma = subprocess.run(["bash", "-c", "printf %.1f 1,5"], env=environment,
                               capture_output=True, text=True, check=True)
        self.assertEqual(comma.stdout, "1,5")
        outputs = {}
        for language, env in (("c", None), ("german", environment)):
            files = []
            for name, flags in (("g.yaml", ()), ("m.yaml", ("--format", "moveit")), ("g.npz", ()),
                                ("g.xml", ()), ("g.glb", ()), ("g.json", None)):
                if flags is None:
                    self.convert(files[0], f"{language}.json", *Imported.IMPORT, env=env)
                    continue
                files.append(f"{language}_{name}")
                printed = self.convert("out/grasps.json", files[-1], *flags, env=env)
                self.assertNotIn("0,0", printed)
            outputs[language] = [(self.folder / file).read_bytes() for file in files]
            back = json.loads((self.folder / f"{language}.json").read_text())
            outputs[language].append(json.dumps(back["results"]))
        self.assertEqual(outputs["c"], outputs["german"])


class Help(program.ProgramTest):
    def test_help_says_formats_and_flags(self):
        done = program.run("convert", "--help")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("Usage: graspfit convert IN OUT [options]", done.stdout)
        for text in ("isaac_grasp 1.0", "dexgraspbench", "moveit", "graspit", "glb", "--hand",
                     "--object", "--fingers", "--grasp", "Exit codes"):
            self.assertIn(text, done.stdout)
        self.assertLessEqual(max(map(len, done.stdout.splitlines())), 110)


if __name__ == "__main__":
    program.main()
