#include "hand_data.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace graspfit::viewer::internal {
namespace {

Json links(const hands::HandModel& hand) {
  Json list = Json::array();
  for (const hands::Link& link : hand.links) {
    list.push_back({{"name", link.name},
                    {"parent", link.parent_link.value_or(-1)},
                    {"joint", link.parent_joint.value_or(-1)},
                    {"X_PL", to_json(link.X_PL_fixed)},
                    {"mesh", to_json(link.mesh_L)}});
  }
  return list;
}

Json joints(const hands::HandModel& hand) {
  Json list = Json::array();
  for (const hands::Joint& joint : hand.joints) {
    Json entry = {{"name", joint.name},
                  {"is_angle", joint.type == hands::JointType::Revolute},
                  {"is_coupled", joint.coupling.has_value()},
                  {"child", joint.child_link},
                  {"X_PJ", to_json(joint.X_PJ)},
                  {"axis", to_json(joint.axis_J)},
                  {"lower", joint.lower},
                  {"upper", joint.upper},
                  {"closing", joint.closing_sign}};
    if (joint.coupling) {
      entry["coupling"] = {{"leader", joint.coupling->leader},
                           {"ratio", joint.coupling->ratio},
                           {"offset", joint.coupling->offset},
                           {"breakaway", joint.coupling->breakaway}};
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json fingers(const hands::HandModel& hand) {
  Json list = Json::array();
  for (const hands::Finger& finger : hand.fingers) {
    list.push_back({{"name", finger.name},
                    {"is_thumb", finger.is_thumb},
                    {"joints", finger.joints},
                    {"tip_pad", finger.tip_pad.value_or(-1)}});
  }
  return list;
}

Json pads(const hands::HandModel& hand, const std::optional<double>& clip_thickness) {
  Json list = Json::array();
  for (const hands::ContactPad& pad : hand.pads) {
    const std::optional<double> thickness =
        pad.clip_thickness ? pad.clip_thickness : clip_thickness;
    list.push_back({{"name", pad.name},
                    {"link", pad.link},
                    {"finger", pad.finger.value_or(-1)},
                    {"X_LC", to_json(pad.X_LC)},
                    {"clip", thickness ? clip_volume(pad, *thickness) : Json(nullptr)}});
  }
  return list;
}

}  // namespace

Json clip_volume(const hands::ContactPad& pad, double thickness) {
  const geometry::TriangleMesh mesh_C = hands::clip_volume_mesh_C(pad, thickness);
  Json points = Json::array();
  for (const Eigen::Vector3d& vertex : mesh_C.vertices) points.push_back(to_json(vertex));
  Json faces = Json::array();
  Json edges = Json::array();
  std::map<std::pair<std::int32_t, std::int32_t>, Eigen::Vector3d> normal_at;
  for (std::int32_t f = 0; f < std::ssize(mesh_C.faces); ++f) {
    const geometry::Face& face = mesh_C.faces[f];
    faces.push_back({face[0], face[1], face[2]});
    const Eigen::Vector3d normal = geometry::face_normal(mesh_C, f);
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = face[k];
      const std::int32_t b = face[(k + 1) % 3];
      const auto [other, is_first] = normal_at.emplace(std::minmax(a, b), normal);
      constexpr double kFlat = 0.06;  // 1 - cosine of 20 degrees: facets of a round pad
      if (!is_first && other->second.dot(normal) < 1.0 - kFlat) edges.push_back({a, b});
    }
  }
  return {{"points", points}, {"faces", faces}, {"edges", edges}};
}

Json hand_data(const hands::HandModel& hand, const std::optional<double>& clip_thickness) {
  return {{"name", hand.name},
          {"links", links(hand)},
          {"joints", joints(hand)},
          {"fingers", fingers(hand)},
          {"pads", pads(hand, clip_thickness)},
          {"palm",
           {{"link", hand.palm.link},
            {"center", to_json(hand.palm.center_H)},
            {"direction", to_json(hand.palm.direction_H)}}}};
}

}  // namespace graspfit::viewer::internal
