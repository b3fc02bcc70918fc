"""Drawing with VTK that the picture scripts share: solids, marks, cameras, text, PNG files.

Uses Debian's python3-vtk9, under xvfb-run where that is installed.
"""

import argparse
import math
import os
import shutil
import sys

COLORS = {
    "object": (0.86, 0.82, 0.75),
    "hand": (0.44, 0.56, 0.68),
    "contact": (0.83, 0.19, 0.16),
    "stable": (0.18, 0.56, 0.34),
    "edge": (0.55, 0.57, 0.59),
    "pad": (0.85, 0.49, 0.12),
    "clip": (0.07, 0.60, 0.65),
    "joint": (0.13, 0.14, 0.16),
    "follower": (0.55, 0.57, 0.59),
    "surroundings": (0.56, 0.64, 0.54),
    "palm": (0.48, 0.29, 0.70),
    "center": (0.13, 0.14, 0.16),
    "ink": (0.14, 0.16, 0.18),
    "soft": (0.40, 0.44, 0.47),
}
SUPERSAMPLING = 2  # each way; smooths every edge, whatever the graphics driver offers
SEEN_THROUGH = 0.45  # Opacity of what stands around.
UNDER_XVFB = "GRASPFIT_UNDER_XVFB"


class BadInput(Exception):
    """What is wrong, in one line."""


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


# ------------------------------------------------------------------------------------------ picture


