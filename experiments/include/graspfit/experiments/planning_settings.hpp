#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/base/number_range.hpp"
#include "graspfit/grasp/object_file.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/sweep/experiment.hpp"

namespace graspfit::experiments {

/// The object of a cell: where its mesh comes from, its size and its orientation.
struct ObjectSettings {
  // One of these three; the others are empty.
  std::string file;      ///< Mesh file in the data folder, or by an absolute path.
  std::string packaged;  ///< A mesh of libcgal-demo by the name of its file.
  std::string shape;     ///< Name of a `geometry::named_shape`, in meters.
  /// Length of the bounding box along `size_axis` [m]; empty: as it is.
  std::optional<double> size;
  std::optional<int> size_axis;  ///< 0, 1, 2; empty: the longest.
  /// Of the file, where `size` does not say how large the object is; empty: 1.
  std::optional<double> meters_per_unit;
  /// The object is scaled down further where its bounding box's shortest edge is longer than this
  /// [m], so that a hand that spans so much can close around it.
  std::optional<double> largest_thickness;
  /// Angles by which the object, scaled, is turned about its frame's fixed x, then y, then z axis
  /// [rad]: planning sees it in that pose.
  Eigen::Vector3d rotation_xyz = Eigen::Vector3d::Zero();

  /// Rank among `geometry::likely_rest_poses`, the likeliest being 1: planning sees the object laid
  /// down on the plane z = 0. Empty: as it is.
  std::optional<int> rest_pose;

  std::string key() const;  ///< Differs between different objects.
};

/// What the planner is asked to do in a cell.
struct PlanningSettings {
  ObjectSettings object;
  std::string hand;  ///< A shipped hand, or a description in the data folder (has a '/').
  std::optional<double> table_z_O;  ///< Everything at or below this z is solid [m].
  std::string preset;  ///< Preset that `options` start from, before other settings; empty: none.
  grasp::PlannerOptions options;
};

/// What stands around the object: a table under an object that was laid down, or where `table_z_O`
/// has it, with the usual clearance.
grasp::Surroundings surroundings_of(const PlanningSettings& settings);

/// Names of all settings with their units and meanings:
///
///     file, packaged or shape, size_m, size_axis (x|y|z|longest), meters_per_unit,
///     largest_thickness_m, rotation_deg, rest_pose, hand, preset
///
/// and table (z in the object's frame) and the planner's options by the names that they have as
/// flags of `graspfit plan`.
const std::vector<sweep::Column>& planning_setting_names();

/// What there is to know about a setting.
struct SettingDescription {
  sweep::Column name;
  std::string allowed;   ///< For people: "a|b", "true|false", "in [4, 512]", "> 0", "text".
  std::string fallback;  ///< Its value where it is not given; empty: none.
  std::optional<base::NumberRange> range;  ///< Range of a number, in `name.unit`.
};

/// All settings of `planning_setting_names`, in that order.
const std::vector<SettingDescription>& planning_setting_descriptions();

/// Checks rules between settings that are allowed one by one. It comes before the check of
/// `PlannerOptions` itself, whose messages name members. @throws SettingError in the words of the
/// settings.
void require_compatible(const grasp::PlannerOptions& options);

/// The settings of a cell; its seed becomes the planner's. `others` are names that belong to the
/// experiment itself and are passed over. @throws SettingError for unknown names and values that
/// are not allowed.
PlanningSettings planning_settings(const sweep::Cell& cell,
                                   const std::vector<sweep::Column>& others = {});

/// As above, from any JSON object (as text) and a seed, for settings nested in others.
PlanningSettings planning_settings(const std::string& settings, std::uint64_t seed,
                                   const std::vector<sweep::Column>& others = {});

/// Loads the object of a cell, scaled, repaired and turned. The last few objects are kept, for
/// cells that share one. @throws MissingData if its file is not there; as
/// `grasp::read_object_file`.
std::shared_ptr<const grasp::ObjectFile> load_object(const ObjectSettings& settings);

/// The hand of a cell. @throws MissingData if its file is not there; as `hands::read_hand_model`.
std::shared_ptr<const hands::HandModel> load_hand(const std::string& hand);

/// The files of object and hand, for manifests.
std::vector<std::filesystem::path> planning_inputs(const PlanningSettings& settings);

}  // namespace graspfit::experiments
