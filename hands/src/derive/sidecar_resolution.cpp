#include "derive/sidecar_resolution.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::hands::internal {

namespace {

using base::InvalidInput;

/// Resolves the sidecar's names in a model that has links and joints.
class SidecarResolver {
 public:
  SidecarResolver(HandModel& model, const Sidecar& sidecar, std::string file)
      : model_(model), sidecar_(sidecar), file_(std::move(file)) {}

  void resolve() {
    closing();
    palm();
    fingers();
    pads();
    tip_pads();
    exclusions();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(file_ + ": " + what); }

  int link(const std::string& name, const std::string& item) const {
    for (int i = 0; i < std::ssize(model_.links); ++i) {
      if (model_.links[i].name == name) return i;
    }
    fail(item + ": the description has no link named " + name);
  }

  int joint(const std::string& name, const std::string& item) const {
    for (int j = 0; j < std::ssize(model_.joints); ++j) {
      if (model_.joints[j].name == name) return j;
    }
    fail(item + ": the description has no movable joint named " + name);
  }

  int pad(const std::string& name, const std::string& item) const {
    for (int p = 0; p < std::ssize(model_.pads); ++p) {
      if (model_.pads[p].name == name) return p;
    }
    fail(item + ": no pad named " + name);
  }

  Joint& joint_at(int index) { return model_.joints[index]; }

  void closing() {
    for (const auto& [name, sign] : *sidecar_.closing) {
      joint_at(joint(name, "closing")).closing_sign = sign;
    }
    // A follower that is not listed closes when its leader does.
    for (Joint& follower : model_.joints) {
      if (!follower.coupling || sidecar_.closing->contains(follower.name)) continue;
      const double ratio = follower.coupling->ratio;
      follower.closing_sign =
          joint_at(follower.coupling->leader).closing_sign * (ratio > 0.0   ? 1
                                                              : ratio < 0.0 ? -1
                                                                            : 0);
    }
  }

  void palm() {
    model_.palm.link = link(sidecar_.palm->link, "palm");
    if (model_.palm.link != 0) {
      fail("palm: link " + sidecar_.palm->link + " is not the root link " + model_.links[0].name);
    }
    model_.palm.center_H = sidecar_.palm->center_H;
    model_.palm.direction_H = sidecar_.palm->direction_H;
  }

  void fingers() {
    for (const SidecarFinger& source : *sidecar_.fingers) {
      const std::string item = "finger " + source.name;
      Finger finger;
      finger.name = source.name;
      finger.is_thumb = source.is_thumb;
      for (const std::string& name : source.links) finger.links.push_back(link(name, item));
      for (const std::string& name : source.joints) finger.joints.push_back(joint(name, item));
      if (source.swing_joint) finger.swing_joint = joint(*source.swing_joint, item);
      model_.fingers.push_back(std::move(finger));
    }
  }

  void pads() {
    for (const SidecarPad& source : *sidecar_.pads) {
      const std::string item = "pad " + source.name;
      ContactPad result;
      result.name = source.name;
      result.link = link(source.link, item);
      if (source.finger != "palm") {
        for (int f = 0; f < std::ssize(model_.fingers); ++f) {
          if (model_.fingers[f].name == source.finger) result.finger = f;
        }
        if (!result.finger) fail(item + ": no finger named " + source.finger);
      }
      result.X_LC = source.X_LC;
      result.outline = source.outline;
      result.surface = source.surface;
      result.planes = surface_planes(result);
      result.clip_thickness = source.clip_thickness;
      model_.pads.push_back(std::move(result));
    }
    if (sidecar_.palm->pad) model_.palm.pad = pad(*sidecar_.palm->pad, "palm");
  }

  /// Sets the tip pads. Where the sidecar names none, it is the last pad on the most distal link
  /// that has one.
  void tip_pads() {
    for (int f = 0; f < std::ssize(model_.fingers); ++f) {
      Finger& finger = model_.fingers[f];
      if ((*sidecar_.fingers)[f].tip_pad) {
        finger.tip_pad = pad(*(*sidecar_.fingers)[f].tip_pad, "finger " + finger.name);
        continue;
      }
      for (int p = 0; p < std::ssize(model_.pads); ++p) {
        const ContactPad& candidate = model_.pads[p];
        if (candidate.finger != f) continue;
        if (!finger.tip_pad || candidate.link >= model_.pads[*finger.tip_pad].link) {
          finger.tip_pad = p;
        }
      }
    }
  }

  void exclusions() {
    // A pair counts once, however often, and in whatever order, description and sidecar have it.
    std::set<std::pair<int, int>> excluded;
    const std::vector<CollisionExclusion> described = std::move(model_.exclusions);
    model_.exclusions.clear();
    const auto exclude = [&](int a, int b) {
      if (excluded.insert(std::minmax(a, b)).second) model_.exclusions.push_back({a, b});
    };
    for (const CollisionExclusion& pair : described) exclude(pair.link_a, pair.link_b);
    for (const auto& [a, b] : *sidecar_.exclusions) {
      exclude(link(a, "exclusions"), link(b, "exclusions"));
    }
    // Links that are fixed to each other never collide, whatever the file says. Frames without a
    // surface cannot collide and are not listed; there may be many.
    std::vector<int> body(model_.links.size());
    std::map<int, std::vector<int>> solid_links;  // of each body
    for (int i = 0; i < std::ssize(model_.links); ++i) {
      const Link& own = model_.links[i];
      body[i] = own.parent_link && !own.parent_joint ? body[*own.parent_link] : i;
      if (own.mesh_L.faces.empty()) continue;
      std::vector<int>& before = solid_links[body[i]];
      for (const int other : before) exclude(other, i);
      before.push_back(i);
    }
  }

  HandModel& model_;
  const Sidecar& sidecar_;
  std::string file_;
};

}  // namespace

void set_couplings(const std::vector<SidecarCoupling>& couplings, const std::string& file,
                   HandModel& model) {
  const auto fail = [&](const std::string& what) { throw InvalidInput(file + ": " + what); };
  const auto joint = [&](const std::string& name, const std::string& item) {
    const auto found = std::find_if(model.joints.begin(), model.joints.end(),
                                    [&](const Joint& one) { return one.name == name; });
    if (found == model.joints.end()) {
      fail(item + ": the description has no movable joint named " + name);
    }
    return base::as_index<int>(found - model.joints.begin());
  };
  std::set<std::string> seen;
  for (const SidecarCoupling& source : couplings) {
    const std::string item = "coupling of joint " + source.joint;
    if (!seen.insert(source.joint).second) fail(item + ": given twice");
    model.joints[joint(source.joint, item)].coupling =
        Coupling{joint(source.leader, item), source.ratio, source.offset, source.breakaway};
  }
}

void follow_first_leaders(const std::string& file, HandModel& model) {
  // A follower of a follower is at q = a (b q0 + c) + d.
  for (Joint& follower : model.joints) {
    if (!follower.coupling) continue;
    Coupling& own = *follower.coupling;
    for (std::size_t steps = 0;; ++steps) {
      const std::optional<Coupling>& above = model.joints[own.leader].coupling;
      if (!above) break;
      if (steps > model.joints.size()) {
        throw InvalidInput(file + ": coupling of joint " + follower.name +
                           ": the couplings form a cycle");
      }
      own.offset += own.ratio * above->offset;
      own.ratio *= above->ratio;
      own.leader = above->leader;
    }
  }
}

HandModel resolved(const Sidecar& sidecar, const std::string& file, HandModel model) {
  SidecarResolver(model, sidecar, file).resolve();
  return model;
}

}  // namespace graspfit::hands::internal
