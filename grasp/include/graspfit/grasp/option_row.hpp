#pragma once

#include <string_view>

#include "graspfit/base/number_range.hpp"

namespace graspfit::grasp {

/// Headings under which options are listed.
namespace option_group {
inline constexpr std::string_view kScores = "Voxels and contact score map";
inline constexpr std::string_view kRequest = "Hand and request";
inline constexpr std::string_view kSearch = "Search";
inline constexpr std::string_view kDistinct =
    "Two grasps are different if any of these is exceeded";
inline constexpr std::string_view kTargets = "Target contacts and fitting";
inline constexpr std::string_view kContacts = "From voxels to contacts, and the way there [R]";
inline constexpr std::string_view kForces = "Forces: epsilon and squeeze [R]";
inline constexpr std::string_view kMeasure = "Measure M = M1^w1 * M2^w2 * M3^w3";
}  // namespace option_group

/// Description of an option of the planner; its type and default are those of its field.
struct OptionRow {
  std::string_view key;          ///< In grasp files, SI units: "pool_spacing_m".
  base::NumberRange range = {};  ///< Of a number, in `unit`.
  // The fields below are for options that people set; other options have at most a `meaning`, for
  // the schema.
  std::string_view name = "";     ///< As a flag and as a setting of experiments: "pool-spacing-mm".
  std::string_view unit = "1";    ///< Of its numbers as flag and setting.
  std::string_view group = "";    ///< One of `option_group`.
  std::string_view meaning = "";  ///< A sentence without its full stop.
  std::string_view source = "";   ///< "P": the paper's; "R": recommended where the paper is silent.
  /// Points of the readings page that the option is about, "A6 A34".
  std::string_view reading = "";
  bool is_setting = true;        ///< Whether experiments may have it.
  std::string_view yes = "yes";  ///< What the values of its flag are called, if it is yes or no.
  std::string_view no = "no";
  bool may_be_infinite = false;   ///< Whether the number may be infinite in grasp files.
  bool is_zero_if_empty = false;  ///< Whether grasp files say 0, not null, of an empty number.
};

/// The number of a field, in SI units, from one in `unit`: "mm" and "deg" are converted.
double to_field_unit(double value, std::string_view unit);
/// The reverse, rounded.
double from_field_unit(double value, std::string_view unit);

}  // namespace graspfit::grasp
