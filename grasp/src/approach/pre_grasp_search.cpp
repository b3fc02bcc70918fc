#include "approach/pre_grasp_search.hpp"

#include <algorithm>

#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/jacobian.hpp"
#include "scene/infinity.hpp"

namespace graspfit::grasp::internal {

using hands::HandConfiguration;
using hands::RigidTransform;

namespace {

// A search ends after so many distances of bodies that are not proven to stay apart: where links
// slide along the object with hardly a gap every way takes hundreds, and few such searches find
// one. A way that is stopped where an earlier one was counts for one.
constexpr int kMostInVain = 8000;

// A link so near to the object in the grasp should not be moved towards it.
constexpr double kNearlyTouching = 0.001;  // [m]
constexpr double kStill = 1e-6;            // of a motion towards it [m]

/// Whether all items pass; an item that fails moves to the front, to be tested first the next time.
template <class T, class Test>
bool all_pass(std::vector<T>& items, const Test& test) {
  const auto failed = std::find_if_not(items.begin(), items.end(), test);
  if (failed == items.end()) return true;
  std::rotate(items.begin(), failed, failed + 1);
  return false;
}

RigidTransform between(const std::vector<RigidTransform>& X_OL, int a, int b) {
  return geometry::relative_pose(X_OL[a], X_OL[b]);
}

/// Lower bound of the distance of two surfaces, up to `enough`; starts from the faces that were
/// near when last measured.
double clearance(const geometry::MeshQuery& a, const geometry::MeshQuery& b,
                 const RigidTransform& X_AB, double enough,
                 std::optional<geometry::ProximitySeed>& seed) {
  const auto found = geometry::surface_clearance(a, b, X_AB, enough, kNearEnough, seed);
  seed = found.nearest;
  return found.at_least;
}

}  // namespace

PreGraspSearch::PreGraspSearch(const PreGraspScene& scene, const hands::PosedConfiguration& grasp,
                               const PreGraspOptions& options)
    : scene_(scene),
      grasp_(grasp.configuration),
      options_(options),
      open_q_(hands::open_configuration(scene.hand).q),
      X_OL_grasp_(grasp.X_OL) {
  for (int link = 0; link < std::ssize(scene.hand.links); ++link) {
    if (scene.collision.link_solid(link)) links_.push_back({link, {}});
  }
  for (const GuardedLink& a : links_) {
    for (const GuardedLink& b : links_) {
      if (b.link <= a.link || scene.hand.is_excluded(a.link, b.link)) continue;
      const bool touch = geometry::do_intersect(solid(a.link), solid(b.link),
                                                between(X_OL_grasp_, a.link, b.link));
      if (!touch) pairs_.push_back({a.link, b.link, {}});
    }
  }
}

std::optional<PreGrasp> PreGraspSearch::find() {
  std::optional<PreGrasp> found = least_opening(Joints::Closing);
  if (!found && options_.leave_pressing) {
    leaves_ = leaving_joints();
    bool is_any_left = false;
    for (std::size_t j = 0; j < leaves_.size(); ++j) {
      is_any_left = is_any_left || (!leaves_[j] && may_open(j));
    }
    if (is_any_left) found = least_opening(Joints::Leaving);
  }
  if (!found && options_.open_neutral) found = least_opening(Joints::All);
  return found;
}

std::optional<PreGrasp> PreGraspSearch::checked(const HandConfiguration& start) {
  const LinkPoses X_OL = hands::forward_kinematics(scene_.hand, start);
  if (!is_clear(X_OL) || !is_free(start, X_OL)) return std::nullopt;
  const Eigen::Vector3d moved = grasp_.X_OH.translation() - start.X_OH.translation();
  return PreGrasp{start, nearest_distance(X_OL), opening_of(start.q),
                  std::max(0.0, moved.dot(grasp_.X_OH.linear() * scene_.hand.palm.direction_H))};
}

std::optional<PreGrasp> PreGraspSearch::least_opening(Joints joints) {
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
      const LinkPoses X_OL = hands::forward_kinematics(scene_.hand, start);
      if (!is_clear(X_OL) || !is_free(start, X_OL)) continue;
      const double share = joints == Joints::Leaving ? opening_of(q) : opening;
      return PreGrasp{start, nearest_distance(X_OL), share, retreat};
    }
  }
  return std::nullopt;
}

