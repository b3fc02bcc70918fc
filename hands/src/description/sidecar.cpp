#include "description/sidecar.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "description/control_characters.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/base/list_text.hpp"

namespace graspfit::hands::internal {

namespace {

using base::InvalidInput;
using base::IoError;
using nlohmann::json;

constexpr const char* kFormat = "graspfit hand sidecar";
constexpr int kVersion = 1;

/// A value of the file and where it stands, so that every complaint names both.
class Item {
 public:
  Item(const json& value, std::string file, std::string path)
      : value_(value), file_(std::move(file)), path_(std::move(path)) {}

  /// In one line, whatever the file's keys hold.
  [[noreturn]] void fail(const std::string& what) const {
    std::string message = file_ + ": " + (path_.empty() ? "" : path_ + ": ") + what;
    std::replace_if(message.begin(), message.end(), is_control, ' ');
    throw InvalidInput(message);
  }

  /// Refuses fields that the format does not know: most are misspelled.
  void require_fields(const std::vector<std::string>& known) const {
    if (!value_.is_object()) fail("is not an object {...}");
    for (const auto& [key, unused] : value_.items()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      fail("unknown field " + key + "; known are " + base::list_text(known));
    }
  }

  Item at(const std::string& key) const {
    const std::string inner = path_.empty() ? key : path_ + "." + key;
    if (!value_.is_object()) fail("is not an object {...}");
    const auto found = value_.find(key);
    if (found == value_.end()) fail("no field " + key);
    return {*found, file_, inner};
  }

  /// The field unless it is missing or null.
  std::optional<Item> find(const std::string& key) const {
    if (!value_.is_object()) fail("is not an object {...}");
    const auto found = value_.find(key);
    if (found == value_.end() || found->is_null()) return std::nullopt;
    return at(key);
  }

  std::vector<Item> array() const {
    if (!value_.is_array()) fail("is not a list [...]");
    std::vector<Item> items;
    for (std::size_t i = 0; i < value_.size(); ++i) {
      items.emplace_back(value_[i], file_, path_ + "[" + std::to_string(i) + "]");
    }
    return items;
  }

  std::vector<std::pair<std::string, Item>> entries() const {
    if (!value_.is_object()) fail("is not an object {...}");
    std::vector<std::pair<std::string, Item>> result;
    for (const auto& [key, value] : value_.items()) {
      result.emplace_back(key, Item(value, file_, path_ + "." + key));
      if (std::any_of(key.begin(), key.end(), is_control))
        fail("has a control character in a name");
    }
    return result;
  }

  std::string text() const {
    if (!value_.is_string()) fail("is not a text");
    return value_.get<std::string>();
  }

  std::string name() const {
    if (!value_.is_string() || value_.get_ref<const std::string&>().empty()) {
      fail("is not a name (a text that is not empty)");
    }
    const auto& name = value_.get_ref<const std::string&>();
    // Names are shown in messages of one line.
    if (std::any_of(name.begin(), name.end(), is_control)) fail("has a control character");
    return name;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const Item& item : array()) result.push_back(item.name());
    return result;
  }

  double number() const {
    if (!value_.is_number()) fail("is not a number");
    const double value = value_.get<double>();
    if (!std::isfinite(value)) fail("is not finite");
    return value;
  }

  bool boolean() const {
    if (!value_.is_boolean()) fail("is neither true nor false");
    return value_.get<bool>();
  }

  template <int Size>
  Eigen::Matrix<double, Size, 1> vector() const {
    const std::vector<Item> items = array();
    if (items.size() != Size) {
      fail("has " + std::to_string(items.size()) + " of " + std::to_string(Size) + " numbers");
    }
    Eigen::Matrix<double, Size, 1> result;
    for (int i = 0; i < Size; ++i) result[i] = items[i].number();
    return result;
  }

