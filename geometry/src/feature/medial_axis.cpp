#include "graspfit/geometry/medial_axis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/base/parallel_for.hpp"
#include "graspfit/geometry/angle.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;

// Normals may be off unit length by this: they come from rounded arithmetic.
constexpr double kUnitLengthTolerance = 1e-6;

double angle_deg(const Vector3d& u, const Vector3d& v) {
  return angle_between(u, v) * 180.0 / std::numbers::pi;
}

std::optional<MedialBall> shrunken_ball(const MeshQuery& object, const SurfaceSample& sample,
                                        const MedialBallOptions& options) {
  constexpr int kMostSteps = 100;
  const Vector3d& p = sample.point;
  MedialBall ball;
  ball.radius = 0.5 * object.box().diagonal().norm();
  for (int step = 0; step < kMostSteps; ++step) {
    ball.center = p - ball.radius * sample.normal;
    const ClosestPoint closest = object.closest_point(ball.center);
    const double intrusion = ball.radius - std::sqrt(closest.squared_distance);
    // The ball that touches the surface at p and passes through q has |p − q|² = 2 r n·(p − q). If
    // it is not smaller, the closest point is p itself, to rounding.
    const Vector3d to_sample = p - closest.point;
    const double rise = sample.normal.dot(to_sample);
    const double radius = rise > 0.0 ? 0.5 * to_sample.squaredNorm() / rise : ball.radius;
    // The intrusion is compared with the smaller radius, so that a thin part does not count as a
    // shallow dent in a large ball.
    const bool is_empty =
        !(radius < ball.radius) || intrusion <= options.emptiness_tolerance * radius;
    if (is_empty) {
      // The first ball has no second contact; that of the others is the point that stopped the
      // previous, larger ball.
      if (step == 0) return std::nullopt;
      ball.object_angle_deg = angle_deg(p - ball.center, ball.contacts[1] - ball.center);
      ball.contacts[0] = p;
      ball.contact_faces[0] = sample.face;
      return ball;
    }
    if (!(radius > 0.0)) return std::nullopt;
    ball.radius = radius;
    ball.contacts[1] = closest.point;
    ball.contact_faces[1] = closest.face;
  }
  return std::nullopt;
}

}  // namespace

void MedialBallOptions::validate() const {
  const char* const where = "MedialBallOptions";
  base::require_between(0.0, 180.0, where, "min_object_angle_deg", min_object_angle_deg);
  base::require_between(0.0, 1.0, where, "min_radius_rel", min_radius_rel);
  base::require_between(1e-12, 0.1, where, "emptiness_tolerance", emptiness_tolerance);
  base::require(num_threads >= 0, where, "num_threads", num_threads, ">= 0");
}

std::vector<MedialBall> medial_balls(const MeshQuery& object,
                                     std::span<const SurfaceSample> samples,
                                     const MedialBallOptions& options) {
  options.validate();
  for (const SurfaceSample& sample : samples) {
    if (sample.face < 0 || sample.face >= std::ssize(object.mesh().faces)) {
      throw base::InvalidInput("medial_balls: a sample is on face " + std::to_string(sample.face) +
                               " of " + std::to_string(object.mesh().faces.size()));
    }
    // A face without area has no normal; its samples have no balls.
    const double length = sample.normal.norm();
    if (!sample.point.allFinite() ||
        !(length == 0.0 || std::abs(length - 1.0) <= kUnitLengthTolerance)) {
      throw base::InvalidInput("medial_balls: a sample's point must be finite and its normal unit");
    }
  }
  std::vector<std::optional<MedialBall>> found(samples.size());
  base::parallel_for(samples.size(), options.num_threads, [&](std::size_t i) {
    std::optional<MedialBall> ball = shrunken_ball(object, samples[i], options);
    if (ball && ball->object_angle_deg > options.min_object_angle_deg &&
        object.containment(ball->center) == Containment::Inside) {
      found[i] = ball;
    }
  });
  double largest = 0.0;
  for (const auto& ball : found) largest = ball ? std::max(largest, ball->radius) : largest;
  std::vector<MedialBall> balls;
  for (const auto& ball : found) {
    if (ball && ball->radius > options.min_radius_rel * largest) balls.push_back(*ball);
  }
  return balls;
}

}  // namespace graspfit::geometry
