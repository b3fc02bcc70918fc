#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graspfit::exchange::internal {

/// A value of a YAML file together with its location, so that every error message says
/// "grasps.yaml: line 12: /grasps/grasp_0/position: is missing". All members throw IoError.
class YamlNode {
 public:
  /// Parses a file's text, one document. `file` is its name in messages.
  static YamlNode parse(std::string file, const std::string& text);

  /// A member of this map; it must exist.
  YamlNode at(const std::string& key) const;
  std::optional<YamlNode> find(const std::string& key) const;
  /// The members of this map in the order of the file; no key may stand there twice.
  std::vector<std::pair<std::string, YamlNode>> members() const;

  std::string text() const;
  double number() const;  ///< Finite; written plain or quoted, read in the C locale.
  Eigen::Vector3d vector3() const;

  /// Throws IoError that states file, line, location and `what` in one line.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  YamlNode(std::shared_ptr<const std::string> file, YAML::Node node, std::string location)
      : file_(std::move(file)), node_(std::move(node)), location_(std::move(location)) {}

  std::shared_ptr<const std::string> file_;
  YAML::Node node_;
  std::string location_;
};

}  // namespace graspfit::exchange::internal
