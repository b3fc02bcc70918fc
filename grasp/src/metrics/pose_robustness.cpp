#include "graspfit/grasp/pose_robustness.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "graspfit/base/option_check.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/grasp/grasp_metric.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Vector3d;

/// Three independent standard normal numbers [Box & Muller 1958].
Vector3d normal_vector(base::Random& random) {
  Vector3d vector;
  for (double& x : vector) {
    const double radius = std::sqrt(-2.0 * std::log1p(-random.uniform()));
    x = radius * std::cos(2.0 * std::numbers::pi * random.uniform());
  }
  return vector;
}

Eigen::Isometry3d random_motion(base::Random& random, const Vector3d& center,
                                const PoseRobustnessOptions& options) {
  const Vector3d turn = options.rotation_deviation * normal_vector(random);
  const Vector3d shift = options.translation_deviation * normal_vector(random);
  const double angle = turn.norm();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (angle > 0.0) motion.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  motion.translation() = center + shift - motion.linear() * center;
  return motion;
}

/// Where a moved pad meets the surface.
std::optional<contact::Contact> met_contact(const contact::Contact& contact,
                                            const Eigen::Isometry3d& motion,
                                            const geometry::MeshQuery& surface, double reach) {
  const Vector3d way = motion.linear() * contact.inward_normal_O;
  const auto hit = surface.first_hit(motion * contact.point_O - reach * way, way);
  if (!hit || hit->distance > 2.0 * reach) return std::nullopt;
  const Vector3d outward = geometry::vector_area(surface.mesh(), hit->face).stableNormalized();
  if (!(outward.dot(way) < 0.0)) return std::nullopt;  // from within, or a face without area
  contact::Contact met = contact;
  met.point_O = hit->point;
  met.inward_normal_O = -outward;
  return met;
}

}  // namespace

void PoseRobustnessOptions::validate() const {
  const auto require = [](bool is_met, std::string_view field, auto value, std::string_view rule) {
    base::require(is_met, "PoseRobustnessOptions", field, value, rule);
  };
  require(num_samples >= 1, "num_samples", num_samples, "at least 1");
  require(translation_deviation >= 0.0 && std::isfinite(translation_deviation),
          "translation_deviation", translation_deviation, "finite and at least 0 m");
  require(rotation_deviation >= 0.0 && std::isfinite(rotation_deviation), "rotation_deviation",
          rotation_deviation, "finite and at least 0 rad");
  require(reach > 0.0 && std::isfinite(reach), "reach", reach, "finite and positive, in m");
}

std::optional<PoseRobustness> pose_robustness(const GraspMetricFacts& facts,
                                              const PoseRobustnessOptions& options) {
  options.validate();
  if (facts.contacts.empty() || facts.surface == nullptr) return std::nullopt;
  int num_closed = 0;
  int num_usable = 0;
  double sum_of_epsilon = 0.0;
  std::size_t num_contacts = 0;
  for (int i = 0; i < options.num_samples; ++i) {
    base::Random random = base::Random::stream(options.seed, static_cast<std::uint64_t>(i));
    const Eigen::Isometry3d motion = random_motion(random, facts.object.center_of_mass_O, options);
    GraspMetricFacts moved = facts;
    moved.grasp = nullptr;
    moved.contacts.clear();
    for (const contact::Contact& contact : facts.contacts) {
      const auto met = met_contact(contact, motion, *facts.surface, options.reach);
      if (met) moved.contacts.push_back(*met);
    }
    num_contacts += moved.contacts.size();
    const GraspMetricInput input(std::move(moved));
    const contact::ContactQuality* quality = input.quality();
    if (quality != nullptr && quality->is_usable()) ++num_usable;
    if (!input.convention() || contact::is_surely_no_force_closure(contact::contact_wrenches(
                                   input.touching(), *input.convention()))) {
      continue;
    }
    if (!contact::is_force_closure(*input.wrench_space())) continue;
    ++num_closed;
    sum_of_epsilon += contact::epsilon_quality(*input.wrench_space());
  }
  const double count = options.num_samples;
  PoseRobustness robustness;
  robustness.closed_share = num_closed / count;
  if (facts.quality_context) robustness.usable_share = num_usable / count;
  robustness.mean_epsilon = sum_of_epsilon / count;
  robustness.mean_num_contacts = static_cast<double>(num_contacts) / count;
  return robustness;
}

}  // namespace graspfit::grasp
