#include "description/sidecar.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "description/control_characters.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_value.hpp"

namespace graspfit::hands::internal {

namespace {

using base::JsonValue;

constexpr const char* kFormat = "graspfit hand sidecar";
constexpr int kVersion = 1;

/// Returns a name that one-line messages may show: one without control characters.
std::string checked(const std::string& name, const JsonValue& item) {
  if (std::any_of(name.begin(), name.end(), is_control)) item.fail("has a control character");
  return name;
}

std::string name(const JsonValue& item) { return checked(item.name(), item); }

std::vector<std::string> names(const JsonValue& item) {
  std::vector<std::string> result;
  for (const JsonValue& entry : item.items()) result.push_back(name(entry));
  return result;
}

template <int Size>
Eigen::Matrix<double, Size, 1> vector(const JsonValue& item) {
  return Eigen::Matrix<double, Size, 1>(item.numbers<Size>().data());
}

void check_format(const JsonValue& format) {
  format.require_members({"name", "version"}, {});
  if (name(format.at("name")) != kFormat) {
    format.fail("name is not \"" + std::string(kFormat) + "\"");
  }
  const double version = format.at("version").number();
  if (version != kVersion) {
    format.fail("version is not " + std::to_string(kVersion) + ", the one this program reads");
  }
}

SidecarFinger finger(const JsonValue& item) {
  item.require_members({"name", "links", "joints"}, {"thumb", "swing_joint", "tip_pad"});
  SidecarFinger result;
  result.name = name(item.at("name"));
  if (const auto thumb = item.find("thumb")) result.is_thumb = thumb->flag();
  result.links = names(item.at("links"));
  result.joints = names(item.at("joints"));
  if (const auto swing = item.find("swing_joint")) result.swing_joint = name(*swing);
  if (const auto pad = item.find("tip_pad")) result.tip_pad = name(*pad);
  return result;
}

SidecarPad pad(const JsonValue& item) {
  item.require_members({"name", "link", "finger", "frame", "outline_m"}, {"surface_m", "clip"});
  SidecarPad result;
  result.name = name(item.at("name"));
  result.link = name(item.at("link"));
  result.finger = name(item.at("finger"));
  const JsonValue frame = item.at("frame");
  frame.require_members({"translation_m", "rotation_wxyz"}, {});
  result.X_LC.translation() = vector<3>(frame.at("translation_m"));
  const JsonValue rotation = frame.at("rotation_wxyz");
  const Eigen::Vector4d q = vector<4>(rotation);
  // A person may type 0.7071: normalize, and refuse only what is no rotation at all.
  if (std::abs(q.norm() - 1.0) > 1e-3) rotation.fail("is not a unit quaternion");
  result.X_LC.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  for (const JsonValue& corner : item.at("outline_m").items()) {
    result.outline.push_back(vector<2>(corner));
  }
  if (const auto surface = item.find("surface_m")) {
    for (const JsonValue& point : surface->items()) result.surface.push_back(vector<3>(point));
    if (result.surface.empty()) surface->fail("is empty; leave it out where the pad is flat");
  }
  if (const auto clip = item.find("clip")) {
    clip->require_members({"kind"}, {"thickness_m"});
    const std::string kind = clip->at("kind").name();
    const std::string expected = result.surface.empty() ? "prism" : "offset";
    if (kind != "prism" && kind != "offset") {
      clip->at("kind").fail("is neither \"prism\" nor \"offset\"");
    }
    if (kind != expected) {
      clip->at("kind").fail("is \"" + kind + "\", but the clip volume of a " +
                            (result.surface.empty() ? "flat pad" : "pad with surface_m") +
                            " is \"" + expected + "\"");
    }
    if (const auto thickness = clip->find("thickness_m")) {
      result.clip_thickness = thickness->number();
      if (*result.clip_thickness <= 0.0) thickness->fail("is not positive");
    }
  }
  return result;
}

SidecarPalm palm(const JsonValue& item) {
  item.require_members({"link", "center_m", "direction"}, {"pad"});
  SidecarPalm result;
  result.link = name(item.at("link"));
  result.center_H = vector<3>(item.at("center_m"));
  const JsonValue direction = item.at("direction");
  result.direction_H = vector<3>(direction);
  if (result.direction_H.norm() == 0.0) direction.fail("is zero");
  result.direction_H.normalize();
  if (const auto its_pad = item.find("pad")) result.pad = name(*its_pad);
  return result;
}

SidecarCoupling coupling(const JsonValue& item) {
  item.require_members({"joint", "leader"}, {"ratio", "offset", "breakaway"});
  SidecarCoupling result;
  result.joint = name(item.at("joint"));
  result.leader = name(item.at("leader"));
  if (const auto ratio = item.find("ratio")) result.ratio = ratio->number();
  if (const auto offset = item.find("offset")) result.offset = offset->number();
  if (const auto breakaway = item.find("breakaway")) result.breakaway = breakaway->flag();
  return result;
}

constexpr const char* kConventions =
    "Meters, radians. rotation_wxyz is a unit quaternion [w, x, y, z]. Pad frame in its link's "
    "frame: z leaves the link, x and y in the pad's plane. Palm center and direction in the root "
    "link's frame. Members left out (fingers, pads, palm, closing, exclusions) are derived from "
    "the description.";

template <int Size>
nlohmann::ordered_json list_of_numbers(const Eigen::Matrix<double, Size, 1>& v) {
  return std::vector<double>(v.data(), v.data() + Size);
}

nlohmann::ordered_json to_json(const SidecarFinger& finger) {
  nlohmann::ordered_json out{{"name", finger.name},
                             {"thumb", finger.is_thumb},
                             {"links", finger.links},
                             {"joints", finger.joints}};
  if (finger.swing_joint) out["swing_joint"] = *finger.swing_joint;
  if (finger.tip_pad) out["tip_pad"] = *finger.tip_pad;
  return out;
}

nlohmann::ordered_json to_json(const SidecarPad& pad) {
  const Eigen::Quaterniond q(pad.X_LC.linear());
  nlohmann::ordered_json out{{"name", pad.name},
                             {"link", pad.link},
                             {"finger", pad.finger},
                             {"frame",
                              {{"translation_m", list_of_numbers<3>(pad.X_LC.translation())},
                               {"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}}}}};
  out["outline_m"] = nlohmann::ordered_json::array();
  for (const Eigen::Vector2d& corner : pad.outline) {
    out["outline_m"].push_back(list_of_numbers<2>(corner));
  }
  if (!pad.surface.empty()) {
    out["surface_m"] = nlohmann::ordered_json::array();
    for (const Eigen::Vector3d& point : pad.surface) {
      out["surface_m"].push_back(list_of_numbers<3>(point));
    }
  }
  out["clip"]["kind"] = pad.surface.empty() ? "prism" : "offset";
  out["clip"]["thickness_m"] = nullptr;
  if (pad.clip_thickness) out["clip"]["thickness_m"] = *pad.clip_thickness;
  return out;
}

nlohmann::ordered_json to_json(const SidecarPalm& palm) {
  nlohmann::ordered_json out{{"link", palm.link},
                             {"center_m", list_of_numbers<3>(palm.center_H)},
                             {"direction", list_of_numbers<3>(palm.direction_H)}};
  if (palm.pad) out["pad"] = *palm.pad;
  return out;
}

nlohmann::ordered_json to_json(const SidecarCoupling& coupling) {
  return {{"joint", coupling.joint},
          {"leader", coupling.leader},
          {"ratio", coupling.ratio},
          {"offset", coupling.offset},
          {"breakaway", coupling.breakaway}};
}

template <typename Items>
nlohmann::ordered_json list_of(const Items& items) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const auto& item : items) out.push_back(to_json(item));
  return out;
}

}  // namespace

Sidecar parse_sidecar(const std::string& text, const std::string& file) {
  const auto root = JsonValue::parsed<base::InvalidInput>(text, file);
  root.require_members({}, {"format", "hand", "description", "conventions", "fingers", "pads",
                            "palm", "closing", "couplings", "exclusions"});
  // A person who writes down a coupling or two need not give the format: the file's name tells it.
  if (const auto format = root.find("format")) check_format(*format);

  Sidecar sidecar;
  if (const auto description = root.find("description")) sidecar.description = description->text();
  if (const auto fingers = root.find("fingers")) {
    sidecar.fingers.emplace();
    for (const JsonValue& item : fingers->items()) sidecar.fingers->push_back(finger(item));
  }
  if (const auto pads = root.find("pads")) {
    sidecar.pads.emplace();
    for (const JsonValue& item : pads->items()) sidecar.pads->push_back(pad(item));
  }
  if (const auto its_palm = root.find("palm")) sidecar.palm = palm(*its_palm);
  if (const auto closing = root.find("closing")) {
    sidecar.closing.emplace();
    for (const auto& [joint, item] : closing->members()) {
      const double sign = item.number();
      if (sign != -1.0 && sign != 0.0 && sign != 1.0) item.fail("is none of -1, 0, 1");
      (*sidecar.closing)[checked(joint, item)] = static_cast<int>(sign);
    }
  }
  if (const auto couplings = root.find("couplings")) {
    sidecar.couplings.emplace();
    for (const JsonValue& item : couplings->items()) sidecar.couplings->push_back(coupling(item));
  }
  if (const auto exclusions = root.find("exclusions")) {
    sidecar.exclusions.emplace();
    for (const JsonValue& item : exclusions->items()) {
      const std::vector<std::string> pair = names(item);
      if (pair.size() != 2) item.fail("is not a pair of links");
      sidecar.exclusions->emplace_back(pair[0], pair[1]);
    }
  }
  return sidecar;
}

std::string sidecar_text(const Sidecar& sidecar, const std::string& hand,
                         const std::string& description) {
  nlohmann::ordered_json root;
  root["format"] = {{"name", kFormat}, {"version", kVersion}};
  root["hand"] = hand;
  root["description"] = description;
  root["conventions"] = kConventions;
  if (sidecar.fingers) root["fingers"] = list_of(*sidecar.fingers);
  if (sidecar.pads) root["pads"] = list_of(*sidecar.pads);
  if (sidecar.palm) root["palm"] = to_json(*sidecar.palm);
  if (sidecar.closing) {
    root["closing"] = nlohmann::ordered_json::object();
    for (const auto& [joint, sign] : *sidecar.closing) root["closing"][joint] = sign;
  }
  if (sidecar.couplings) root["couplings"] = list_of(*sidecar.couplings);
  if (sidecar.exclusions) {
    root["exclusions"] = nlohmann::ordered_json::array();
    for (const auto& [a, b] : *sidecar.exclusions) root["exclusions"].push_back({a, b});
  }
  // The name of a hand may be a file's name, which may contain any bytes.
  return root.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

}  // namespace graspfit::hands::internal
