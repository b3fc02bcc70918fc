#include "import/mesh_borrowing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "import/hand_tree.hpp"
#include "import/urdf.hpp"
#include "model/joint_tree.hpp"

namespace graspfit::hands::internal {

namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// Largest differences of two lines that count as the same axis. Rotations are written with four
/// decimals, an error of 5e-5 each, which over the 0.2 m of a finger is 1e-5 m.
constexpr double kSameDirection = 5e-4;  // [rad]
constexpr double kSamePlace = 5e-5;      // [m]
/// Largest difference of limits of equal width, which are written with three digits.
constexpr double kSameWidth = 1e-3;  // [rad] or [m]

struct AxisLine {
  Vector3d point;
  Vector3d direction;  ///< Unit.
};

double distance(const AxisLine& a, const Vector3d& point) {
  return (point - a.point).cross(a.direction).norm();
}

bool are_parallel(const AxisLine& a, const AxisLine& b) {
  return a.direction.cross(b.direction).norm() < kSameDirection;
}

/// A tree of joints, and the joint positions at which it is compared.
struct Skeleton : JointTree {
  explicit Skeleton(const HandModel& tree)
      : JointTree(tree), q(Eigen::VectorXd::Zero(std::ssize(tree.joints))) {}

  std::vector<RigidTransform> poses() const {
    return forward_kinematics(tree(), {.X_OH = RigidTransform::Identity(), .q = q});
  }

  /// A joint's axis in the root link's frame.
  AxisLine axis_line(int index) const {
    const RigidTransform X_HJ = poses()[joint(index).parent_link] * joint(index).X_PJ;
    return {X_HJ.translation(), X_HJ.linear() * joint(index).axis_J};
  }

  Eigen::VectorXd q;
};

/// Finds the joint of `theirs` for every joint of `ours`, and the positions of the joints of
/// `theirs` at which both trees have the same pose while the joints of `ours` are at zero.
class JointMatcher {
 public:
  JointMatcher(const Skeleton& ours, Skeleton& theirs)
      : ours_(ours), theirs_(theirs), match_(ours.tree().joints.size()) {}

  /// Matches the joints. Empty if they match, else the reason why they do not.
  std::optional<std::string> find() {
    if (ours_.tree().joints.size() != theirs_.tree().joints.size()) {
      return "it has " + std::to_string(theirs_.tree().joints.size()) + " joints, not " +
             std::to_string(ours_.tree().joints.size());
    }
    if (match_after(std::nullopt, std::nullopt)) return std::nullopt;
    return "no joint of it stands where " + unmatched_ + " does";
  }

  const std::vector<std::optional<int>>& match() const { return match_; }

 private:
  bool match_after(std::optional<int> our_joint, std::optional<int> their_joint) {
    const std::vector<int> ours = ours_.next(our_joint);
    const std::vector<int> theirs = theirs_.next(their_joint);
    if (ours.size() != theirs.size()) {
      if (!ours.empty()) unmatched_ = "joint " + ours_.joint(ours[0]).name;
      return false;
    }
    std::vector<bool> taken(theirs.size(), false);
    for (const int a : ours) {
      bool found = false;
      for (std::size_t k = 0; k < theirs.size() && !found; ++k) {
        if (taken[k] || !stand_alike(a, theirs[k])) continue;
        found = taken[k] = match_from(a, theirs[k]);
      }
      if (!found) {
        if (unmatched_.empty()) unmatched_ = "joint " + ours_.joint(a).name;
        return false;
      }
    }
    return true;
  }

  bool match_from(int a, int b) {
    for (const double position : candidates(a, b)) {
      theirs_.q[b] = position;
      unmatched_.clear();
      if (match_after(a, b)) {
        match_[a] = b;
        return true;
      }
    }
    theirs_.q[b] = 0.0;
    return false;
  }

  bool stand_alike(int a, int b) const {
    if (ours_.joint(a).type != theirs_.joint(b).type) return false;
    const AxisLine ours = ours_.axis_line(a);
    const AxisLine theirs = theirs_.axis_line(b);
    // The position of a prismatic joint's axis does not matter.
    return are_parallel(ours, theirs) && (ours_.joint(a).type == JointType::Prismatic ||
                                          distance(ours, theirs.point) < kSamePlace);
  }

  /// Positions of joint b of `theirs` that could correspond to zero of joint a of `ours`, the
  /// likeliest first.
  std::vector<double> candidates(int a, int b) const {
    const std::vector<int> ours = ours_.next(a);
    const std::vector<int> theirs = theirs_.next(b);
    if (ours.empty()) return {position_by_limits(a, b)};
    std::vector<double> positions = {0.0};
    const AxisLine target = ours_.axis_line(ours[0]);
    for (const int next : theirs) {
      const std::vector<double> more = positions_that_align(b, target, theirs_.axis_line(next));
      positions.insert(positions.end(), more.begin(), more.end());
    }
    return positions;
  }

  double position_by_limits(int a, int b) const {
    const Joint& ours = ours_.joint(a);
    const Joint& theirs = theirs_.joint(b);
    const double width = ours.upper - ours.lower;
    if (std::abs(width - (theirs.upper - theirs.lower)) > kSameWidth) return 0.0;
    const bool is_same_way = ours_.axis_line(a).direction.dot(theirs_.axis_line(b).direction) > 0.0;
    return is_same_way ? theirs.lower - ours.lower : theirs.upper + ours.lower;
  }

