#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

namespace graspfit::exchange::internal {

/// A double-quoted YAML scalar, which is JSON's text too.
std::string in_quotes(std::string_view text);

/// The shortest round-trip decimal with a point in it: YAML 1.1 takes "1e-17" for a text.
std::string yaml_number(double value);

/// "[x, y, z]".
std::string yaml_list(const Eigen::Vector3d& v);

/// The name that other tools get to know an object by: its file's name without extension.
std::string object_name(const std::string& file);

}  // namespace graspfit::exchange::internal
