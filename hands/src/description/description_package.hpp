#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace graspfit::hands::internal {

/// The folder that `package://` leads to: that of the nearest package.xml above the file, or else
/// the file's own folder. Symbolic links resolved.
std::filesystem::path package_folder(const std::filesystem::path& description_file);

/// The only folders that a description may refer to, so that reading a stranger's hand does not
/// open other files of the user that it names. They are the package's folder and, where no
/// package.xml says what the package is, `meshes` beside the description's own folder: the layout
/// of most packages, "urdf/hand.urdf" with "../meshes/". Symbolic links resolved.
std::vector<std::filesystem::path> readable_folders(const std::filesystem::path& description_file);

/// Text for messages, to follow the name of a file that lies in none of the readable folders: where
/// the file is not, and what would let the description refer to it. `file` must have its symbolic
/// links resolved.
std::string outside_text(const std::filesystem::path& description_file,
                         const std::filesystem::path& file);

}  // namespace graspfit::hands::internal
