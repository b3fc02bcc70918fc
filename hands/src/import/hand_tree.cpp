#include "import/hand_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::hands::internal {

namespace {

using base::InvalidInput;

/// Links and joints in order parents first (depth first, children in the order of the file), with
/// the names that the tree gives them resolved. Surfaces are read later.
class TreeBuilder {
 public:
  TreeBuilder(const RobotDescription& description, std::string file,
              std::optional<std::string> root, Findings& findings)
      : description_(description),
        file_(std::move(file)),
        root_(std::move(root)),
        findings_(findings) {}

  std::optional<HandModel> build() {
    const std::string root = checked_root();
    if (!is_tree_) return std::nullopt;
    model_.name = description_.name;
    add_tree(root);
    for (const DescribedLink& link : description_.links) {
      if (!added_.contains(link.name)) {
        fault("the links form a cycle: link " + link.name + " is not reached from root " + root);
        break;  // other links of the cycle would repeat the fault
      }
    }
    if (!is_tree_) return std::nullopt;
    const std::string palm = root_ ? *root_ : palm_below(root);
    if (palm != root) begin_at(palm);
    couplings();
    exclusions();
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(file_ + ": " + what); }

  /// Reports what keeps the links from being one tree with a movable joint.
  void fault(const std::string& what) {
    is_tree_ = false;
    findings_.attempt([&] { fail(what); });
  }

  /// The only link without a joint above it. Everything wrong with the links' connections becomes a
  /// fault here, except for cycles that are not connected to the root.
  std::string checked_root() {
    if (description_.links.empty()) {
      fault("no links");
      return "";
    }
    for (std::size_t i = 0; i < description_.links.size(); ++i) {
      link_of_.emplace(description_.links[i].name, i);
    }
    std::map<std::string, std::string> joint_above;
    for (const DescribedJoint& joint : description_.joints) {
      for (const std::string& end : {joint.parent, joint.child}) {
        if (!link_of_.contains(end)) fault("joint " + joint.name + ": no link named " + end);
      }
      const auto [other, is_new] = joint_above.emplace(joint.child, joint.name);
      if (!is_new) {
        fault("link " + joint.child + " hangs on two joints, " + other->second + " and " +
              joint.name);
      }
    }
    std::vector<std::string> roots;
    for (const DescribedLink& link : description_.links) {
      if (!joint_above.contains(link.name)) roots.push_back(link.name);
    }
    if (roots.empty()) fault("the links form a cycle: every one is the child of a joint");
    for (std::size_t i = 1; i < roots.size(); ++i) {
      fault("links " + roots[0] + " and " + roots[i] + " are both roots: no joint joins them");
    }
    if (std::all_of(
            description_.joints.begin(), description_.joints.end(),
            [](const DescribedJoint& j) { return j.type == DescribedJoint::Type::Fixed; })) {
      fault("no movable joint");
    }
    return roots.empty() ? "" : roots[0];
  }

  void add(const std::string& name, std::optional<int> parent, const DescribedJoint* above) {
    const int index = base::as_index<int>(model_.links.size());
    added_.insert(name);
    Link link;
    link.name = name;
    link.parent_link = parent;
    link.inertia = description_.links[link_of_.at(name)].inertia;
    if (above != nullptr && above->type == DescribedJoint::Type::Fixed) {
      link.X_PL_fixed = above->X_PJ;
    } else if (above != nullptr) {
      link.parent_joint = base::as_index<int>(model_.joints.size());
      Joint joint;
      joint.name = above->name;
      joint.type = above->type == DescribedJoint::Type::Prismatic ? JointType::Prismatic
                                                                  : JointType::Revolute;
      joint.parent_link = *parent;
      joint.child_link = index;
      joint.X_PJ = above->X_PJ;
      joint.axis_J = above->axis;
      joint.lower = above->lower;
      joint.upper = above->upper;
      model_.joints.push_back(std::move(joint));
    }
    model_.links.push_back(std::move(link));
  }

  /// Adds a link and all links below it, depth first. It does not recurse, since a chain may be too
  /// long for the stack.
  void add_tree(const std::string& root) {
    struct Next {
      std::string name;
      std::optional<int> parent;
      const DescribedJoint* above = nullptr;
    };
    std::vector<Next> waiting{{.name = root, .parent = std::nullopt}};
    while (!waiting.empty()) {
      const Next next = waiting.back();
      waiting.pop_back();
      const int index = base::as_index<int>(model_.links.size());
      add(next.name, next.parent, next.above);
      const auto first = std::ssize(waiting);
      for (const DescribedJoint& joint : description_.joints) {
        if (joint.parent == next.name) waiting.push_back({joint.child, index, &joint});
      }
      std::reverse(waiting.begin() + first, waiting.end());
    }
  }

