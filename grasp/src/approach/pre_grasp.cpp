#include "graspfit/grasp/pre_grasp.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "approach/checked_pre_grasp.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "rows/range_check.hpp"
#include "scene/infinity.hpp"
#include "scene/straight_way.hpp"

namespace graspfit::grasp {

using hands::HandConfiguration;
using hands::RigidTransform;

namespace {

// Largest number of steps of a retreat that options may ask for; each step costs the distances of
// all links.
constexpr int kMostSteps = 1000;

// A search ends after so many distances of bodies that are not proven to stay apart: where links
// slide along the object with hardly a gap every way takes hundreds, and few such searches find
// one.
constexpr int kMostInVain = 8000;

/// A lower bound of a distance, and how far was searched for it: beyond, the bound says no more.
struct SearchedBound {
  double at_least = 0.0;  ///< [m]
  double searched = 0.0;  ///< [m]
};

struct LinkPair {
  int a;
  int b;
  geometry::ProximitySeed seed;  ///< Faces near each other when last measured.
  SearchedBound in_grasp = {};
};

/// A link, to be kept from object and surroundings.
struct GuardedLink {
  int link;
  geometry::ProximitySeed seed;  ///< With the object.
  SearchedBound in_grasp = {};   ///< The same.
};

/// Whether all items pass; an item that fails moves to the front, to be tested first the next time.
template <class T, class Test>
bool all_pass(std::vector<T>& items, const Test& test) {
  const auto failed = std::find_if_not(items.begin(), items.end(), test);
  if (failed == items.end()) return true;
  std::rotate(items.begin(), failed, failed + 1);
  return false;
}

/// The search for one grasp's pre-grasp.
class PreGraspSearch {
 public:
  PreGraspSearch(const hands::HandModel& hand, const hands::HandCollision& collision,
                 const geometry::MeshQuery& object, const SurroundingsCollision& surroundings,
                 const HandConfiguration& grasp, const PreGraspOptions& options)
      : hand_(hand),
        collision_(collision),
        object_(object),
        surroundings_(surroundings),
        grasp_(grasp),
        options_(options),
        open_q_(hands::open_configuration(hand).q),
        X_OL_grasp_(hands::forward_kinematics(hand, grasp)) {
    for (int link = 0; link < static_cast<int>(hand.links.size()); ++link) {
      if (collision.link_solid(link)) links_.push_back({link, {}, {}});
    }
    for (const GuardedLink& a : links_) {
      for (const GuardedLink& b : links_) {
        if (b.link <= a.link || hand.is_excluded(a.link, b.link)) continue;
        const bool touch = geometry::do_intersect(solid(a.link), solid(b.link),
                                                  between(X_OL_grasp_, a.link, b.link));
        if (!touch) pairs_.push_back({a.link, b.link, {}, {}});
      }
    }
  }

  std::optional<PreGrasp> operator()() {
    std::optional<PreGrasp> found = least_opening(Joints::Closing);
    if (!found && options_.open_neutral) found = least_opening(Joints::All);
    return found;
  }

  std::optional<PreGrasp> checked(const HandConfiguration& start) {
    const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand_, start);
    if (!is_clear(X_OL) || !is_free(start, X_OL)) return std::nullopt;
    const Eigen::Vector3d moved = grasp_.X_OH.translation() - start.X_OH.translation();
    return PreGrasp{start, nearest_distance(X_OL), opening_of(start.q),
                    std::max(0.0, moved.dot(grasp_.X_OH.linear() * hand_.palm.direction_H))};
  }

 private:
  enum class Joints { Closing, All };

  /// The first pre-grasp among all openings of these joints and retreats, in their order.
  std::optional<PreGrasp> least_opening(Joints joints) {
    const int num_retreats = static_cast<int>(options_.largest_retreat / options_.retreat_step *
                                              (1.0 + 1e-12));  // 0.1 / 0.01 is 10, not 9.99…
    num_in_vain_ = 0;
    Eigen::VectorXd tried_q;
    for (int step = 1; step <= options_.opening_steps; ++step) {
      const double opening = static_cast<double>(step) / options_.opening_steps;
      const Eigen::VectorXd q = opened(opening, joints);
      if (tried_q.size() == q.size() && tried_q == q) continue;  // joints that cannot open further
      tried_q = q;
      for (int i = 0; i <= num_retreats; ++i) {
        if (num_in_vain_ > kMostInVain) return std::nullopt;
        const double retreat = i * options_.retreat_step;
        const HandConfiguration start{retreated(retreat), q};
        const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand_, start);
        if (!is_clear(X_OL) || !is_free(start, X_OL)) continue;
        return PreGrasp{start, nearest_distance(X_OL), opening, retreat};
      }
    }
    return std::nullopt;
  }

