#!/usr/bin/python3
"""Pictures of grasps: DIR/grasp_001.png and so on, from the files that `graspfit plan` wrote.

Reads DIR/grasps.json and, for each of its grasps, DIR/grasp_NNN.obj: the object (`o object`) and the
posed links (`o link NAME`), in meters, in the object frame O. Each picture shows the grasp across the
palm direction and facing the contact polygon, both in parallel projection, so that the scale bar holds
everywhere. Pictures are written under a temporary name and renamed.

Uses Debian's python3-vtk9, under xvfb-run where that is installed. Exit code 1 with one line on bad
input or a missing program.
"""

import argparse
import json
import math
import os
import pathlib
import shutil
import sys

COLORS = {
    "object": (0.86, 0.82, 0.75),
    "hand": (0.44, 0.56, 0.68),
    "contact": (0.83, 0.19, 0.16),
    "stable": (0.18, 0.56, 0.34),
    "edge": (0.55, 0.57, 0.59),
    "palm": (0.48, 0.29, 0.70),
    "center": (0.13, 0.14, 0.16),
    "ink": (0.14, 0.16, 0.18),
    "soft": (0.40, 0.44, 0.47),
}
BOTTOM, TOP = 0.115, 0.9  # of the two views, as parts of the picture's height
SUPERSAMPLING = 2  # each way; smooths every edge, whatever the graphics driver offers
UNDER_XVFB = "GRASPFIT_UNDER_XVFB"


class BadInput(Exception):
    """What is wrong, in one line."""


# ------------------------------------------------------------------------------------------- input


def read_grasps(path):
    """The object and list of grasps of a grasp file, checked as far as pictures need them."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise BadInput(f"{path}: not JSON: {error}") from error

    def entry(value, *keys):
        trail = ""
        for key in keys:
            trail += f"/{key}"
            try:
                value = value[key]
            except (KeyError, IndexError, TypeError):
                raise BadInput(f"{path}: no {trail}") from None
        return value

    def vector(value, what):
        if (
            not isinstance(value, list)
            or len(value) != 3
            or not all(isinstance(x, (int, float)) and math.isfinite(x) for x in value)
        ):
            raise BadInput(f"{path}: {what} is {json.dumps(value)}, not three numbers")
        return value

    found = entry(data, "results", "grasps")
    if not isinstance(found, list):
        raise BadInput(f"{path}: /results/grasps is no list")
    palm = entry(data, "hand", "palm")
    grasps = []
    for i, item in enumerate(found):
        where = f"/results/grasps/{i}"
        pose = entry(item, "X_OH")
        rotation = entry(pose, "rotation_wxyz")
        if not isinstance(rotation, list) or len(rotation) != 4:
            raise BadInput(f"{path}: {where}/X_OH/rotation_wxyz is {json.dumps(rotation)}")
        translation = vector(entry(pose, "translation_m"), f"{where}/X_OH/translation_m")
        direction = rotate(rotation, vector(entry(palm, "direction_H"), "/hand/palm/direction_H"))
        center = rotate(rotation, vector(entry(palm, "center_H_m"), "/hand/palm/center_H_m"))
        contacts = []
        for j, contact in enumerate(entry(item, "contacts")):
            at = f"{where}/contacts/{j}"
            contacts.append(
                {
                    "point": vector(entry(contact, "point_O_m"), f"{at}/point_O_m"),
                    "normal": vector(entry(contact, "inward_normal_O"), f"{at}/inward_normal_O"),
                    "finger": str(entry(contact, "finger")),
                }
            )
        pairs = [tuple(sorted(entry(pair, "contacts"))) for pair in entry(item, "stable_pairs")]
        measures = {name: entry(item, name) for name in ("m", "m1", "m2", "m3")}
        for name, value in measures.items():
            if not isinstance(value, (int, float)):
                raise BadInput(f"{path}: {where}/{name} is {json.dumps(value)}, not a number")
        grasps.append(
            {
                "number": i + 1,
                "contacts": contacts,
                "stable_pairs": pairs,
                "palm_center": [a + b for a, b in zip(translation, center)],
                "palm_direction": direction,
                "state": "valid" if item.get("valid") else "usable" if item.get("usable") else "unusable",
                "penetration": float(item.get("largest_penetration_m") or 0.0),
                **measures,
            }
        )
    return {
        "object_name": pathlib.PurePath(str(entry(data, "object", "file"))).stem,
        "center_of_mass": vector(
            entry(data, "object", "center_of_mass_O_m"), "/object/center_of_mass_O_m"
        ),
        "hand_name": str(entry(data, "hand", "name")),
        "grasps": grasps,
    }


def rotate(quaternion_wxyz, v):
    """v turned by a unit quaternion."""
    w, *q = quaternion_wxyz
    t = [2.0 * x for x in cross(q, v)]
    return [a + w * b + c for a, b, c in zip(v, t, cross(q, t))]


def read_parts(path):
    """Named parts of an OBJ file: [(name, vertices, faces)], faces indexing the part's vertices."""
    vertices = []
    parts = []
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            for number, line in enumerate(file, start=1):
                words = line.split()
                if not words or words[0] not in ("v", "f", "o", "g"):
                    continue
                try:
                    if words[0] == "v":
                        point = tuple(float(word) for word in words[1:4])
                        if len(point) != 3 or not all(map(math.isfinite, point)):
                            raise ValueError
                        vertices.append(point)
                    elif words[0] == "f":
                        face = [int(word.partition("/")[0]) for word in words[1:]]
                        face = [k - 1 if k > 0 else len(vertices) + k for k in face]
                        if len(face) < 3 or min(face) < 0 or max(face) >= len(vertices):
                            raise ValueError
                        if not parts:
                            parts.append(("object", []))
                        parts[-1][1].append(face)
                    else:
                        parts.append((" ".join(words[1:]), []))
                except ValueError:
                    raise BadInput(f"{path}: line {number} makes no sense: {line.strip()[:60]}") from None
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    result = []
    for name, faces in parts:
        used = sorted({k for face in faces for k in face})
        new_index = {k: i for i, k in enumerate(used)}
        result.append(
            (name, [vertices[k] for k in used], [[new_index[k] for k in face] for face in faces])
        )
    if not any(name == "object" and faces for name, _, faces in result):
        raise BadInput(f"{path}: holds no faces of a part named object")
    return result