std::vector<bool> PreGraspSearch::leaving_joints() const {
  const auto num_joints = base::as_index<int>(scene_.hand.joints.size());
  // What opens with each joint: itself, and those that follow it, clutched or not.
  Eigen::MatrixXd openings(num_joints, num_joints);
  for (int j = 0; j < num_joints; ++j) {
    Eigen::VectorXd q = grasp_.q;
    q[j] = open_q_[j];
    for (int follower = 0; follower < num_joints; ++follower) {
      const auto& coupling = scene_.hand.joints[follower].coupling;
      if (coupling && coupling->leader == j) q[follower] = open_q_[follower];
    }
    hands::apply_couplings(scene_.hand, q);
    openings.col(j) = q - grasp_.q;
  }
  std::vector<bool> leaves(scene_.hand.joints.size(), true);
  for (const GuardedLink& guarded : links_) {
    const RigidTransform& X_OL = X_OL_grasp_[guarded.link];
    const auto near =
        geometry::nearest_points(scene_.object, solid(guarded.link), X_OL, kNearlyTouching);
    if (!near || near->distance == 0.0) continue;
    const Eigen::Vector3d outward = (near->point_on_b_A - near->point_on_a_A).normalized();
    const Eigen::RowVectorXd motions =
        outward.transpose() *
        hands::point_jacobian(scene_.hand, X_OL_grasp_, guarded.link,
                              geometry::inverted(X_OL) * near->point_on_b_A)
            .topRows<3>() *
        openings;
    for (int j = 0; j < num_joints; ++j) {
      if (motions[j] < -kStill) leaves[j] = false;
    }
  }
  return leaves;
}

Eigen::VectorXd PreGraspSearch::opened(double opening, Joints joints) const {
  Eigen::VectorXd q = grasp_.q;
  for (std::size_t j = 0; j < scene_.hand.joints.size(); ++j) {
    const bool is_neutral = scene_.hand.joints[j].closing_sign == 0;
    if (!may_open(j) || (is_neutral && joints == Joints::Closing)) continue;
    if (joints == Joints::Leaving && !leaves_[j]) continue;
    double& position = q[j];
    position = (1.0 - opening) * position + opening * open_q_[j];
  }
  hands::clamp_to_limits(scene_.hand, q);
  hands::apply_couplings(scene_.hand, q);
  return q;
}

bool PreGraspSearch::may_open(std::size_t joint) const {
  return options_.open_neutral || scene_.hand.joints[joint].closing_sign != 0;
}

double PreGraspSearch::opening_of(const Eigen::VectorXd& q) const {
  double largest = 0.0;
  for (int j = 0; j < std::ssize(scene_.hand.joints); ++j) {
    const double whole = open_q_[j] - grasp_.q[j];
    if (scene_.hand.joints[j].closing_sign == 0 || whole == 0.0) continue;
    largest = std::max(largest, (q[j] - grasp_.q[j]) / whole);
  }
  return std::min(largest, 1.0);
}

RigidTransform PreGraspSearch::retreated(double retreat) const {
  RigidTransform X_OH = grasp_.X_OH;
  X_OH.translation() -= retreat * (X_OH.linear() * scene_.hand.palm.direction_H);
  return X_OH;
}

double PreGraspSearch::surroundings_distance(int link, const RigidTransform& X_OL,
                                             double enough) const {
  return scene_.surroundings.distance(scene_.collision, link, X_OL, enough).distance;
}

bool PreGraspSearch::is_clear(const LinkPoses& X_OL) {
  const double wanted = options_.clearance;
  return all_pass(links_, [&](GuardedLink& guarded) {
    const int link = guarded.link;
    const RigidTransform& X = X_OL[link];
    if (surroundings_distance(link, X, wanted) < wanted) return false;
    const auto near = geometry::nearest_points(scene_.object, solid(link), X, wanted,
                                               guarded.of_object.seed, wanted);
    if (near) guarded.of_object.seed = geometry::ProximitySeed{near->face_a, near->face_b};
    return !near && !scene_.collision.link_intersects(scene_.object, link, X);
  });
}

