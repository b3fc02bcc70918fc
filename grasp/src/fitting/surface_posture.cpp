#include "fitting/surface_posture.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>
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

constexpr int kMostEvaluations = 14;
// A posture whose gap is larger than so much, and so much per step that is left, is left there: of
// those that ended with a gap of less than 3 mm fewer than one in twenty had come from beyond.
constexpr int kHopefulFor = 2;             // steps
constexpr double kLastHopefulGap = 0.003;  // [m]
constexpr double kGapPerStep = 0.001;      // [m]
constexpr int kStepsToPlaces = 3;          // after these it is asked whether places are worth it
constexpr double kLongestStep = 0.02;      // of every entry of a motion [m]
constexpr double kLongestReach = 0.1;      // of every entry before a step is shortened [m]
// A step is worth it if by this share of the sum of squares it lowers it, or promises to.
constexpr double kLeastGain = 0.05;
// Against 1 for a gap: how far a pad leans, as a length; a link's depth.
constexpr double kLeanLever = 0.002;  // [m/rad]
constexpr double kDepthWeight = 2.0;
// By so much pads and links are kept off: places are rounder than the surface, and refinement
// closes gaps more often than it frees a hand that is in the object. [voxels]
constexpr double kMargin = 0.25;
constexpr double kDepthMargin = 0.5;
// A point of a pad that is so much higher than another counts 1/e as much as where it touches.
constexpr double kContactDepth = 0.25;  // [voxels]
constexpr double kPointSpacing = 2.0;   // of points that show how deep a link is [voxels]
constexpr double kGroupSpacing = 8.0;   // of groups of them [voxels]
constexpr double kSelfMargin = 0.001;   // between links of different fingers [m]
constexpr double kTableMargin = 0.001;  // of links above the table and its clearance [m]
constexpr double kFirstDamping = 0.01;
constexpr double kMostDamping = 100.0;

/// The cell of a lattice of this spacing, in whole numbers.
std::array<double, 3> cell_at(const Vector3d& point, double spacing) {
  const Vector3d cell = (point / spacing).array().floor();
  return {cell[0], cell[1], cell[2]};
}

/// From a point of a pad to the place: along its normal, and across it as far as the point is
/// farther from it than a voxel.
Vector3d way_to_place(const Vector3d& point_O, const SurfacePlace& place, double voxel_size) {
  const Vector3d way = place.point_O - point_O;
  const Vector3d along = place.outward_normal_O * place.outward_normal_O.dot(way);
  const Vector3d across = way - along;
  const double beyond = across.norm() - voxel_size;
  return beyond > 0.0 ? Vector3d(along + across * (beyond / across.norm())) : along;
}

}  // namespace

/// What a motion should do: move a point of a link, perhaps against another link, along a
/// direction, or turn a link about it, by a value. The squares of weight · (what it does − value)
/// are summed.
struct SurfaceSearch::Wish {
  int link = 0;
  Vector3d point_O = Vector3d::Zero();
  Vector3d direction_O = Vector3d::Zero();
  double value = 0.0;
  double weight = 1.0;
  bool is_turn = false;
  std::optional<int> against = {};
};

struct SurfaceSearch::Evaluated {
  SurfacePosture posture;
  Vector3d pivot_O = Vector3d::Zero();  ///< Of turns of the palm.
  std::vector<Wish> wishes;
  double sum = 0.0;  ///< Of the squares, at rest.
};

/// The sum of squares as a function of the motion.
class SurfaceSearch::NormalEquations {
 public:
  NormalEquations(const std::vector<Wish>& wishes, const HandMotion& motion)
      : a_(MatrixXd::Zero(motion.size(), motion.size())), b_(VectorXd::Zero(motion.size())) {
    std::vector<Index> entries;  // of the row at hand that are not zero
    for (const Wish& wish : wishes) {
      RowVectorXd row = wish.is_turn ? motion.turn_row(wish.link, wish.direction_O)
                                     : motion.row(wish.link, wish.point_O, wish.direction_O);
      if (wish.against) row -= motion.row(*wish.against, wish.point_O, wish.direction_O);
      entries.clear();
      for (Index i = 0; i < row.size(); ++i) {
        if (row[i] != 0.0) entries.push_back(i);
      }
      const double squared_weight = wish.weight * wish.weight;
      for (const Index i : entries) {
        b_[i] += squared_weight * wish.value * row[i];
        for (const Index j : entries) a_(i, j) += squared_weight * row[i] * row[j];
      }
    }
  }

  /// By how much a motion lowers the sum.
  double gain(const VectorXd& motion) const { return motion.dot(2.0 * b_ - a_ * motion); }