  const geometry::MeshQuery& solid(int link) const { return *collision_.link_solid(link); }

  static RigidTransform between(const std::vector<RigidTransform>& X_OL, int a, int b) {
    return geometry::relative_pose(X_OL[a], X_OL[b]);
  }

  Eigen::VectorXd opened(double opening, Joints joints) const {
    Eigen::VectorXd q = grasp_.q;
    for (std::size_t j = 0; j < hand_.joints.size(); ++j) {
      if (hand_.joints[j].closing_sign == 0 && joints == Joints::Closing) continue;
      double& position = q[j];
      position = (1.0 - opening) * position + opening * open_q_[j];
    }
    hands::clamp_to_limits(hand_, q);
    hands::apply_couplings(hand_, q);
    return q;
  }

  /// The largest share, over the closing joints, of the motion to the joint's position in the open
  /// hand, in [0, 1].
  double opening_of(const Eigen::VectorXd& q) const {
    double largest = 0.0;
    for (std::size_t j = 0; j < hand_.joints.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      const double whole = open_q_[i] - grasp_.q[i];
      if (hand_.joints[j].closing_sign == 0 || whole == 0.0) continue;
      largest = std::max(largest, (q[i] - grasp_.q[i]) / whole);
    }
    return std::min(largest, 1.0);
  }

  RigidTransform retreated(double retreat) const {
    RigidTransform X_OH = grasp_.X_OH;
    X_OH.translation() -= retreat * (X_OH.linear() * hand_.palm.direction_H);
    return X_OH;
  }

  double surroundings_distance(int link, const RigidTransform& X_OL, double enough) const {
    return surroundings_.distance(collision_, link, X_OL, enough).distance;
  }

  /// Whether every link keeps the wanted clearance.
  bool is_clear(const std::vector<RigidTransform>& X_OL) {
    const double wanted = options_.clearance;
    return all_pass(links_, [&](GuardedLink& guarded) {
      const int link = guarded.link;
      const RigidTransform& X = X_OL[link];
      if (surroundings_distance(link, X, wanted) < wanted) return false;
      const auto near =
          geometry::nearest_points(object_, solid(link), X, wanted, guarded.seed, wanted);
      if (near) guarded.seed = {near->face_a, near->face_b};
      return !near && !collision_.link_intersects(object_, link, X);
    });
  }

  /// Distance of the nearest link, where none is in the object.
  double nearest_distance(const std::vector<RigidTransform>& X_OL) const {
    double nearest = internal::kInfinity;
    for (const GuardedLink& guarded : links_) {
      const RigidTransform& X = X_OL[guarded.link];
      nearest = std::min(nearest, surroundings_distance(guarded.link, X, nearest));
      nearest =
          geometry::surface_clearance(object_, solid(guarded.link), X, nearest, 1.0, guarded.seed)
              .at_least;
    }
    return nearest;
  }

  /// Lower bound of the distance of two surfaces, up to `enough`; starts from the faces that were
  /// near when last measured.
  static double clearance(const geometry::MeshQuery& a, const geometry::MeshQuery& b,
                          const RigidTransform& X_AB, double enough,
                          geometry::ProximitySeed& seed) {
    const auto found = geometry::surface_clearance(a, b, X_AB, enough, internal::kNearEnough, seed);
    seed = found.nearest;
    return found.at_least;
  }