double PreGraspSearch::nearest_distance(const LinkPoses& X_OL) const {
  double nearest = kInfinity;
  for (const GuardedLink& guarded : links_) {
    const RigidTransform& X = X_OL[guarded.link];
    nearest = std::min(nearest, surroundings_distance(guarded.link, X, nearest));
    nearest = geometry::surface_clearance(scene_.object, solid(guarded.link), X, nearest, 1.0,
                                          guarded.of_object.seed)
                  .at_least;
  }
  return nearest;
}

bool PreGraspSearch::meet_again(const HandConfiguration& start, const StraightWay& way) const {
  // Where they meet on this way, if not on its last segment, on which they may.
  const auto share_of = [&](const Bodies& bodies, double speed) -> std::optional<double> {
    if (!bodies.met_at || (1.0 - *bodies.met_at) * speed <= options_.way_tolerance) {
      return std::nullopt;
    }
    return bodies.met_at;
  };
  const auto at = [&](double share) {
    return hands::forward_kinematics(scene_.hand, interpolated(start, grasp_, share));
  };
  const auto link_meets = [&](const GuardedLink& guarded) {
    const auto share = share_of(guarded.of_object, way.speed(guarded.link));
    return share &&
           scene_.collision.link_intersects(scene_.object, guarded.link, at(*share)[guarded.link]);
  };
  const auto pair_meets = [&](const LinkPair& pair) {
    const auto share = share_of(pair.bodies, way.relative_speed(pair.a, pair.b));
    return share && geometry::do_intersect(solid(pair.a), solid(pair.b),
                                           between(at(*share), pair.a, pair.b));
  };
  return std::any_of(links_.begin(), links_.end(), link_meets) ||
         std::any_of(pairs_.begin(), pairs_.end(), pair_meets);
}

bool PreGraspSearch::is_free(const HandConfiguration& start, const LinkPoses& X_OL_start) {
  const StraightWay way(scene_.hand, start, grasp_);
  if (meet_again(start, way)) {
    ++num_in_vain_;
    return false;
  }
  const auto stays_apart = [&](double speed, Bodies& bodies, const auto& distance) {
    int num_distances = 0;
    const bool are_apart =
        are_apart_on_way(speed, options_.way_tolerance, [&](double share, double enough) {
          ++num_distances;
          if (share == 1.0) {
            // All ways end there.
            SearchedBound& in_grasp = bodies.in_grasp;
            if (in_grasp.at_least >= in_grasp.searched && enough > in_grasp.searched) {
              in_grasp = {distance(X_OL_grasp_, enough), enough};
            }
            return std::min(in_grasp.at_least, enough);
          }
          const double found = distance(
              share == 0.0
                  ? X_OL_start
                  : hands::forward_kinematics(scene_.hand, interpolated(start, grasp_, share)),
              enough);
          if (found == 0.0) bodies.met_at = share;
          return std::min(found, enough);
        });
    if (!are_apart) num_in_vain_ += num_distances;
    return are_apart;
  };
  const auto is_link_free = [&](GuardedLink& guarded) {
    const int link = guarded.link;
    Bodies of_surroundings;
    return stays_apart(way.speed(link), guarded.of_object,
                       [&](const LinkPoses& X_OL, double enough) {
                         return clearance(scene_.object, solid(link), X_OL[link], enough,
                                          guarded.of_object.seed);
                       }) &&
           (scene_.surroundings.surroundings().is_empty() ||
            stays_apart(way.speed(link), of_surroundings,
                        [&](const LinkPoses& X_OL, double enough) {
                          return surroundings_distance(link, X_OL[link], enough);
                        }));
  };
  const auto is_pair_free = [&](LinkPair& pair) {
    return stays_apart(way.relative_speed(pair.a, pair.b), pair.bodies,
                       [&](const LinkPoses& X_OL, double enough) {
                         return clearance(solid(pair.a), solid(pair.b),
                                          between(X_OL, pair.a, pair.b), enough, pair.bodies.seed);
                       });
  };
  return all_pass(links_, is_link_free) && all_pass(pairs_, is_pair_free);
}

}  // namespace graspfit::grasp::internal
