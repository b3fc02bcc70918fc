#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/object_file.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::exchange {

/// Tolerances of reading another tool's file.
struct ImportTolerances {
  double largest_norm_error = 1e-3;      ///< Largest difference of a quaternion's norm from 1;
                                         ///< quaternions are normalized then.
  double largest_limit_excess = 1e-6;    ///< Largest excess over a joint's limits [rad or m], which
                                         ///< is clamped: limits may be in single precision.
  double largest_coupling_error = 1e-3;  ///< Largest distance of a coupled joint from where its
                                         ///< leader puts it [rad or m]; it is then put there.
  void validate() const;                 ///< Throws InvalidInput naming the field and its value.
};

/// A grasp as another tool's file states it.
struct ImportedGrasp {
  std::string name;
  hands::HandConfiguration configuration;      ///< X_OH and all joints.
  std::optional<Eigen::VectorXd> pre_grasp_q;  ///< Joints of the pre-grasp, at the same palm pose.
};

/// Grasps of another tool, measured as ours are.
struct ImportResult {
  grasp::GraspFile file;             ///< Grasp file, best M first, ties in the order given.
  std::vector<std::size_t> sources;  ///< For each grasp of `file`, its index among those given.
  std::vector<std::string> notes;    ///< Notes for people: pre-grasps that are missing or
                                     ///< could not be kept.
};

/// Makes a grasp file from grasps that come from elsewhere.
///
/// Nothing but poses and joints is taken over: contacts, M, ε, penetration, pre-grasps and squeezes
/// are computed from the meshes, by `options`, which the file records as if the planner had used
/// them. `options` also say which fingers and whether the palm are to touch. A given pre-grasp is
/// kept if it is clear by `options.pre_grasp.clearance` and the straight path from it to the grasp
/// is proven free; otherwise one is searched for (`grasp::find_pre_grasp`). A grasp that itself
/// cuts something has no free path, and no pre-grasp. `Grasp::attempt` is the grasp's index among
/// those given, and no attempts are counted.
/// @throws InvalidInput for bad options, a hand that cannot do what they ask, an object that is not
/// a closed outward solid, configurations outside the hand's limits.
/// @throws IoError if a link mesh of the hand can no longer be read.
ImportResult import_grasps(const grasp::ObjectFile& object, const hands::HandModel& hand,
                           std::span<const ImportedGrasp> grasps, const grasp::ImportRecord& source,
                           const grasp::PlannerOptions& options = {});

}  // namespace graspfit::exchange