  /// Whether the straight path to the grasp is free. Surfaces that stay apart suffice, since no
  /// body is inside another to begin with: at the start no link is in the object, and in the grasp
  /// neither link of a pair is in the other.
  bool is_free(const HandConfiguration& start, const std::vector<RigidTransform>& X_OL_start) {
    const internal::StraightWay way(hand_, start, grasp_);
    const auto stays_apart = [&](double speed, SearchedBound& in_grasp, const auto& distance) {
      int num_distances = 0;
      const bool are_apart = internal::are_apart_on_way(
          speed, options_.way_tolerance, [&](double share, double enough) {
            ++num_distances;
            if (share == 0.0) return std::min(distance(X_OL_start, enough), enough);
            if (share == 1.0) {
              // All ways end there.
              if (in_grasp.at_least >= in_grasp.searched && enough > in_grasp.searched) {
                in_grasp = {distance(X_OL_grasp_, enough), enough};
              }
              return std::min(in_grasp.at_least, enough);
            }
            const auto X_OL = hands::forward_kinematics(hand_, interpolated(start, grasp_, share));
            return std::min(distance(X_OL, enough), enough);
          });
      if (!are_apart) num_in_vain_ += num_distances;
      return are_apart;
    };
    const auto is_link_free = [&](GuardedLink& guarded) {
      const int link = guarded.link;
      const auto index = static_cast<std::size_t>(link);
      SearchedBound of_surroundings;
      return stays_apart(way.speed(link), guarded.in_grasp,
                         [&](const std::vector<RigidTransform>& X_OL, double enough) {
                           return clearance(object_, solid(link), X_OL[index], enough,
                                            guarded.seed);
                         }) &&
             (surroundings_.surroundings().is_empty() ||
              stays_apart(way.speed(link), of_surroundings,
                          [&](const std::vector<RigidTransform>& X_OL, double enough) {
                            return surroundings_distance(link, X_OL[index], enough);
                          }));
    };
    const auto is_pair_free = [&](LinkPair& pair) {
      return stays_apart(way.relative_speed(pair.a, pair.b), pair.in_grasp,
                         [&](const std::vector<RigidTransform>& X_OL, double enough) {
                           return clearance(solid(pair.a), solid(pair.b),
                                            between(X_OL, pair.a, pair.b), enough, pair.seed);
                         });
    };
    return all_pass(links_, is_link_free) && all_pass(pairs_, is_pair_free);
  }

  const hands::HandModel& hand_;
  const hands::HandCollision& collision_;
  const geometry::MeshQuery& object_;
  const SurroundingsCollision& surroundings_;
  const HandConfiguration& grasp_;
  const PreGraspOptions& options_;
  const Eigen::VectorXd open_q_;
  const std::vector<RigidTransform> X_OL_grasp_;
  std::vector<GuardedLink> links_;  ///< Those with a solid; one that failed last comes first.
  std::vector<LinkPair> pairs_;  ///< Pairs that must stay apart; one that failed last comes first.
  int num_in_vain_ = 0;          ///< Distances of bodies not proven to stay apart, of this search.
};

}  // namespace

void PreGraspOptions::validate() const {
  internal::require_ranges("PreGraspOptions", *this, internal::pre_grasp_rows);
  base::require(largest_retreat / retreat_step <= kMostSteps, "PreGraspOptions", "retreat_step_m",
                retreat_step, "at least a thousandth of largest_retreat_m");
}

HandConfiguration interpolated(const HandConfiguration& from, const HandConfiguration& to,
                               double share) {
  base::require(from.q.size() == to.q.size(), "interpolated", "number of joint positions",
                static_cast<long>(to.q.size()),
                "that of the other configuration, " + std::to_string(from.q.size()));
  base::require(share >= 0.0 && share <= 1.0, "interpolated", "share", share, "in [0, 1]");
  if (share == 0.0) return from;
  if (share == 1.0) return to;
  HandConfiguration result;
  result.q = (1.0 - share) * from.q + share * to.q;
  result.X_OH = from.X_OH;
  if (from.X_OH.linear() != to.X_OH.linear()) {
    const Eigen::Quaterniond start(from.X_OH.linear());
    const Eigen::Quaterniond end(to.X_OH.linear());
    result.X_OH.linear() = start.slerp(share, end).normalized().toRotationMatrix();
  }
  result.X_OH.translation() =
      (1.0 - share) * from.X_OH.translation() + share * to.X_OH.translation();
  return result;
}

std::optional<PreGrasp> find_pre_grasp(const hands::HandModel& hand,
                                       const hands::HandCollision& collision,
                                       const geometry::MeshQuery& object,
                                       const SurroundingsCollision& surroundings,
                                       const HandConfiguration& grasp,
                                       const PreGraspOptions& options) {
  options.validate();
  hands::validate(hand, grasp);
  return PreGraspSearch(hand, collision, object, surroundings, grasp, options)();
}

std::optional<PreGrasp> internal::checked_pre_grasp(const hands::HandModel& hand,
                                                    const hands::HandCollision& collision,
                                                    const geometry::MeshQuery& object,
                                                    const SurroundingsCollision& surroundings,
                                                    const HandConfiguration& start,
                                                    const HandConfiguration& grasp,
                                                    const PreGraspOptions& options) {
  options.validate();
  hands::validate(hand, start);
  hands::validate(hand, grasp);
  return PreGraspSearch(hand, collision, object, surroundings, grasp, options).checked(start);
}

}  // namespace graspfit::grasp
