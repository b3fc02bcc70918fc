"""From targets to grasp: the open hand, the adjustment loop, its end, the refined grasp."""

import numpy as np
from figure_style import panels, show_picture
from grasp_row import measures
from grasp_scene import FITTING, HAND, OBJECT, TARGET, Stage, back_direction, grasp_marks, hand_points, span
from voxel_data import stages

WORDS = {
    "initial": "initial configuration",
    "loop_2": "in the loop",
    "fitted": "end of the loop",
    "grasp": "refined grasp",
}


def stage_panel(stage, source, record, poses, points, final):
    """The hand at one stage with the targets; at the last with contacts."""
    grasp = record["grasps"][0]
    vertices, triangles = source.object_mesh(record)
    links = source.link_meshes(record)
    back, up = back_direction(record, grasp)
    size = span(points)
    targets = [np.asarray(t["point_O_m"]) for t in grasp["targets"]["contacts"]]

    def marks():
        # Contacts lie on their targets, nearly: smaller than those, targets leave them to be seen.
        made = [stage.colored_ball(p, (0.009 if final else 0.017) * size, TARGET) for p in targets]
        pairs = [(targets[i], targets[j]) for i in range(len(targets)) for j in range(i + 1, len(targets))]
        return [*made, stage.colored_tubes(pairs, 0.0035 * size, TARGET)]

    contacts = grasp_marks(stage, record, grasp, size, arrows=False)
    solids = [stage.mesh(vertices, triangles, OBJECT)]
    solids += stage.hand(links, poses, HAND if final else FITTING)
    return stage.panel(solids, back, up, points, (lambda: marks() + contacts()) if final else marks)


def draw(source):
    record = source.grasp_file("fitting_stages", "squirrel")
    found = stages(source, "squirrel")
    table = source.table("fitting_stages", ("object", "refinement_shift_m", "mean_target_distance_m"))
    row = table[table["object"] == "squirrel"].iloc[0]
    links = source.link_meshes(record)
    vertices, _ = source.object_mesh(record)
    points = np.concatenate([vertices, *(hand_points(links, found[name][1]) for name in WORDS)])
    stage = Stage(560, 620)
    figure, axes = panels(
        "SQUIRREL (15 cm), Barrett hand: from targets (blue) to contacts (red)", 1, 4, 8.8, 3.3,
        f"Mean distance of contacts from targets {1000 * row['mean_target_distance_m']:.1f} mm;"
        f" refinement moved the palm by {1000 * row['refinement_shift_m']:.1f} mm. {measures(record['grasps'][0]).splitlines()[0]}.",
        head=0.48, foot=0.3,
    )  # fmt: skip
    for ax, (name, words) in zip(axes[0], WORDS.items()):
        iterations, poses = found[name]
        panel = stage_panel(stage, source, record, poses, points, name == "grasp")
        show_picture(ax, panel, words, f"iteration {iterations}" if name != "grasp" else "on the true meshes")
    return figure
