"""The mug in a Barrett hand: contacts and the clip volumes that they were found with."""

import numpy as np
from figure_data import posed
from figure_style import panels, show_picture
from grasp_row import measures
from grasp_scene import CLIP, CONTACT, OBJECT, Stage, back_direction, grasp_panel
from object_names import note_for


def clip_prism(pad):
    """Corners [2 n, 3] and triangles of a flat pad's outline, extended by the clip thickness, in C."""
    outline = np.asarray(pad["outline_C_m"])
    n = len(outline)
    low = np.column_stack([outline, np.zeros(n)])
    high = np.column_stack([outline, np.full(n, pad["clip_thickness_m"])])
    fan = [(0, i, i + 1) for i in range(1, n - 1)]
    sides = [(i, (i + 1) % n, (i + 1) % n + n) for i in range(n)]
    sides += [(i, (i + 1) % n + n, i + n) for i in range(n)]
    below = [(a, c, b) for a, b, c in fan]
    above = [(a + n, b + n, c + n) for a, b, c in fan]
    return np.concatenate([low, high]), np.array(below + above + sides)


def outline_edges(points):
    """Edges of the prism's two outlines and between them."""
    n = len(points) // 2
    edges = []
    for i in range(n):
        j = (i + 1) % n
        edges += [(points[i], points[j]), (points[i + n], points[j + n]), (points[i], points[i + n])]
    return edges


def close_up(stage, source, record, grasp):
    """The object alone with contacts and clip volumes, and the hand as a ghost."""
    vertices, triangles = source.object_mesh(record)
    links = source.link_meshes(record)
    pads = {pad["name"]: pad for pad in record["hand"]["pads"]}
    prisms = []
    for contact in grasp["contacts"]:
        pad = pads[contact["pad"]]
        corners, faces = clip_prism(pad)
        in_link = posed(corners, pad["X_LC"])
        prisms.append((posed(in_link, grasp["X_OL"][pad["link"]]), faces))
    solids = [stage.mesh(vertices, triangles, OBJECT)]
    solids += stage.hand(links, grasp["X_OL"], opacity=0.16)
    for corners, faces in prisms:
        solids.append(stage.mesh(corners, faces, CLIP, opacity=0.55))
    size = np.linalg.norm(vertices.max(axis=0) - vertices.min(axis=0))

    def marks():
        made = [stage.colored_tubes(outline_edges(corners), 0.003 * size, CLIP) for corners, _ in prisms]
        for contact in grasp["contacts"]:
            made.append(stage.colored_ball(contact["point_O_m"], 0.016 * size, CONTACT))
            made += stage.colored_arrow(
                contact["point_O_m"], contact["inward_normal_O"], 0.11 * size, 0.004 * size, CONTACT
            )
        return made

    back, up = back_direction(record, grasp)
    points = np.concatenate([vertices, *(corners for corners, _ in prisms)])
    return stage.panel(solids, back, up, points, marks)


def draw(source):
    record = source.grasp_file("paper_grasps", "mug_clip_volumes")
    grasp = record["grasps"][0]
    stage = Stage(700, 700)
    thickness = 1000 * record["used"]["clip_thickness_m"]
    figure, axes = panels(
        f"MUG*, Barrett hand: {len(grasp['contacts'])} contacts by clip volumes {thickness:.1f} mm thick", 1, 2, 7.0, 4.2,
        note_for(["mug"], "Right: the hand as a ghost, clip volumes of the touching pads blue-green, contact points with inward normals red."),
        head=0.42, foot=0.24,
    )  # fmt: skip
    show_picture(axes[0][0], grasp_panel(stage, source, record), None, measures(grasp))
    areas = ", ".join(f"{1e6 * c['area_m2']:.0f}" for c in grasp["contacts"])
    show_picture(axes[0][1], close_up(stage, source, record, grasp), None, f"contact areas {areas} mm²")
    return figure
