#include <algorithm>
#include <cmath>

#include "derive/deriver.hpp"
#include "graspfit/base/number_range.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::hands::internal {

std::vector<SidecarPad> Deriver::pads(const std::vector<SidecarFinger>& fingers) {
  std::vector<SidecarPad> result;
  const VectorXd q = closed_by(0.5);
  const auto X_HL = poses(q);
  for (std::size_t f = 0; f < chains_.size(); ++f) {
    const Chain& chain = chains_[f];
    for (std::size_t i = 0; i < chain.bodies.size(); ++i) {
      const auto faces = facing(chain, i, q);
      if (!faces) continue;
      const Body& body = bodies_[chain.bodies[i]];
      for (const int link : body.links) {
        if (tree_.links[link].mesh_L.faces.empty()) continue;
        if (std::find(fingers[f].links.begin(), fingers[f].links.end(), tree_.links[link].name) ==
            fingers[f].links.end()) {
          continue;
        }
        std::vector<MeshQuery> others;
        for (const int other : body.links) {
          if (other == link || tree_.links[other].mesh_L.faces.empty()) continue;
          others.emplace_back(transformed(tree_.links[other].mesh_L,
                                          geometry::relative_pose(X_HL[link], X_HL[other])));
        }
        const Eigen::Matrix3d R_LH = X_HL[link].linear().transpose();
        PadSearch search{R_LH * faces->direction_H, R_LH * faces->along_H, std::nullopt, 0.0};
        const auto found = fit_pad(MeshQuery(tree_.links[link].mesh_L), others, search);
        const bool is_tip = i + 1 == chain.bodies.size();
        if (found && !is_tip && is_shut_in(*found, link, chain)) continue;
        add_pad(result, found, tree_.links[link].name, fingers[f].name);
      }
    }
  }
  // A tip pad that is given by name alone is the pad on the last link that has one.
  for (const SidecarFinger& finger : fingers) {
    if (!finger.tip_pad) continue;
    for (auto pad = result.rbegin(); pad != result.rend(); ++pad) {
      if (pad->finger != finger.name) continue;
      pad->name = *finger.tip_pad;
      break;
    }
  }
  if (!bodies_[0].mesh.faces.empty()) {
    const PadSearch search{palm_direction_, palm_axis(), palm_center_, palm_reach()};
    const auto pad = fit_pad(MeshQuery(bodies_[0].mesh), {}, search);
    add_pad(result, pad, tree_.links[0].name, "palm");
  }
  return result;
}

double Deriver::palm_reach() const {
  const auto X_HL = poses(closed_by(0.5));
  double reach = 0.0;
  for (const Chain& chain : chains_) {
    for (const Vector3d& point :
         {Vector3d(pose_of_body(X_HL, chain.bodies.front()).translation()), tip(chain, X_HL)}) {
      reach = std::max(reach, palm_direction_.cross(point - palm_center_).norm());
    }
  }
  return reach;
}

bool Deriver::is_shut_in(const FittedPad& pad, int link, const Chain& chain) const {
  constexpr double kStart = 1e-4;  // [m], off the pad itself
  constexpr double kClose = 0.05;  // [m]; less than what hands are made to hold
  double height = 0.0;
  for (const Vector3d& point : pad.surface) height = std::max(height, point.z());
  for (const double share : {0.0, 0.5}) {
    const auto X_HL = poses(closed_by(share));
    const RigidTransform X_HC = X_HL[link] * pad.X_LC;
    bool is_hit = false;
    for (int body = 0; body < std::ssize(bodies_) && !is_hit; ++body) {
      const bool is_other_finger =
          std::any_of(chains_.begin(), chains_.end(), [&](const Chain& other) {
            return &other != &chain &&
                   std::find(other.bodies.begin(), other.bodies.end(), body) != other.bodies.end();
          });
      const std::vector<int>& own = bodies_[body].links;
      if (is_other_finger || bodies_[body].mesh.faces.empty() ||
          std::find(own.begin(), own.end(), link) != own.end()) {
        continue;
      }
      const RigidTransform X_BC = geometry::relative_pose(pose_of_body(X_HL, body), X_HC);
      const auto hit =
          MeshQuery(bodies_[body].mesh)
              .first_hit(X_BC * Vector3d(0.0, 0.0, height + kStart), X_BC.linear().col(2));
      is_hit = hit && hit->distance < kClose;
    }
    if (!is_hit) return false;
  }
  return true;
}

Vector3d Deriver::palm_axis() const {
  int least = 0;
  palm_direction_.cwiseAbs().minCoeff(&least);
  return Vector3d::Unit(least);
}

void Deriver::add_pad(std::vector<SidecarPad>& list, const std::optional<FittedPad>& found,
                      const std::string& link, const std::string& finger) {
  if (!found) return;
  constexpr double kLeastArea = 2e-5;  // [m²], 20 mm²: smaller ones are edges
  if (found->area < kLeastArea) return;
  SidecarPad pad;
  pad.name = finger != "palm"                  ? link + "_pad"
             : given_.palm && given_.palm->pad ? *given_.palm->pad
                                               : "palm_pad";
  pad.link = link;
  pad.finger = finger;
  pad.X_LC = found->X_LC;
  pad.outline = found->outline;
  pad.surface = found->surface;
  list.push_back(pad);
  const auto millimeters = [](double meters) {
    return base::shortest_decimal(std::round(meters * 1e5) / 100.0);
  };
  findings_.note("pad " + pad.name,
                 std::string("derived: ") + (pad.surface.empty() ? "flat" : "bulging") + ", " +
                     base::plain_decimal(std::round(found->area * 1e6)) + " mm^2, within " +
                     millimeters(found->deviation) + " mm of the mesh");
}

SidecarPalm Deriver::palm(const std::vector<SidecarPad>& found,
                          const std::optional<std::vector<SidecarPad>>& given) {
  SidecarPalm result;
  result.link = tree_.links[0].name;
  result.center_H = palm_center_;
  result.direction_H = palm_direction_;
  for (const SidecarPad& pad : given ? *given : found) {
    if (pad.finger != "palm") continue;
    result.pad = pad.name;
  }
  const auto text = [](const Vector3d& v) {
    std::string list;
    for (int i = 0; i < 3; ++i) {
      const double rounded = std::round(v[i] * 1e3) / 1e3 + 0.0;  // no negative zero
      list += (i ? " " : "") + base::shortest_decimal(rounded);
    }
    return list;
  };
  findings_.note("link " + result.link, "palm derived: center " + text(palm_center_) +
                                            " m, direction " + text(palm_direction_) +
                                            ", toward where the half-closed fingers face");
  return result;
}

}  // namespace graspfit::hands::internal
