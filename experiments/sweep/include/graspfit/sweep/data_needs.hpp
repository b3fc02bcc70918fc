#pragma once

#include <string>
#include <vector>

namespace graspfit::sweep {

/// Where something that cells read comes from.
enum class DataSource {
  BuiltIn,               ///< A shape, made by the program itself.
  Packaged,              ///< A mesh of libcgal-demo.
  DataFolder,            ///< A mesh or a hand in `data_folder`.
  DataFolderOrPackaged,  ///< A mesh of the data folder that libcgal-demo has, too, byte for byte.
  OwnFile                ///< A file by its absolute path.
};

/// Something that a setting names.
struct DataNeed {
  DataSource source = DataSource::BuiltIn;
  std::string name;       ///< As the setting has it: "meshes/paper/mug.obj", "torus".
  bool is_there = false;  ///< On this machine, now.
};

/// Returns all data that settings (a JSON object as text) name by `file`, `packaged`, `shape` and,
/// unless it is a shipped one, `hand`, also in nested settings, in the order of keys (by name) and
/// array items.
std::vector<DataNeed> data_needs(const std::string& settings);

/// Says whether all data that settings name are there.
bool has_all_data(const std::string& settings);

}  // namespace graspfit::sweep
