#include "graspfit/hands/hand_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/base/number_text.hpp"
#include "model/pad_outline.hpp"

namespace graspfit::hands {

namespace {

using base::InvalidInput;
using base::shortest_decimal;
using internal::area_of;
using internal::cross;
using internal::Side;
using internal::sides;

constexpr const char* kPalmName = "palm";

/// "a, b, c" of the names of some items.
template <typename Items>
std::string names_of(const Items& items) {
  return items.empty() ? "none" : base::list_text(items, [](auto& item) { return item.name; });
}

template <typename Items>
int index_of(const HandModel& model, const Items& items, const std::string& name,
             const std::string& kind) {
  for (int i = 0; i < std::ssize(items); ++i) {
    if (items[i].name == name) return i;
  }
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(item.name);
  throw InvalidInput("hand " + model.name + ": no " + kind + " named " + name + "; there are " +
                     names_of(items) + base::did_you_mean(name, names));
}

/// Collects what every check of `validate` needs: the model, and errors that name the hand.
class Checker {
 public:
  explicit Checker(const HandModel& model) : model_(model) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput("hand " + (model_.name.empty() ? std::string("(no name)") : model_.name) +
                       ": " + what);
  }

  void require(bool condition, const std::string& what) const {
    if (!condition) fail(what);
  }

  void require_index(int index, std::size_t size, const std::string& what) const {
    require(index >= 0 && std::cmp_less(index, size),
            what + " has index " + std::to_string(index) + " of " + std::to_string(size));
  }

  void require_pose(const RigidTransform& pose, const std::string& what) const {
    require(pose.matrix().allFinite(), what + " is not finite");
    // Rotations that come from text have 12 or more digits; 1e-6 only tells them from shears.
    const Eigen::Matrix3d defect =
        pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity();
    require(defect.norm() < 1e-6 && pose.linear().determinant() > 0.0, what + " is not a rotation");
  }

  template <typename Items>
  void require_distinct_names(const Items& items, const std::string& kind) const {
    std::set<std::string> seen;
    for (const auto& item : items) {
      require(!item.name.empty(), kind + " without a name");
      require(seen.insert(item.name).second, "two " + kind + "s named " + item.name);
    }
  }

  void inertia(const Link& link) const {
    if (!link.inertia) return;
    const std::string what = "link " + link.name + ": ";
    require(std::isfinite(link.inertia->mass) && link.inertia->mass >= 0.0,
            what + "mass " + shortest_decimal(link.inertia->mass) + " is negative or not finite");
    require(link.inertia->center_L.allFinite(), what + "center of mass is not finite");
    require(link.inertia->inertia_L.allFinite(), what + "inertia is not finite");
  }

  void links() const {
    require(!model_.links.empty(), "no links");
    require_distinct_names(model_.links, "link");
    for (int i = 0; i < std::ssize(model_.links); ++i) {
      const Link& link = model_.links[i];
      const std::string what = "link " + link.name;
      inertia(link);
      if (i == 0) {
        require(!link.parent_link && !link.parent_joint, what + ": the root has a parent");
        continue;
      }
      const int parent = link.parent_link.value_or(-1);
      require(parent >= 0 && parent < i,
              what + ": its parent link " + std::to_string(parent) + " does not come before it");
      require_pose(link.X_PL_fixed, what + ": fixed pose");
      if (!link.parent_joint) continue;
      require_index(*link.parent_joint, model_.joints.size(), what + ": parent joint");
      const Joint& joint = model_.joints[*link.parent_joint];
      require(joint.child_link == i && joint.parent_link == parent,
              what + ": joint " + joint.name + " joins other links");
    }
  }

