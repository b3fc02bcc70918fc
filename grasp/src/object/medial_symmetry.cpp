#include "graspfit/grasp/medial_symmetry.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/hands/palm_pose.hpp"
#include "rows/range_check.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Vector3d;

// How far a ball's center may be off, over its radius: what the tolerance of `medial_balls` leaves
// on faceted round bodies.
constexpr double kCenterAccuracy = 0.03;
constexpr int kRandomCandidates = 8;  // as many as there are around an axis

MedialSymmetry symmetry_of(const geometry::MedialBall& ball, const std::vector<Vector3d>& centers,
                           double least_spread, const MedialSymmetryOptions& options) {
  MedialSymmetry symmetry{.ball = ball};
  symmetry.neighbors = base::as_index<int>(centers.size()) - 1;
  for (const Vector3d& center : centers) symmetry.center_of_gravity_O += center;
  symmetry.center_of_gravity_O /= static_cast<double>(centers.size());
  if (symmetry.neighbors < 1) return symmetry;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& center : centers) {
    const Vector3d off = center - symmetry.center_of_gravity_O;
    scatter += off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);  // smallest first
  const double first = std::max(0.0, axes.eigenvalues()[2]);
  const double second = std::max(0.0, axes.eigenvalues()[1]);
  const double noise = std::max(least_spread, kCenterAccuracy * ball.radius);
  if (std::sqrt(first / static_cast<double>(centers.size())) <= noise) {
    symmetry.kind = SymmetryKind::Point;
    return symmetry;
  }
  symmetry.ratio = second / first;
  symmetry.first_axis_O = axes.eigenvectors().col(2);
  symmetry.second_axis_O = axes.eigenvectors().col(1);
  symmetry.kind = symmetry.ratio <= options.axis_ratio  ? SymmetryKind::Axis
                  : symmetry.ratio <= options.rim_ratio ? SymmetryKind::Rim
                                                        : SymmetryKind::Interior;
  return symmetry;
}

Vector3d random_direction(base::Random& random) {
  const double z = random.uniform(-1.0, 1.0);
  const double turn = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(turn), r * std::sin(turn), z};
}

}  // namespace

void MedialSymmetryOptions::validate() const {
  internal::require_ranges("MedialSymmetryOptions", *this, internal::medial_symmetry_rows);
  base::require(rim_ratio >= axis_ratio, "MedialSymmetryOptions", "rim_ratio", rim_ratio,
                "at least axis_ratio");
}

double search_radius(const geometry::TriangleMesh& mesh, const MedialSymmetryOptions& options) {
  return std::max(options.search_radius,
                  options.search_radius_rel * geometry::longest_extent(mesh));
}

std::vector<MedialSymmetry> medial_symmetries(std::span<const geometry::MedialBall> balls,
                                              double radius, double longest_extent,
                                              const MedialSymmetryOptions& options) {
  options.validate();
  std::vector<MedialSymmetry> symmetries;
  std::vector<Vector3d> centers;
  for (const geometry::MedialBall& ball : balls) {
    centers.clear();
    for (const geometry::MedialBall& other : balls) {
      if ((other.center - ball.center).squaredNorm() <= radius * radius) {
        centers.push_back(other.center);
      }
    }
    symmetries.push_back(
        symmetry_of(ball, centers, options.least_spread_rel * longest_extent, options));
  }
  return symmetries;
}

std::vector<MedialSymmetry> medial_symmetries(const ObjectModel& object,
                                              const MedialSymmetryOptions& options,
                                              std::uint64_t seed) {
  options.validate();
  const auto samples = geometry::sample_surface(
      object.mesh(), {.count = static_cast<std::size_t>(options.samples), .seed = seed});
  const auto balls = geometry::medial_balls(
      object.query, samples,
      {.min_object_angle_deg = options.min_object_angle_deg, .num_threads = 1});
  return medial_symmetries(balls, search_radius(object.mesh(), options),
                           geometry::longest_extent(object.mesh()), options);
}

std::vector<MedialCandidate> medial_candidates(std::span<const MedialSymmetry> symmetries,
                                               std::uint64_t seed) {
  std::vector<MedialCandidate> candidates;
  for (std::int32_t i = 0; i < std::ssize(symmetries); ++i) {
    const MedialSymmetry& symmetry = symmetries[i];
    const Vector3d& center = symmetry.ball.center;
    const auto add = [&](const Vector3d& outward, const Vector3d& axis) {
      candidates.push_back({center, outward, axis, i});
    };
    switch (symmetry.kind) {
      case SymmetryKind::Axis: {
        const Vector3d& along = symmetry.first_axis_O;
        const Vector3d across = along.cross(symmetry.second_axis_O).normalized();
        for (const Vector3d& outward : {symmetry.second_axis_O, across,
                                        Vector3d(-symmetry.second_axis_O), Vector3d(-across)}) {
          add(outward, along);
          add(outward, -along);
        }
        break;
      }
      case SymmetryKind::Rim: {
        const double side =
            symmetry.second_axis_O.dot(center - symmetry.center_of_gravity_O) < 0.0 ? -1.0 : 1.0;
        const Vector3d outward = side * symmetry.second_axis_O;
        add(outward, symmetry.first_axis_O);
        add(outward, -symmetry.first_axis_O);
        break;
      }
      case SymmetryKind::Point: {
        base::Random random = base::Random::stream(seed, i);
        for (int k = 0; k < kRandomCandidates; ++k) {
          const Vector3d outward = random_direction(random);
          const double turn = random.uniform(0.0, 2.0 * std::numbers::pi);
          add(outward, hands::turned_axis(hands::any_normal(outward), outward, turn));
        }
        break;
      }
      case SymmetryKind::Interior:
      case SymmetryKind::Alone:
        break;
    }
  }
  return candidates;
}

}  // namespace graspfit::grasp
