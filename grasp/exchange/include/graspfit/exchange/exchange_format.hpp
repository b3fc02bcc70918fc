#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/grasp/grasp_io.hpp"

namespace graspfit::exchange {

/// File formats of other tools. Each has a header of its own that says frames, units and quaternion
/// order.
enum class ExchangeFormat {
  IsaacGrasp,     ///< isaac_grasp 1.0, YAML; the one that is read too.
  DexGraspBench,  ///< NPZ of plain arrays.
  MoveItGrasp,    ///< YAML with the keys of moveit_msgs/Grasp.
  GraspItWorld,   ///< World XML; one grasp a file.
  PosedGlb,       ///< glTF 2.0 binary: posed hand and object; one grasp a file.
};

/// "isaac", "dexgraspbench", "moveit", "graspit", "glb".
std::string_view name_of(ExchangeFormat format);

/// The format of a name; empty if there is none of it.
std::optional<ExchangeFormat> format_named(std::string_view name);

/// The format that a file's extension stands for: .yaml and .yml isaac_grasp, .npz, .xml, .glb;
/// empty for others.
std::optional<ExchangeFormat> format_of(const std::filesystem::path& file);

/// "xml", ...: the extension of a format's files, without the dot.
std::string_view extension_of(ExchangeFormat format);

/// Whether a file of that format holds a single grasp.
bool holds_one_grasp(ExchangeFormat format);

/// What of this file's grasps the format cannot carry, or carries otherwise than a reader of the
/// format may expect: a sentence each, for people.
std::vector<std::string> limits_of(ExchangeFormat format, const grasp::GraspFile& file);

}  // namespace graspfit::exchange
