#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "derive/deriver.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"

namespace graspfit::hands::internal {
namespace {

constexpr double kTipShare = 0.2;  // of a link's length: what counts as its tip

}  // namespace

Vector3d Deriver::tip_of(const Body& body) const {
  const bool is_slide = tree_.joints[*body.joint].type == JointType::Prismatic;
  Vector3d far = Vector3d::Zero();
  for (const Vector3d& v : body.mesh.vertices) {
    if (v.squaredNorm() > far.squaredNorm()) far = v;
  }
  Eigen::AlignedBox3d box;
  for (const Vector3d& v : body.mesh.vertices) {
    if (is_slide || v.dot(far) >= (1.0 - kTipShare) * far.squaredNorm()) box.extend(v);
  }
  return box.center();
}

double Deriver::reach_of(const Chain& chain) const {
  const auto X_HL = poses(rest());
  return (tip(chain, X_HL) - pose_of_body(X_HL, chain.bodies.front()).translation()).norm();
}

void Deriver::chains() {
  if (given_.fingers) {
    given_chains();
  } else {
    // A leaf of the tree of bodies ends a finger if it has a surface; else the last body before it
    // that has one does.
    std::vector<bool> is_end(bodies_.size(), false);
    std::vector<bool> has_end_below(bodies_.size(), false);
    for (std::size_t b = bodies_.size(); b-- > 1;) {
      is_end[b] = !has_end_below[b] && !bodies_[b].mesh.faces.empty();
      if (is_end[b] || has_end_below[b]) has_end_below[*bodies_[b].parent] = true;
    }
    for (int b = 1; b < std::ssize(bodies_); ++b) {
      if (!is_end[b]) continue;
      std::vector<int> bodies;
      for (int up = b; up > 0; up = *bodies_[up].parent) {
        bodies.insert(bodies.begin(), up);
      }
      chains_.push_back(chain_of(std::move(bodies)));
    }
    drop_linkage_members();
    share_out_trunks();
  }
  if (chains_.empty()) {
    fail(
        "no link with a surface hangs on a movable joint: no finger can be derived; write "
        "\"fingers\" into the sidecar");
  }
}

void Deriver::given_chains() {
  const std::vector<int> body_of = body_of_links(bodies_, tree_.links.size());
  for (const SidecarFinger& finger : *given_.fingers) {
    std::vector<int> bodies;
    for (const std::string& name : finger.links) {
      for (std::size_t i = 0; i < tree_.links.size(); ++i) {
        if (tree_.links[i].name != name) continue;
        const int body = body_of[i];
        if (body > 0 && (bodies.empty() || bodies.back() != body)) bodies.push_back(body);
      }
    }
    if (bodies.empty()) {
      fail("finger " + finger.name + ": none of its links moves: nothing can be derived for it");
    }
    chains_.push_back(chain_of(std::move(bodies)));
  }
}

Chain Deriver::chain_of(std::vector<int> bodies) const {
  Chain chain;
  chain.bodies = std::move(bodies);
  for (const int body : chain.bodies) {
    const int joint = *bodies_[body].joint;
    chain.joints.push_back(joint);
    const int leader = leader_of(tree_, joint);
    if (std::find(chain.leaders.begin(), chain.leaders.end(), leader) == chain.leaders.end()) {
      chain.leaders.push_back(leader);
    }
  }
  chain.tip_B = tip_of(bodies_[chain.bodies.back()]);
  return chain;
}

void Deriver::drop_linkage_members() {
  std::vector<std::vector<RigidTransform>> samples;
  for (std::size_t s = 0; s < 5; ++s) samples.push_back(poses(sampled(s)));
  std::vector<Chain> kept;
  for (const Chain& chain : chains_) {
    const bool only_follows = std::all_of(chain.joints.begin(), chain.joints.end(), [&](int j) {
      return tree_.joints[j].coupling.has_value();
    });
    const Chain* carrier = nullptr;
    for (const Chain& other : chains_) {
      if (!only_follows || &other == &chain || other.leaders != chain.leaders) continue;
      if (reach_from_palm(other) <= reach_from_palm(chain)) continue;
      if (always_touch(chain, other, samples)) carrier = &other;
    }
    if (carrier == nullptr) {
      kept.push_back(chain);
      continue;
    }
    findings_.note("link " + name_of_body(chain.bodies.back()),
                   "is no finger: it follows its joints and always touches link " +
                       name_of_body(carrier->bodies.back()) + ", a bar of that finger's linkage");
  }
  chains_ = std::move(kept);
}

double Deriver::reach_from_palm(const Chain& chain) const {
  const auto X_HL = poses(rest());
  const Body& body = bodies_[chain.bodies.back()];
  double reach = 0.0;
  for (const Vector3d& v : body.mesh.vertices) {
    reach = std::max(reach, (pose_of_body(X_HL, chain.bodies.back()) * v).norm());
  }
  return reach;
}

bool Deriver::always_touch(const Chain& a, const Chain& b,
                           const std::vector<std::vector<RigidTransform>>& samples) const {
  for (const auto& X_HL : samples) {
    bool touch = false;
    for (const int body_a : a.bodies) {
      for (const int body_b : b.bodies) {
        if (touch || body_a == body_b) continue;
        const TriangleMesh& mesh_a = bodies_[body_a].mesh;
        const TriangleMesh& mesh_b = bodies_[body_b].mesh;
        if (mesh_a.faces.empty() || mesh_b.faces.empty()) continue;
        touch = geometry::do_intersect(
            MeshQuery(mesh_a), MeshQuery(mesh_b),
            geometry::relative_pose(pose_of_body(X_HL, body_a), pose_of_body(X_HL, body_b)));
      }
    }
    if (!touch) return false;
  }
  return true;
}

void Deriver::share_out_trunks() {
  std::set<int> taken;
  std::vector<std::size_t> order(chains_.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return reach_of(chains_[a]) > reach_of(chains_[b]);
  });
  for (const std::size_t c : order) {
    std::erase_if(chains_[c].bodies, [&](int body) { return taken.contains(body); });
    taken.insert(chains_[c].bodies.begin(), chains_[c].bodies.end());
    chains_[c] = chain_of(chains_[c].bodies);
  }
}