  void joints() const {
    require(!model_.joints.empty(), "no movable joint");
    require_distinct_names(model_.joints, "joint");
    for (int j = 0; j < std::ssize(model_.joints); ++j) {
      const Joint& joint = model_.joints[j];
      const std::string what = "joint " + joint.name;
      require_index(joint.parent_link, model_.links.size(), what + ": parent link");
      require_index(joint.child_link, model_.links.size(), what + ": child link");
      require(model_.links[joint.child_link].parent_joint == j,
              what + ": its child link hangs on another joint");
      require_pose(joint.X_PJ, what + ": origin");
      require(joint.axis_J.allFinite() && std::abs(joint.axis_J.norm() - 1.0) < 1e-9,
              what + ": axis is not a unit vector");
      require(
          std::isfinite(joint.lower) && std::isfinite(joint.upper) && joint.lower <= joint.upper,
          what + ": limits " + shortest_decimal(joint.lower) + " to " +
              shortest_decimal(joint.upper) + " are reversed or not finite");
      require(
          joint.closing_sign >= -1 && joint.closing_sign <= 1,
          what + ": closing sign " + std::to_string(joint.closing_sign) + " is none of -1, 0, 1");
      if (!joint.coupling) continue;
      require_index(joint.coupling->leader, model_.joints.size(), what + ": leader");
      const Joint& leader = model_.joints[joint.coupling->leader];
      require(joint.coupling->leader != j, what + " follows itself");
      require(!leader.coupling, what + ": its leader " + leader.name + " follows another joint");
      require(std::isfinite(joint.coupling->ratio) && std::isfinite(joint.coupling->offset),
              what + ": coupling is not finite");
      require(!joint.coupling->breakaway || joint.closing_sign != 0,
              what + ": breakaway without a closing direction");
    }
  }

  void fingers() const {
    require(!model_.fingers.empty(), "no fingers");
    require_distinct_names(model_.fingers, "finger");
    std::set<int> taken;
    int num_thumbs = 0;
    for (int f = 0; f < std::ssize(model_.fingers); ++f) {
      const Finger& finger = model_.fingers[f];
      const std::string what = "finger " + finger.name;
      require(finger.name != kPalmName, what + ": the name palm is taken by the palm");
      require(!finger.links.empty(), what + ": no links");
      require(!finger.joints.empty(), what + ": no joints");
      for (std::size_t i = 0; i < finger.links.size(); ++i) {
        const int link = finger.links[i];
        require_index(link, model_.links.size(), what + ": link");
        const std::string& link_name = model_.links[link].name;
        require(link != model_.palm.link, what + ": link " + link_name + " is the palm");
        require(taken.insert(link).second, what + ": link " + link_name + " is listed twice");
        require(i == 0 || link > finger.links[i - 1],
                what + ": links are not ordered from proximal to distal");
      }
      for (std::size_t i = 0; i < finger.joints.size(); ++i) {
        const int joint = finger.joints[i];
        require_index(joint, model_.joints.size(), what + ": joint");
        const Joint& j = model_.joints[joint];
        require(
            std::find(finger.links.begin(), finger.links.end(), j.child_link) != finger.links.end(),
            what + ": joint " + j.name + " moves none of its links");
        require(i == 0 || joint > finger.joints[i - 1],
                what + ": joints are not ordered from proximal to distal");
      }
      if (finger.swing_joint) {
        require(std::find(finger.joints.begin(), finger.joints.end(), *finger.swing_joint) !=
                    finger.joints.end(),
                what + ": its swing joint is not one of its joints");
      }
      if (finger.tip_pad) {
        require_index(*finger.tip_pad, model_.pads.size(), what + ": tip pad");
        require(model_.pads[*finger.tip_pad].finger == f, what + ": its tip pad " +
                                                              model_.pads[*finger.tip_pad].name +
                                                              " belongs to another finger");
      }
      num_thumbs += finger.is_thumb ? 1 : 0;
    }
    require(num_thumbs <= 1, std::to_string(num_thumbs) + " fingers are marked as thumb");
  }

