"""All figures: slug (the script <slug>.py of scenes or charts), what of the paper it answers to, and
its experiments."""

from typing import NamedTuple

ROOMS = ("drawing", "scenes", "charts")  # folders of scripts: what all share, pictures in space, plots


class Listed(NamedTuple):
    slug: str
    item: str  # of the paper; "ours" where it has none
    experiments: tuple  # whose published tables it reads
    shows_meshes: bool  # of objects: not drawn without GRASPFIT_DATA


FIGURES = (
    Listed("three_finger_grasp", "Fig. 1", ("paper_grasps",), True),
    Listed("pipeline", "Fig. 2", ("object_voxels", "fitting_stages"), True),
    Listed("hands", "Fig. 3", ("paper_grasps",), False),
    Listed("sustainability", "Fig. 4", ("paper_grasps", "object_voxels"), False),
    Listed("contact_triangles", "Fig. 5", ("paper_grasps",), True),
    Listed("unstable_contacts", "Fig. 6", ("measured_contacts",), False),
    Listed("score_map_and_targets", "Fig. 7", ("object_voxels", "fitting_stages"), True),
    Listed("score_terms", "Fig. 8", ("object_voxels",), False),
    Listed("fitting_stages", "Fig. 9", ("fitting_stages",), True),
    Listed("clip_volumes", "Fig. 10", ("paper_grasps",), True),
    Listed("good_and_bad_grasp", "Fig. 11", ("paper_grasps",), True),
    Listed("gallery", "Fig. 12", ("paper_grasps",), True),
    Listed("gallery_times", "Fig. 12, its numbers", ("paper_grasps",), False),
    Listed("contacts_and_time", "Fig. 13", ("contacts_and_time",), False),
    Listed("approach_directions", "Fig. 14", ("paper_grasps",), True),
    Listed("object_sizes", "Fig. 15", ("paper_grasps",), True),
    Listed("torus_sizes", "Fig. 16", ("paper_grasps",), True),
    Listed("ball_modes", "Fig. 17", ("paper_grasps",), True),
    Listed("three_methods", "Fig. 18", ("paper_grasps",), True),
    Listed("intermediate_models", "Fig. 19", ("guidance_models", "object_voxels", "paper_grasps"), True),
    Listed("table1", "Table 1", ("table1",), False),
    Listed("failures", "Fig. 21", ("paper_grasps", "planner_paper_objects"), True),
    Listed("parameter_sweeps", "ours", ("parameter_sweeps",), False),
    Listed("special_cases", "Figs. 10, 12, 14-17, its claims", ("special_cases",), False),
    Listed("rates", "ours", ("planner_paper_objects",), False),
    Listed("everyday_objects", "ours", ("planner_everyday",), False),
    Listed("hold_rates", "ours", ("hold_rates",), False),
    Listed("force_closure", "ours", ("force_closure",), False),
    Listed("reach_grasps", "ours", ("reach_grasps",), False),
)