std::string Deriver::name_of_body(int body) const {
  const Body& b = bodies_[body];
  for (const int link : b.links) {
    if (!tree_.links[link].mesh_L.faces.empty()) return tree_.links[link].name;
  }
  return tree_.links[b.links.front()].name;
}

std::optional<int> Deriver::thumb() const {
  if (chains_.size() < 3) return std::nullopt;
  const auto open = poses(closed_by(0.0));
  const auto closed = poses(closed_by(0.5));
  std::vector<Vector3d> way;
  for (const Chain& chain : chains_) {
    Vector3d w = tip(chain, closed) - tip(chain, open);
    w -= w.dot(palm_direction_) * palm_direction_;
    way.push_back(w.norm() > 0.0 ? Vector3d(w.normalized()) : w);
  }
  std::optional<int> least;
  double agreement = 0.0;
  double second = 0.0;
  for (int f = 0; f < std::ssize(way); ++f) {
    double sum = 0.0;
    for (int g = 0; g < std::ssize(way); ++g) {
      if (g != f) sum += way[f].dot(way[g]) / static_cast<double>(way.size() - 1);
    }
    if (!least || sum < agreement) {
      second = agreement;
      agreement = sum;
      least = f;
    } else if (least == 0 && f == 1) {
      second = sum;
    } else {
      second = std::min(second, sum);
    }
  }
  constexpr double kClear = 0.2;  // difference of mean cosines
  return second - agreement >= kClear ? least : std::nullopt;
}

std::vector<std::string> Deriver::names() const {
  std::vector<std::string> result;
  for (const Chain& chain : chains_) {
    std::string prefix;
    bool is_first = true;
    for (const int body : chain.bodies) {
      for (const int link : bodies_[body].links) {
        const std::string& name = tree_.links[link].name;
        if (is_first) prefix = name;
        is_first = false;
        const auto differ = std::mismatch(prefix.begin(), prefix.end(), name.begin(), name.end());
        prefix.erase(differ.first, prefix.end());
      }
    }
    while (!prefix.empty() && std::string("_-. /").find(prefix.back()) != std::string::npos) {
      prefix.pop_back();
    }
    result.push_back(prefix);
  }
  const std::set<std::string> distinct(result.begin(), result.end());
  const bool are_names =
      distinct.size() == result.size() && !distinct.contains("palm") &&
      std::all_of(result.begin(), result.end(), [](const auto& n) { return n.size() > 1; });
  for (std::size_t f = 0; f < result.size() && !are_names; ++f) {
    result[f] = "finger_" + std::to_string(f + 1);
  }
  return result;
}

std::vector<SidecarFinger> Deriver::fingers() {
  std::vector<SidecarFinger> result;
  const std::optional<int> its_thumb = thumb();
  const std::vector<std::string> its_names = names();
  const auto X_rest = poses(rest());
  for (int f = 0; f < std::ssize(chains_); ++f) {
    const Chain& chain = chains_[f];
    SidecarFinger finger;
    finger.name = its_names[f];
    finger.is_thumb = f == its_thumb;
    for (const int body : chain.bodies) {
      for (const int link : bodies_[body].links) {
        finger.links.push_back(tree_.links[link].name);
      }
    }
    // Bodies are complete subtrees of fixed links, which may interleave with the next joint's.
    std::sort(finger.links.begin(), finger.links.end(),
              [&](const std::string& a, const std::string& b) {
                return tree_.link_index(a) < tree_.link_index(b);
              });
    for (const int joint : chain.joints) finger.joints.push_back(tree_.joints[joint].name);
    // The swing joint is, of the joints that neither close nor open, the one whose axis is nearest
    // to the palm's direction. If cosines differ by less than a tenth, the proximal joint is.
    double nearest = -0.1;
    for (const int joint : chain.joints) {
      if (tree_.joints[joint].closing_sign != 0) continue;
      if (tree_.joints[joint].type == JointType::Prismatic) continue;
      const double cosine = std::abs(axis_H(joint, X_rest).dot(palm_direction_));
      if (cosine <= nearest + 0.1) continue;
      nearest = cosine;
      finger.swing_joint = tree_.joints[joint].name;
    }
    if (given_.pads) {  // pads that are given name their fingers
      for (const SidecarPad& pad : *given_.pads) {
        if (std::find(finger.links.begin(), finger.links.end(), pad.link) != finger.links.end()) {
          finger.name = pad.finger;
        }
      }
    }
    result.push_back(std::move(finger));
  }
  std::string text;
  for (const SidecarFinger& finger : result) {
    text += (text.empty() ? "" : "; ") + finger.name + (finger.is_thumb ? " (thumb)" : "");
    for (const std::string& joint : finger.joints) {
      text += " " + joint + (finger.swing_joint == joint ? " (swing)" : "");
    }
  }
  findings_.note("", "fingers derived from the tree's leaves: " + text);
  return result;
}

}  // namespace graspfit::hands::internal
