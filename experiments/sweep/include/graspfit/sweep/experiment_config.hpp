#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/sweep/experiment.hpp"

namespace graspfit::sweep {

/// The axis of objects, in experiments that have one.
inline constexpr const char* kObjectAxis = "object";

/// One `axis=a,b,...` of the command line.
struct AxisChange {
  std::string axis;
  std::vector<std::string> values;
};

/// Parses "axis=a,b". @throws InvalidInput.
AxisChange parse_axis_change(const std::string& text);

/// Which part of an experiment's configuration is run, and what is changed in it.
struct ConfigRequest {
  bool is_quick = false;            ///< Whether only the few cells of its member `quick` are run.
  std::vector<AxisChange> changes;  ///< Changes of axes, made in order.
  /// Meshes for the axis `object`, instead of its values, or beside those that a change picks.
  std::vector<std::filesystem::path> object_files = {};
  std::optional<double> object_longest = {};  ///< Longest edge of the bounding box of each of these
                                              ///< meshes [m]; if empty, the meshes keep their
                                              ///< sizes, in meters, or get those that settings
                                              ///< state.
  /// Whether values of axes whose data are not on this machine are left out where other values
  /// remain. An axis `object` that lacks some data then also gets shapes and a packaged mesh.
  /// Values that `quick` or a change picks stay.
  bool leaves_out_missing_data = false;
};

/// A configuration, checked: every cell has settings that its experiment can use.
struct ExperimentConfig {
  std::string file;
  std::string sha256;    ///< SHA-256 of the file.
  std::string question;  ///< For people.
  std::string cell;      ///< What one cell computes, for people.
  ParameterSweep sweep;
  bool is_quick = false;
  bool is_modified = false;  ///< Whether the command line (besides `is_quick`) or missing data
                             ///< changed the configuration.
  /// Which axes lack values for want of data and what they are now, for people; empty: none.
  std::string left_out = "";

  /// Everything that the results depend on as canonical JSON text: sweep and its settings.
  std::string identity() const;
};

/// Reads `configs/<slug>.json`:
///
///     experiment   the slug again
///     question     what it answers
///     cell         what one cell computes
///     seed         base of all seeds, an integer from 0
///     seeds        optional; n adds a last axis "seed" with 1, ..., n
///     settings     optional; settings of all cells
///     axes         name -> values: plain values of the setting of that name, or objects with a
///                  "name" (and perhaps a "note") and any settings; {"values_of": SLUG} stands
///                  for all values of the axis of the same name in the file of that experiment,
///                  with "only" for those with the labels in that array
///     quick        optional; axes: name -> labels that remain, and perhaps values of its own;
///                  settings; seeds. A file, packaged mesh or shape there replaces any other
///
/// A change picks values of an axis by their labels. On an axis of plain values it may also give
/// new ones; with the name of any other setting it makes a new axis.
/// @throws IoError, InvalidInput: file, key, what is wrong, what is allowed.
ExperimentConfig read_config(const Experiment& experiment, const std::filesystem::path& file,
                             const ConfigRequest& request = {});

}  // namespace graspfit::sweep
