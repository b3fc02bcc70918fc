#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace graspfit::sweep {

/// Folder of files that are not part of the repository: `$GRASPFIT_DATA`, or else `shared` beside
/// the repository.
std::filesystem::path data_folder();

/// Folder of the shipped configurations: `$GRASPFIT_EXPERIMENTS`, beside an installed program, or
/// the sources'. @throws InvalidInput if there is none.
std::filesystem::path config_folder();

/// The repository that this library was built from; need not exist any more.
std::filesystem::path source_folder();

/// Where a file of the data folder is: there, or else the packaged mesh of the same bytes, which
/// some of its meshes have (`packaged_twin`); none if it is in neither place. An absolute path is
/// itself.
std::optional<std::filesystem::path> find_data_file(const std::string& relative);

/// The same. @throws MissingData that says how to have it, if it is nowhere.
std::filesystem::path data_file(const std::string& relative);

/// Name of the packaged mesh that has the bytes of this file of the data folder; none if no mesh
/// has.
std::optional<std::string> packaged_twin(const std::string& relative);

/// A mesh of libcgal-demo by the name of its file; none if it is not unpacked on this machine.
/// `setup/setup.sh` unpacks them.
std::optional<std::filesystem::path> find_packaged_mesh(const std::string& name);

/// The same. @throws MissingData that says how to have it, if it is not there.
std::filesystem::path packaged_mesh(const std::string& name);

/// What manifests call an input: relative to the data folder or to the repository where it lies in
/// one of them, "packaged/..." for a packaged mesh; "sources/..." of the repository where the data
/// folder has a file of the same name. The root of a file system is no such folder here.
std::string name_of_input(const std::filesystem::path& file);

}  // namespace graspfit::sweep