  /// The motion of least squares, damped, within bounds: what would leave them stays at its bound.
  VectorXd solution(double damping, const HandMotion::Bounds& bounds) const {
    MatrixXd damped = a_;
    damped.diagonal().array() += damping;
    VectorXd step = damped.ldlt().solve(b_);
    const auto is_beyond = [&](Index i) {
      return step[i] < bounds.lower[i] || step[i] > bounds.upper[i];
    };
    VectorXd wanted = b_;
    bool is_bounded = false;
    for (Index i = 0; i < step.size(); ++i) {
      if (!is_beyond(i)) continue;
      is_bounded = true;
      const double value = std::clamp(step[i], bounds.lower[i], bounds.upper[i]);
      wanted -= value * damped.col(i);
      damped.row(i).setZero();
      damped.col(i).setZero();
      damped(i, i) = 1.0;
      wanted[i] = value;
    }
    if (is_bounded) step = damped.ldlt().solve(wanted);
    return step.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  }

 private:
  MatrixXd a_;
  VectorXd b_;
};

CoarseDistances::CoarseDistances(const geometry::SignedDistanceMap& map)
    : last_voxel_((map.lattice.counts.array() - 1).cast<float>()),
      strides_(1, map.lattice.counts[0], map.lattice.counts[0] * map.lattice.counts[1]) {
  values_.reserve(map.values.size());
  for (const float value : map.values) {
    values_.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F)));
  }
}

SurfaceSearch::SurfaceSearch(const FittingHand& hand, const ObjectModel& object,
                             const std::vector<SurfacePlace>& places, const NearestPlaces& nearest,
                             const NearestPlaces& nearest_for_pads,
                             const SurroundingsCollision& surroundings)
    : hand_(hand),
      object_(object),
      places_(places),
      nearest_(nearest),
      nearest_for_pads_(nearest_for_pads),
      surroundings_(surroundings),
      distances_(object.distance),
      entries_(hand.model(), true, true, MotionEntries::Breakaway::Beyond) {
  for (const SurfacePlace& place : places) {
    planes_.push_back({place.outward_normal_O.cast<float>(),
                       static_cast<float>(place.outward_normal_O.dot(place.point_O))});
  }
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
  const double voxel_size = object.grid.lattice.voxel_size;
  for (int link = 0; link < std::ssize(hand.model().links); ++link) {
    groups_.push_back(groups_of(hand.samples(link).points_L, voxel_size));
  }
  find_neighbors();
}

/// Pairs of links of different fingers, but for those whose boxes are too coarse to tell whether
/// they are apart.
void SurfaceSearch::find_neighbors() {
  const hands::HandModel& model = hand_.model();
  const std::vector<RigidTransform> X_OL =
      hands::forward_kinematics(model, hands::open_configuration(model));
  for (std::size_t f = 0; f < model.fingers.size(); ++f) {
    for (std::size_t g = 0; g < f; ++g) {
      for (const int a : model.fingers[f].links) {
        for (const int b : model.fingers[g].links) {
          const bool both = hand_.collision().link_solid(a) && hand_.collision().link_solid(b);
          if (!both || model.is_excluded(a, b)) continue;
          if (!overlap(a, b, X_OL)) neighbors_.emplace_back(a, b);
        }
      }
    }
  }
}

/// The point of one of two links that is deepest in the other's box, grown a little.
std::optional<SurfaceSearch::Wish> SurfaceSearch::overlap(
    int a, int b, const std::vector<RigidTransform>& X_OL) const {
  std::optional<Wish> deepest;
  const auto seek = [&](int inner, int outer) {
    Eigen::AlignedBox3d box = hand_.collision().link_solid(outer)->box();
    box.min().array() -= kSelfMargin;
    box.max().array() += kSelfMargin;
    const RigidTransform X = geometry::relative_pose(X_OL[outer], X_OL[inner]);
    const Eigen::AlignedBox3d& inner_box = hand_.collision().link_solid(inner)->box();
    if (box.exteriorDistance(Vector3d(X * inner_box.center())) >
        0.5 * inner_box.diagonal().norm()) {
      return;
    }
    for (const PointGroup& group : groups_[inner]) {
      const Vector3d center = X * group.center_L.cast<double>();
      if (box.exteriorDistance(center) > group.radius) continue;
      for (const Eigen::Vector3f& point_L : group.points_L) {
        const Vector3d point = X * point_L.cast<double>();
        const Vector3d above = point - box.min();
        const Vector3d below = box.max() - point;
        Index low = 0;
        Index high = 0;
        const double to_min = above.minCoeff(&low);
        const double to_max = below.minCoeff(&high);
        const double depth = std::min(to_min, to_max);
        if (depth <= (deepest ? deepest->value : 0.0)) continue;
        const Vector3d out =
            to_min < to_max ? Vector3d(-Vector3d::Unit(low)) : Vector3d::Unit(high);
        deepest =
            Wish{inner, X_OL[outer] * point, X_OL[outer].linear() * out, depth, 1.0, false, outer};
      }
    }
  };
  const geometry::MeshQuery& solid_a = *hand_.collision().link_solid(a);
  const geometry::MeshQuery& solid_b = *hand_.collision().link_solid(b);
  const double apart = (X_OL[a] * solid_a.box().center() - X_OL[b] * solid_b.box().center()).norm();
  const double reach = 0.5 * (solid_a.box().diagonal().norm() + solid_b.box().diagonal().norm());
  if (apart > reach + kSelfMargin) return std::nullopt;
  seek(a, b);
  seek(b, a);
  return deepest;
}

