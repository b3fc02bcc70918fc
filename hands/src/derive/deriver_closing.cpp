#include <cmath>
#include <utility>

#include "derive/deriver.hpp"
#include "graspfit/base/random.hpp"

namespace graspfit::hands::internal {
namespace {

constexpr std::uint64_t kSeed = 4;
constexpr std::size_t kNumSamples = 48;
constexpr double kParallel = 0.64;  // cosine of 50°: axes that bend a finger the same way

}  // namespace

VectorXd Deriver::sampled(std::size_t sample) const {
  base::Random random = base::Random::stream(kSeed, sample);
  VectorXd q(std::ssize(tree_.joints));
  for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
    q[j] = random.uniform(tree_.joints[j].lower, tree_.joints[j].upper);
  }
  return q;
}

double Deriver::spread(const std::vector<RigidTransform>& X_HL) const {
  std::vector<Vector3d> tips;
  for (const Chain& chain : chains_) tips.push_back(tip(chain, X_HL));
  double sum = 0.0;
  for (std::size_t f = 0; f < tips.size(); ++f) {
    sum += (tips[f] - palm_middle_).norm();
    for (std::size_t g = 0; g < tips.size(); ++g) {
      if (g != f) sum += (tips[f] - tips[g]).norm() / static_cast<double>(tips.size() - 1);
    }
  }
  return sum;
}

void Deriver::signs() {
  if (!bodies_[0].mesh.faces.empty()) {
    palm_middle_ = geometry::bounding_box(bodies_[0].mesh).center();
  } else {
    for (const Chain& chain : chains_) {
      palm_middle_ += tree_.joints[chain.joints.front()].X_PJ.translation() /
                      static_cast<double>(chains_.size());
    }
  }
  role_.assign(tree_.joints.size(), Role::None);
  sign_.assign(tree_.joints.size(), 0);
  const auto X_rest = poses(rest());
  for (const Chain& chain : chains_) {
    const int last = chain.joints.back();
    for (const int joint : chain.joints) {
      const bool bends = tree_.joints[joint].type == JointType::Prismatic ||
                         tree_.joints[last].type == JointType::Prismatic ||
                         std::abs(axis_H(joint, X_rest).dot(axis_H(last, X_rest))) >= kParallel;
      Role& role = role_[leader_of(tree_, joint)];
      if (bends) {
        role = Role::Bend;
      } else if (role == Role::None) {
        role = Role::Other;
      }
    }
  }
  std::vector<double> gain(tree_.joints.size(), 0.0);
  for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
    if (role_[j] != Role::Bend) continue;
    for (std::size_t s = 0; s < kNumSamples; ++s) {
      VectorXd q = sampled(s);
      q[j] = tree_.joints[j].lower;
      gain[j] += spread(poses(q));
      q[j] = tree_.joints[j].upper;
      gain[j] -= spread(poses(q));
    }
  }
  // All joints that bend one finger bend it in the same sense: the sum of their gains decides in
  // which, each with the sign that turns the joint's axis to the last joint's.
  std::vector<double> vote(tree_.joints.size(), 0.0);
  for (const Chain& chain : chains_) {
    double sum = 0.0;
    std::vector<std::pair<int, double>> turned;
    for (const int leader : chain.leaders) {
      if (role_[leader] != Role::Bend) continue;
      const double side = side_of(chain, leader, X_rest);
      turned.emplace_back(leader, side);
      sum += side * gain[leader];
    }
    for (const auto& [leader, side] : turned) vote[leader] += side * sum;
  }
  for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
    if (role_[j] == Role::Bend) sign_[j] = vote[j] >= 0.0 ? 1 : -1;
  }
}

double Deriver::side_of(const Chain& chain, int leader,
                        const std::vector<RigidTransform>& X_HL) const {
  const int last = chain.joints.back();
  for (const int joint : chain.joints) {
    if (leader_of(tree_, joint) != leader) continue;
    const auto& coupling = tree_.joints[joint].coupling;
    const double ratio = coupling && coupling->ratio < 0.0 ? -1.0 : 1.0;
    if (tree_.joints[joint].type == JointType::Prismatic ||
        tree_.joints[last].type == JointType::Prismatic) {
      return ratio;
    }
    return axis_H(joint, X_HL).dot(axis_H(last, X_HL)) < 0.0 ? -ratio : ratio;
  }
  return 1.0;
}

std::map<std::string, int> Deriver::closing() const {
  std::map<std::string, int> result;
  for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
    if (sign_[j] != 0) result[tree_.joints[j].name] = sign_[j];
  }
  return result;
}

void Deriver::take_signs(const std::map<std::string, int>& signs) {
  for (Joint& joint : tree_.joints) {
    const auto found = signs.find(joint.name);
    joint.closing_sign = found == signs.end() ? 0 : found->second;
  }
  for (Joint& joint : tree_.joints) {
    if (!joint.coupling || signs.contains(joint.name)) continue;
    const double ratio = joint.coupling->ratio;
    joint.closing_sign = tree_.joints[joint.coupling->leader].closing_sign * (ratio > 0.0   ? 1
                                                                              : ratio < 0.0 ? -1
                                                                                            : 0);
  }
  bool closes = false;
  for (const Chain& chain : chains_) {
    for (const int joint : chain.joints) {
      closes = closes || tree_.joints[joint].closing_sign != 0;
    }
  }
  if (!closes) fail("no joint of any finger closes it; write \"closing\" into the sidecar");
}

void Deriver::note_closing(const std::map<std::string, int>& signs) {
  std::string text;
  for (const auto& [name, sign] : signs) {
    text += (text.empty() ? "" : ", ") + name + (sign > 0 ? " +" : " -");
  }
  findings_.note("", "closing directions derived (toward palm and other tips): " + text);
}

}  // namespace graspfit::hands::internal
