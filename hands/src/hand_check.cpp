#include "graspfit/hands/hand_check.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_workspace.hpp"
#include "internal/findings.hpp"
#include "internal/hand_assembly.hpp"

namespace graspfit::hands {

namespace {

using Eigen::Vector3d;
using internal::Findings;

/// For people: three digits.
std::string rounded(double value) {
  char text[32];
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 3);
  return {text, end};
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// How the joints of a tree follow each other, whatever links fixed joints join.
class JointTree {
 public:
  explicit JointTree(const HandModel& tree) : tree_(tree), above_(tree.links.size(), -1) {
    for (std::size_t i = 1; i < tree_.links.size(); ++i) {
      const Link& link = tree_.links[i];
      above_[i] = link.parent_joint >= 0 ? link.parent_joint
                                         : above_[static_cast<std::size_t>(link.parent_link)];
    }
    const HandConfiguration zero{
        .X_OH = RigidTransform::Identity(),
        .q = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(tree_.joints.size()))};
    X_HL_ = forward_kinematics(tree_, zero);
  }

  const HandModel& tree() const { return tree_; }
  const Joint& joint(int j) const { return tree_.joints[static_cast<std::size_t>(j)]; }
  int num_joints() const { return static_cast<int>(tree_.joints.size()); }

  /// The joint that moves a link; −1 for what the root carries.
  int above_link(std::size_t link) const { return above_[link]; }
  /// The joint before a joint; −1 if there is none.
  int above(int j) const { return above_[static_cast<std::size_t>(joint(j).parent_link)]; }
  /// The joints next after a joint; −1: those on the root.
  std::vector<int> next(int j) const {
    std::vector<int> result;
    for (int k = 0; k < num_joints(); ++k) {
      if (above(k) == j) result.push_back(k);
    }
    return result;
  }

  /// At zero of all joints, in the root link's frame.
  Vector3d point(int j) const { return X_HJ(j).translation(); }
  Vector3d axis(int j) const { return X_HJ(j).linear() * joint(j).axis_J; }
  bool are_parallel(int a, int b) const {
    constexpr double kParallel = 0.02;  // [rad]; axes of one plane of flexion, measured on CAD
    return axis(a).cross(axis(b)).norm() < kParallel;
  }

  double range(int j) const { return joint(j).upper - joint(j).lower; }
  /// Follows no joint, and none follows it.
  bool is_free(int j) const {
    return !joint(j).coupling &&
           std::none_of(tree_.joints.begin(), tree_.joints.end(), [&](const Joint& other) {
             return other.coupling && other.coupling->leader == j;
           });
  }
  bool is_revolute(int j) const { return joint(j).type == JointType::Revolute; }

 private:
  RigidTransform X_HJ(int j) const {
    return X_HL_[static_cast<std::size_t>(joint(j).parent_link)] * joint(j).X_PJ;
  }