  /// Movable joints on a link and on the links that are fixed to it, depth first. It does not
  /// recurse, as `add_tree`.
  std::vector<const DescribedJoint*> joints_on(const std::string& link) const {
    std::vector<const DescribedJoint*> result;
    std::vector<const DescribedJoint*> waiting;
    const auto wait_for_joints_on = [&](const std::string& name) {
      const auto first = std::ssize(waiting);
      for (const DescribedJoint& joint : description_.joints) {
        if (joint.parent == name) waiting.push_back(&joint);
      }
      std::reverse(waiting.begin() + first, waiting.end());
    };
    wait_for_joints_on(link);
    while (!waiting.empty()) {
      const DescribedJoint& joint = *waiting.back();
      waiting.pop_back();
      if (joint.type == DescribedJoint::Type::Fixed) {
        wait_for_joints_on(joint.child);
      } else {
        result.push_back(&joint);
      }
    }
    return result;
  }

  /// The first link below (or at) `root` on which more than one movable joint hangs; `root` itself
  /// if there is none.
  std::string palm_below(const std::string& root) const {
    std::string link = root;
    while (true) {
      const auto joints = joints_on(link);
      if (joints.size() > 1) return link;
      if (joints.empty()) return root;
      link = joints[0]->child;
    }
  }

  /// Builds the tree once more from another root.
  void begin_at(const std::string& root) {
    const HandModel whole = std::move(model_);
    model_ = {};
    model_.name = whole.name;
    added_.clear();
    add_tree(root);
    if (model_.joints.empty()) fail("palm: no movable joint hangs below link " + root);
    std::string links;
    std::string joints;
    for (const Link& link : whole.links) {
      if (!added_.contains(link.name)) links += (links.empty() ? "" : ", ") + link.name;
    }
    for (const Joint& joint : whole.joints) {
      const bool is_kept = std::any_of(model_.joints.begin(), model_.joints.end(),
                                       [&](const Joint& kept) { return kept.name == joint.name; });
      if (!is_kept) joints += (joints.empty() ? "" : ", ") + joint.name;
    }
    findings_.note("link " + root, "is the palm and the root of the hand; left out are links " +
                                       links + (joints.empty() ? "" : " and joints " + joints));
  }

  bool is_left_out(const std::string& joint_name) const {
    return std::any_of(description_.joints.begin(), description_.joints.end(),
                       [&](const DescribedJoint& joint) {
                         return joint.name == joint_name && !added_.contains(joint.child);
                       });
  }

  int joint(const std::string& name, const std::string& item) const {
    for (int j = 0; j < std::ssize(model_.joints); ++j) {
      if (model_.joints[j].name == name) return j;
    }
    fail(item + ": no movable joint named " + name);
  }

  void couplings() {
    for (const DescribedJoint& source : description_.joints) {
      if (!source.coupling || source.type == DescribedJoint::Type::Fixed) continue;
      if (is_left_out(source.name)) continue;
      if (is_left_out(source.coupling->joint)) {
        findings_.suspicious("joint " + source.name, "follows joint " + source.coupling->joint +
                                                         ", which is left out: taken as free");
        continue;
      }
      const std::string item = "joint " + source.name + " follows another";
      const DescribedCoupling& coupling = *source.coupling;
      findings_.attempt(
          [&] {
            model_.joints[joint(source.name, item)].coupling =
                Coupling{joint(coupling.joint, item), coupling.multiplier, coupling.offset,
                         coupling.breakaway};
          },
          "joint " + source.name);
    }
  }

  void exclusions() {
    for (const auto& [a, b] : description_.exclusions) {
      if (link_of_.contains(a) && link_of_.contains(b) &&
          (!added_.contains(a) || !added_.contains(b))) {
        continue;
      }
      model_.exclusions.push_back({model_.link_index(a), model_.link_index(b)});
    }
  }

  const RobotDescription& description_;
  std::string file_;
  std::optional<std::string> root_;
  Findings& findings_;
  bool is_tree_ = true;
  std::map<std::string, std::size_t> link_of_;
  std::set<std::string> added_;
  HandModel model_;
};

}  // namespace

std::optional<HandModel> build_tree(const RobotDescription& description, const std::string& file,
                                    const std::optional<std::string>& root, Findings& findings) {
  return TreeBuilder(description, file, root, findings).build();
}

}  // namespace graspfit::hands::internal
