#include "graspfit/base/path_text.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "io/record_json.hpp"

namespace graspfit::grasp::internal {
namespace {

const char* joint_unit(const hands::Joint& joint) {
  return joint.type == hands::JointType::Revolute ? "rad" : "m";
}

Json joint_json(const hands::HandModel& hand, const hands::Joint& joint) {
  Json coupling = nullptr;
  if (joint.coupling) {
    coupling = {{"leader", hand.joints[joint.coupling->leader].name},
                {"ratio", joint.coupling->ratio},
                {"offset", joint.coupling->offset},
                {"breakaway", joint.coupling->breakaway}};
  }
  return {{"name", joint.name},
          {"type", joint.type == hands::JointType::Revolute ? "revolute" : "prismatic"},
          {"unit", joint_unit(joint)},
          {"lower", joint.lower},
          {"upper", joint.upper},
          {"parent_link", hand.links[joint.parent_link].name},
          {"child_link", hand.links[joint.child_link].name},
          {"X_PJ", to_json(joint.X_PJ)},
          {"axis_J", to_json(joint.axis_J)},
          {"closing_sign", joint.closing_sign},
          {"coupling", coupling}};
}

Json pad_json(const hands::HandModel& hand, const hands::ContactPad& pad, double clip_thickness) {
  Json outline = Json::array();
  for (const Eigen::Vector2d& corner : pad.outline) {
    outline.push_back(Json::array({corner.x(), corner.y()}));
  }
  Json surface = Json::array();
  for (const Eigen::Vector3d& corner : pad.surface) surface.push_back(to_json(corner));
  Json planes = Json::array();
  for (const geometry::HalfSpace& plane : pad.planes) {
    planes.push_back({{"normal_C", to_json(plane.normal)}, {"offset_m", plane.offset}});
  }
  const double thickness = pad.clip_thickness.value_or(clip_thickness);
  Json half_spaces = Json::array();
  for (const geometry::HalfSpace& half_space :
       hands::transformed(hands::clip_volume_C(pad, thickness), pad.X_LC)) {
    half_spaces.push_back(
        {{"normal_L", to_json(half_space.normal)}, {"offset_m", half_space.offset}});
  }
  return {{"name", pad.name},
          {"link", hand.links[pad.link].name},
          {"finger", hand.part_name(pad.finger)},
          {"X_LC", to_json(pad.X_LC)},
          {"outline_C_m", outline},
          {"surface_C_m", surface},
          {"surface_planes_C", planes},
          {"largest_boundary_distance_m", hands::largest_boundary_distance(pad)},
          {"area_m2", hands::pad_area(pad)},
          {"clip_volume_L", {{"thickness_m", thickness}, {"half_spaces", half_spaces}}}};
}

/// The path of a file; that of a shipped hand is relative to the folder of shipped hands, the same
/// on every machine.
Json file_json(const std::string& file) {
  return base::path_text(hands::path_in_library(file).string());
}

}  // namespace

Json hand_json(const GraspFile& file) {
  const hands::HandModel& hand = file.hand;
  Json links = Json::array();
  for (std::size_t i = 0; i < hand.links.size(); ++i) {
    const bool has_file = !hand.links[i].mesh_files.empty();
    Json mesh_files = Json::array();
    for (const std::string& name : hand.links[i].mesh_files) {
      mesh_files.push_back(base::path_text(name));
    }
    const bool has_used_mesh = file.used_meshes && !file.used_meshes->links.at(i).empty();
    links.push_back(
        {{"name", hand.links[i].name},
         {"mesh_files", mesh_files},
         {"mesh_sha256", has_file ? Json(file.link_mesh_sha256.at(i)) : Json(nullptr)},
         {"used_mesh_file", has_used_mesh ? Json(file.used_meshes->links[i]) : Json(nullptr)}});
  }
  Json joints = Json::array();
  for (const hands::Joint& joint : hand.joints) joints.push_back(joint_json(hand, joint));
  Json fingers = Json::array();
  for (const hands::Finger& finger : hand.fingers) {
    Json finger_links = Json::array();
    for (int link : finger.links) finger_links.push_back(hand.links[link].name);
    Json finger_joints = Json::array();
    for (int joint : finger.joints) finger_joints.push_back(hand.joints[joint].name);
    fingers.push_back(
        {{"name", finger.name},
         {"is_thumb", finger.is_thumb},
         {"links", finger_links},
         {"joints", finger_joints},
         {"tip_pad", finger.tip_pad ? Json(hand.pads[*finger.tip_pad].name) : Json(nullptr)}});
  }
  Json pads = Json::array();
  for (const hands::ContactPad& pad : hand.pads) {
    pads.push_back(pad_json(hand, pad, file.clip_thickness));
  }
  Json exclusions = Json::array();
  for (const hands::CollisionExclusion& exclusion : hand.exclusions) {
    exclusions.push_back(
        Json::array({hand.links[exclusion.link_a].name, hand.links[exclusion.link_b].name}));
  }
  return {{"name", hand.name},
          {"description_file", file_json(hand.description_file)},
          {"description_sha256", hand.description_sha256},
          {"sidecar_file", file_json(hand.sidecar_file)},
          {"sidecar_sha256", hand.sidecar_sha256},
          {"palm",
           {{"link", hand.links[hand.palm.link].name},
            {"center_H_m", to_json(hand.palm.center_H)},
            {"direction_H", to_json(hand.palm.direction_H)},
            {"pad", hand.palm.pad ? Json(hand.pads[*hand.palm.pad].name) : Json(nullptr)}}},
          {"links", links},
          {"joints", joints},
          {"fingers", fingers},
          {"pads", pads},
          {"collision_exclusions", exclusions}};
}

}  // namespace graspfit::grasp::internal