  const HandModel& tree_;
  std::vector<int> above_;
  std::vector<RigidTransform> X_HL_;
};

// ---- Links
// ----------------------------------------------------------------------------------------

/// `has_geometry`: links whose description names a shape, whether or not it could be read.
void look_for_missing_meshes(const JointTree& joints, const std::set<std::string>& has_geometry,
                             Findings& findings) {
  // Links that move as one: -1 (the root) first.
  for (int body = -1; body < joints.num_joints(); ++body) {
    bool has_mesh = false;
    std::vector<std::string> names;
    for (std::size_t l = 0; l < joints.tree().links.size(); ++l) {
      if (joints.above_link(l) != body) continue;
      names.push_back(joints.tree().links[l].name);
      has_mesh = has_mesh || has_geometry.contains(names.back());
    }
    if (has_mesh) continue;
    const std::string item = "link " + names[0];
    if (body == -1) {
      findings.suspicious(item, "the palm has no mesh: nothing collides with it or touches it");
    } else if (joints.next(body).empty()) {
      findings.suspicious(item, "has no mesh, and the hand ends there: nothing to touch with");
    } else {
      findings.note(item, "has no mesh; it stands between joints");
    }
  }
}

void look_at_inertia(const Link& link, Findings& findings) {
  // Of the diagonal of the link's box; a solid box has 1/sqrt(12) = 0.29 of it, whatever its shape.
  constexpr double kSmallestGyration = 0.05;
  constexpr double kLargestGyration = 1.0;
  constexpr double kOutside = 0.5;
  constexpr double kSlack = 1e-3;  // of the largest moment: rounding of the text
  if (!link.inertia || link.inertia->mass == 0.0 || link.mesh_L.faces.empty()) return;
  const std::string item = "link " + link.name;
  const Eigen::AlignedBox3d box = geometry::bounding_box(link.mesh_L);
  const double diagonal = box.diagonal().norm();
  const double outside = box.exteriorDistance(link.inertia->center_L);
  if (outside > kOutside * diagonal) {
    findings.suspicious(item, "its center of mass lies " + rounded(outside) +
                                  " m outside its mesh, which is " + rounded(diagonal) + " m long");
  }
  if (link.inertia->inertia_L.isZero(0.0)) return;
  const Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(link.inertia->inertia_L).eigenvalues();
  const double slack = kSlack * moments[2];
  if (moments[0] < -slack || moments[2] > moments[0] + moments[1] + slack) {
    findings.suspicious(item, "no body has the principal moments of inertia " +
                                  rounded(moments[0]) + ", " + rounded(moments[1]) + ", " +
                                  rounded(moments[2]) + " kg m^2");
    return;
  }
  const double gyration = std::sqrt(0.5 * moments.sum() / link.inertia->mass);
  if (gyration < kSmallestGyration * diagonal || gyration > kLargestGyration * diagonal) {
    findings.suspicious(item, "its inertia is that of a body with a radius of gyration of " +
                                  rounded(gyration) + " m, but its mesh is " + rounded(diagonal) +
                                  " m long; are its units kg m^2?");
  }
}

void look_at_masses(const HandModel& tree, Findings& findings) {
  std::vector<std::string> without;
  std::size_t num_bodies = 0;
  for (const Link& link : tree.links) {
    look_at_inertia(link, findings);
    if (link.mesh_L.faces.empty()) continue;
    ++num_bodies;
    if (!link.inertia || link.inertia->mass == 0.0) without.push_back(link.name);
  }
  if (without.empty()) return;
  findings.note("", std::to_string(without.size()) + " of " + std::to_string(num_bodies) +
                        " links with a mesh have no mass: " + listed(without));
}

// ---- Couplings
// ------------------------------------------------------------------------------------

std::string advice(const Joint& follower, const Joint& leader, double ratio) {
  return "; if it does, add {\"joint\": \"" + follower.name + "\", \"leader\": \"" + leader.name +
         "\", \"ratio\": " + rounded(ratio) + "} to the sidecar's couplings, if not, an empty list";
}

/// The end of a finger and the joint before it, if both are free and flex in one plane.
std::vector<std::pair<int, int>> free_end_pairs(const JointTree& joints) {
  std::vector<std::pair<int, int>> pairs;
  for (int j = 0; j < joints.num_joints(); ++j) {
    const int before = joints.above(j);
    if (before < 0 || !joints.next(j).empty() || !joints.is_free(j) || !joints.is_free(before) ||
        !joints.is_revolute(j) || !joints.is_revolute(before) || !joints.are_parallel(j, before)) {
      continue;
    }
    pairs.emplace_back(before, j);
  }
  return pairs;
}

/// Joints from `j` on, as long as they do not branch.
std::vector<int> chain_from(const JointTree& joints, int j) {
  std::vector<int> chain = {j};
  for (auto next = joints.next(j); next.size() == 1; next = joints.next(next[0])) {
    chain.push_back(next[0]);
  }
  return chain;
}

/// Whether the plane halfway between the parallel axes of two joints mirrors the joints after the
/// one onto those after the other, at zero.
bool are_mirrored(const JointTree& joints, int a, int b) {
  constexpr double kSamePlace = 2e-3;  // [m]; CAD of twin fingers differs by tenths of a mm
  const std::vector<int> of_a = chain_from(joints, a);
  const std::vector<int> of_b = chain_from(joints, b);
  if (of_a.size() != of_b.size() || of_a.size() < 2) return false;
  const Vector3d axis = joints.axis(a);
  Vector3d between = joints.point(b) - joints.point(a);
  between -= between.dot(axis) * axis;
  if (between.norm() < kSamePlace) return false;
  const Vector3d normal = between.normalized();
  const Vector3d middle = 0.5 * (joints.point(a) + joints.point(b));
  for (std::size_t k = 0; k < of_a.size(); ++k) {
    constexpr double kSameDirection = 0.02;  // [rad]
    const Vector3d direction_a = joints.axis(of_a[k]);
    const Vector3d mirrored = direction_a - 2.0 * normal.dot(direction_a) * normal;
    const Vector3d direction_b = joints.axis(of_b[k]);
    if (mirrored.cross(direction_b).norm() > kSameDirection) return false;
    const Vector3d point_a = joints.point(of_a[k]);
    const Vector3d image = point_a - 2.0 * normal.dot(point_a - middle) * normal;
    if ((image - joints.point(of_b[k])).cross(direction_b).norm() > kSamePlace) return false;
  }
  return true;
}

void look_for_lost_couplings(const JointTree& joints, Findings& findings) {
  constexpr double kShortRange = 0.5;                    // of the joint before
  constexpr double kWideSwing = 0.5 * std::numbers::pi;  // [rad]
  constexpr double kSameAngle = 0.02;                    // [rad]; limits with two digits
  constexpr double kSameStroke = 1e-4;                   // [m]
  constexpr int kMostDrives = 20;
  bool is_suspicious = false;
  const auto suspicious = [&](const Joint& joint, const std::string& what) {
    findings.suspicious("joint " + joint.name, what);
    is_suspicious = true;
  };
  const std::vector<std::pair<int, int>> ends = free_end_pairs(joints);
  for (const auto& [before, end] : ends) {
    const double ratio = joints.range(end) / joints.range(before);
    if (!(ratio > 0.0 && ratio < kShortRange)) continue;
    suspicious(joints.joint(end),
               "has " + rounded(ratio) + " of the range of joint " + joints.joint(before).name +
                   " before it, about a parallel axis, and is independent: it looks like a geared "
                   "end joint that should follow" +
                   advice(joints.joint(end), joints.joint(before), ratio));
  }
  const std::vector<int> on_root = joints.next(-1);
  for (std::size_t i = 0; i < on_root.size(); ++i) {
    for (std::size_t k = i + 1; k < on_root.size(); ++k) {
      const int a = on_root[i];
      const int b = on_root[k];
      if (!joints.is_free(a) || !joints.is_free(b) || !joints.are_parallel(a, b)) continue;
      const double difference = std::abs(joints.range(a) - joints.range(b));
      // A mirror image turns the other way about an axis in the mirror, and slides the other way
      // along an axis across it.
      const double mirrored_ratio = joints.axis(a).dot(joints.axis(b)) > 0.0 ? -1.0 : 1.0;
      if (joints.is_revolute(a) && joints.is_revolute(b)) {
        const std::vector<int> after = joints.next(a);
        const bool is_swing = after.size() == 1 && !joints.are_parallel(a, after[0]);
        if (!is_swing || difference > kSameAngle || joints.range(a) < kWideSwing - kSameAngle ||
            !are_mirrored(joints, a, b)) {
          continue;
        }
        suspicious(joints.joint(b), "swings a mirror image of the finger of joint " +
                                        joints.joint(a).name + " by " + rounded(joints.range(a)) +
                                        " rad, and both are independent: it looks like one spread "
                                        "that both should share" +
                                        advice(joints.joint(b), joints.joint(a), mirrored_ratio));
      } else if (!joints.is_revolute(a) && !joints.is_revolute(b) && difference < kSameStroke &&
                 joints.next(a).empty() && joints.next(b).empty()) {
        suspicious(joints.joint(b),
                   "slides as far as joint " + joints.joint(a).name +
                       ", parallel to it, and both are independent: they look like the two jaws of "
                       "a gripper with one drive" +
                       advice(joints.joint(b), joints.joint(a), mirrored_ratio));
      }
    }
  }
  const bool has_coupling =
      std::any_of(joints.tree().joints.begin(), joints.tree().joints.end(),
                  [](const Joint& joint) { return joint.coupling.has_value(); });
  if (has_coupling || is_suspicious || ends.empty()) return;
  std::vector<std::string> pairs;
  for (const auto& [before, end] : ends) {
    pairs.push_back(joints.joint(end).name + " after " + joints.joint(before).name);
  }
  const std::string what =
      "no joint follows another; where end joints of this hand follow the "
      "joints before them (" +
      listed(pairs) + "), add couplings to the sidecar, else an empty list";
  if (joints.num_joints() > kMostDrives) {
    findings.suspicious("", std::to_string(joints.num_joints()) +
                                " independent joints are more than any built hand drives: " + what);
  } else {
    findings.note("", what);
  }
}

// ---- Closing
// --------------------------------------------------------------------------------------

/// The position of a joint at the end of its closing.
double closed_position(const Joint& joint) {
  return joint.closing_sign > 0 ? joint.upper : joint.lower;
}

constexpr int kClosingSteps = 16;  // per range: under 10 degrees each

/// Whether a joint's travel, all others open, takes the pad along where it looks or backward.
void look_at_closing_joint(const HandModel& hand, int j, Findings& findings) {
  constexpr double kShortestTurn = 0.1;    // [rad]
  constexpr double kShortestSlide = 1e-3;  // [m]
  constexpr double kBackward = -0.5;       // of the path: more backward than sideways
  const Joint& joint = hand.joints[static_cast<std::size_t>(j)];
  const std::string item = "joint " + joint.name;
  const double travel = joint.upper - joint.lower;
  const bool is_revolute = joint.type == JointType::Revolute;
  if (travel < (is_revolute ? kShortestTurn : kShortestSlide)) {
    findings.suspicious(item, "closes by " + rounded(travel) + (is_revolute ? " rad" : " m") +
                                  " only: its limits keep it from closing");
    return;
  }
  for (const Finger& finger : hand.fingers) {
    const bool is_mine =
        std::find(finger.joints.begin(), finger.joints.end(), j) != finger.joints.end();
    if (!is_mine || finger.tip_pad < 0) continue;
    HandConfiguration c = open_configuration(hand);
    const double from = c.q[j];
    RigidTransform X_last = pad_pose(hand, finger.tip_pad, forward_kinematics(hand, c));
    double forward = 0.0;
    double path = 0.0;
    for (int step = 1; step <= kClosingSteps; ++step) {
      c.q[j] = from + (closed_position(joint) - from) * step / kClosingSteps;
      apply_couplings(hand, c.q);
      const RigidTransform X_OC = pad_pose(hand, finger.tip_pad, forward_kinematics(hand, c));
      const Vector3d moved = X_OC.translation() - X_last.translation();
      forward += moved.dot(X_last.linear().col(2));
      path += moved.norm();
      X_last = X_OC;
    }
    if (forward < kBackward * path) {
      findings.suspicious(item, "its closing sign " + std::to_string(joint.closing_sign) +
                                    " takes the pad of finger " + finger.name +
                                    " backward, away from what it should touch");
    }
  }
}

/// How near a finger's tip comes when it closes, over how near it is when open: to the palm's
/// center line, the palm center, and the tips of the other fingers, which close too.
void look_at_closing_finger(const HandModel& hand, std::size_t f, Findings& findings) {
  constexpr double kNearer = 0.9;
  const Finger& finger = hand.fingers[f];
  const std::string item = "finger " + finger.name;
  const bool closes = std::any_of(finger.joints.begin(), finger.joints.end(), [&](int j) {
    return hand.joints[static_cast<std::size_t>(j)].closing_sign != 0;
  });
  if (!closes) {
    findings.suspicious(item, "has no joint that closes: list one under closing in the sidecar");
    return;
  }
  if (finger.tip_pad < 0) return;
  const HandConfiguration open = open_configuration(hand);
  const auto distances = [&](int step) {
    HandConfiguration c = open;
    for (std::size_t j = 0; j < hand.joints.size(); ++j) {
      if (hand.joints[j].closing_sign == 0) continue;
      double& q = c.q[static_cast<Eigen::Index>(j)];
      q += (closed_position(hand.joints[j]) - q) * step / kClosingSteps;
    }
    apply_couplings(hand, c.q);
    const auto X_OL = forward_kinematics(hand, c);
    const Vector3d tip = pad_pose(hand, finger.tip_pad, X_OL).translation();
    const Vector3d from_center = tip - hand.palm.center_H;
    std::vector<double> result = {from_center.norm(),
                                  from_center.cross(hand.palm.direction_H).norm()};
    for (std::size_t other = 0; other < hand.fingers.size(); ++other) {
      if (other == f || hand.fingers[other].tip_pad < 0) continue;
      result.push_back(
          (pad_pose(hand, hand.fingers[other].tip_pad, X_OL).translation() - tip).norm());
    }
    return result;
  };
  const std::vector<double> when_open = distances(0);
  for (int step = 1; step <= kClosingSteps; ++step) {
    const std::vector<double> now = distances(step);
    for (std::size_t k = 0; k < now.size(); ++k) {
      if (now[k] < kNearer * when_open[k]) return;
    }
  }
  findings.suspicious(item,
                      "does not close: from open to closed its tip comes no nearer to the palm or "
                      "to another tip; its closing signs or limits are wrong");
}

void look_for_tips_that_never_meet(const HandModel& hand, Findings& findings) {
  if (hand.fingers.size() < 2) {
    findings.suspicious("", "one finger only: nothing to hold an object against but the palm");
    return;
  }
  // Whether tips face each other at all needs no fine grid: its ends are moved on.
  constexpr std::int64_t kCoarse = std::int64_t{1} << 16;
  const HandWorkspace workspace = hand_workspace(hand, {.max_configurations = kCoarse});
  const auto thumb = static_cast<std::size_t>(hand.thumb());
  const std::string thumb_name = hand.fingers[thumb].name;
  if (workspace.any_graspable_diameter.largest <= 0.0) {
    findings.suspicious("finger " + thumb_name,
                        "no ball fits between its tip pad and that of any other finger: they never "
                        "face each other");
    return;
  }
  for (std::size_t f = 0; f < hand.fingers.size(); ++f) {
    if (f == thumb || workspace.graspable_diameter[f].largest > 0.0) continue;
    findings.note("finger " + hand.fingers[f].name,
                  "no ball fits between its tip pad and that of " + thumb_name);
  }
}

// ---- The whole hand
// -------------------------------------------------------------------------------

void look_for_overlaps(const HandModel& hand, Findings& findings) {
  const auto overlap =
      HandCollision(hand).against_self(forward_kinematics(hand, open_configuration(hand)));
  if (!overlap.intersects) return;
  const auto name = [&](int link) { return hand.links[static_cast<std::size_t>(link)].name; };
  findings.suspicious("link " + name(overlap.link_a),
                      "overlaps link " + name(overlap.link_b) + " by " +
                          rounded(overlap.depth * 1e3) +
                          " mm in the open configuration; exclude the pair from collision in the "
                          "sidecar if that is how they are built");
}

void tell_exclusions(const HandModel& hand, Findings& findings) {
  std::vector<std::string> pairs;
  for (const CollisionExclusion& pair : hand.exclusions) {
    pairs.push_back(hand.links[static_cast<std::size_t>(pair.link_a)].name + " - " +
                    hand.links[static_cast<std::size_t>(pair.link_b)].name);
  }
  findings.note("", std::to_string(pairs.size()) + " pairs of links are excluded from collision" +
                        (pairs.empty() ? "" : ": " + listed(pairs)));
}

void tell_idle_joints(const HandModel& hand, Findings& findings) {
  std::vector<std::string> idle;
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const bool is_used =
        std::any_of(hand.fingers.begin(), hand.fingers.end(), [&](const Finger& finger) {
          return std::find(finger.joints.begin(), finger.joints.end(), static_cast<int>(j)) !=
                 finger.joints.end();
        });
    if (!is_used) idle.push_back(hand.joints[j].name);
  }
  if (!idle.empty()) findings.note("", "joints that belong to no finger: " + listed(idle));
}

