#include "internal/hand_tree.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "graspfit/geometry/errors.hpp"

namespace graspfit::hands::internal {

namespace {

using geometry::InvalidInput;

/// Links and joints in order parents first (depth first, children in the order of the file), with
/// the names that the tree gives them resolved. Surfaces are read later.
class TreeBuilder {
 public:
  TreeBuilder(const RobotDescription& description, std::string file)
      : description_(description), file_(std::move(file)) {}

  HandModel build() {
    if (description_.links.empty()) fail("no links");
    for (std::size_t i = 0; i < description_.links.size(); ++i)
      link_of_[description_.links[i].name] = i;
    std::map<std::string, std::string> joint_above;
    for (const DescribedJoint& joint : description_.joints) {
      for (const std::string& end : {joint.parent, joint.child}) {
        if (!link_of_.contains(end)) fail("joint " + joint.name + ": no link named " + end);
      }
      const auto [other, is_new] = joint_above.emplace(joint.child, joint.name);
      if (!is_new) {
        fail("link " + joint.child + " hangs on two joints, " + other->second + " and " +
             joint.name);
      }
    }
    std::vector<std::string> roots;
    for (const DescribedLink& link : description_.links) {
      if (!joint_above.contains(link.name)) roots.push_back(link.name);
    }
    if (roots.empty()) fail("the links form a cycle: every one is the child of a joint");
    if (roots.size() > 1) {
      fail("links " + roots[0] + " and " + roots[1] + " are both roots: no joint joins them");
    }
    if (std::all_of(
            description_.joints.begin(), description_.joints.end(),
            [](const DescribedJoint& j) { return j.type == DescribedJoint::Type::Fixed; })) {
      fail("no movable joint");
    }
    model_.name = description_.name;
    add(roots[0], -1, nullptr);
    if (model_.links.size() != description_.links.size()) {
      for (const DescribedLink& link : description_.links) {
        if (!added_.contains(link.name)) {
          fail("the links form a cycle: link " + link.name + " is not reached from root " +
               roots[0]);
        }
      }
    }
    couplings();
    exclusions();
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(file_ + ": " + what); }

  void add(const std::string& name, int parent, const DescribedJoint* above) {
    const int index = static_cast<int>(model_.links.size());
    added_.insert(name);
    Link link;
    link.name = name;
    link.parent_link = parent;
    link.inertia = description_.links[link_of_.at(name)].inertia;
    if (above != nullptr && above->type == DescribedJoint::Type::Fixed) {
      link.X_PL_fixed = above->X_PJ;
    } else if (above != nullptr) {
      link.parent_joint = static_cast<int>(model_.joints.size());
      Joint joint;
      joint.name = above->name;
      joint.type = above->type == DescribedJoint::Type::Prismatic ? JointType::Prismatic
                                                                  : JointType::Revolute;
      joint.parent_link = parent;
      joint.child_link = index;
      joint.X_PJ = above->X_PJ;
      joint.axis_J = above->axis;
      joint.lower = above->lower;
      joint.upper = above->upper;
      model_.joints.push_back(std::move(joint));
    }
    model_.links.push_back(std::move(link));
    for (const DescribedJoint& joint : description_.joints) {
      if (joint.parent == name) add(joint.child, index, &joint);
    }
  }

  int joint(const std::string& name, const std::string& item) const {
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      if (model_.joints[j].name == name) return static_cast<int>(j);
    }
    fail(item + ": no movable joint named " + name);
  }

  void couplings() {
    for (const DescribedJoint& source : description_.joints) {
      if (!source.coupling || source.type == DescribedJoint::Type::Fixed) continue;
      const std::string item = "joint " + source.name + " follows another";
      const DescribedCoupling& coupling = *source.coupling;
      model_.joints[static_cast<std::size_t>(joint(source.name, item))].coupling = Coupling{
          joint(coupling.joint, item), coupling.multiplier, coupling.offset, coupling.breakaway};
    }
  }

  void exclusions() {
    for (const auto& [a, b] : description_.exclusions) {
      model_.exclusions.push_back({model_.link_index(a), model_.link_index(b)});
    }
  }

  const RobotDescription& description_;
  std::string file_;
  std::map<std::string, std::size_t> link_of_;
  std::set<std::string> added_;
  HandModel model_;
};

}  // namespace

HandModel build_tree(const RobotDescription& description, const std::string& file) {
  return TreeBuilder(description, file).build();
}

}  // namespace graspfit::hands::internal
