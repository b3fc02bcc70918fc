#include "graspfit/hands/hand_check.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "check/coupling_check.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_closing.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_workspace.hpp"
#include "library/hand_assembly.hpp"
#include "model/finding_text.hpp"
#include "model/findings.hpp"
#include "model/hand_size.hpp"
#include "model/joint_tree.hpp"

namespace graspfit::hands {

namespace {

using Eigen::Vector3d;
using internal::Findings;
using internal::JointTree;
using internal::rounded;

// ---- Links
// ----------------------------------------------------------------------------------------

/// Reports bodies without mesh. `has_geometry` are the links whose description names a shape,
/// whether or not it could be read.
void report_missing_meshes(const JointTree& joints, const std::set<std::string>& has_geometry,
                           Findings& findings) {
  // A body is the links that move as one, named by the joint that moves them; the root's comes
  // first.
  std::vector<std::optional<int>> bodies = {std::nullopt};
  for (int j = 0; j < joints.num_joints(); ++j) bodies.emplace_back(j);
  for (const std::optional<int>& body : bodies) {
    bool has_mesh = false;
    std::vector<std::string> names;
    for (int l = 0; l < std::ssize(joints.tree().links); ++l) {
      if (joints.above_link(l) != body) continue;
      names.push_back(joints.tree().links[l].name);
      has_mesh = has_mesh || has_geometry.contains(names.back());
    }
    if (has_mesh) continue;
    const std::string item = "link " + names[0];
    if (!body) {
      findings.suspicious(item, "the palm has no mesh: nothing collides with it or touches it");
    } else if (joints.next(body).empty()) {
      findings.suspicious(item, "has no mesh, and the hand ends there: nothing to touch with");
    } else {
      findings.note(item, "has no mesh; it stands between joints");
    }
  }
}

void check_inertia(const Link& link, Findings& findings) {
  // Radii of gyration relative to the diagonal of the link's box; a solid box has 1/sqrt(12)
  // = 0.29, whatever its shape.
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

void check_masses(const HandModel& tree, Findings& findings) {
  std::vector<std::string> without;
  std::size_t num_bodies = 0;
  for (const Link& link : tree.links) {
    check_inertia(link, findings);
    if (link.mesh_L.faces.empty()) continue;
    ++num_bodies;
    if (!link.inertia || link.inertia->mass == 0.0) without.push_back(link.name);
  }
  if (without.empty()) return;
  findings.note("", std::to_string(without.size()) + " of " + std::to_string(num_bodies) +
                        " links with a mesh have no mass: " + base::list_text(without));
}

// ---- Closing
// --------------------------------------------------------------------------------------

constexpr int kClosingSteps = 16;  // per range: under 10 degrees each

/// Reports a joint that closes by too little, or moves the pad backward, against its normal, while
/// all other joints are open.
void check_closing_joint(const HandModel& hand, int j, Findings& findings) {
  constexpr double kShortestTurn = 0.1;    // [rad]
  constexpr double kShortestSlide = 1e-3;  // [m]
  constexpr double kBackward = -0.5;       // of the path: more backward than sideways
  const Joint& joint = hand.joints[j];
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
    if (!is_mine || !finger.tip_pad) continue;
    HandConfiguration c = open_configuration(hand);
    const double from = c.q[j];
    RigidTransform X_last = pad_pose(hand, *finger.tip_pad, forward_kinematics(hand, c));
    double forward = 0.0;
    double path = 0.0;
    for (int step = 1; step <= kClosingSteps; ++step) {
      c.q[j] = from + (joint.closed_limit() - from) * step / kClosingSteps;
      apply_couplings(hand, c.q);
      const RigidTransform X_OC = pad_pose(hand, *finger.tip_pad, forward_kinematics(hand, c));
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

/// Reports a finger whose tip does not come nearer when it closes than when it is open: to the
/// palm's center line, to the palm center, or to the tips of the other fingers, which close too.
void check_closing_finger(const HandModel& hand, int f, Findings& findings) {
  constexpr double kNearer = 0.9;
  const Finger& finger = hand.fingers[f];
  const std::string item = "finger " + finger.name;
  const bool closes = std::any_of(finger.joints.begin(), finger.joints.end(),
                                  [&](int j) { return hand.joints[j].closing_sign != 0; });
  if (!closes) {
    findings.suspicious(item, "has no joint that closes: list one under closing in the sidecar");
    return;
  }
  if (!finger.tip_pad) return;
  const HandConfiguration open = open_configuration(hand);
  const auto distances = [&](int step) {
    HandConfiguration c = open;
    for (std::size_t j = 0; j < hand.joints.size(); ++j) {
      if (hand.joints[j].closing_sign == 0) continue;
      double& q = c.q[j];
      q += (hand.joints[j].closed_limit() - q) * step / kClosingSteps;
    }
    apply_couplings(hand, c.q);
    const auto X_OL = forward_kinematics(hand, c);
    const Vector3d tip = pad_pose(hand, *finger.tip_pad, X_OL).translation();
    const Vector3d from_center = tip - hand.palm.center_H;
    std::vector<double> result = {from_center.norm(),
                                  from_center.cross(hand.palm.direction_H).norm()};
    for (int other = 0; other < std::ssize(hand.fingers); ++other) {
      if (other == f || !hand.fingers[other].tip_pad) continue;
      result.push_back(
          (pad_pose(hand, *hand.fingers[other].tip_pad, X_OL).translation() - tip).norm());
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

/// Reports fingers that self-collision keeps open: closing the hand leaves them straight.
void report_blocked_fingers(const HandModel& hand, Findings& findings) {
  constexpr double kStillOpen = 0.1;  // of the closing motion
  const auto name = [&](int link) { return hand.links[link].name; };
  for (const ClosingStop& stop : closing_stops(hand, 1.0)) {
    if (!stop.finger || stop.share >= kStillOpen) continue;
    const std::string a = name(stop.link_a);
    const std::string b = name(stop.link_b);
    findings.suspicious("finger " + hand.fingers[*stop.finger].name,
                        "closing leaves it open: after " + rounded(100.0 * stop.share) +
                            " % of its way link " + a + " meets link " + b +
                            "; if that is how they are built, exclude the pair from collision in "
                            "the sidecar: \"exclusions\": [[\"" +
                            a + "\", \"" + b + "\"]]");
  }
}

void report_tips_that_never_meet(const HandModel& hand, Findings& findings) {
  if (hand.fingers.size() < 2) {
    findings.suspicious("", "one finger only: nothing to hold an object against but the palm");
    return;
  }
  // A coarse grid shows whether tips face each other at all, since local search improves its ends.
  constexpr std::int64_t kCoarse = std::int64_t{1} << 16;
  const HandWorkspace workspace = hand_workspace(hand, {.max_configurations = kCoarse});
  const int thumb = hand.thumb();
  const std::string thumb_name = hand.fingers[thumb].name;
  if (workspace.any_graspable_diameter.largest <= 0.0) {
    findings.suspicious("finger " + thumb_name,
                        "no ball fits between its tip pad and that of any other finger: they never "
                        "face each other");
    return;
  }
  for (int f = 0; f < std::ssize(hand.fingers); ++f) {
    if (f == thumb || workspace.graspable_diameter[f].largest > 0.0) continue;
    findings.note("finger " + hand.fingers[f].name,
                  "no ball fits between its tip pad and that of " + thumb_name);
  }
}

// ---- The whole hand
// -------------------------------------------------------------------------------

void report_overlaps(const HandModel& hand, Findings& findings) {
  const auto overlap =
      HandCollision(hand).against_self(forward_kinematics(hand, open_configuration(hand)));
  if (!overlap.intersects) return;
  const auto name = [&](int link) { return hand.links[link].name; };
  findings.suspicious("link " + name(*overlap.link_a),
                      "overlaps link " + name(*overlap.link_b) + " by " +
                          rounded(overlap.depth * 1e3) +
                          " mm in the open configuration; exclude the pair from collision in the "
                          "sidecar if that is how they are built");
}

void tell_exclusions(const HandModel& hand, Findings& findings) {
  std::vector<std::string> pairs;
  for (const CollisionExclusion& pair : hand.exclusions) {
    pairs.push_back(hand.links[pair.link_a].name + " - " + hand.links[pair.link_b].name);
  }
  findings.note("", std::to_string(pairs.size()) + " pairs of links are excluded from collision" +
                        (pairs.empty() ? "" : ": " + base::list_text(pairs)));
}

void tell_idle_joints(const HandModel& hand, Findings& findings) {
  std::vector<std::string> idle;
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    const bool is_used =
        std::any_of(hand.fingers.begin(), hand.fingers.end(), [&](const Finger& finger) {
          return std::find(finger.joints.begin(), finger.joints.end(), j) != finger.joints.end();
        });
    if (!is_used) idle.push_back(hand.joints[j].name);
  }
  if (!idle.empty()) findings.note("", "joints that belong to no finger: " + base::list_text(idle));
}

void check_whole(const HandModel& hand, Findings& findings) {
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    if (hand.joints[j].closing_sign != 0 && !hand.joints[j].coupling) {
      check_closing_joint(hand, j, findings);
    }
  }
  for (int f = 0; f < std::ssize(hand.fingers); ++f) check_closing_finger(hand, f, findings);
  report_tips_that_never_meet(hand, findings);
  report_overlaps(hand, findings);
  report_blocked_fingers(hand, findings);
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
    report_missing_meshes(joints, has_geometry, findings);
    check_masses(*sources.tree, findings);
    if (!sources.sidecar.couplings) internal::report_lost_couplings(joints, findings);
  }
  const bool is_hand_sized = sources.tree && !findings.has_faults() &&
                             internal::extent_at_rest(*sources.tree) <= internal::kLargestHand;
  if (check.model && is_hand_sized) {
    findings.attempt([&] { check_whole(*check.model, findings); });
  } else if (check.model) {
    findings.note("", "how it closes is looked at once its lengths are meters");
  }
  check.findings = findings.list();
  std::stable_sort(check.findings.begin(), check.findings.end(),
                   [](const HandFinding& a, const HandFinding& b) { return a.kind < b.kind; });
  return check;
}

}  // namespace graspfit::hands
