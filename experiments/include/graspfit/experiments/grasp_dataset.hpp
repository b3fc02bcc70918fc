#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/sweep/experiment_config.hpp"

/// \file
/// Data sets of grasps: many objects, some hands, a few grasps of each. Underneath is an experiment
/// whose cells are objects times hands, so that runs resume, come in shards, and give the same
/// bytes whatever they are cut into.

namespace graspfit::experiments {

/// Slug of the experiment, and so the name of its tables: `dataset.csv` is the index.
inline constexpr const char* kDatasetSlug = "dataset";

/// Protocol of a data set whose grasps are not tested in physics.
inline constexpr const char* kNoProtocol = "none";

/// A mesh of a data set.
struct DatasetObject {
  std::filesystem::path file;
  std::string name;                       ///< What rows call it; empty: made of the file's name.
  std::optional<double> longest;          ///< Longest edge of its bounding box [m].
  std::optional<double> meters_per_unit;  ///< Of its file, where `longest` is not given.
  std::string license;                    ///< As its source states it; empty: not stated.
};

/// The objects of some sources, in their order: a mesh (OFF, OBJ, PLY, STL, glTF, GLB), a folder
/// (all meshes in it and in its folders, by their paths), or a list. A list is a text file with a
/// mesh on each line (`.txt`; # begins a comment), or a table (`.csv`) with a column `file` and
/// perhaps `name`, `longest_m`, `meters_per_unit`, `license`; its paths are relative to the list's
/// folder. The meshes are not read: what is wrong with one of them is said by its row.
/// @throws IoError for a source that cannot be read, InvalidInput for one that is none of these, an
/// empty one, or bad values of a table, with its line.
std::vector<DatasetObject> dataset_objects(std::span<const std::filesystem::path> sources);

/// What a data set is made of.
struct DatasetRequest {
  std::vector<DatasetObject> objects;  ///< At least one.
  std::vector<std::string> hands;      ///< Shipped hands or descriptions; at least one.
  /// Longest edges of the bounding box [m], each a value of its own for every object that has no
  /// `longest`; empty: objects keep their sizes.
  std::vector<double> sizes;
  std::optional<double> meters_per_unit;  ///< Of objects that state none; empty: 1.
  std::string preset = "strong";
  int grasps = 5;                               ///< Of each object with each hand, at most.
  std::string protocol = "dexgraspbench-100g";  ///< Hold test of every grasp, or `kNoProtocol`.
  int margins = 0;  ///< Grasps of each cell whose smallest failing loads are searched for.
  std::uint64_t seed = 1;
  /// Further settings of the experiment by their names, as texts: numbers, true and false are read
  /// as such.
  std::vector<std::pair<std::string, std::string>> settings = {};
};

/// The configuration of the experiment, as JSON. Objects that would have the same name get numbers.
/// @throws InvalidInput for a request without objects or hands.
std::string dataset_config(const DatasetRequest& request);

/// The experiment: a cell plans grasps of one object with one hand, tests them and keeps its grasp
/// file in its folder. A mesh or hand that cannot be used is a row with its reason.
const sweep::Experiment& dataset_experiment();

/// What `write_dataset_files` wrote, and counted.
struct DatasetFiles {
  std::vector<std::filesystem::path> arrays;  ///< Relative to the data set's folder.
  std::filesystem::path card;
};

/// Writes, from the finished tables and grasp files of a data set in `folder`:
///
///     arrays/<hand>_0001.npz   `exchange::GraspArrays` of the first thousand objects of the
///                              configuration, ...; objects without grasps are left out
///     CARD.md                  what is in it, how it was made, how to load it
///
/// Memory holds the grasps of a thousand objects. The same bytes for the same data set.
/// @throws IoError, InvalidInput for tables or grasp files that are damaged.
DatasetFiles write_dataset_files(const std::filesystem::path& folder,
                                 const sweep::ExperimentConfig& config);

}  // namespace graspfit::experiments
