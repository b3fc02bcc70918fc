#pragma once

#include <filesystem>
#include <limits>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/hand_library.hpp"

namespace graspfit::testing {

/// Returns options of which every field is away from its default, so that one that is not written,
/// or not read, shows.
inline grasp::PlannerOptions unusual_options() {
  grasp::PlannerOptions options;
  options.planner = "ma";
  options.missing_contact = grasp::MissingContact::Measured;
  options.sampling = {.source = grasp::ApproachSource::BoxRays,
                      .count = 11,
                      .box_margin = 0.02,
                      .box_spacing = 0.03,
                      .largest_standoff = 0.04};
  options.medial_symmetry = {.samples = 12,
                             .min_object_angle_deg = 110.0,
                             .axis_ratio = 0.02,
                             .rim_ratio = 0.5,
                             .search_radius = 0.011,
                             .search_radius_rel = 0.06,
                             .least_spread_rel = 0.002};
  options.style = grasp::GraspStyle::Power;
  options.palm = false;
  options.seed = 18446744073709551615U;  // It is the largest there is.
  options.search = grasp::SearchRule::First;
  options.acceptance = grasp::Acceptance::Usable;
  options.rejection = grasp::Rejection::Quality;
  options.largest_deviation = 0.017;
  options.counted_pads = contact::CountedPads::TipsAndPalm;
  options.contact_pieces = contact::ContactPieces::Separate;
  options.contact_faces = contact::ContactFaces::Facing;
  options.fitting.contact_state = grasp::ContactState::FirstGraze;
  options.fitting.palm_after_contact = grasp::PalmAfterContact::Frozen;
  options.refinement.near_pad_steps = 5;
  options.count = 7;
  options.max_attempts = 77;
  options.max_iterations = 5000000000;  // It is more than an int holds.
  options.approach_O = Eigen::Vector3d(0.1, -1.0 / 3.0, 0.7);
  options.approach_angle = 0.4;
  options.wall_clock_limit_s = 12.5;
  options.contact_score_threshold = 0.55;
  options.resolution = 31;
  options.clip_thickness = 0.1;
  options.score.normalization = grasp::ScoreNormalization::Raw;
  options.weak->weak_thickness = 0.004;
  options.weak->min_length_ratio = 1.5;
  options.weak->shape_diameter.trim_deviations = std::numeric_limits<double>::infinity();
  options.targets.pair_rule = grasp::PairRule::AllPairs;
  options.targets.search = grasp::TargetSearch::Ranked;
  options.targets.exclude_weak = false;
  options.targets.ideal_m_bias = 1.25;
  options.targets.ideal_m_draws = 9;
  options.targets.angle_weight = 0.5;
  options.targets.pool_spacing = 0.01;
  options.targets.palm_reach_tolerance = 0.02;
  options.rank = grasp::RankRule::Epsilon;
  options.target_draws = 3;
  options.candidate_order = grasp::CandidateOrder::Balance;
  options.kept = grasp::KeptCandidate::Balanced;
  options.max_placements = 2;
  options.max_redraws = 3;
  options.fitting.give_up_distance = 0.02;
  options.fitting.guard = grasp::PenetrationGuard::Voxels;
  options.fitting.guard_self = true;
  options.refine = false;
  options.refinement.wanted_gap = 3e-5;
  options.refinement.largest_gap = 0.2;  // It is so large that every contact bears forces.
  options.refinement.least_distance = 2e-6;
  options.refinement.max_iterations = 61;
  options.refinement.slide_steps = 3;
  options.refinement.reach = 0.04;
  options.refinement.largest_shift = 0.01;
  options.refinement.largest_turn = 0.25;
  options.self_overlap = 0.002;
  options.pre_grasps = false;
  options.pre_grasp.clearance = 0.006;
  options.pre_grasp.largest_retreat = 0.2;
  options.pre_grasp.retreat_step = 0.02;
  options.pre_grasp.opening_steps = 11;
  options.pre_grasp.open_neutral = true;
  options.pre_grasp.leave_pressing = true;
  options.pre_grasp.way_tolerance = 2e-5;
  options.squeeze.normal_sum = 12.0;
  options.squeeze.stiffness = 4.0;
  options.squeeze.slide_stiffness = 2100.0;
  options.squeeze.largest_residual = 0.06;
  options.distinct.translation = 0.02;
  options.distinct.rotation = 0.3;
  options.distinct.joints = 0.4;
  options.distinct.slide_scale = 0.2;
  options.friction = 0.7;
  options.squeeze_friction = 0.3;
  options.quality.regularity = contact::Regularity::EdgeOnly;
  options.quality.units = contact::MeasureUnits::Centimeters;
  options.quality.alpha = 0.1;
  return options;
}

/// Returns a Barrett hand in some pose around a ball of 5 cm radius, measured as the planner
/// measures.
inline grasp::GraspFile sample_file(const std::filesystem::path& object_file) {
  geometry::write_mesh(object_file, geometry::ball(0.05, 2));
  const grasp::ObjectFile object = grasp::read_object_file(object_file);

  grasp::GraspFile file;
  file.object = object.record;
  file.object.repairs = {{"filled holes", 2, 1.25e-7, 0.003}};
  file.object.repair.weld_distance_rel = 0.001;
  file.object.repair.self_intersections = geometry::SelfIntersections::Report;
  file.object.repair.wrap = geometry::AlphaWrap{.alpha_rel = 0.05, .offset_rel = 0.01};
  file.hand = hands::find_hand("barrett");
  file.link_mesh_sha256.resize(file.hand.links.size());
  for (std::size_t i = 0; i < file.hand.links.size(); ++i) {
    if (file.hand.links[i].mesh_files.empty()) continue;
    file.link_mesh_sha256[i] = base::sha256_hex(
        base::read_file(std::filesystem::path(file.hand.description_file).parent_path() /
                        file.hand.links[i].mesh_files.at(0)));
  }
  file.options = unusual_options();
  file.options.quality.units = contact::MeasureUnits::Normalized;
  file.options.counted_pads = contact::CountedPads::All;
  file.options.weak.reset();  // A search would take seconds.
  file.surroundings.table_z_O = -0.2;
  file.surroundings.obstacles.push_back(object.record);
  file.fingers = {"thumb", "finger_1", "finger_2"};
  file.voxel_size = 0.1 / 30.0;
  file.clip_thickness = 0.1;  // It is so thick that every pad meets the ball.
  file.merge_distance = 0.1 * file.voxel_size;
  file.stop = grasp::PlannerStop::WallClock;
  file.statistics.attempts = 5;
  for (int i = 0; i <= static_cast<int>(grasp::AttemptOutcome::PoorShape); ++i) {
    file.statistics.outcomes[static_cast<grasp::AttemptOutcome>(i)] = i;
  }
  file.statistics.target_failures["no seed"] = 3;
  file.statistics.guidance["balls alone"] = 4;
  file.statistics.duplicates = 2;
  file.statistics.refinement_iterations = 123;
  file.timings.fitting_s = 0.25;

  grasp::Surroundings surroundings;
  surroundings.table_z_O = file.surroundings.table_z_O;
  const grasp::RecordedScene scene(file, object.mesh, surroundings);
  base::Random random(3);
  for (int i = 0; i < 4; ++i) {
    hands::HandConfiguration configuration = hands::open_configuration(file.hand);
    for (Eigen::Index j = 0; j < configuration.q.size(); ++j) {
      const hands::Joint& joint = file.hand.joints[static_cast<std::size_t>(j)];
      configuration.q[j] = random.uniform(joint.lower, 0.4 * joint.upper);
    }
    hands::apply_couplings(file.hand, configuration.q);
    const Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    configuration.X_OH =
        Eigen::Translation3d(0.0, 0.0, 0.0) *
        Eigen::AngleAxisd(random.uniform(-3.14, 3.14), axis.normalized()) *
        Eigen::Translation3d(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), -0.15);
    grasp::Grasp measured = scene.measure(configuration);
    measured.attempt = i;
    measured.ideal_m = 1.0 / 3.0;
    measured.targets.contacts.resize(2);
    measured.targets.contacts[0].score = std::numeric_limits<double>::infinity();
    measured.targets.contacts[1].finger = 1;
    measured.refinement_iterations = 10 + i;
    if (i == 1) {
      measured.pre_grasp = grasp::PreGrasp{hands::open_configuration(file.hand), 0.011, 0.7, 0.03};
      measured.squeeze = contact::Squeeze{
          configuration,
          Eigen::Matrix3Xd::Random(3, static_cast<Eigen::Index>(measured.contacts.size())), 0.125,
          false, true};
    }
    if (i == 3) {
      measured.wrench = contact::WrenchQuality{0.0625, 0.5, true, 6, {}};
      measured.wrench->convention.tool = contact::WrenchTool::GraspIt;
      measured.wrench->convention.reference_point_O = Eigen::Vector3d(0.1, 0.2, 0.3);
      measured.wrench->convention.options = {.num_cone_edges = 6,
                                             .friction = 0.7,
                                             .torque_scale = 0.05,
                                             .force_scaling = contact::ForceScaling::UnitEdge,
                                             .force_limit = 2.0,
                                             .outside = contact::OutsideValue::MinusOne};
      measured.penetration.surroundings_touched = true;
      measured.targets.contacts[1].is_palm = true;
      measured.targets.contacts[1].finger.reset();
    }
    if (!measured.contacts.empty()) measured.contacts[0].weak = i == 2;
    file.grasps.push_back(measured);
  }
  file.preset = "strong";
  return file;
}

}  // namespace graspfit::testing