  void pads() const {
    require_distinct_names(model_.pads, "pad");
    for (const ContactPad& pad : model_.pads) {
      const std::string what = "pad " + pad.name;
      require_index(pad.link, model_.links.size(), what + ": link");
      if (!pad.finger) {
        require(pad.link == model_.palm.link, what + " of the palm is not on the palm link");
      } else {
        require_index(*pad.finger, model_.fingers.size(), what + ": finger");
        const Finger& finger = model_.fingers[*pad.finger];
        require(std::find(finger.links.begin(), finger.links.end(), pad.link) != finger.links.end(),
                what + ": its link " + model_.links[pad.link].name + " is none of finger " +
                    finger.name);
      }
      require_pose(pad.X_LC, what + ": frame");
      outline(pad.outline, what);
      surface(pad, what);
      require(
          !pad.clip_thickness || (std::isfinite(*pad.clip_thickness) && *pad.clip_thickness > 0.0),
          what + ": clip thickness is not positive");
    }
  }

  void outline(const std::vector<Eigen::Vector2d>& points, const std::string& what) const {
    require(points.size() >= 3,
            what + ": outline has " + std::to_string(points.size()) + " corners");
    for (const Eigen::Vector2d& point : points) {
      require(point.allFinite(), what + ": outline is not finite");
    }
    const double area = area_of(points);
    require(area != 0.0, what + ": outline has no area");
    require(area > 0.0, what + ": outline is clockwise");
    // In a convex outline no corner lies to the right of any side, up to the rounding of decimal
    // input.
    const double slack = 1e-9 * std::sqrt(area);
    const std::vector<Side> lines = sides(points);
    double turn = 0.0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (const Eigen::Vector2d& point : points) {
        require(lines[i].inward.dot(point) - lines[i].offset >= -slack,
                what + ": outline is not convex");
      }
      const Eigen::Vector2d& next = lines[(i + 1) % lines.size()].inward;
      turn += std::atan2(cross(lines[i].inward, next), lines[i].inward.dot(next));
    }
    // The corners of an outline that goes around twice lie left of every side, too.
    require(turn < 3.0 * std::numbers::pi, what + ": outline goes around more than once");
  }

  void surface(const ContactPad& pad, const std::string& what) const {
    require(pad.surface.empty() == pad.planes.empty(),
            what + ": surface and planes do not belong together");
    if (pad.surface.empty()) return;
    const std::vector<Side> lines = sides(pad.outline);
    // Allows for the rounding of decimal input, relative to the pad's size.
    const double slack = 1e-9 * std::sqrt(area_of(pad.outline));
    // The pad is the hull: points this little below it are allowed, such as rounded points of a
    // straight line.
    constexpr double kDentRel = 1e-3;  // of the pad's size
    double height = 0.0;
    for (std::size_t i = 0; i < pad.surface.size(); ++i) {
      const Eigen::Vector3d& point = pad.surface[i];
      const std::string which = what + ": surface point " + std::to_string(i);
      require(point.allFinite(), which + " is not finite");
      require(point.z() >= 0.0, which + " lies behind the pad's plane");
      for (const Side& side : lines) {
        require(side.inward.dot(point.head<2>()) - side.offset >= -slack,
                which + " lies beside the outline");
      }
      require(height_over_pad(pad, point) >= -kDentRel * std::sqrt(area_of(pad.outline)),
              which + " lies below the others: the surface is not convex");
      height = std::max(height, point.z());
    }
    require(height > slack, what + ": its surface does not rise over its plane");
  }

  void palm() const {
    require(model_.palm.link == 0, "the palm link is not the root link " + model_.links[0].name);
    require(model_.palm.center_H.allFinite(), "palm center is not finite");
    require(model_.palm.direction_H.allFinite() &&
                std::abs(model_.palm.direction_H.norm() - 1.0) < 1e-9,
            "palm direction is not a unit vector");
    if (!model_.palm.pad) return;
    require_index(*model_.palm.pad, model_.pads.size(), "palm pad");
    require(!model_.pads[*model_.palm.pad].finger, "the palm's pad belongs to a finger");
  }

  void exclusions() const {
    for (const CollisionExclusion& pair : model_.exclusions) {
      require_index(pair.link_a, model_.links.size(), "collision exclusion");
      require_index(pair.link_b, model_.links.size(), "collision exclusion");
    }
  }

