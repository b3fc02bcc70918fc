#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::testing {

/// Returns the angle between two vectors [rad], by atan2, so that it is exact to rounding near 0
/// and π too.
inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Returns nothing if an error message names the field and the value, otherwise the message.
inline std::string unsaid(const std::string& message, const std::string& field,
                          const std::string& value) {
  const bool says_field = message.find(field) != std::string::npos;
  const bool says_value = message.find(value) != std::string::npos;
  return says_field && says_value ? "" : message;
}

/// The slack for comparing an angle, a length relative to 1 m or a ratio that two programs compute
/// from the same doubles: a few hundred rounding errors.
inline constexpr double kRounding = 1e-12;

/// Returns whether `distance` lies in `range`.
inline bool is_in_range(double distance, const hands::DistanceRange& range) {
  return distance >= range.smallest - kRounding && distance <= range.largest + kRounding;
}

/// Returns whether the targets can be given to the fingers, the first to the first, so that every
/// two are within their fingers' own range, and the palm, if it has a target, within all fingers'.
/// It tries all permutations.
inline bool is_in_reach_of_hand(const grasp::PartDistances& distances,
                                const grasp::RequestedParts& parts,
                                const grasp::TargetContacts& targets) {
  std::vector<int> order = parts.fingers;
  std::sort(order.begin() + 1, order.end());
  do {
    bool is_in_reach = true;
    for (std::size_t i = 0; i < targets.contacts.size(); ++i) {
      for (std::size_t j = 0; j < std::min(i, order.size()); ++j) {
        const double distance = (targets.contacts[i].point_O - targets.contacts[j].point_O).norm();
        const hands::DistanceRange& range = i < order.size()
                                                ? distances.tip_to_tip[order[i]][order[j]]
                                                : distances.palm_to_tip[order[j]];
        is_in_reach = is_in_reach && is_in_range(distance, range);
      }
    }
    if (is_in_reach) return true;
  } while (std::next_permutation(order.begin() + 1, order.end()));
  return false;
}

/// Evaluates every requirement of section 6 on a set of target contacts from scratch. Returns one
/// line for each that is broken.
inline std::vector<std::string> broken_requirements(const grasp::ObjectModel& object,
                                                    const grasp::PartDistances& distances,
                                                    const grasp::RequestedParts& parts,
                                                    const grasp::TargetOptions& options,
                                                    const grasp::TargetContacts& targets) {
  std::vector<std::string> broken;
  const auto report = [&](const auto&... words) {
    std::ostringstream line;
    line.precision(17);
    (line << ... << words);
    broken.push_back(line.str());
  };
  if (targets.contacts.size() != static_cast<std::size_t>(parts.size())) {
    report(targets.contacts.size(), " targets for ", parts.size(), " parts");
    return broken;
  }
  if (!is_in_reach_of_hand(distances, parts, targets)) report("no fingers reach all targets");
  const double min_separation = options.min_separation.value_or(0.0);
  // These are the targets of the fingers alone; the palm's comes last.
  std::vector<grasp::TargetContact> contacts = targets.contacts;
  if (parts.palm) {
    const grasp::TargetContact palm = contacts.back();
    contacts.pop_back();
    if (!palm.is_palm) report("the last target is not the palm's");
    for (const grasp::TargetContact& target : contacts) {
      const Eigen::Vector3d from_palm = target.point_O - palm.point_O;
      if (!(from_palm.dot(palm.outward_normal_O) < 0.0)) report("a target behind the palm");
      if (from_palm.norm() < min_separation - kRounding) report("a target at the palm");
    }
    for (const geometry::SurfacePatch& patch : object.patches) {
      const Eigen::Vector3d offset = patch.centroid - palm.point_O;
      const double height = offset.dot(palm.outward_normal_O);
      const double beside = (offset - height * palm.outward_normal_O).norm();
      if (height > object.grid.lattice.voxel_size + kRounding &&
          beside < distances.palm->pad_radius - kRounding) {
        report("patch ", &patch - object.patches.data(), " stands in the palm's way");
      }
    }
  }
  const bool is_random = options.search == grasp::TargetSearch::Random;
  if (targets.seeds_tried < (is_random ? 1 : 0) || targets.seeds_tried > options.max_seeds) {
    report("seeds tried: ", targets.seeds_tried);
  }
  // Both limits grow by half once `relax_after_seeds` seeds have failed.
  const double relaxed = targets.seeds_tried > options.relax_after_seeds ? 1.5 : 1.0;

  std::set<int> patches;
  for (std::size_t i = 0; i < targets.contacts.size(); ++i) {
    const grasp::TargetContact& target = targets.contacts[i];
    const int patch_index = target.patch.value_or(-1);
    if (patch_index < 0 || patch_index >= static_cast<int>(object.patches.size())) {
      report("target ", i, ": patch ", patch_index);
      return broken;
    }
    if (!patches.insert(patch_index).second) report("target ", i, ": patch used twice");
    const geometry::SurfacePatch& patch = object.patches[patch_index];
    if (!patch.has_normal) report("target ", i, ": patch without a normal");
    if (target.point_O != patch.centroid) report("target ", i, ": not the patch's centroid");
    if (target.outward_normal_O != patch.outward_normal) report("target ", i, ": other normal");
    if (std::abs(target.outward_normal_O.norm() - 1.0) > kRounding) {
      report("target ", i, ": normal of length ", target.outward_normal_O.norm());
    }
    if (options.exclude_weak && !object.is_weak_patch.empty() &&
        object.is_weak_patch[patch_index]) {
      report("target ", i, ": on a weak feature");
    }
    if (target.score != object.scores.scores[patch_index]) report("target ", i, ": other score");
    if (!(target.score > options.score_threshold)) report("target ", i, ": score ", target.score);
  }

  const double first_edge = (contacts[1].point_O - contacts[0].point_O).norm();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = i + 1; j < contacts.size(); ++j) {
      const Eigen::Vector3d i_to_j = contacts[j].point_O - contacts[i].point_O;
      const double length = i_to_j.norm();
      if (length < min_separation - kRounding) {
        report("targets ", i, " and ", j, ": closer than the separation: ", length);
      }
      if (i == 0 || options.pair_rule == grasp::PairRule::AllPairs) {
        const double at_i = angle_between(contacts[i].outward_normal_O, -i_to_j);
        const double at_j = angle_between(contacts[j].outward_normal_O, i_to_j);
        if (!(at_i < options.theta_max + kRounding) || !(at_j < options.theta_max + kRounding)) {
          report("targets ", i, " and ", j, ": angles ", at_i, " ", at_j);
        }
      }
      if (j == 2) {  // With more targets not all edges can agree.
        const double error = std::abs(length - first_edge) / first_edge;
        if (error > options.edge_tolerance_rel * relaxed + kRounding) {
          report("targets ", i, " and ", j, ": edge error ", error, " relaxed by ", relaxed);
        }
      }
    }
  }
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const grasp::TargetContact& target : contacts) centroid += target.point_O;
  centroid /= static_cast<double>(contacts.size());
  const double distance =
      (centroid - object.mass.center_of_mass).norm() / object.normalizing_radius;
  if (distance > options.centroid_limit_rel * relaxed + kRounding) {
    report("centroid distance ", distance, " relaxed by ", relaxed);
  }
  return broken;
}

}  // namespace graspfit::testing