 private:
  const json& value_;
  std::string file_;
  std::string path_;
};

void check_format(const Item& format) {
  format.require_fields({"name", "version"});
  if (format.at("name").name() != kFormat) {
    format.fail("name is not \"" + std::string(kFormat) + "\"");
  }
  const double version = format.at("version").number();
  if (version != kVersion) {
    format.fail("version is not " + std::to_string(kVersion) + ", the one this program reads");
  }
}

SidecarFinger finger(const Item& item) {
  item.require_fields({"name", "thumb", "links", "joints", "swing_joint", "tip_pad"});
  SidecarFinger result;
  result.name = item.at("name").name();
  if (const auto thumb = item.find("thumb")) result.is_thumb = thumb->boolean();
  result.links = item.at("links").names();
  result.joints = item.at("joints").names();
  if (const auto swing = item.find("swing_joint")) result.swing_joint = swing->name();
  if (const auto pad = item.find("tip_pad")) result.tip_pad = pad->name();
  return result;
}

SidecarPad pad(const Item& item) {
  item.require_fields({"name", "link", "finger", "frame", "outline_m", "surface_m", "clip"});
  SidecarPad result;
  result.name = item.at("name").name();
  result.link = item.at("link").name();
  result.finger = item.at("finger").name();
  const Item frame = item.at("frame");
  frame.require_fields({"translation_m", "rotation_wxyz"});
  result.X_LC.translation() = frame.at("translation_m").vector<3>();
  const Item rotation = frame.at("rotation_wxyz");
  const Eigen::Vector4d q = rotation.vector<4>();
  // A person may type 0.7071: normalize, and refuse only what is no rotation at all.
  if (std::abs(q.norm() - 1.0) > 1e-3) rotation.fail("is not a unit quaternion");
  result.X_LC.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  for (const Item& corner : item.at("outline_m").array()) {
    result.outline.push_back(corner.vector<2>());
  }
  if (const auto surface = item.find("surface_m")) {
    for (const Item& point : surface->array()) result.surface.push_back(point.vector<3>());
    if (result.surface.empty()) surface->fail("is empty; leave it out where the pad is flat");
  }
  if (const auto clip = item.find("clip")) {
    clip->require_fields({"kind", "thickness_m"});
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

SidecarPalm palm(const Item& item) {
  item.require_fields({"link", "center_m", "direction", "pad"});
  SidecarPalm result;
  result.link = item.at("link").name();
  result.center_H = item.at("center_m").vector<3>();
  const Item direction = item.at("direction");
  result.direction_H = direction.vector<3>();
  if (result.direction_H.norm() == 0.0) direction.fail("is zero");
  result.direction_H.normalize();
  if (const auto its_pad = item.find("pad")) result.pad = its_pad->name();
  return result;
}

SidecarCoupling coupling(const Item& item) {
  item.require_fields({"joint", "leader", "ratio", "offset", "breakaway"});
  SidecarCoupling result;
  result.joint = item.at("joint").name();
  result.leader = item.at("leader").name();
  if (const auto ratio = item.find("ratio")) result.ratio = ratio->number();
  if (const auto offset = item.find("offset")) result.offset = offset->number();
  if (const auto breakaway = item.find("breakaway")) result.breakaway = breakaway->boolean();
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
  json document;
  try {
    document = json::parse(text);
  } catch (const json::exception& error) {
    throw IoError(file + ": not JSON: " + base::json_fault(error.what()));
  }
  const Item root(document, file, "");
  root.require_fields({"format", "hand", "description", "conventions", "fingers", "pads", "palm",
                       "closing", "couplings", "exclusions"});
  // A person who writes down a coupling or two need not write what this is: the file's name says.
  if (const auto format = root.find("format")) check_format(*format);

  Sidecar sidecar;
  if (const auto description = root.find("description")) sidecar.description = description->text();
  if (const auto fingers = root.find("fingers")) {
    sidecar.fingers.emplace();
    for (const Item& item : fingers->array()) sidecar.fingers->push_back(finger(item));
  }
  if (const auto pads = root.find("pads")) {
    sidecar.pads.emplace();
    for (const Item& item : pads->array()) sidecar.pads->push_back(pad(item));
  }
  if (const auto its_palm = root.find("palm")) sidecar.palm = palm(*its_palm);
  if (const auto closing = root.find("closing")) {
    sidecar.closing.emplace();
    for (const auto& [joint, item] : closing->entries()) {
      const double sign = item.number();
      if (sign != -1.0 && sign != 0.0 && sign != 1.0) item.fail("is none of -1, 0, 1");
      (*sidecar.closing)[joint] = static_cast<int>(sign);
    }
  }
  if (const auto couplings = root.find("couplings")) {
    sidecar.couplings.emplace();
    for (const Item& item : couplings->array()) sidecar.couplings->push_back(coupling(item));
  }
  if (const auto exclusions = root.find("exclusions")) {
    sidecar.exclusions.emplace();
    for (const Item& item : exclusions->array()) {
      const std::vector<std::string> pair = item.names();
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
  // The name of a hand may be that of a file, whose bytes are anything.
  return root.dump(1, ' ', false, json::error_handler_t::replace) + '\n';
}

}  // namespace graspfit::hands::internal
