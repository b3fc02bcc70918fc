"""Rendered panels: objects, posed hands, contacts, voxels, in parallel projection.

A panel is (image, meters per pixel): an RGB array for figure_style.show_picture. Needs Debian's
python3-vtk9 and a display (make runs under xvfb-run).
"""

import io
import math
import pathlib
import sys

import matplotlib.image
import numpy as np
from figure_data import MissingData, posed, turned
from matplotlib.colors import to_rgb

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "viewer"))
import vtk_picture  # noqa: E402
from render_grasps import hull_edges, polygon_normal, side_direction  # noqa: E402

OBJECT, HAND, FITTING = "#dbd1bf", "#7090ad", "#9a7fc0"
CONTACT, STABLE, EDGE, TARGET = "#d43127", "#2e8f57", "#8c9196", "#0072B2"
CENTER, PALM, CLIP = "#22252a", "#7a4ab3", "#009E9E"

# Axis of the mesh file that points up in pictures; y where nothing else is said.
UP = {"bottle": 2, "torus": 1, "toy_car": 1, "flower_pot": 1, "bowling_pin": 1}


class Stage(vtk_picture.Canvas):
    """Draws scenes into panels of one size in pixels."""

    def __init__(self, width=520, height=520):
        try:
            super().__init__(width, height)
        except vtk_picture.BadInput as error:
            raise MissingData(str(error)) from error

    def panel(self, solids, back, up, points, marks=None):
        """Panel of actors seen from direction `back`, all `points` [n, 3] in view.

        `marks` makes actors anew that also shine through what hides them.
        """
        window = self.window()
        camera, height_m = self.camera(
            list(back), list(up), np.asarray(points).tolist(), self.width / self.height
        )
        self.add_view(window, (0.0, 0.0, 1.0, 1.0), camera, solids, marks or (lambda: []))
        content = self.png(window)
        window.Finalize()
        image = matplotlib.image.imread(io.BytesIO(content), format="png")[..., :3]
        return image, height_m / self.height

    def mesh(self, vertices, triangles, color, opacity=1.0, face_colors=None, feature_deg=40.0):
        """A surface; with `face_colors` [m, 3] in 0..1 one color per triangle."""
        from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

        vtk = self.vtk
        points = vtk.vtkPoints()
        points.SetData(numpy_to_vtk(np.ascontiguousarray(vertices, dtype=float), deep=True))
        cells = vtk.vtkCellArray()
        layout = np.column_stack([np.full(len(triangles), 3), triangles]).astype(np.int64).ravel()
        cells.SetCells(len(triangles), numpy_to_vtkIdTypeArray(layout, deep=True))
        mesh = vtk.vtkPolyData()
        mesh.SetPoints(points)
        mesh.SetPolys(cells)
        if face_colors is not None:
            bytes_ = np.round(255 * np.asarray(face_colors)[:, :3]).astype(np.uint8)
            mesh.GetCellData().SetScalars(numpy_to_vtk(np.ascontiguousarray(bytes_), deep=True))
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputData(mesh)
        normals.SetFeatureAngle(feature_deg)
        normals.ConsistencyOff()
        normals.SplittingOn()
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(normals.GetOutputPort())
        mapper.SetScalarVisibility(face_colors is not None)
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        properties = actor.GetProperty()
        properties.SetColor(*to_rgb(color))
        properties.SetAmbient(0.15)
        properties.SetDiffuse(0.87)
        properties.SetSpecular(0.08)
        properties.SetSpecularPower(30.0)
        properties.SetOpacity(opacity)
        return actor

    def colored_ball(self, center, radius, color):
        return self.ball(list(center), radius, to_rgb(color))

    def colored_arrow(self, start, direction, length, radius, color):
        return self.arrow(list(start), list(direction), length, radius, to_rgb(color))

    def colored_tubes(self, segments, radius, color):
        return self.tubes([(list(a), list(b)) for a, b in segments], radius, to_rgb(color))

    def boxes(self, centers, size, colors, opacity=1.0):
        """Cubes with edges of length `size`, one color [3] each."""
        corners, triangles = cube()
        count = len(centers)
        vertices = (np.asarray(centers)[:, None, :] + size * corners[None, :, :]).reshape(-1, 3)
        faces = (triangles[None] + 8 * np.arange(count)[:, None, None]).reshape(-1, 3)
        face_colors = np.repeat(np.asarray(colors)[:, :3], len(triangles), axis=0)
        return self.mesh(vertices, faces, "#ffffff", opacity, face_colors)

    def hand(self, links, poses, color=HAND, opacity=1.0):
        """Actors of a hand: its link meshes at the poses of a grasp file."""
        return [
            self.mesh(posed(vertices, poses[name]), triangles, color, opacity)
            for name, (vertices, triangles) in links.items()
        ]