 private:
  const HandModel& model_;
};

}  // namespace

int HandModel::num_intrinsic_dof() const {
  return static_cast<int>(std::count_if(joints.begin(), joints.end(),
                                        [](const Joint& joint) { return !joint.coupling; }));
}

int HandModel::finger_index(const std::string& finger_name) const {
  return index_of(*this, fingers, finger_name, "finger");
}

int HandModel::joint_index(const std::string& joint_name) const {
  return index_of(*this, joints, joint_name, "joint");
}

int HandModel::link_index(const std::string& link_name) const {
  return index_of(*this, links, link_name, "link");
}

int HandModel::pad_index(const std::string& pad_name) const {
  return index_of(*this, pads, pad_name, "pad");
}

std::string HandModel::part_name(std::optional<int> finger) const {
  return finger ? fingers[*finger].name : kPalmName;
}

int HandModel::tip_pad_of(int finger) const {
  if (finger < 0 || finger >= std::ssize(fingers)) {
    throw InvalidInput("finger " + std::to_string(finger) + " of hand " + name + ", which has " +
                       std::to_string(fingers.size()));
  }
  if (const std::optional<int>& pad = fingers[finger].tip_pad) return *pad;
  throw InvalidInput("finger " + fingers[finger].name + " of hand " + name +
                     " has no fingertip pad");
}

int HandModel::palm_pad() const {
  if (palm.pad) return *palm.pad;
  throw InvalidInput("the palm of hand " + name + " has no pad");
}

int HandModel::thumb() const {
  for (int f = 0; f < std::ssize(fingers); ++f) {
    if (fingers[f].is_thumb) return f;
  }
  return 0;
}

bool HandModel::is_excluded(int link_a, int link_b) const {
  if (link_a == link_b) return true;
  return std::any_of(exclusions.begin(), exclusions.end(), [&](const CollisionExclusion& pair) {
    return (pair.link_a == link_a && pair.link_b == link_b) ||
           (pair.link_a == link_b && pair.link_b == link_a);
  });
}

void validate(const HandModel& model) {
  const Checker check(model);
  check.links();
  check.joints();
  check.palm();
  check.fingers();
  check.pads();
  check.exclusions();
}

double largest_reach(const HandModel& model) {
  // A link whose pose in H never changes is measured from the palm center; every joint after such
  // links adds at most the length of its fixed part and its stroke.
  struct Bound {
    bool is_fixed = true;
    RigidTransform X_HL = RigidTransform::Identity();  ///< Only if fixed.
    double distance = 0.0;  ///< Upper bound of |link origin − palm center| [m].
  };
  std::vector<Bound> bounds(model.links.size());
  double reach = 0.0;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Link& link = model.links[i];
    Bound& bound = bounds[i];
    if (i == 0) {
      bound.distance = model.palm.center_H.norm();
    } else {
      const Bound& parent = bounds[*link.parent_link];
      const Joint* joint = link.parent_joint ? &model.joints[*link.parent_joint] : nullptr;
      const RigidTransform& X_PL = joint ? joint->X_PJ : link.X_PL_fixed;
      bound.is_fixed = parent.is_fixed && joint == nullptr;
      bound.X_HL = parent.X_HL * X_PL;
      bound.distance = parent.is_fixed ? (bound.X_HL.translation() - model.palm.center_H).norm()
                                       : parent.distance + X_PL.translation().norm();
      if (joint && joint->type == JointType::Prismatic) {
        bound.distance += std::max(std::abs(joint->lower), std::abs(joint->upper));
      }
    }
    reach = std::max(reach, bound.distance);
    for (const Eigen::Vector3d& vertex : link.mesh_L.vertices) {
      const double of_vertex = bound.is_fixed ? (bound.X_HL * vertex - model.palm.center_H).norm()
                                              : bound.distance + vertex.norm();
      reach = std::max(reach, of_vertex);
    }
  }
  return reach;
}

}  // namespace graspfit::hands
