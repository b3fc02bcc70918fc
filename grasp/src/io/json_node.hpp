#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/grasp/option_names.hpp"

namespace graspfit::grasp::internal {

/// A value of a JSON file together with where it stands, so that every complaint says
/// "grasps.json: /results/grasps/0/quality/m: is missing". All members throw IoError.
class JsonNode {
 public:
  using Json = nlohmann::ordered_json;

  /// The root of a file, which messages name by its path.
  static JsonNode read(const std::filesystem::path& file);

  /// A member of this object; it must exist.
  JsonNode at(const std::string& key) const;
  /// The items of this array.
  std::vector<JsonNode> items() const;
  /// The members of this object, in the order of the file.
  std::vector<std::pair<std::string, JsonNode>> members() const;

  bool is_null() const;
  bool is_text() const;
  double number() const;
  double positive_number() const;  ///< > 0.
  std::int64_t integer() const;
  std::uint64_t unsigned_integer() const;
  std::size_t count() const { return static_cast<std::size_t>(unsigned_integer()); }
  int small_integer() const;
  bool flag() const;
  std::string text() const;
  std::string path() const;  ///< Of a file, as geometry's `path_text` writes it.
  std::vector<std::string> texts() const;
  Eigen::Vector3d vector3() const;
  geometry::RigidTransform pose() const;  ///< {translation_m, rotation_wxyz}.

  /// A value of an enumeration by its name.
  template <class Enum>
  Enum choice() const {
    const std::string name = text();
    const auto value = value_named<Enum>(name);
    if (!value) fail("is \"" + name + "\", not one of " + names_of<Enum>());
    return *value;
  }

  /// Throws IoError: file, place, `what`.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  JsonNode(std::shared_ptr<const std::string> file, std::shared_ptr<const Json> root,
           const Json* json, std::string place)
      : file_(std::move(file)), root_(std::move(root)), json_(json), place_(std::move(place)) {}
  JsonNode child(const Json& json, const std::string& name) const {
    return {file_, root_, &json, place_ + '/' + name};
  }
  template <std::size_t N>
  std::array<double, N> numbers() const;

  std::shared_ptr<const std::string> file_;
  std::shared_ptr<const Json> root_;  ///< Keeps the tree alive that `json_` points into.
  const Json* json_;
  std::string place_;  ///< JSON pointer; empty for the root.
};

}  // namespace graspfit::grasp::internal
