#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace graspfit::testing {

/// The repository's root, for files under version control: `source_directory() / "hands/models"`.
std::filesystem::path source_directory();

/// A file of the data folder that does not belong to the repository, such as
/// `meshes/paper/bunny.off`. The folder is `$GRASPFIT_DATA`, or else `shared` beside the
/// repository. Empty when there is no such file; the test then skips itself.
std::optional<std::filesystem::path> find_data(std::string_view relative_path);

/// A mesh of Debian's `libcgal-demo`, such as `bunny00.off`, unpacked by `./quickstart` and
/// `./run-tests` into `$GRASPFIT_PACKAGED_MESHES`, or else `graspfit/meshes` in the user's cache
/// (`$XDG_CACHE_HOME` or `~/.cache`). Empty when there is no such file.
std::optional<std::filesystem::path> packaged_mesh(std::string_view file_name);

}  // namespace graspfit::testing