/// One point of every cell, in groups of the cells of a coarser lattice.
std::vector<SurfaceSearch::PointGroup> SurfaceSearch::groups_of(
    const std::vector<Vector3d>& points_L, double voxel_size) {
  std::map<std::array<double, 3>, std::map<std::array<double, 3>, Vector3d>> cells;
  for (const Vector3d& point : points_L) {
    cells[cell_at(point, kGroupSpacing * voxel_size)].emplace(
        cell_at(point, kPointSpacing * voxel_size), point);
  }
  std::vector<PointGroup> groups;
  for (const auto& [number, points] : cells) {
    PointGroup& group = groups.emplace_back();
    Eigen::AlignedBox3d box;
    for (const auto& [cell, point] : points) {
      group.points_L.push_back(point.cast<float>());
      box.extend(point);
    }
    group.center_L = box.center().cast<float>();
    group.radius = static_cast<float>(0.5 * box.diagonal().norm());
  }
  return groups;
}

double SurfaceSearch::height(std::int32_t place, const Vector3d& point_O) const {
  const Plane& plane = planes_[place];
  return static_cast<double>(plane.normal.dot(point_O.cast<float>()) - plane.offset);
}

/// The place nearest to a point; of a thin wall, which is below both of its sides, the one above
/// which the point is, or below which it is less deep.
std::int32_t SurfaceSearch::place_at(const Vector3d& point_O) const {
  const std::int32_t place = nearest_.at(point_O);
  const std::int32_t other = nearest_.other_side(place);
  return other >= 0 && height(other, point_O) > height(place, point_O) ? other : place;
}

/// Of a link's points that are within the lift of voxels that are not empty the one deepest below
/// its place.
SurfaceSearch::DeepPoint SurfaceSearch::deepest_point(int link, const RigidTransform& X_OL,
                                                      double lift) const {
  const geometry::VoxelLattice& lattice = object_.grid.lattice;
  const double voxels_per_meter = 1.0 / lattice.voxel_size;
  const double near = lift * voxels_per_meter;
  DeepPoint deepest;
  // From points of the link to positions in the lattice.
  const Eigen::Matrix3f turn = (voxels_per_meter * X_OL.linear()).cast<float>();
  const Eigen::Vector3f shift =
      (voxels_per_meter * (X_OL.translation() - lattice.origin)).cast<float>();
  const auto voxels_away = [&](const Eigen::Vector3f& point_L) {
    return distances_.at((turn * point_L + shift).array());
  };
  for (const PointGroup& group : groups_[link]) {
    const double far = near + group.radius * voxels_per_meter + std::numbers::sqrt3;
    if (voxels_away(group.center_L) > far) continue;
    for (const Eigen::Vector3f& point_L : group.points_L) {
      if (voxels_away(point_L) > near) continue;
      const Vector3d point = X_OL * point_L.cast<double>();
      if (object_.distance.at(point) > near) continue;
      const double depth = -height(place_at(point), point);
      if (depth > deepest.depth) deepest = {depth, point};
    }
  }
  if (deepest.depth > -std::numeric_limits<double>::infinity()) {
    deepest.outward_O = places_[place_at(deepest.point_O)].outward_normal_O;
  }
  return deepest;
}