# ------------------------------------------------------------------------------------------ vectors


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def along(p, direction, distance):
    return [x + distance * d for x, d in zip(p, direction)]


def unit(v):
    size = math.sqrt(dot(v, v))
    return [x / size for x in v] if size > 0.0 else None


def perpendicular(v):
    axis = [0.0, 0.0, 0.0]
    axis[min(range(3), key=lambda k: abs(v[k]))] = 1.0
    return unit(cross(v, axis))


def polygon_normal(grasp):
    """Unit normal of the contacts' polygon, on the side that the palm does not cover."""
    points = [contact["point"] for contact in grasp["contacts"]]
    palm = grasp["palm_direction"]
    normal = None
    if len(points) == 2:
        normal = unit(cross(minus(points[1], points[0]), palm))
    elif len(points) > 2:
        # Newell's: right for any polygon, close for contacts that are not in a plane.
        total = [0.0, 0.0, 0.0]
        for a, b in zip(points, points[1:] + points[:1]):
            total = [x + y for x, y in zip(total, cross(a, b))]
        normal = unit(total)
    if normal is None:
        return perpendicular(palm)
    return [-x for x in normal] if dot(normal, palm) < 0.0 else normal


def side_direction(grasp, up):
    """Toward the eye: across the palm direction, close to level, showing the polygon's face."""
    palm = grasp["palm_direction"]
    normal = polygon_normal(grasp)
    start = perpendicular(palm)
    other = cross(palm, start)
    best, best_score = start, -math.inf
    for i in range(48):
        angle = 2.0 * math.pi * i / 48
        candidate = [math.cos(angle) * a + math.sin(angle) * b for a, b in zip(start, other)]
        score = abs(dot(candidate, normal)) - 0.8 * abs(candidate[up] - 0.2)
        if score > best_score + 1e-9:
            best, best_score = candidate, score
    return best


def hull_edges(points):
    """Edges of the convex hull of a few points: pairs with all others on one side of a plane."""
    edges = []
    n = len(points)
    for i in range(n):
        for j in range(i + 1, n):
            is_edge = n <= 3
            for k in range(n):
                if is_edge or k in (i, j):
                    continue
                normal = cross(minus(points[j], points[i]), minus(points[k], points[i]))
                sides = [dot(normal, minus(points[l], points[i])) for l in range(n) if l not in (i, j, k)]
                is_edge = all(s > 0 for s in sides) or all(s <= 0 for s in sides)
            if is_edge:
                edges.append((i, j))
    return edges


