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

/// Finds a file of the data folder: in that folder, or else as the packaged mesh with the same
/// bytes, which some of its meshes have (`packaged_twin`). The result is empty if the file is in
/// neither place. An absolute path is looked up as it is.
std::optional<std::filesystem::path> find_data_file(const std::string& relative);

/// As `find_data_file`. @throws MissingData that says how to get the file, if it is nowhere.
std::filesystem::path data_file(const std::string& relative);

/// Name of the packaged mesh that has the bytes of this file of the data folder; none if no mesh
/// has.
std::optional<std::string> packaged_twin(const std::string& relative);

/// A mesh of libcgal-demo by the name of its file; none if it is not unpacked on this machine.
/// `setup/setup.sh` unpacks them.
std::optional<std::filesystem::path> find_packaged_mesh(const std::string& name);

/// As `find_packaged_mesh`. @throws MissingData that says how to get the mesh, if it is not there.
std::filesystem::path packaged_mesh(const std::string& name);

/// Returns the name of an input in manifests. It is relative to the data folder or to the
/// repository where the file lies in one of them, and "packaged/..." for a packaged mesh. A file of
/// the repository is "sources/..." where the data folder has a file of the same name. The root of a
/// file system does not count as one of these folders. Any other file is named by its absolute
/// path.
std::string name_of_input(const std::filesystem::path& file);

}  // namespace graspfit::sweep
