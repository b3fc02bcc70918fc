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
  IsaacGrasp,     ///< isaac_grasp 1.0, YAML; also read.
  DexGraspBench,  ///< NPZ of plain arrays; also read.
  MoveItGrasp,    ///< YAML with the keys of moveit_msgs/Grasp.
  GraspItWorld,   ///< World XML; one grasp a file.
  PosedGlb,       ///< glTF 2.0 binary: posed hand and object; one grasp a file.
};

/// "isaac", "dexgraspbench", "moveit", "graspit", "glb".
std::string_view name_of(ExchangeFormat format);

/// Returns the format of that name; empty if there is none.
std::optional<ExchangeFormat> format_named(std::string_view name);

/// The format that a file's extension stands for: .yaml and .yml isaac_grasp, .npz, .xml, .glb,
/// in letters of either case; empty for others.
std::optional<ExchangeFormat> format_of(const std::filesystem::path& file);

/// "xml", ...: the extension of a format's files, without the dot.
std::string_view extension_of(ExchangeFormat format);

/// Whether a file of that format holds a single grasp.
bool holds_one_grasp(ExchangeFormat format);

/// Returns what of this file's grasps the format cannot carry, or carries otherwise than a reader
/// of the format may expect: a sentence each, for people.
std::vector<std::string> limits_of(ExchangeFormat format, const grasp::GraspFile& file);

}  // namespace graspfit::exchange
