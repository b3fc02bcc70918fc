#include "approach/pre_grasp_search.hpp"

#include <algorithm>

#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "scene/infinity.hpp"
#include "scene/straight_way.hpp"

namespace graspfit::grasp::internal {

using hands::HandConfiguration;
using hands::RigidTransform;

namespace {

// A search ends after so many distances of bodies that are not proven to stay apart: where links
// slide along the object with hardly a gap every way takes hundreds, and few such searches find
// one.
constexpr int kMostInVain = 8000;

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
    if (scene.collision.link_solid(link)) links_.push_back({link, {}, {}});
  }
  for (const GuardedLink& a : links_) {
    for (const GuardedLink& b : links_) {
      if (b.link <= a.link || scene.hand.is_excluded(a.link, b.link)) continue;
      const bool touch = geometry::do_intersect(solid(a.link), solid(b.link),
                                                between(X_OL_grasp_, a.link, b.link));
      if (!touch) pairs_.push_back({a.link, b.link, {}, {}});
    }
  }
}

std::optional<PreGrasp> PreGraspSearch::find() {
  std::optional<PreGrasp> found = least_opening(Joints::Closing);
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
      return PreGrasp{start, nearest_distance(X_OL), opening, retreat};
    }
  }
  return std::nullopt;
}

Eigen::VectorXd PreGraspSearch::opened(double opening, Joints joints) const {
  Eigen::VectorXd q = grasp_.q;
  for (std::size_t j = 0; j < scene_.hand.joints.size(); ++j) {
    if (scene_.hand.joints[j].closing_sign == 0 && joints == Joints::Closing) continue;
    double& position = q[j];
    position = (1.0 - opening) * position + opening * open_q_[j];
  }
  hands::clamp_to_limits(scene_.hand, q);
  hands::apply_couplings(scene_.hand, q);
  return q;
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
    const auto near =
        geometry::nearest_points(scene_.object, solid(link), X, wanted, guarded.seed, wanted);
    if (near) guarded.seed = geometry::ProximitySeed{near->face_a, near->face_b};
    return !near && !scene_.collision.link_intersects(scene_.object, link, X);
  });
}

double PreGraspSearch::nearest_distance(const LinkPoses& X_OL) const {
  double nearest = kInfinity;
  for (const GuardedLink& guarded : links_) {
    const RigidTransform& X = X_OL[guarded.link];
    nearest = std::min(nearest, surroundings_distance(guarded.link, X, nearest));
    nearest = geometry::surface_clearance(scene_.object, solid(guarded.link), X, nearest, 1.0,
                                          guarded.seed)
                  .at_least;
  }
  return nearest;
}

bool PreGraspSearch::is_free(const HandConfiguration& start, const LinkPoses& X_OL_start) {
  const StraightWay way(scene_.hand, start, grasp_);
  const auto stays_apart = [&](double speed, SearchedBound& in_grasp, const auto& distance) {
    int num_distances = 0;
    const bool are_apart =
        are_apart_on_way(speed, options_.way_tolerance, [&](double share, double enough) {
          ++num_distances;
          if (share == 0.0) return std::min(distance(X_OL_start, enough), enough);
          if (share == 1.0) {
            // All ways end there.
            if (in_grasp.at_least >= in_grasp.searched && enough > in_grasp.searched) {
              in_grasp = {distance(X_OL_grasp_, enough), enough};
            }
            return std::min(in_grasp.at_least, enough);
          }
          const auto X_OL =
              hands::forward_kinematics(scene_.hand, interpolated(start, grasp_, share));
          return std::min(distance(X_OL, enough), enough);
        });
    if (!are_apart) num_in_vain_ += num_distances;
    return are_apart;
  };
  const auto is_link_free = [&](GuardedLink& guarded) {
    const int link = guarded.link;
    SearchedBound of_surroundings;
    return stays_apart(way.speed(link), guarded.in_grasp,
                       [&](const LinkPoses& X_OL, double enough) {
                         return clearance(scene_.object, solid(link), X_OL[link], enough,
                                          guarded.seed);
                       }) &&
           (scene_.surroundings.surroundings().is_empty() ||
            stays_apart(way.speed(link), of_surroundings,
                        [&](const LinkPoses& X_OL, double enough) {
                          return surroundings_distance(link, X_OL[link], enough);
                        }));
  };
  const auto is_pair_free = [&](LinkPair& pair) {
    return stays_apart(way.relative_speed(pair.a, pair.b), pair.in_grasp,
                       [&](const LinkPoses& X_OL, double enough) {
                         return clearance(solid(pair.a), solid(pair.b),
                                          between(X_OL, pair.a, pair.b), enough, pair.seed);
                       });
  };
  return all_pass(links_, is_link_free) && all_pass(pairs_, is_pair_free);
}

}  // namespace graspfit::grasp::internal