  /// Positions of joint b that bring the line `from`, which it moves, onto `to`, if any do.
  std::vector<double> positions_that_align(int b, const AxisLine& to, const AxisLine& from) const {
    const AxisLine axis = theirs_.axis_line(b);
    const double at = theirs_.q[b];
    const Vector3d& z = axis.direction;
    if (theirs_.joint(b).type == JointType::Prismatic) {
      // The joint moves `from` along z until the lines meet: the part of the offset across `to`
      // must vanish.
      const Vector3d across = z - z.dot(to.direction) * to.direction;
      if (across.norm() < kSameDirection) return {};
      return {at + (to.point - from.point).dot(across) / across.squaredNorm()};
    }
    // The angle is measured in the plane normal to the axis, between the directions of the lines,
    // or between their points if the lines are parallel to the axis.
    const auto flat = [&](const Vector3d& v) { return Vector3d(v - z.dot(v) * z); };
    const auto angle = [&](const Vector3d& u, const Vector3d& v) {
      return std::atan2(z.dot(u.cross(v)), u.dot(v));
    };
    Vector3d u = flat(from.direction);
    Vector3d v = flat(to.direction);
    const bool is_parallel = u.norm() < kSameDirection;
    if (is_parallel) {
      u = flat(from.point - axis.point);
      v = flat(to.point - axis.point);
      if (u.norm() < kSamePlace) return {};
      return {at + angle(u, v)};
    }
    return {at + angle(u, v), at + angle(-u, v)};
  }

  const Skeleton& ours_;
  Skeleton& theirs_;
  std::vector<std::optional<int>> match_;  ///< Per joint of ours; empty where none was found.
  std::string unmatched_;                  ///< The joint of ours at which the last attempt ended.
};

LinkInertia moved(const LinkInertia& inertia, const RigidTransform& X) {
  return {inertia.mass, X * inertia.center_L,
          X.linear() * inertia.inertia_L * X.linear().transpose()};
}

std::string name_of(const DescribedGeometry& part) {
  const auto* mesh = std::get_if<MeshFileShape>(&part.shape);
  return mesh ? mesh->filename : "a primitive";
}

/// The first link that is no child of a joint: the whole tree is compared, not only from the palm
/// on.
std::optional<std::string> root_of(const RobotDescription& description) {
  for (const DescribedLink& link : description.links) {
    if (std::none_of(description.joints.begin(), description.joints.end(),
                     [&](const DescribedJoint& joint) { return joint.child == link.name; })) {
      return link.name;
    }
  }
  return std::nullopt;
}

/// The only URDF in a folder.
fs::path urdf_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".urdf") found.push_back(entry.path());
  }
  if (found.size() != 1) {
    throw base::InvalidInput("there are " + std::to_string(found.size()) +
                             " URDF files beside it, not one");
  }
  return found[0];
}

RobotDescription borrowed(const fs::path& file, RobotDescription description, Findings& findings) {
  const fs::path folder = fs::absolute(file).parent_path();
  const fs::path urdf_file = urdf_in(folder);
  Findings strict(Findings::AtFault::Throw);  // suspicious joints of the URDF do not matter
  const RobotDescription urdf = parse_urdf(base::read_file(urdf_file), urdf_file.string(), strict);
  const HandModel our_tree = *build_tree(description, file.string(), root_of(description), strict);
  const HandModel their_tree = *build_tree(urdf, urdf_file.string(), root_of(urdf), strict);
  const Skeleton ours(our_tree);
  Skeleton theirs(their_tree);
  JointMatcher matcher(ours, theirs);
  if (const auto why = matcher.find()) {
    throw base::InvalidInput(urdf_file.filename().string() + ": " + *why);
  }
  const std::vector<RigidTransform> X_HL = ours.poses();
  const std::vector<RigidTransform> X_HU = theirs.poses();
  for (DescribedLink& link : description.links) {
    if (!link.visual.empty() || !link.collision.empty()) continue;
    const int l = our_tree.link_index(link.name);
    std::optional<int> body;
    if (const auto above = ours.above_link(l)) {
      body = matcher.match()[*above];
    }
    std::vector<const DescribedLink*> with_inertia;
    RigidTransform X_with_inertia = RigidTransform::Identity();
    std::string names;
    for (const DescribedLink& source : urdf.links) {
      const int u = their_tree.link_index(source.name);
      if (theirs.above_link(u) != body) continue;
      const RigidTransform X_LU = geometry::relative_pose(X_HL[l], X_HU[u]);
      for (DescribedGeometry part : source.collision.empty() ? source.visual : source.collision) {
        part.X_LG = X_LU * part.X_LG;
        names += (names.empty() ? "" : ", ") + name_of(part);
        link.collision.push_back(std::move(part));
      }
      if (!source.inertia) continue;
      with_inertia.push_back(&source);
      X_with_inertia = X_LU;
    }
    if (with_inertia.size() == 1) link.inertia = moved(*with_inertia[0]->inertia, X_with_inertia);
    if (!names.empty()) {
      findings.note("link " + link.name, "its mesh is not there; taken from " +
                                             urdf_file.filename().string() +
                                             ", whose joints stand in the same places: " + names);
    }
  }
  return description;
}

}  // namespace

RobotDescription with_borrowed_meshes(const fs::path& file, const RobotDescription& description,
                                      Findings& findings) {
  try {
    return borrowed(file, description, findings);
  } catch (const base::Error& error) {
    findings.suspicious("", "link meshes are not there, and none can be taken from a URDF: " +
                                std::string(error.what()));
  }
  return description;
}

}  // namespace graspfit::hands::internal
