#include "fitting/surface_posture.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "graspfit/hands/contact_pad.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using hands::RigidTransform;

constexpr int kMostEvaluations = 20;
// A posture with such a gap after so many steps is left there.
constexpr int kHopelessAfter = 6;
constexpr double kHopelessGap = 0.012;  // [m]
constexpr double kLongestStep = 0.02;   // of every entry of a motion [m]
constexpr double kLeastGain = 0.02;     // of the sum of squares, by a step that is worth another
// Against 1 for a gap: how far a pad leans, as a length; a link's depth.
constexpr double kLeanLever = 0.002;  // [m/rad]
constexpr double kDepthWeight = 1.0;
// By so much pads and links are kept off: patches are rounder than the surface. [voxels]
constexpr double kMargin = 0.25;
// A point of a pad that is so much higher than another counts 1/e as much as where it touches.
constexpr double kContactDepth = 0.25;  // [voxels]
constexpr double kPointSpacing = 2.0;   // of points that show how deep a link is [voxels]
constexpr double kFirstDamping = 0.01;
constexpr double kMostDamping = 100.0;

}  // namespace

/// Rows w (r · δ − value) whose squares are summed, as normal equations.
class SurfaceSearch::NormalEquations {
 public:
  explicit NormalEquations(Index size) : a_(MatrixXd::Zero(size, size)), b_(VectorXd::Zero(size)) {}
  void want(const RowVectorXd& row, double value, double weight) {
    a_.noalias() += (weight * weight) * row.transpose() * row;
    b_.noalias() += (weight * weight * value) * row.transpose();
    sum_ += weight * weight * value * value;
  }
  double sum() const { return sum_; }
  VectorXd solution(double damping) const {
    MatrixXd damped = a_;
    damped.diagonal().array() += damping;
    return damped.ldlt().solve(b_);
  }

 private:
  MatrixXd a_;
  VectorXd b_;
  double sum_ = 0.0;
};

namespace {

/// From a point of a pad to the patch: along its normal, and across it as far as the point is
/// beyond the patch's voxel.
Vector3d way_to_patch(const Vector3d& point_O, const geometry::SurfacePatch& patch,
                      double voxel_size) {
  const Vector3d way = patch.centroid - point_O;
  const Vector3d along = patch.outward_normal * patch.outward_normal.dot(way);
  const Vector3d across = way - along;
  const double beyond = across.norm() - voxel_size;
  return beyond > 0.0 ? Vector3d(along + across * (beyond / across.norm())) : along;
}

}  // namespace

SurfaceSearch::SurfaceSearch(const FittingHand& hand, const ObjectModel& object,
                             const NearestPatches& nearest, const NearestPatches& places)
    : hand_(hand),
      object_(object),
      nearest_(nearest),
      places_(places),
      motion_(hand.model(), true, true) {
  for (const hands::ContactPad& pad : hand.model().pads) {
    std::vector<Vector3d>& points = pad_points_L_.emplace_back();
    const auto add = [&](const Vector3d& point_C) { points.push_back(pad.X_LC * point_C); };
    add(hands::pad_contact_point_C(pad));
    for (std::size_t i = 0; i < pad.outline.size(); ++i) {
      const Eigen::Vector2d& corner = pad.outline[i];
      const Eigen::Vector2d middle = 0.5 * (corner + pad.outline[(i + 1) % pad.outline.size()]);
      add({corner.x(), corner.y(), 0.0});
      add({middle.x(), middle.y(), 0.0});
      add({0.5 * corner.x(), 0.5 * corner.y(), 0.0});
    }
    for (const Vector3d& point : pad.surface) add(point);
  }
  const double spacing = kPointSpacing * object.grid.lattice.voxel_size;
  for (std::size_t link = 0; link < hand.model().links.size(); ++link) {
    std::vector<Vector3d>& points = link_points_L_.emplace_back();
    std::set<std::array<double, 3>> taken;  // cells, in whole numbers
    for (const Vector3d& point : hand.samples(static_cast<int>(link)).points_L) {
      const Vector3d cell = (point / spacing).array().floor();
      if (taken.insert({cell[0], cell[1], cell[2]}).second) points.push_back(point);
    }
  }
}

/// Of a link's points in full voxels the one deepest below its patch.
SurfaceSearch::DeepPoint SurfaceSearch::deepest_point(std::size_t link,
                                                      const RigidTransform& X_OL) const {
  DeepPoint deepest;
  const FittingHand::LinkSamples& samples = hand_.samples(static_cast<int>(link));
  if (samples.balls.empty()) return deepest;
  const FittingHand::Ball& ball = samples.balls.front();
  const double voxel_size = object_.grid.lattice.voxel_size;
  // The map's values change by at most √2 per voxel.
  if (object_.distance.at(Vector3d(X_OL * ball.center_L)) >
      std::numbers::sqrt2 * (ball.radius / voxel_size + std::numbers::sqrt3)) {
    return deepest;
  }
  const geometry::VoxelLattice& lattice = object_.grid.lattice;
  const Vector3d upper = lattice.counts.cast<double>();
  const double margin = kMargin * voxel_size;
  for (const Vector3d& point_L : link_points_L_[link]) {
    const Vector3d point = X_OL * point_L;
    const Vector3d position = (point - lattice.origin) / voxel_size;
    if (!(position.minCoeff() >= 0.0) || !(position.array() < upper.array()).all()) continue;
    // Thin features have no full voxels.
    if (object_.distance.at(Eigen::Vector3i(position.cast<int>())) > 0.0F) continue;
    const geometry::SurfacePatch& patch = object_.patches[nearest_.at(point)];
    const double depth = margin - patch.outward_normal.dot(point - patch.centroid);
    if (depth > deepest.depth) deepest = {depth, point, patch.outward_normal};
  }
  return deepest;
}

