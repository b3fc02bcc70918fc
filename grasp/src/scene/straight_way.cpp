#include "scene/straight_way.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <queue>

namespace graspfit::grasp::internal {

using Eigen::Vector3d;
using hands::RigidTransform;

namespace {

/// Allowance for rounding at the size of a hand [m]: distances are off by 1e-12 of the coordinates,
/// poses at the end of ten others by 1e-15 of their reach.
constexpr double kTouching = 1e-8;

/// Shares of a way between which bodies are not yet known to be apart.
struct Segment {
  double lower;
  double upper;
  bool operator<(const Segment& other) const { return upper - lower < other.upper - other.lower; }
};

/// Largest distance of a link's frame from its parent's while its joint goes from `from` to `to`:
/// at one of the ends, for the distance is convex.
double offset_of(const hands::HandModel& hand, const hands::Link& link, const Eigen::VectorXd& from,
                 const Eigen::VectorXd& to) {
  if (!link.parent_joint) return link.X_PL_fixed.translation().norm();
  const hands::Joint& joint = hand.joints[*link.parent_joint];
  if (joint.type == hands::JointType::Revolute) return joint.X_PJ.translation().norm();
  const auto at = [&](const Eigen::VectorXd& q) {
    return (joint.X_PJ * (q[*link.parent_joint] * joint.axis_J)).norm();
  };
  return std::max(at(from), at(to));
}

}  // namespace

double turn_between(const RigidTransform& from, const RigidTransform& to) {
  return Eigen::Quaterniond(from.linear()).angularDistance(Eigen::Quaterniond(to.linear()));
}

StraightWay::StraightWay(const hands::HandModel& hand, const hands::HandConfiguration& from,
                         const hands::HandConfiguration& to)
    : hand_(hand), motion_((to.q - from.q).cwiseAbs()) {
  const double palm_path = (to.X_OH.translation() - from.X_OH.translation()).norm();
  const double palm_turn = turn_between(from.X_OH, to.X_OH);
  for (const hands::Link& link : hand.links) {
    Vector3d axis = Vector3d::Zero();
    if (link.parent_joint) axis = hand.joints[*link.parent_joint].axis_J;
    double radius = 0.0;
    double lever = 0.0;
    for (const Vector3d& vertex : link.mesh_L.vertices) {
      radius = std::max(radius, vertex.norm());
      lever = std::max(lever, vertex.cross(axis).norm());
    }
    radii_.push_back(radius);
    levers_.push_back(lever);
    offsets_.push_back(link.parent_link ? offset_of(hand, link, from.q, to.q) : 0.0);
  }
  for (int link = 0; link < std::ssize(hand.links); ++link) {
    int root = link;
    double reach = radii_[link];
    while (const auto parent = hand.links[root].parent_link) {
      reach += offsets_[root];
      root = *parent;
    }
    speeds_.push_back(palm_path + palm_turn * reach + speed_in(link, root));
  }
}

double StraightWay::speed_in(int link, int ancestor) const {
  double speed = 0.0;
  double reach = radii_[link];  // from the frame of the link `at`
  for (int at = link; at != ancestor;) {
    if (const auto joint = hand_.links[at].parent_joint) {
      const bool is_revolute = hand_.joints[*joint].type == hands::JointType::Revolute;
      speed += motion_[*joint] * (!is_revolute ? 1.0 : at == link ? levers_[at] : reach);
    }
    reach += offsets_[at];
    at = *hand_.links[at].parent_link;
  }
  return speed;
}

double StraightWay::relative_speed(int link_a, int link_b) const {
  // Parents come before their children: going up from the later one ends at the common ancestor.
  int a = link_a;
  int b = link_b;
  while (a != b) {
    int& later = a > b ? a : b;
    later = *hand_.links[later].parent_link;
  }
  return speed_in(link_a, a) + speed_in(link_b, a);
}

bool are_apart_on_way(double relative_speed, double tolerance, const DistanceOnWay& distance) {
  constexpr int kMostDistances = 500;
  if (tolerance > 0.0 && relative_speed <= tolerance) return true;  // nothing but the last segment
  // The bodies are practically at rest: what holds at share 0 holds on the whole path.
  if (relative_speed <= kTouching) return distance(0.0, 8.0 * kTouching) > 2.0 * kTouching;
  const double share_per_meter = 1.0 / relative_speed;
  const auto covered = [&](double d) { return (d - kTouching) * share_per_meter; };
  const double at_start = distance(0.0, relative_speed);
  if (at_start <= kTouching) return false;
  const double low = covered(at_start);
  if (low >= 1.0) return true;
  const double at_end = distance(1.0, relative_speed * (1.0 - low));
  const double high = 1.0 - std::max(covered(at_end), tolerance * share_per_meter);
  // The widest segment comes first: there bodies that touch are found soonest.
  std::priority_queue<Segment> open;
  open.push({low, high});
  for (int count = 2; !open.empty(); ++count) {
    const auto [lower, upper] = open.top();
    open.pop();
    if (lower >= upper) continue;
    if (count >= kMostDistances) return false;
    const double middle = 0.5 * (lower + upper);
    const double d = distance(middle, relative_speed * 0.5 * (upper - lower) + 2.0 * kTouching);
    if (d <= kTouching) return false;
    open.push({lower, middle - covered(d)});
    open.push({middle + covered(d), upper});
  }
  return true;
}

}  // namespace graspfit::grasp::internal
