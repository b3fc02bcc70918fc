#include "check/coupling_check.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/base/list_text.hpp"
#include "model/finding_text.hpp"

namespace graspfit::hands::internal {

namespace {

std::string advice(const Joint& follower, const Joint& leader, double ratio) {
  return "; if it does, add {\"joint\": \"" + follower.name + "\", \"leader\": \"" + leader.name +
         "\", \"ratio\": " + rounded(ratio) + "} to the sidecar's couplings, if not, an empty list";
}

/// Pairs of the last joint of a finger and the joint before it that are free and flex in one plane.
std::vector<std::pair<int, int>> free_end_pairs(const JointTree& joints) {
  std::vector<std::pair<int, int>> pairs;
  for (int j = 0; j < joints.num_joints(); ++j) {
    const std::optional<int> before = joints.above(j);
    if (!before || !joints.next(j).empty() || !joints.is_free(j) || !joints.is_free(*before) ||
        !joints.is_revolute(j) || !joints.is_revolute(*before) ||
        !joints.are_parallel(j, *before)) {
      continue;
    }
    pairs.emplace_back(*before, j);
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
/// one onto the joints after the other, while all joints are at zero.
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

/// Reports last joints of fingers that move much less than the joint before them. Returns whether
/// there are any.
bool report_geared_ends(const JointTree& joints, const std::vector<std::pair<int, int>>& ends,
                        Findings& findings) {
  constexpr double kShortRange = 0.5;  // of the joint before
  bool is_any = false;
  for (const auto& [before, end] : ends) {
    const double ratio = joints.range(end) / joints.range(before);
    if (!(ratio > 0.0 && ratio < kShortRange)) continue;
    is_any = true;
    findings.suspicious(
        "joint " + joints.joint(end).name,
        "has " + rounded(ratio) + " of the range of joint " + joints.joint(before).name +
            " before it, about a parallel axis, and is independent: it looks like a geared "
            "end joint that should follow" +
            advice(joints.joint(end), joints.joint(before), ratio));
  }
  return is_any;
}

/// Whether two joints on the palm swing fingers that are mirror images of each other, by equal
/// angles.
bool swing_mirrored_fingers(const JointTree& joints, int a, int b) {
  constexpr double kWideSwing = 0.5 * std::numbers::pi;  // [rad]
  constexpr double kSameAngle = 0.02;                    // [rad]; limits with two digits
  if (!joints.is_revolute(a) || !joints.is_revolute(b)) return false;
  const std::vector<int> after = joints.next(a);
  const bool is_swing = after.size() == 1 && !joints.are_parallel(a, after[0]);
  return is_swing && std::abs(joints.range(a) - joints.range(b)) <= kSameAngle &&
         joints.range(a) >= kWideSwing - kSameAngle && are_mirrored(joints, a, b);
}

/// Whether two joints on the palm slide equally far and carry no further joints: jaws of a gripper.
bool slide_like_jaws(const JointTree& joints, int a, int b) {
  constexpr double kSameStroke = 1e-4;  // [m]
  return !joints.is_revolute(a) && !joints.is_revolute(b) &&
         std::abs(joints.range(a) - joints.range(b)) < kSameStroke && joints.next(a).empty() &&
         joints.next(b).empty();
}

/// Reports independent joints on the palm that look as if one drive moved them. Returns whether
/// there are any.
bool report_twins(const JointTree& joints, Findings& findings) {
  bool is_any = false;
  const std::vector<int> on_root = joints.next(std::nullopt);
  for (std::size_t i = 0; i < on_root.size(); ++i) {
    for (std::size_t k = i + 1; k < on_root.size(); ++k) {
      const int a = on_root[i];
      const int b = on_root[k];
      if (!joints.is_free(a) || !joints.is_free(b) || !joints.are_parallel(a, b)) continue;
      std::string what;
      if (swing_mirrored_fingers(joints, a, b)) {
        what = "swings a mirror image of the finger of joint " + joints.joint(a).name + " by " +
               rounded(joints.range(a)) +
               " rad, and both are independent: it looks like one spread that both should share";
      } else if (slide_like_jaws(joints, a, b)) {
        what = "slides as far as joint " + joints.joint(a).name +
               ", parallel to it, and both are independent: they look like the two jaws of a "
               "gripper with one drive";
      } else {
        continue;
      }
      // A mirror image turns in the opposite sense about an axis in the mirror's plane, and slides
      // in the opposite direction along an axis normal to it.
      const double ratio = joints.axis(a).dot(joints.axis(b)) > 0.0 ? -1.0 : 1.0;
      findings.suspicious("joint " + joints.joint(b).name,
                          what + advice(joints.joint(b), joints.joint(a), ratio));
      is_any = true;
    }
  }
  return is_any;
}

}  // namespace

void report_lost_couplings(const JointTree& joints, Findings& findings) {
  constexpr int kMostDrives = 20;
  const std::vector<std::pair<int, int>> ends = free_end_pairs(joints);
  const bool has_geared_ends = report_geared_ends(joints, ends, findings);
  const bool has_twins = report_twins(joints, findings);
  const bool has_coupling =
      std::any_of(joints.tree().joints.begin(), joints.tree().joints.end(),
                  [](const Joint& joint) { return joint.coupling.has_value(); });
  if (has_coupling || has_geared_ends || has_twins || ends.empty()) return;
  std::vector<std::string> pairs;
  for (const auto& [before, end] : ends) {
    pairs.push_back(joints.joint(end).name + " after " + joints.joint(before).name);
  }
  const std::string what =
      "no joint follows another; where end joints of this hand follow the "
      "joints before them (" +
      base::list_text(pairs) + "), add couplings to the sidecar, else an empty list";
  if (joints.num_joints() > kMostDrives) {
    findings.suspicious("", std::to_string(joints.num_joints()) +
                                " independent joints are more than any built hand drives: " + what);
  } else {
    findings.note("", what);
  }
}

}  // namespace graspfit::hands::internal