/// About where a pad touches: the mean of its points, those most that are nearest to the surface or
/// deepest below it.
Vector3d SurfaceSearch::touching_point(int pad, const RigidTransform& X_OL) const {
  const std::vector<Vector3d>& points_L = pad_points_L_[static_cast<std::size_t>(pad)];
  std::vector<double> heights;
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& point_L : points_L) {
    const Vector3d point = X_OL * point_L;
    const geometry::SurfacePatch& patch = object_.patches[nearest_.at(point)];
    heights.push_back(patch.outward_normal.dot(point - patch.centroid));
    least = std::min(least, heights.back());
  }
  const double unit = kContactDepth * object_.grid.lattice.voxel_size;
  Vector3d sum = Vector3d::Zero();
  double weights = 0.0;
  for (std::size_t i = 0; i < points_L.size(); ++i) {
    const double weight = std::exp((least - heights[i]) / unit);
    sum += weight * points_L[i];
    weights += weight;
  }
  return X_OL * Vector3d(sum / weights);
}

SurfacePosture SurfaceSearch::lay(const std::vector<int>& pads,
                                  const hands::HandConfiguration& start) const {
  HandMotion motions[2] = {motion_, motion_};
  HandMotion* motion = &motions[0];
  HandMotion* trial_motion = &motions[1];
  NormalEquations equations(motion->size());
  SurfacePosture best = evaluated(pads, start, *motion, equations);
  NormalEquations trial_equations = equations;
  double damping = kFirstDamping;
  for (int i = 1; i < kMostEvaluations && damping < kMostDamping; ++i) {
    VectorXd step = equations.solution(damping);
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) step *= kLongestStep / longest;
    const HandMotion::Bounds bounds = motion->bounds(kLongestStep);
    SurfacePosture trial =
        evaluated(pads, motion->moved(step.cwiseMax(bounds.lower).cwiseMin(bounds.upper)),
                  *trial_motion, trial_equations);
    if (!(trial_equations.sum() < equations.sum())) {
      damping *= 8.0;
      continue;
    }
    if (i > kHopelessAfter && trial.largest_gap > kHopelessGap) break;
    const bool is_done = trial_equations.sum() > (1.0 - kLeastGain) * equations.sum();
    std::swap(motion, trial_motion);
    std::swap(equations, trial_equations);
    best = std::move(trial);
    if (is_done) break;
    damping = std::max(0.25 * damping, 1e-4);
  }
  return best;
}

/// The posture of a configuration; sets motion and equations for a step from there.
SurfacePosture SurfaceSearch::evaluated(const std::vector<int>& pads,
                                        const hands::HandConfiguration& configuration,
                                        HandMotion& motion, NormalEquations& equations) const {
  const hands::HandModel& model = hand_.model();
  const double voxel_size = object_.grid.lattice.voxel_size;
  SurfacePosture posture;
  posture.configuration = configuration;
  posture.X_OL = hands::forward_kinematics(model, configuration);
  std::vector<Vector3d> points;
  Vector3d pivot = Vector3d::Zero();
  for (const int pad : pads) {
    points.push_back(touching_point(pad, posture.X_OL[model.pads[pad].link]));
    pivot += points.back() / static_cast<double>(pads.size());
  }
  motion.set(configuration, posture.X_OL, pivot);
  equations = NormalEquations(motion.size());
  for (std::size_t i = 0; i < pads.size(); ++i) {
    const int link = model.pads[pads[i]].link;
    const std::int32_t number = places_.at(points[i]);
    const geometry::SurfacePatch& patch = object_.patches[number];
    posture.patches.push_back(number);
    const Vector3d way = way_to_patch(points[i], patch, voxel_size);
    const Vector3d normal = hands::pad_pose(model, pads[i], posture.X_OL).linear().col(2);
    const Vector3d inward = -patch.outward_normal;
    const Vector3d cross = normal.cross(inward);
    const double lean = std::atan2(cross.norm(), normal.dot(inward));
    posture.largest_gap = std::max(posture.largest_gap, way.norm());
    posture.largest_lean = std::max(posture.largest_lean, lean);
    const Vector3d turn = cross.norm() > 0.0 ? Vector3d(lean / cross.norm() * cross) : cross;
    for (int axis = 0; axis < 3; ++axis) {
      equations.want(motion.turn_row(link, Vector3d::Unit(axis)), turn[axis], kLeanLever);
    }
    // Across the patch the pad is free to move.
    const double along = patch.outward_normal.dot(way) + kMargin * voxel_size;
    equations.want(motion.row(link, points[i], patch.outward_normal), along, 1.0);
    const Vector3d across = way - patch.outward_normal.dot(way) * patch.outward_normal;
    if (const double beyond = across.norm(); beyond > 0.0) {
      equations.want(motion.row(link, points[i], across / beyond), beyond, 1.0);
    }
  }
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const DeepPoint deep = deepest_point(link, posture.X_OL[link]);
    if (!(deep.depth > 0.0)) continue;
    posture.largest_depth = std::max(posture.largest_depth, deep.depth);
    equations.want(motion.row(static_cast<int>(link), deep.point_O, deep.outward_O), deep.depth,
                   kDepthWeight);
  }
  return posture;
}

}  // namespace graspfit::grasp::internal
