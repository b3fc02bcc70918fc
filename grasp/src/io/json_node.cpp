#include "io/json_node.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/path_text.hpp"
#include "io/pose_numbers.hpp"

namespace graspfit::grasp::internal {

JsonNode JsonNode::read(const std::filesystem::path& file) {
  const auto name = std::make_shared<const std::string>(file.string());
  const std::string text = base::read_json_file(file);
  try {
    const auto root = std::make_shared<const Json>(Json::parse(text));
    return {name, root, root.get(), ""};
  } catch (const Json::exception& error) {
    throw base::IoError(*name + ": is not JSON: " + base::json_fault(error.what()));
  }
}

void JsonNode::fail(const std::string& what) const {
  throw base::IoError(*file_ + ": " + (place_.empty() ? "/" : place_) + ": " + what);
}

bool JsonNode::is_null() const { return json_->is_null(); }
bool JsonNode::is_text() const { return json_->is_string(); }

JsonNode JsonNode::at(const std::string& key) const {
  if (!json_->is_object()) fail("is not an object");
  const auto member = json_->find(key);
  if (member == json_->end()) child(*json_, key).fail("is missing");
  return child(*member, key);
}

std::vector<JsonNode> JsonNode::items() const {
  if (!json_->is_array()) fail("is not an array");
  std::vector<JsonNode> nodes;
  for (const Json& item : *json_) nodes.push_back(child(item, std::to_string(nodes.size())));
  return nodes;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  if (!json_->is_object()) fail("is not an object");
  std::vector<std::pair<std::string, JsonNode>> nodes;
  for (const auto& [key, value] : json_->items()) nodes.emplace_back(key, child(value, key));
  return nodes;
}

double JsonNode::number() const {
  if (!json_->is_number()) fail("is not a number");
  return json_->get<double>();
}

double JsonNode::positive_number() const {
  const double value = number();
  if (!(value > 0.0)) fail("is " + base::shortest_decimal(value) + ", must be > 0");
  return value;
}

std::int64_t JsonNode::integer() const {
  if (!json_->is_number_integer()) fail("is not an integer");
  if (json_->is_number_unsigned() &&
      json_->get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()}) {
    fail("is too large");
  }
  return json_->get<std::int64_t>();
}

std::uint64_t JsonNode::unsigned_integer() const {
  if (!json_->is_number_unsigned()) fail("is not an integer from 0");
  return json_->get<std::uint64_t>();
}

int JsonNode::small_integer() const {
  const std::int64_t value = integer();
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    fail("is out of range: " + std::to_string(value));
  }
  return static_cast<int>(value);
}

bool JsonNode::flag() const {
  if (!json_->is_boolean()) fail("is neither true nor false");
  return json_->get<bool>();
}

std::string JsonNode::text() const {
  if (!json_->is_string()) fail("is not a text");
  return json_->get<std::string>();
}

std::string JsonNode::path() const { return base::path_of_text(text()); }

std::vector<std::string> JsonNode::texts() const {
  std::vector<std::string> texts;
  for (const JsonNode& item : items()) texts.push_back(item.text());
  return texts;
}

template <std::size_t N>
std::array<double, N> JsonNode::numbers() const {
  const std::vector<JsonNode> nodes = items();
  if (nodes.size() != N) {
    fail("has " + std::to_string(nodes.size()) + " numbers, not " + std::to_string(N));
  }
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) values[i] = nodes[i].number();
  return values;
}

Eigen::Vector3d JsonNode::vector3() const {
  const auto [x, y, z] = numbers<3>();
  return {x, y, z};
}

geometry::RigidTransform JsonNode::pose() const {
  const JsonNode rotation = at("rotation_wxyz");
  const std::array<double, 4> wxyz = rotation.numbers<4>();
  double squared_norm = 0.0;
  for (double component : wxyz) squared_norm += component * component;
  // Written quaternions are unit to rounding; six digits by hand pass, a wrong convention does not.
  if (!(std::abs(squared_norm - 1.0) < 1e-5)) rotation.fail("is not a unit quaternion");
  return internal::pose(at("translation_m").vector3(), wxyz);
}

}  // namespace graspfit::grasp::internal
