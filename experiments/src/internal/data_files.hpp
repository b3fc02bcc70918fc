#pragma once

#include <filesystem>
#include <string>

namespace graspfit::experiments::internal {

/// Folder of files that are not part of the repository: `$GRASPFIT_DATA`, or else `shared` beside
/// the repository.
std::filesystem::path data_folder();

/// A file in it. @throws MissingData that says how to have it, if it is not there.
std::filesystem::path data_file(const std::string& relative);

/// What manifests call an input: relative to the data folder or to the repository where it lies in
/// one of them; "sources/..." of the latter where the data folder has a file of the same name. The
/// root of a file system is no data folder here.
std::string name_of_input(const std::filesystem::path& file);

}  // namespace graspfit::experiments::internal