/// About where a pad touches: the mean of its points, those most that are nearest to the surface or
/// deepest below it.
Vector3d SurfaceSearch::touching_point(int pad, const RigidTransform& X_OL) const {
  const std::vector<Vector3d>& points_L = pad_points_L_[pad];
  std::vector<double> heights;
  heights.reserve(points_L.size());
  for (const Vector3d& point_L : points_L) {
    const Vector3d point = X_OL * point_L;
    heights.push_back(height(place_at(point), point));
  }
  const double least = *std::min_element(heights.begin(), heights.end());
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
                                  const hands::HandConfiguration& start, double lift,
                                  const IsWorthIt& is_worth_it) const {
  const auto motion_from = [&](const Evaluated& at) {
    return HandMotion(entries_, at.posture.configuration, at.posture.X_OL, at.pivot_O);
  };
  Evaluated best = evaluated(pads, start, lift, std::numeric_limits<double>::infinity());
  NormalEquations equations(best.wishes, motion_from(best));
  double damping = kFirstDamping;
  int num_steps = 0;
  for (int i = 1; i < kMostEvaluations && damping < kMostDamping; ++i) {
    const HandMotion motion = motion_from(best);
    VectorXd step = equations.solution(damping, motion.bounds(kLongestReach));
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) step *= kLongestStep / longest;
    if (equations.gain(step) < kLeastGain * best.sum) break;
    Evaluated trial = evaluated(pads, motion.moved(step), lift, best.sum);
    if (!(trial.sum < best.sum)) {
      damping *= 8.0;
      continue;
    }
    const double hopeful = kLastHopefulGap + kGapPerStep * (kMostEvaluations - 1 - i);
    if (i > kHopefulFor && trial.posture.largest_gap > hopeful) break;
    const bool is_done = trial.sum > (1.0 - kLeastGain) * best.sum;
    best = std::move(trial);
    if (is_done) break;
    if (++num_steps == kStepsToPlaces && is_worth_it && !is_worth_it(best.posture.places)) break;
    equations = NormalEquations(best.wishes, motion_from(best));
    damping = std::max(0.25 * damping, 1e-4);
  }
  return std::move(best.posture);
}

/// The posture of a configuration, and what a step from there should do; as soon as its sum is seen
/// to be no less than `most`, only so much of it.
SurfaceSearch::Evaluated SurfaceSearch::evaluated(const std::vector<int>& pads,
                                                  const hands::HandConfiguration& configuration,
                                                  double lift, double most) const {
  const hands::HandModel& model = hand_.model();
  const double voxel_size = object_.grid.lattice.voxel_size;
  const double margin = kMargin * voxel_size + lift;
  const double depth_margin = kDepthMargin * voxel_size + lift;
  Evaluated result;
  const auto add = [&](const Wish& wish) {
    result.wishes.push_back(wish);
    result.sum += wish.weight * wish.weight * wish.value * wish.value;
  };
  SurfacePosture& posture = result.posture;
  posture.configuration = configuration;
  posture.X_OL = hands::forward_kinematics(model, configuration);
  for (const int pad : pads) {
    const int link = model.pads[pad].link;
    const Vector3d point = touching_point(pad, posture.X_OL[link]);
    result.pivot_O += point / static_cast<double>(pads.size());
    const Vector3d normal = hands::pad_pose(model, pad, posture.X_OL).linear().col(2);
    const std::int32_t number = nearest_for_pads_.at(point, normal);
    const SurfacePlace& place = places_[number];
    posture.places.push_back(number);
    const Vector3d way = way_to_place(point, place, voxel_size);
    const Vector3d inward = -place.outward_normal_O;
    const Vector3d cross = normal.cross(inward);
    const double lean = std::atan2(cross.norm(), normal.dot(inward));
    posture.largest_lean = std::max(posture.largest_lean, lean);
    // Turns that swing the normal; about itself the pad is free to turn.
    const Vector3d turn = cross.norm() > 0.0 ? Vector3d(lean / cross.norm() * cross) : cross;
    const Vector3d u = normal.unitOrthogonal();
    for (const Vector3d& axis : {u, Vector3d(normal.cross(u))}) {
      add({link, point, axis, turn.dot(axis), kLeanLever, true});
    }
    // Across the place the pad is free to move.
    const double along = place.outward_normal_O.dot(way);
    add({link, point, place.outward_normal_O, along + margin});
    const Vector3d across = way - along * place.outward_normal_O;
    const double beyond = across.norm();
    if (beyond > 0.0) add({link, point, across / beyond, beyond});
    posture.largest_gap = std::max(posture.largest_gap, std::hypot(along + margin, beyond));
  }
  for (int link = 0; link < std::ssize(model.links); ++link) {
    if (result.sum >= most) return result;
    const DeepPoint deep = deepest_point(link, posture.X_OL[link], lift);
    posture.largest_depth = std::max(posture.largest_depth, deep.depth);
    if (deep.depth + depth_margin > 0.0) {
      add({link, deep.point_O, deep.outward_O, deep.depth + depth_margin, kDepthWeight});
    }
  }
  for (int link = 0; link < std::ssize(model.links) && result.sum < most; ++link) {
    const auto lowest = surroundings_.over_table(link, posture.X_OL[link], kTableMargin);
    if (!lowest || lowest->height >= kTableMargin) continue;
    add({link, lowest->corner_O, Vector3d::UnitZ(), kTableMargin - lowest->height, kDepthWeight});
  }
  for (const auto& [a, b] : neighbors_) {
    if (const std::optional<Wish> apart = overlap(a, b, posture.X_OL)) add(*apart);
  }
  return result;
}

}  // namespace graspfit::grasp::internal
