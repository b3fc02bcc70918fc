#pragma once

#include <optional>

#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/weak_regions.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// Everything that the measures of a grasp depend on besides the grasp.
struct MeasuringScene {
  const hands::HandModel& hand;
  const hands::HandCollision& collision;
  const geometry::MeshQuery& object;
  const SurroundingsCollision& surroundings;
  const geometry::WeakRegions* weak = nullptr;  ///< Null: nothing is known to be weak.
  contact::WrenchObject wrench_object = {};     ///< Scales of ε.
  double friction = 0.4;                        ///< Of ε.
  contact::QualityContext quality_context = {};
  contact::QualityOptions quality_options = {};
  contact::ContactEstimationOptions contact_options = {};
  /// A requested part whose contacts all have a larger gap counts as without contact in
  /// `Grasp::has_all_contacts`, not in M [m]; empty: any gap will do.
  std::optional<double> largest_gap = std::nullopt;
  /// Contacts with a larger gap bear no force: not in ε [m].
  std::optional<double> bearing_gap = std::nullopt;
};

/// Contacts, M, ε and penetration of a configuration, from the true meshes alone: what the planner
/// reports and what `evaluate` recomputes.
Grasp measure_grasp(const MeasuringScene& scene, const hands::HandConfiguration& configuration,
                    const RequestedParts& requested);

/// How hard a grasp is to break [R], by which grasps are kept (`KeptCandidate::Strongest`) and
/// ranked (`RankRule::Epsilon`): `contact::signed_epsilon` of the contacts that bear forces.
///
/// @param friction the planner's is `PlannerOptions::squeeze_friction`
/// @param bearing_gap as in `MeasuringScene` [m]
double grasp_strength(const Grasp& grasp, const contact::WrenchObject& object, double friction,
                      const std::optional<double>& bearing_gap);

}  // namespace graspfit::grasp
