#pragma once

/// \file
/// Fields of the structs in grasp files, in the order of the file; see json_fields.hpp.

namespace graspfit::grasp::internal {

constexpr auto repair_step_fields = [](auto& at, auto& step) {
  at(step.what, "what");
  at(step.count, "count");
  at(step.volume_change, "volume_change_m3");
  at(step.hausdorff_bound, "hausdorff_bound_m");
};

/// The numbers of a pose, as they are kept.
constexpr auto laid_pose_fields = [](auto& at, auto& laid) {
  at(laid.translation, "translation_m");
  at(laid.rotation_wxyz, "rotation_wxyz");
};

constexpr auto laid_fields = [](auto& at, auto& laid) {
  at.group("X_OF", laid, laid_pose_fields);
  at(laid.rank, "rank");
  at(laid.probability, "probability");
};

constexpr auto wrap_fields = [](auto& at, auto& wrap) {
  at(wrap.alpha_rel, "alpha_rel");
  at(wrap.offset_rel, "offset_rel");
};

/// Of an object's record, the repairs that were made among them.
constexpr auto repair_fields = [](auto& at, auto& object) {
  at(object.repair.mode, "mode");
  at(object.repair.weld_distance_rel, "weld_distance_rel");
  at(object.repair.max_hole_extent_rel, "max_hole_extent_rel");
  at(object.repair.self_intersections, "self_intersections");
  at.optional_group("wrap", object.repair.wrap, wrap_fields);
  at.list(object.repairs, "steps", repair_step_fields);
};

/// All but the bounding box.
constexpr auto mesh_fields = [](auto& at, auto& mesh) {
  at(mesh.num_vertices, "num_vertices");
  at(mesh.num_faces, "num_faces");
  at(mesh.num_parts, "num_parts");
  at(mesh.is_closed, "is_closed");
  at(mesh.is_manifold, "is_manifold");
  at(mesh.is_outward, "is_outward");
  at(mesh.num_unused_vertices, "num_unused_vertices");
  at(mesh.num_degenerate_faces, "num_degenerate_faces");
  at(mesh.num_doubled_faces, "num_doubled_faces");
  at(mesh.num_boundary_edges, "num_boundary_edges");
  at(mesh.num_nonmanifold_edges, "num_nonmanifold_edges");
  at(mesh.num_inconsistent_edges, "num_inconsistent_edges");
  at(mesh.num_inward_parts, "num_inward_parts");
  at(mesh.num_self_intersections, "num_self_intersections");
};

constexpr auto convention_fields = [](auto& at, auto& convention) {
  at(convention.tool, "tool");
  at(convention.reference_point_O, "reference_point_O_m");
  at.required(convention.options.torque_scale, "torque_scale_m");
  at(convention.options.friction, "friction");
  at(convention.options.num_cone_edges, "num_cone_edges");
  at.constant("l1", "norm");  // The wrench space of grasp files has no other norm.
  at(convention.options.force_scaling, "force_scaling");
  at(convention.options.force_limit, "force_limit");
  at(convention.options.outside, "outside");
};

/// What the grasp withstands and all that the numbers depend on.
constexpr auto wrench_fields = [](auto& at, auto& wrench) {
  at(wrench.epsilon, "epsilon");
  at(wrench.volume, "volume");
  at(wrench.is_force_closure, "is_force_closure");
  at(wrench.rank, "rank");
  at.group("convention", wrench.convention, convention_fields);
};

constexpr auto contact_fields = [](auto& at, auto& contact) {
  at.link(contact.link, "link");
  at.pad(contact.pad, "pad");
  at.part(contact.finger, "finger");
  at(contact.point_O, "point_O_m");
  at(contact.inward_normal_O, "inward_normal_O");
  at(contact.area, "area_m2");
  at(contact.pad_boundary_distance, "pad_boundary_distance_m");
  at(contact.gap, "gap_m");
  at(contact.weak, "weak");
  at(contact.is_target, "target");
};

constexpr auto sustainability_fields = [](auto& at, auto& term) {
  at(term.boundary_distance, "boundary_distance");
  at(term.area, "area");
  at(term.strength, "strength");
};

/// The measure and the terms that it comes from, but for the stable pairs.
constexpr auto quality_fields = [](auto& at, auto& quality) {
  at(quality.m, "m");
  at(quality.m1, "m1");
  at(quality.m2, "m2");
  at(quality.m3, "m3");
  at(quality.regularity, "regularity");
  at(quality.centroid_distance, "centroid_distance_m");
  at(quality.scaled_centroid_distance, "scaled_centroid_distance");
  at.list(quality.terms, "sustainability_terms", sustainability_fields);
};

constexpr auto penetration_fields = [](auto& at, auto& penetration) {
  at(penetration.object_intersects, "object_intersects");
  at(penetration.object_depth, "object_depth_m");
  at(penetration.object_depth_bound, "object_depth_bound_m");
  at.link(penetration.object_link, "object_link");
  at(penetration.self_intersects, "self_intersects");
  at(penetration.self_depth, "self_depth_m");
  at.link(penetration.self_link_a, "self_link_a");
  at.link(penetration.self_link_b, "self_link_b");
  at(penetration.surroundings_touched, "surroundings_touched");
};

constexpr auto target_fields = [](auto& at, auto& target) {
  at.part(target, "finger");
  at.other_pad(target, "pad");
  at(target.point_O, "point_O_m");
  at(target.outward_normal_O, "outward_normal_O");
  at.index(target.patch, "patch");
  at.open_number(target.score, "score");  // Raw scores of planes are infinite.
};

constexpr auto targets_fields = [](auto& at, auto& targets) {
  at(targets.seeds_tried, "seeds_tried");
  at(targets.rank, "rank");
  at.list(targets.contacts, "contacts", target_fields);
};

constexpr auto object_timings_fields = [](auto& at, auto& timings) {
  at(timings.query_s, "query_s");
  at(timings.patches_s, "patches_s");
  at(timings.voxels_s, "voxels_s");
  at(timings.distance_s, "distance_s");
  at(timings.scores_s, "scores_s");
  at(timings.weak_s, "weak_s");
};

constexpr auto timings_fields = [](auto& at, auto& timings) {
  at.group("object", timings.object, object_timings_fields);
  at(timings.guidance_s, "guidance_s");
  at(timings.targets_s, "targets_s");
  at(timings.fitting_s, "fitting_s");
  at(timings.contact_tests_s, "contact_tests_s");
  at(timings.measure_s, "measure_s");
  at(timings.refinement_s, "refinement_s");
  at(timings.pre_grasp_s, "pre_grasp_s");
  at(timings.total_s, "total_s");
};

}  // namespace graspfit::grasp::internal
