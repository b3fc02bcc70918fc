#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::testing {

/// Angle between two vectors [rad]; by atan2, so that it is exact to rounding near 0 and π too.
inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Empty if an error message names the field and the value; the message if it does not.
inline std::string unsaid(const std::string& message, const std::string& field,
                          const std::string& value) {
  const bool says_field = message.find(field) != std::string::npos;
  const bool says_value = message.find(value) != std::string::npos;
  return says_field && says_value ? "" : message;
}

/// Slack for comparing an angle, a length relative to 1 m or a ratio that two programs compute from
/// the same doubles: a few hundred rounding errors.
inline constexpr double kRounding = 1e-12;

/// Whether `distance` lies in one of `ranges`.
inline bool in_some_range(double distance, const std::vector<hands::DistanceRange>& ranges) {
  for (const hands::DistanceRange& range : ranges) {
    if (distance >= range.smallest - kRounding && distance <= range.largest + kRounding) {
      return true;
    }
  }
  return false;
}

/// Every requirement of section 6 on a set of target contacts, evaluated from scratch: one line for
/// each that is broken. `fingers` as given to `select_target_contacts`, the seed's first.
inline std::vector<std::string> broken_requirements(const grasp::ObjectModel& object,
                                                    const hands::TipDistances& distances,
                                                    const std::vector<int>& fingers,
                                                    const grasp::TargetOptions& options,
                                                    const grasp::TargetContacts& targets) {
  std::vector<std::string> broken;
  const auto report = [&](const auto&... parts) {
    std::ostringstream line;
    line.precision(17);
    (line << ... << parts);
    broken.push_back(line.str());
  };
  const auto& contacts = targets.contacts;
  if (contacts.size() != fingers.size()) {
    report(contacts.size(), " targets for ", fingers.size(), " fingers");
    return broken;
  }
  if (targets.seeds_tried < 1 || targets.seeds_tried > options.max_seeds) {
    report("seeds tried: ", targets.seeds_tried);
  }
  // A19: both limits grow by half once `relax_after_seeds` seeds have failed.
  const double relaxed = targets.seeds_tried > options.relax_after_seeds ? 1.5 : 1.0;

  std::set<int> patches;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const grasp::TargetContact& target = contacts[i];
    if (target.patch < 0 || target.patch >= static_cast<int>(object.patches.size())) {
      report("target ", i, ": patch ", target.patch);
      return broken;
    }
    if (!patches.insert(target.patch).second) report("target ", i, ": patch used twice");
    const geometry::SurfacePatch& patch = object.patches[target.patch];
    if (!patch.has_normal) report("target ", i, ": patch without a normal");
    if (target.point_O != patch.centroid) report("target ", i, ": not the patch's centroid");
    if (target.outward_normal_O != patch.outward_normal) report("target ", i, ": other normal");
    if (std::abs(target.outward_normal_O.norm() - 1.0) > kRounding) {
      report("target ", i, ": normal of length ", target.outward_normal_O.norm());
    }
    if (target.score != object.scores.scores[target.patch]) report("target ", i, ": other score");
    if (!(target.score > options.score_threshold)) report("target ", i, ": score ", target.score);
  }

  // |V1V2| has to be in reach of the seed's finger and another; so has every further target (A18).
  std::vector<hands::DistanceRange> seed_ranges, other_ranges;
  for (std::size_t a = 1; a < fingers.size(); ++a) {
    seed_ranges.push_back(distances[fingers[0]][fingers[a]]);
    for (std::size_t b = a + 1; b < fingers.size(); ++b) {
      other_ranges.push_back(distances[fingers[a]][fingers[b]]);
    }
  }
  const double first_edge = (contacts[1].point_O - contacts[0].point_O).norm();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = i + 1; j < contacts.size(); ++j) {
      const Eigen::Vector3d i_to_j = contacts[j].point_O - contacts[i].point_O;
      const double length = i_to_j.norm();
      if (!in_some_range(length, i == 0 ? seed_ranges : other_ranges)) {
        report("targets ", i, " and ", j, ": distance ", length, " out of reach");
      }
      if (length < options.min_separation - kRounding) {
        report("targets ", i, " and ", j, ": closer than the separation: ", length);
      }
      if (i == 0 || options.pair_rule == grasp::PairRule::AllPairs) {
        const double at_i = angle_between(contacts[i].outward_normal_O, -i_to_j);
        const double at_j = angle_between(contacts[j].outward_normal_O, i_to_j);
        if (!(at_i < options.theta_max + kRounding) || !(at_j < options.theta_max + kRounding)) {
          report("targets ", i, " and ", j, ": angles ", at_i, " ", at_j);
        }
      }
      if (j >= 2) {
        const double error = std::abs(length - first_edge) / first_edge;
        if (error > options.edge_tolerance_rel * relaxed + kRounding) {
          report("targets ", i, " and ", j, ": edge error ", error, " relaxed by ", relaxed);
        }
      }
    }
  }
  if (contacts.size() >= 3) {
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    for (const grasp::TargetContact& target : contacts) centroid += target.point_O;
    centroid /= static_cast<double>(contacts.size());
    const double distance =
        (centroid - object.mass.center_of_mass).norm() / object.normalizing_radius;
    if (distance > options.centroid_limit_rel * relaxed + kRounding) {
      report("centroid distance ", distance, " relaxed by ", relaxed);
    }
  }
  return broken;
}

}  // namespace graspfit::testing