# ------------------------------------------------------------------------------------------ picture


class Painter:
    """Draws grasps into pictures of one size with one VTK window."""

    def __init__(self, width, height, up, scene):
        import vtk  # here: checks of the input come before a second of loading

        self.vtk = vtk
        vtk.vtkObject.GlobalWarningDisplayOff()
        self.width, self.height, self.up, self.scene = width, height, up, scene
        self.scale = SUPERSAMPLING * min(height / 800, width / 1400)  # of text and lines

    def paint(self, grasp, parts):
        """PNG file of one grasp as bytes."""
        vtk = self.vtk
        window = vtk.vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        window.SetSize(SUPERSAMPLING * self.width, SUPERSAMPLING * self.height)
        window.SetNumberOfLayers(2)

        low = [min(v[k] for _, vertices, _ in parts for v in vertices) for k in range(3)]
        high = [max(v[k] for _, vertices, _ in parts for v in vertices) for k in range(3)]
        size = math.dist(low, high)
        solids = [self.solid(*part) for part in parts if part[2]]
        views = [
            ("across the palm direction", side_direction(grasp, self.up)),
            ("facing the contact polygon", polygon_normal(grasp)),
        ]
        for column, (name, back) in enumerate(views):
            frame = (0.5 * column, BOTTOM, 0.5 * (column + 1), TOP)
            camera, height_m = self.camera(back, parts, size)
            shaded = self.renderer(window, frame, 0)
            shaded.SetActiveCamera(camera)
            kit = vtk.vtkLightKit()
            kit.SetKeyLightIntensity(0.86)
            kit.SetKeyToFillRatio(2.6)
            kit.AddLightsToRenderer(shaded)
            for solid in solids:
                shaded.AddActor(solid)
            # Marks once more in front of everything, faint: those hidden by the hand shine through.
            above = self.renderer(window, frame, 1)
            above.SetActiveCamera(camera)
            for opacity, renderer in ((1.0, shaded), (0.6, above)):
                for mark in self.marks(grasp, size):
                    mark.GetProperty().SetOpacity(opacity)
                    renderer.AddActor(mark)
            shaded.ResetCameraClippingRange()
            self.add_axes(window, column, camera)
            view_pixels = (TOP - BOTTOM) * SUPERSAMPLING * self.height
            self.add_scale_bar(window, column, name, height_m / view_pixels)
        self.add_caption(window, grasp)
        window.Render()
        return self.png(window)

    def renderer(self, window, frame, layer):
        renderer = self.vtk.vtkRenderer()
        renderer.SetViewport(*frame)
        renderer.SetLayer(layer)
        renderer.SetBackground(1.0, 1.0, 1.0)
        renderer.InteractiveOff()
        window.AddRenderer(renderer)
        return renderer

    def solid(self, name, vertices, faces):
        vtk = self.vtk
        points = vtk.vtkPoints()
        points.SetDataTypeToDouble()
        points.SetNumberOfPoints(len(vertices))
        for i, vertex in enumerate(vertices):
            points.SetPoint(i, vertex)
        cells = vtk.vtkCellArray()
        for face in faces:
            cells.InsertNextCell(len(face))
            for k in face:
                cells.InsertCellPoint(k)
        mesh = vtk.vtkPolyData()
        mesh.SetPoints(points)
        mesh.SetPolys(cells)
        triangles = vtk.vtkTriangleFilter()
        triangles.SetInputData(mesh)
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputConnection(triangles.GetOutputPort())
        normals.SetFeatureAngle(40.0)
        normals.ConsistencyOff()
        normals.SplittingOn()
        is_object = name == "object"
        actor = self.actor(normals, COLORS["object" if is_object else "hand"])
        look = actor.GetProperty()
        look.SetAmbient(0.12)
        look.SetDiffuse(0.88)
        look.SetSpecular(0.05 if is_object else 0.18)
        look.SetSpecularPower(30.0)
        return actor

    def actor(self, source, color):
        mapper = self.vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(source.GetOutputPort())
        mapper.ScalarVisibilityOff()
        actor = self.vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*color)
        return actor

    def ball(self, center, radius, color):
        source = self.vtk.vtkSphereSource()
        source.SetCenter(*center)
        source.SetRadius(radius)
        source.SetThetaResolution(32)
        source.SetPhiResolution(24)
        return self.flat(self.actor(source, color))

    def tube(self, start, end, radius, color):
        source = self.vtk.vtkLineSource()
        source.SetPoint1(*start)
        source.SetPoint2(*end)
        tube = self.vtk.vtkTubeFilter()
        tube.SetInputConnection(source.GetOutputPort())
        tube.SetRadius(radius)
        tube.SetNumberOfSides(16)
        tube.CappingOn()
        return self.flat(self.actor(tube, color))

    def arrow(self, start, direction, length, radius, color):
        direction = unit(direction)
        if direction is None:
            return []
        head = 5.0 * radius
        neck = along(start, direction, length - head)
        cone = self.vtk.vtkConeSource()
        cone.SetRadius(2.4 * radius)
        cone.SetHeight(head)
        cone.SetResolution(24)
        cone.SetDirection(*direction)
        cone.SetCenter(*along(neck, direction, 0.5 * head))
        return [self.tube(start, neck, radius, color), self.flat(self.actor(cone, color))]

    @staticmethod
    def flat(actor):
        look = actor.GetProperty()
        look.SetAmbient(0.35)
        look.SetDiffuse(0.65)
        look.SetSpecular(0.15)
        look.SetSpecularPower(40.0)
        return actor

    def marks(self, grasp, size):
        """Contacts with their inward normals, the polygon's edges, palm direction, center of mass."""
        marks = [self.ball(self.scene["center_of_mass"], 0.010 * size, COLORS["center"])]
        points = [contact["point"] for contact in grasp["contacts"]]
        edges = set(hull_edges(points)) | set(grasp["stable_pairs"])
        for i, j in sorted(edges):
            if not (0 <= i < j < len(points)):
                raise BadInput(f"grasp {grasp['number']}: no contacts {i} and {j}")
            stable = (i, j) in grasp["stable_pairs"]
            color = COLORS["stable" if stable else "edge"]
            marks.append(self.tube(points[i], points[j], (0.0032 if stable else 0.0022) * size, color))
        for contact in grasp["contacts"]:
            marks.append(self.ball(contact["point"], 0.0115 * size, COLORS["contact"]))
            marks += self.arrow(
                contact["point"], contact["normal"], 0.085 * size, 0.003 * size, COLORS["contact"]
            )
        marks += self.arrow(
            grasp["palm_center"], grasp["palm_direction"], 0.16 * size, 0.0036 * size, COLORS["palm"]
        )
        return marks

    def camera(self, back, parts, size):
        """A parallel camera with all parts in view, and the height of that view in meters."""
        up = [0.0, 0.0, 0.0]
        up[self.up] = 1.0
        if abs(dot(up, back)) > 0.97:
            up = up[-1:] + up[:-1]
        right = unit(cross(up, back))
        up = cross(back, right)
        spans = []
        for axis in (right, up, back):
            values = [dot(v, axis) for _, vertices, _ in parts for v in vertices]
            spans.append((min(values), max(values)))
        center = [0.0, 0.0, 0.0]
        for (low, high), axis in zip(spans, (right, up, back)):
            center = along(center, axis, 0.5 * (low + high))
        aspect = 0.5 * self.width / ((TOP - BOTTOM) * self.height)
        height = max(spans[1][1] - spans[1][0], (spans[0][1] - spans[0][0]) / aspect)
        height = 1.06 * height
        camera = self.vtk.vtkCamera()
        camera.ParallelProjectionOn()
        camera.SetParallelScale(0.5 * height)
        camera.SetFocalPoint(*center)
        camera.SetPosition(*along(center, back, 2.0 * size))
        camera.SetViewUp(*up)
        return camera, height

    def text(self, renderer, words, x, y, size, color, bold=False, align="left"):
        """Text at a pixel of the renderer; its width in pixels."""
        actor = self.vtk.vtkTextActor()
        actor.SetInput(words)
        look = actor.GetTextProperty()
        look.SetFontFamilyToArial()
        look.SetFontSize(round(size * self.scale))
        look.SetColor(*color)
        look.SetBold(bold)
        look.SetVerticalJustificationToBottom()
        {
            "left": look.SetJustificationToLeft,
            "center": look.SetJustificationToCentered,
            "right": look.SetJustificationToRight,
        }[align]()
        actor.SetPosition(x, y)
        renderer.AddActor2D(actor)
        box = [0.0] * 4
        actor.GetBoundingBox(renderer, box)
        return box[1] - box[0]

    def flat_shape(self, renderer, points, color, line_width=None):
        """A filled polygon, or with a width a line, at pixels of the renderer."""
        vtk = self.vtk
        corners = vtk.vtkPoints()
        cell = vtk.vtkCellArray()
        cell.InsertNextCell(len(points))
        for i, (x, y) in enumerate(points):
            corners.InsertNextPoint(x, y, 0.0)
            cell.InsertCellPoint(i)
        shape = vtk.vtkPolyData()
        shape.SetPoints(corners)
        mapper = vtk.vtkPolyDataMapper2D()
        mapper.SetInputData(shape)
        actor = vtk.vtkActor2D()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*color)
        if line_width is None:
            shape.SetPolys(cell)
        else:
            shape.SetLines(cell)
            actor.GetProperty().SetLineWidth(line_width)
        renderer.AddActor2D(actor)

    def add_caption(self, window, grasp):
        s = self.scale
        top = self.renderer(window, (0.0, 0.9, 1.0, 1.0), 0)
        scene = self.scene
        title = f"{scene['object_name']}, {scene['hand_name']} hand, grasp {grasp['number']}"
        measures = (
            f"M {grasp['m']:.3f}   (M1 {grasp['m1']:.3f}, M2 {grasp['m2']:.3f}, M3 {grasp['m3']:.3f})"
            f"   {grasp['state']}"
        )
        if grasp["penetration"] > 0.0:
            measures += f"   penetration {1000 * grasp['penetration']:.2f} mm"
        self.text(top, title, 24 * s, 40 * s, 19, COLORS["ink"], bold=True)
        self.text(top, measures, 24 * s, 12 * s, 16, COLORS["ink"])
        bottom = self.renderer(window, (0.0, 0.0, 1.0, 0.055), 0)
        x = 24 * s
        for key, words in (
            ("contact", "contact and inward normal"),
            ("stable", "stable pair of contacts"),
            ("edge", "other edge of the contact polygon"),
            ("palm", "palm direction"),
            ("center", "center of mass"),
        ):
            turns = [2.0 * math.pi * i / 24 for i in range(24)]
            disc = [(x + (6 + 6 * math.cos(t)) * s, (21 + 6 * math.sin(t)) * s) for t in turns]
            self.flat_shape(bottom, disc, COLORS[key])
            x += 18 * s
            x += self.text(bottom, words, x, 13 * s, 13, COLORS["soft"]) + 24 * s

    def add_scale_bar(self, window, column, name, meters_per_pixel):
        """The strip below a view: its name, and a length in it."""
        s = self.scale
        strip = (0.5 * column, 0.055, 0.5 * (column + 1), BOTTOM)
        renderer = self.renderer(window, strip, 0)
        width = 0.5 * SUPERSAMPLING * self.width
        wanted = 130 * s * meters_per_pixel
        power = 10.0 ** math.floor(math.log10(wanted))
        length = next(k * power for k in (5, 2, 1) if k * power <= wanted * (1 + 1e-9))
        words = f"{1000 * length:g} mm" if length < 0.01 else f"{100 * length:g} cm"
        if length >= 1.0:
            words = f"{length:g} m"
        right = width - 24 * s
        left = right - length / meters_per_pixel
        bracket = [(left, 17 * s), (left, 9 * s), (right, 9 * s), (right, 17 * s)]
        self.flat_shape(renderer, bracket, COLORS["soft"], 2.0 * s)
        self.text(renderer, words, 0.5 * (left + right), 18 * s, 14, COLORS["soft"], align="center")
        self.text(renderer, name, 0.5 * width, 14 * s, 15, COLORS["soft"], align="center")

    def add_axes(self, window, column, camera):
        """The axes of O in the view's lower left corner."""
        side = 0.12
        aspect = self.height / self.width
        x = 0.5 * column + 0.008
        frame = (x, 0.056, x + side * aspect, 0.056 + side)
        renderer = self.renderer(window, frame, 1)
        for k, (name, color) in enumerate(
            (("x", (0.78, 0.22, 0.18)), ("y", (0.23, 0.56, 0.25)), ("z", (0.18, 0.37, 0.71)))
        ):
            direction = [0.0, 0.0, 0.0]
            direction[k] = 1.0
            for actor in self.arrow([0.0, 0.0, 0.0], direction, 1.0, 0.045, color):
                renderer.AddActor(actor)
            label = self.vtk.vtkBillboardTextActor3D()
            label.SetInput(name)
            label.SetPosition(*along([0.0, 0.0, 0.0], direction, 1.25))
            look = label.GetTextProperty()
            look.SetFontSize(round(14 * self.scale))
            look.SetColor(*color)
            look.SetBold(True)
            look.SetJustificationToCentered()
            look.SetVerticalJustificationToCentered()
            renderer.AddActor(label)
        small = self.vtk.vtkCamera()
        small.ParallelProjectionOn()
        small.SetParallelScale(1.5)
        small.SetFocalPoint(0.0, 0.0, 0.0)
        small.SetPosition(*[5.0 * x for x in unit(minus(camera.GetPosition(), camera.GetFocalPoint()))])
        small.SetViewUp(*camera.GetViewUp())
        renderer.SetActiveCamera(small)
        renderer.ResetCameraClippingRange()

    def png(self, window):
        vtk = self.vtk
        capture = vtk.vtkWindowToImageFilter()
        capture.SetInput(window)
        capture.SetInputBufferTypeToRGB()
        capture.ReadFrontBufferOff()
        shrink = vtk.vtkImageShrink3D()
        shrink.SetInputConnection(capture.GetOutputPort())
        shrink.SetShrinkFactors(SUPERSAMPLING, SUPERSAMPLING, 1)
        shrink.AveragingOn()
        writer = vtk.vtkPNGWriter()
        writer.SetInputConnection(shrink.GetOutputPort())
        writer.WriteToMemoryOn()
        writer.Write()
        data = writer.GetResult()
        if data is None or data.GetNumberOfTuples() == 0:
            raise BadInput("VTK made no picture; is there a working OpenGL driver (libgl1-mesa-dri)?")
        return bytes(memoryview(data))