void look_at_whole(const HandModel& hand, Findings& findings) {
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    if (hand.joints[j].closing_sign != 0 && !hand.joints[j].coupling) {
      look_at_closing_joint(hand, static_cast<int>(j), findings);
    }
  }
  for (std::size_t f = 0; f < hand.fingers.size(); ++f) look_at_closing_finger(hand, f, findings);
  look_for_tips_that_never_meet(hand, findings);
  look_for_overlaps(hand, findings);
  tell_exclusions(hand, findings);
  tell_idle_joints(hand, findings);
}

}  // namespace

std::size_t HandCheck::count(FindingKind kind) const {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [&](const HandFinding& finding) { return finding.kind == kind; }));
}

HandCheck check_hand(const std::filesystem::path& description_file) {
  Findings findings(Findings::AtFault::Collect);
  const internal::HandSources sources = internal::read_sources(description_file, findings);
  HandCheck check;
  check.model = internal::assemble(sources, findings);
  if (sources.tree) {
    const JointTree joints(*sources.tree);
    std::set<std::string> has_geometry;
    for (const internal::DescribedLink& link : sources.description.links) {
      if (!link.visual.empty() || !link.collision.empty()) has_geometry.insert(link.name);
    }
    look_for_missing_meshes(joints, has_geometry, findings);
    look_at_masses(*sources.tree, findings);
    if (!sources.sidecar.couplings) look_for_lost_couplings(joints, findings);
  }
  if (check.model) {
    findings.attempt([&] { look_at_whole(*check.model, findings); });
  }
  check.findings = findings.list();
  std::stable_sort(check.findings.begin(), check.findings.end(),
                   [](const HandFinding& a, const HandFinding& b) { return a.kind < b.kind; });
  return check;
}

}  // namespace graspfit::hands
