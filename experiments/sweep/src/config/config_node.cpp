#include "config/config_node.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/nearest_name.hpp"

namespace graspfit::sweep::internal {

void ConfigNode::fail(const std::string& what) const {
  throw base::InvalidInput(file_ + ": " + (place_.empty() ? "/" : place_) + ": " + what);
}

bool ConfigNode::has(const std::string& key) const { return json_->contains(key); }

void ConfigNode::require_members(const std::vector<std::string>& required,
                                 const std::vector<std::string>& optional) const {
  const auto is_in = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const auto& [key, node] : members()) {
    if (is_in(required, key) || is_in(optional, key)) continue;
    std::vector<std::string> known = required;
    known.insert(known.end(), optional.begin(), optional.end());
    node.fail("is not a member that is known here; there are " + base::known_names(key, known));
  }
  for (const std::string& key : required) at(key);
}

ConfigNode ConfigNode::at(const std::string& key) const {
  if (!json_->is_object()) fail("is not an object");
  const auto member = json_->find(key);
  const std::string place = place_ + '/' + key;
  if (member == json_->end()) ConfigNode(file_, *json_, place).fail("is missing");
  return {file_, *member, place};
}

std::vector<ConfigNode> ConfigNode::items() const {
  if (!json_->is_array() || json_->empty()) fail("is not an array with at least one value");
  std::vector<ConfigNode> nodes;
  for (const Json& item : *json_) {
    nodes.emplace_back(file_, item, place_ + '/' + std::to_string(nodes.size()));
  }
  return nodes;
}

std::vector<std::pair<std::string, ConfigNode>> ConfigNode::members() const {
  if (!json_->is_object()) fail("is not an object");
  std::vector<std::pair<std::string, ConfigNode>> nodes;
  for (const auto& [key, value] : json_->items()) {
    nodes.emplace_back(key, ConfigNode(file_, value, place_ + '/' + key));
  }
  return nodes;
}

std::string ConfigNode::text() const {
  if (!json_->is_string() || json_->get_ref<const std::string&>().empty()) {
    fail("is " + json_->dump() + ", not a text");
  }
  return json_->get<std::string>();
}

std::uint64_t ConfigNode::unsigned_integer() const {
  if (!json_->is_number_unsigned()) fail("is " + json_->dump() + ", not an integer from 0");
  return json_->get<std::uint64_t>();
}

}  // namespace graspfit::sweep::internal