# --------------------------------------------------------------------------------------------- main


def write_atomically(path, content):
    part = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with open(part, "xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    finally:
        part.unlink(missing_ok=True)


def pixels(text):
    value = int(text)
    if not 200 <= value <= 8000:
        raise argparse.ArgumentTypeError(f"{value} is not in 200 to 8000")
    return value


def main():
    parser = argparse.ArgumentParser(
        prog="render_grasps.py",
        description="Writes DIR/grasp_001.png and so on: pictures of the grasps in DIR/grasps.json.",
    )
    parser.add_argument(
        "folder", metavar="DIR", type=pathlib.Path, help="folder of a plan, or its grasps.json"
    )
    parser.add_argument("--out", metavar="DIR", type=pathlib.Path, help="for pictures (default: the same)")
    parser.add_argument("--width", type=pixels, default=1400, help="pixels (default 1400)")
    parser.add_argument("--height", type=pixels, default=800, help="pixels (default 800)")
    parser.add_argument(
        "--up", choices="xyz", default="y", help="axis of O that points up in the picture (default y)"
    )
    arguments = parser.parse_args()
    try:
        file = arguments.folder
        if file.suffix != ".json":
            file = file / "grasps.json"
        out = arguments.out or file.parent
        if not out.is_dir():
            raise BadInput(f"{out}: no such folder")
        scene = read_grasps(file)
        for grasp in scene["grasps"]:
            path = file.parent / f"grasp_{grasp['number']:03d}.obj"
            if not path.is_file():
                raise BadInput(f"{path}: No such file")
        # A virtual display wherever there is one: a user's display may be remote, closed to us, or
        # without OpenGL, and VTK then ends the program.
        if UNDER_XVFB not in os.environ:
            xvfb = shutil.which("xvfb-run")
            if xvfb:
                os.environ[UNDER_XVFB] = "1"
                command = [xvfb, "-a", "-s", "-screen 0 1280x1024x24", sys.executable, *sys.argv]
                os.execv(xvfb, command)
            if not os.environ.get("DISPLAY"):
                raise BadInput("no display: install xvfb and xauth")
        try:
            painter = Painter(arguments.width, arguments.height, "xyz".index(arguments.up), scene)
        except ImportError as error:
            raise BadInput(f"{error}: install python3-vtk9") from error
        for grasp in scene["grasps"]:
            name = f"grasp_{grasp['number']:03d}"
            picture = painter.paint(grasp, read_parts(file.parent / f"{name}.obj"))
            write_atomically(out / f"{name}.png", picture)
    except BadInput as error:
        print(f"render_grasps.py: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
