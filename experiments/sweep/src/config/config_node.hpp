#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace graspfit::sweep::internal {

/// A value of a configuration file with where it stands, so that every complaint says
/// "planner.json: /axes/hand/2: is 3, not a text". All members throw InvalidInput.
class ConfigNode {
 public:
  using Json = nlohmann::ordered_json;

  ConfigNode(std::string file, const Json& json, std::string place = "")
      : file_(std::move(file)), json_(&json), place_(std::move(place)) {}

  const Json& json() const { return *json_; }
  const std::string& place() const { return place_; }

  /// Throws unless this is an object with these members and no others but the optional ones.
  void require_members(const std::vector<std::string>& required,
                       const std::vector<std::string>& optional) const;
  bool has(const std::string& key) const;
  ConfigNode at(const std::string& key) const;
  std::vector<ConfigNode> items() const;  ///< Of an array that is not empty.
  std::vector<std::pair<std::string, ConfigNode>> members() const;
  std::string text() const;  ///< Not empty.
  std::uint64_t unsigned_integer() const;
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string file_;
  const Json* json_;
  std::string place_;
};

}  // namespace graspfit::sweep::internal