def cube():
    """Corners [8, 3] of the unit cube around the origin, and its triangles [12, 3]."""
    corners = np.array([[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [(a, b, c) for a, b, c, _ in quads] + [(a, c, d) for a, _, c, d in quads]
    return corners, np.array(triangles)


def hand_points(links, poses):
    """All vertices of a posed hand [n, 3]."""
    return np.concatenate([posed(vertices, poses[name]) for name, (vertices, _) in links.items()])


def view_of(record, grasp):
    """What viewer/render_grasps.py chooses its views by."""
    palm = record["hand"]["palm"]
    return {
        "contacts": [{"point": c["point_O_m"]} for c in grasp["contacts"]],
        "palm_center": posed([palm["center_H_m"]], grasp["X_OH"])[0].tolist(),
        "palm_direction": turned(palm["direction_H"], grasp["X_OH"]).tolist(),
    }


def up_of(name):
    axis = UP.get(name, 1)
    return axis, [float(k == axis) for k in range(3)]


def object_name(record):
    return pathlib.PurePath(record["object"]["file"]).stem.replace("_lowpoly", "").replace("_frame", "")


def back_direction(record, grasp, facing=False):
    """Toward the eye: across the palm direction and nearly level, or facing the contact polygon."""
    view = view_of(record, grasp)
    axis, up = up_of(object_name(record))
    back = polygon_normal(view) if facing else side_direction(view, axis)
    if abs(np.dot(up, back)) > 0.97:
        up = up[-1:] + up[:-1]
    return back, up


def span(points):
    return float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))


def grasp_marks(stage, record, grasp, size, arrows=True, palm=False, targets=False):
    """Contacts with inward normals, edges of the polygon, stable pairs, center of mass."""
    points = [c["point_O_m"] for c in grasp["contacts"]]
    stable = {tuple(sorted(pair["contacts"])) for pair in grasp["stable_pairs"]}
    edges = set(hull_edges(points)) - stable

    def make():
        made = [stage.colored_ball(record["object"]["center_of_mass_O_m"], 0.011 * size, CENTER)]
        for pairs, radius, color in ((edges, 0.0026, EDGE), (stable, 0.0042, STABLE)):
            if pairs:
                segments = [(points[i], points[j]) for i, j in sorted(pairs)]
                made.append(stage.colored_tubes(segments, radius * size, color))
        made += [stage.colored_ball(point, 0.016 * size, CONTACT) for point in points]
        if arrows:
            for contact in grasp["contacts"]:
                made += stage.colored_arrow(
                    contact["point_O_m"], contact["inward_normal_O"], 0.1 * size, 0.0042 * size, CONTACT
                )
        if palm:
            view = view_of(record, grasp)
            made += stage.colored_arrow(
                view["palm_center"], view["palm_direction"], 0.2 * size, 0.005 * size, PALM
            )
        if targets:
            made += [
                stage.colored_ball(t["point_O_m"], 0.014 * size, TARGET)
                for t in grasp["targets"]["contacts"]
            ]
        return made

    return make


def grasp_panel(stage, source, record, index=0, facing=False, view=None, **marks):
    """Panel of a grasp of a record: object, hand, marks; `view` is (back, up) instead of ours."""
    grasp = record["grasps"][index]
    vertices, triangles = source.object_mesh(record)
    links = source.link_meshes(record)
    points = np.concatenate([vertices, hand_points(links, grasp["X_OL"])])
    back, up = view or back_direction(record, grasp, facing)
    solids = [stage.mesh(vertices, triangles, OBJECT), *stage.hand(links, grasp["X_OL"])]
    make = grasp_marks(stage, record, grasp, span(points), **marks)
    return stage.panel(solids, back, up, points, make)


def score_colors(scores, colormap):
    """RGB rows of scores in 0..1; those above are cut off."""
    return colormap(np.clip(np.asarray(scores, dtype=float), 0.0, 1.0))[:, :3]


def level(azimuth_deg, elevation_deg, up_axis=1):
    """Direction toward the eye, `azimuth_deg` around the axis that points up."""
    a, e = math.radians(azimuth_deg), math.radians(elevation_deg)
    direction = [0.0, 0.0, 0.0]
    direction[up_axis] = math.sin(e)
    direction[(up_axis + 1) % 3] = math.cos(e) * math.cos(a)
    direction[(up_axis + 2) % 3] = math.cos(e) * math.sin(a)
    return direction
