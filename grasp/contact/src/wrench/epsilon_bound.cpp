#include "graspfit/contact/epsilon_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "graspfit/base/errors.hpp"
#include "wrench/nearest_wrench.hpp"

namespace graspfit::contact {
namespace {

using Eigen::Index;
using Column = Eigen::Matrix<double, 7, 1>;
using Basis = Eigen::Matrix<double, 7, 7>;

constexpr int kMostPivots = 100;      // of a ray; about ten are usual
constexpr int kMostNormals = 20;      // of facets, from one ray; two are usual
constexpr double kTolerance = 1e-11;  // of shares and of products of unit wrenches
constexpr double kPenalty = 1e4;      // of corners that are no wrenches, beside lengths of about 1
constexpr double kAside = 0.05;       // entries of a ray along an axis for the other axes
constexpr double kAsideOfForce = 1e-6;  // entries added to those of a force's ray

/// The ray from the origin along d: the largest t for which t d = Σ λ_j w_j with shares λ_j ≥ 0 of
/// sum 1, by the simplex method. Basic are six corners and t. Beside the wrenches there are six
/// corners along the axes, one for each, that a penalty drives out: with them there is always a
/// basis to begin with.
class Ray {
 public:
  /// All entries of the direction differ from zero.
  Ray(const Wrenches& wrenches, const Wrench& direction) : wrenches_(wrenches) {
    // The corners s_i e_i, with s_i the sign of d_i. The basis is (S, -d; 1, 0), with S = diag(s):
    // t is (1 - s w) / |d|_1 of its product with (w, 1), the share of corner i s_i w_i + |d_i| t.
    Eigen::Matrix<double, 1, 7> share_of_t;
    for (Index i = 0; i < 6; ++i) share_of_t[i] = direction[i] > 0.0 ? -1.0 : 1.0;
    share_of_t[6] = 1.0;
    share_of_t /= direction.lpNorm<1>();
    for (Index i = 0; i < 6; ++i) {
      inverse_.row(i) = std::abs(direction[i]) * share_of_t;
      inverse_(i, i) += direction[i] > 0.0 ? 1.0 : -1.0;
      penalty_[i] = -kPenalty;
    }
    inverse_.row(6) = share_of_t;
  }

  /// Pivots until no wrench is beyond the facet. False if the ray leaves the hull nowhere.
  bool shoot() {
    for (int pivot = 0; pivot < kMostPivots; ++pivot) {
      const Facet facet = this->facet();
      const Support support = this->support(facet.normal);
      if (support.height - facet.offset <= kTolerance) return is_of_wrenches();
      const Column entering = inverse_ * column(support.wrench);
      std::optional<Index> leaving;
      double least = std::numeric_limits<double>::infinity();
      for (Index i = 0; i < 6; ++i) {
        if (entering[i] <= kTolerance) continue;
        const double ratio = inverse_(i, 6) / entering[i];
        if (ratio >= least) continue;
        least = ratio;
        leaving = i;
      }
      if (!leaving) return false;
      exchange(*leaving, entering);
    }
    return false;
  }

  /// Turns the ray onto the normal of its facet and pivots until it meets a facet again. False if
  /// that is not found.
  bool turn() {
    Column direction = Column::Zero();
    direction.head<6>() = -facet().normal.normalized();
    exchange(6, inverse_ * direction);
    for (int pivot = 0; pivot < kMostPivots; ++pivot) {
      Index leaving = 0;
      if (inverse_.col(6).head<6>().minCoeff(&leaving) >= -kTolerance) return true;
      // Of the wrenches that can take its place the one that the facet's plane meets first.
      const Facet facet = this->facet();
      const auto row = inverse_.row(leaving);
      std::optional<Index> next;
      double least = std::numeric_limits<double>::infinity();
      for (Index k = 0; k < wrenches_.cols(); ++k) {
        const double share = row.head<6>().dot(wrenches_.col(k)) + row[6];
        if (share >= -kTolerance) continue;
        const double ratio = (facet.offset - facet.normal.dot(wrenches_.col(k))) / -share;
        if (ratio >= least) continue;
        least = ratio;
        next = k;
      }
      if (!next) return false;
      exchange(leaving, inverse_ * column(*next));
    }
    return false;
  }

  /// How far the ray is in the hull, in lengths of its direction.
  double length() const { return inverse_(6, 6); }

  /// The distance from the origin to the plane along the facet's normal that no wrench is beyond.
  double distance() const { return support(facet().normal.normalized()).height; }