class Canvas:
    """Pictures of one size; subclasses put views, captions and legends into a window."""

    def __init__(self, width, height):
        try:
            import vtk  # here: checks of the input come before a second of loading
        except ImportError as error:
            raise BadInput(f"{error}: install python3-vtk9") from error

        self.vtk = vtk
        vtk.vtkObject.GlobalWarningDisplayOff()
        self.width, self.height = width, height
        self.scale = SUPERSAMPLING * min(height / 800, width / 1400)  # of text and lines

    def window(self):
        window = self.vtk.vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        window.SetSize(SUPERSAMPLING * self.width, SUPERSAMPLING * self.height)
        window.SetNumberOfLayers(2)
        return window

    def add_view(self, window, frame, camera, solids, marks):
        """The scene in a part of the window: solids, and marks that shine through what hides them.

        `marks` makes them anew: faint ones are drawn once more in front of everything.
        """
        shaded = self.renderer(window, frame, 0)
        shaded.SetActiveCamera(camera)
        kit = self.vtk.vtkLightKit()
        kit.SetKeyLightIntensity(0.86)
        kit.SetKeyToFillRatio(2.6)
        kit.AddLightsToRenderer(shaded)
        for solid in solids:
            shaded.AddActor(solid)
        above = self.renderer(window, frame, 1)
        above.SetActiveCamera(camera)
        for opacity, renderer in ((1.0, shaded), (0.6, above)):
            for mark in marks():
                mark.GetProperty().SetOpacity(opacity)
                renderer.AddActor(mark)
        shaded.ResetCameraClippingRange()

    def add_legend(self, renderer, x, y, entries):
        """Colored discs with words, from pixel x to the right."""
        s = self.scale
        for key, words in entries:
            turns = [2.0 * math.pi * i / 24 for i in range(24)]
            disc = [(x + (6 + 6 * math.cos(t)) * s, y + (8 + 6 * math.sin(t)) * s) for t in turns]
            self.flat_shape(renderer, disc, COLORS[key])
            x += 18 * s
            x += self.text(renderer, words, x, y, 13, COLORS["soft"]) + 24 * s

    def renderer(self, window, frame, layer):
        renderer = self.vtk.vtkRenderer()
        renderer.SetViewport(*frame)
        renderer.SetLayer(layer)
        renderer.SetBackground(1.0, 1.0, 1.0)
        renderer.InteractiveOff()
        window.AddRenderer(renderer)
        return renderer

    def table(self, object_vertices, z):
        """The part of the table around the object, seen through."""
        spans = [(min(v[k] for v in object_vertices), max(v[k] for v in object_vertices)) for k in (0, 1)]
        margin = 0.75 * max(high - low for low, high in spans)
        (x_low, x_high), (y_low, y_high) = [(low - margin, high + margin) for low, high in spans]
        # A slab, since views across a palm that looks down see a plane edge on.
        corners = [
            (x, y, top)
            for top in (z - 0.03 * margin, z)
            for x, y in ((x_low, y_low), (x_high, y_low), (x_high, y_high), (x_low, y_high))
        ]
        sides = [[k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4] for k in range(4)]
        table = self.solid(corners, [[3, 2, 1, 0], [4, 5, 6, 7], *sides], "surroundings", specular=0.0)
        table.GetProperty().SetOpacity(SEEN_THROUGH)
        return table

    def solid(self, vertices, faces, color, specular=0.18):
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
        actor = self.actor(normals, COLORS[color])
        properties = actor.GetProperty()
        properties.SetAmbient(0.12)
        properties.SetDiffuse(0.88)
        properties.SetSpecular(specular)
        properties.SetSpecularPower(30.0)
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
        return self.tubes([(start, end)], radius, color)

    def tubes(self, segments, radius, color):
        """Many tubes as one actor: thousands of actors take VTK minutes and gigabytes."""
        vtk = self.vtk
        points = vtk.vtkPoints()
        points.SetDataTypeToDouble()
        lines = vtk.vtkCellArray()
        for segment in segments:
            lines.InsertNextCell(2)
            for end in segment:
                lines.InsertCellPoint(points.InsertNextPoint(*end))
        source = vtk.vtkPolyData()
        source.SetPoints(points)
        source.SetLines(lines)
        tube = vtk.vtkTubeFilter()
        tube.SetInputData(source)
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
        properties = actor.GetProperty()
        properties.SetAmbient(0.35)
        properties.SetDiffuse(0.65)
        properties.SetSpecular(0.15)
        properties.SetSpecularPower(40.0)
        return actor

    def camera(self, back, up, points, aspect):
        """A parallel camera with all points in view, and the height of that view in meters.

        `aspect` is the view's width over its height.
        """
        right = unit(cross(up, back)) or perpendicular(back)
        up = cross(back, right)
        spans = []
        for axis in (right, up, back):
            values = [dot(p, axis) for p in points]
            spans.append((min(values), max(values)))
        center = [0.0, 0.0, 0.0]
        for (low, high), axis in zip(spans, (right, up, back)):
            center = along(center, axis, 0.5 * (low + high))
        height = max(spans[1][1] - spans[1][0], (spans[0][1] - spans[0][0]) / aspect)
        height = 1.06 * height
        camera = self.vtk.vtkCamera()
        camera.ParallelProjectionOn()
        camera.SetParallelScale(0.5 * height)
        camera.SetFocalPoint(*center)
        camera.SetPosition(*along(center, back, 2.0 * (spans[2][1] - spans[2][0]) + height))
        camera.SetViewUp(*up)
        return camera, height

    def text(self, renderer, words, x, y, size, color, bold=False, align="left"):
        """Text at a pixel of the renderer; its width in pixels."""
        actor = self.vtk.vtkTextActor()
        actor.SetInput(words)
        properties = actor.GetTextProperty()
        properties.SetFontFamilyToArial()
        properties.SetFontSize(round(size * self.scale))
        properties.SetColor(*color)
        properties.SetBold(bold)
        properties.SetVerticalJustificationToBottom()
        {
            "left": properties.SetJustificationToLeft,
            "center": properties.SetJustificationToCentered,
            "right": properties.SetJustificationToRight,
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

    def add_scale_bar(self, window, strip, name, meters_per_pixel):
        """The strip below a view: its name, and a length in it."""
        s = self.scale
        renderer = self.renderer(window, strip, 0)
        width = (strip[2] - strip[0]) * SUPERSAMPLING * self.width
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

    def add_axes(self, window, corner, camera):
        """The axes of the frame in the view's lower left corner."""
        side = 0.12
        aspect = self.height / self.width
        x, y = corner
        frame = (x, y, x + side * aspect, y + side)
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
            properties = label.GetTextProperty()
            properties.SetFontSize(round(14 * self.scale))
            properties.SetColor(*color)
            properties.SetBold(True)
            properties.SetJustificationToCentered()
            properties.SetVerticalJustificationToCentered()
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
        """PNG file as bytes."""
        vtk = self.vtk
        window.Render()
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


def go_under_xvfb():
    """Runs the script again on a virtual display wherever there is one.

    A user's display may be remote, closed to us, or without OpenGL, and VTK then ends the program.
    """
    if UNDER_XVFB in os.environ:
        return
    xvfb = shutil.which("xvfb-run")
    if xvfb:
        os.environ[UNDER_XVFB] = "1"
        command = [xvfb, "-a", "-s", "-screen 0 1280x1024x24", sys.executable, *sys.argv]
        os.execv(xvfb, command)
    if not os.environ.get("DISPLAY"):
        raise BadInput("no display: install xvfb and xauth")


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
