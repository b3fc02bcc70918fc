#include "yaml/yaml_node.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "graspfit/base/errors.hpp"

namespace graspfit::exchange::internal {
namespace {

std::string in_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

}  // namespace

YamlNode YamlNode::parse(std::string file, const std::string& text) {
  const auto name = std::make_shared<const std::string>(std::move(file));
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() != 1) {
      throw base::IoError(*name + ": has " + std::to_string(documents.size()) +
                          " YAML documents, not one");
    }
    return {name, documents[0], ""};
  } catch (const YAML::Exception& error) {
    const std::string line =
        error.mark.is_null() ? "" : "line " + std::to_string(error.mark.line + 1) + ": ";
    throw base::IoError(*name + ": " + line + "is not YAML: " + in_one_line(error.msg));
  }
}

void YamlNode::fail(const std::string& what) const {
  const YAML::Mark mark = node_.Mark();
  const std::string line = mark.is_null() ? "" : "line " + std::to_string(mark.line + 1) + ": ";
  throw base::IoError(
      in_one_line(*file_ + ": " + line + (location_.empty() ? "/" : location_) + ": " + what));
}

std::vector<std::pair<std::string, YamlNode>> YamlNode::members() const {
  if (!node_.IsMap()) fail("is not a map");
  std::vector<std::pair<std::string, YamlNode>> nodes;
  std::set<std::string> keys;
  for (const auto& member : node_) {
    if (!member.first.IsScalar()) fail("has a key that is not a text");
    const std::string& key = member.first.Scalar();
    if (!keys.insert(key).second) fail("has " + key + " twice");
    nodes.emplace_back(key, YamlNode(file_, member.second, location_ + '/' + key));
  }
  return nodes;
}

std::optional<YamlNode> YamlNode::find(const std::string& key) const {
  for (auto& [name, node] : members()) {
    if (name == key) return node;
  }
  return std::nullopt;
}

YamlNode YamlNode::at(const std::string& key) const {
  if (const std::optional<YamlNode> found = find(key)) return *found;
  YamlNode(file_, node_, location_ + '/' + key).fail("is missing");
}

std::string YamlNode::text() const {
  if (!node_.IsScalar()) fail("is not a text");
  return node_.Scalar();
}

double YamlNode::number() const {
  if (!node_.IsScalar()) fail("is not a number");
  const std::string& text = node_.Scalar();
  const char* first = text.data();
  const char* const last = first + text.size();
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++first;
  double value = 0.0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc() || end != last || !std::isfinite(value)) {
    fail("is \"" + text + "\", not a finite number");
  }
  return value;
}

Eigen::Vector3d YamlNode::vector3() const {
  if (!node_.IsSequence() || node_.size() != 3) fail("is not a list of three numbers");
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) {
    v[i] = YamlNode(file_, node_[i], location_ + '/' + std::to_string(i)).number();
  }
  return v;
}

}  // namespace graspfit::exchange::internal
