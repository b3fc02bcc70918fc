#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace graspfit::testing {

/// Returns the repository's root, for files under version control: `source_directory() /
/// "hands/models"`.
std::filesystem::path source_directory();

/// Returns the path of a file of the data folder that does not belong to the repository, such as
/// `meshes/paper/bunny.off`. The folder is `$GRASPFIT_DATA`, or else `shared` beside the
/// repository. It is empty when there is no such file; the test then skips itself.
std::optional<std::filesystem::path> find_data(std::string_view relative_path);

/// Returns the path of a mesh of Debian's `libcgal-demo`, such as `bunny00.off`, which
/// `./quickstart` and `./run-tests` unpack into `$GRASPFIT_PACKAGED_MESHES`, or else into
/// `graspfit/meshes` in the user's cache (`$XDG_CACHE_HOME` or `~/.cache`). It is empty when there
/// is no such file.
std::optional<std::filesystem::path> packaged_mesh(std::string_view file_name);

}  // namespace graspfit::testing