 private:
  /// normal · w ≤ offset, with equality at the basic corners, but for their penalties.
  struct Facet {
    Wrench normal;
    double offset;
  };
  Facet facet() const {
    Eigen::Matrix<double, 1, 7> dual = inverse_.row(6);
    for (Index i = 0; i < 6; ++i) dual += penalty_[i] * inverse_.row(i);
    return {-dual.head<6>().transpose(), dual[6]};
  }
  /// The wrench that is farthest along a direction, and how far.
  struct Support {
    Index wrench = 0;
    double height = -std::numeric_limits<double>::infinity();
  };
  Support support(const Wrench& direction) const {
    Support farthest;
    for (Index k = 0; k < wrenches_.cols(); ++k) {
      const double height = direction.dot(wrenches_.col(k));
      if (height > farthest.height) farthest = {k, height};
    }
    return farthest;
  }
  Column column(Index wrench) const {
    Column result;
    result << wrenches_.col(wrench), 1.0;
    return result;
  }
  bool is_of_wrenches() const {
    for (Index i = 0; i < 6; ++i) {
      if (penalty_[i] != 0.0 && inverse_(i, 6) > kTolerance) return false;
    }
    return true;
  }
  /// Puts another column, given in the basis, in the place of a basic one.
  void exchange(Index leaving, const Column& entering) {
    const Eigen::Matrix<double, 1, 7> row = inverse_.row(leaving) / entering[leaving];
    inverse_ -= entering * row;
    inverse_.row(leaving) = row;
    if (leaving < 6) penalty_[leaving] = 0.0;
  }

  const Wrenches& wrenches_;
  Basis inverse_;
  Column penalty_ = Column::Zero();
};

/// Length of a point of the hull near the one nearest to the origin, of any point that proves the
/// origin to be outside if `any` is; empty if the origin is in the hull, or nearly so.
std::optional<double> distance_outside(const Wrenches& wrenches, bool any) {
  const auto is_enough = [&](const Wrench& point, double product) {
    return product > (any ? 0.0 : 0.99 * point.squaredNorm());
  };
  const Wrench nearest = internal::near_wrench(wrenches, is_enough).point;
  const double least = (nearest.transpose() * wrenches).minCoeff();
  if (!(least > 0.0)) return std::nullopt;
  return nearest.norm();
}

void require_finite(const Wrenches& wrenches, const std::string& function) {
  if (wrenches.cols() == 0 || !wrenches.allFinite()) {
    throw base::InvalidInput(function + ": needs at least one wrench, and finite ones");
  }
}

/// Along the axes and the diagonals between them.
std::array<Eigen::Vector3d, 14> force_directions() {
  std::array<Eigen::Vector3d, 14> directions;
  auto next = directions.begin();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) *next++ = sign * Eigen::Vector3d::Unit(axis);
  }
  for (int corner = 0; corner < 8; ++corner) {
    *next++ =
        Eigen::Vector3d(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0)
            .normalized();
  }
  return directions;
}

}  // namespace

double least_force(const Wrenches& wrenches, double enough) {
  require_finite(wrenches, "least_force");
  static const std::array<Eigen::Vector3d, 14> kDirections = force_directions();
  const double longest = wrenches.colwise().norm().maxCoeff();
  if (!(longest > 0.0)) return 0.0;
  const Wrenches unit = wrenches / longest;
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& force : kDirections) {
    least = std::min(least, (force.transpose() * unit.topRows<3>()).maxCoeff());
  }
  if (least * longest <= enough) return std::max(0.0, least * longest);
  for (const Eigen::Vector3d& force : kDirections) {
    Wrench direction = Wrench::Constant(kAsideOfForce);
    direction.head<3>() += force;
    Ray ray(unit, direction);
    if (!ray.shoot()) return 0.0;
    least = std::min(least, ray.length());
    if (least * longest <= enough) break;
  }
  return std::max(0.0, least * longest);
}

double epsilon_bound(const Wrenches& wrenches, double enough) {
  require_finite(wrenches, "epsilon_bound");
  const double longest = wrenches.colwise().norm().maxCoeff();
  if (!(longest > 0.0)) return 0.0;
  const Wrenches unit = wrenches / longest;
  if (const std::optional<double> outside = distance_outside(unit, enough >= 0.0)) {
    return -*outside * longest;
  }
  // Where wrenches reach least far along an axis, the nearest facet is soonest found.
  struct Axis {
    double reach;  // of the wrenches along it, no less than epsilon
    Index axis;
    double sign;
  };
  std::array<Axis, 12> axes;
  for (Index i = 0; i < 6; ++i) {
    axes[2 * i] = {-unit.row(i).minCoeff(), i, -1.0};
    axes[2 * i + 1] = {unit.row(i).maxCoeff(), i, 1.0};
  }
  std::stable_sort(axes.begin(), axes.end(),
                   [](const Axis& a, const Axis& b) { return a.reach < b.reach; });
  if (axes.front().reach * longest <= enough) return axes.front().reach * longest;
  double least = std::numeric_limits<double>::infinity();
  for (const Axis& axis : axes) {
    Wrench direction = Wrench::Constant(axis.sign * kAside);
    direction[axis.axis] = axis.sign;
    Ray ray(unit, direction);
    if (!ray.shoot()) return 0.0;
    double distance = ray.distance();
    for (int i = 0; i < kMostNormals; ++i) {
      least = std::min(least, distance);
      if (least * longest <= enough) return least * longest;
      if (!ray.turn()) break;
      const double next = ray.distance();
      if (!(next < distance)) break;
      distance = next;
    }
  }
  return least * longest;
}

}  // namespace graspfit::contact
