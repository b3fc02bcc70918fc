#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace graspfit::hands::internal {

/// The mesh files that are named by an MJCF description and the files that it includes, by the name
/// of the mesh. Their paths are relative to the description's folder, with symbolic links resolved.
using MjcfMeshFiles = std::map<std::string, std::string>;

/// Follows the includes and folders of an MJCF description as MuJoCo does, before MuJoCo opens
/// anything: mjModel does not keep the files' names, and MuJoCo reads whatever it is told to.
/// @throws IoError, InvalidInput (file, element, name) for an included file, mesh, texture, height
/// field or skin that is not there or lies outside the description's package.
/// @throws InvalidInput (file, line, attribute) for numbers that are not finite, some of which
/// MuJoCo takes for defaults.
MjcfMeshFiles check_mjcf_files(const std::string& text, const std::filesystem::path& file);

}  // namespace graspfit::hands::internal
