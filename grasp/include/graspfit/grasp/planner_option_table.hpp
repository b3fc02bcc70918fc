#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "graspfit/grasp/option_row.hpp"
#include "graspfit/grasp/planner_options.hpp"

/// \file
/// The options of the planner by name, for programs, files and languages in which people write
/// them. The rows themselves stand in `grasp/src/rows/option_rows.hpp`, one per field.

namespace graspfit::grasp {

/// What the values of an option are.
enum class OptionKind {
  Number,
  Integer,
  YesNo,
  Choice,     ///< One of several names.
  Names,      ///< Any number of names.
  Direction,  ///< x, y, z.
};

/// A value of an option, in the option's unit; the types are in the order of `OptionKind`.
using OptionValue = std::variant<double, std::int64_t, bool, std::string, std::vector<std::string>,
                                 Eigen::Vector3d>;

/// An option of `PlannerOptions` that people set.
struct PlannerOption : OptionRow {
  OptionKind kind = OptionKind::Number;
  std::string path = "";  ///< Of its key among the options of a grasp file: "fitting.clearance_m".
  std::vector<std::string> choices = {};  ///< Of a choice.
  std::string fallback = "";              ///< Its default as text; empty: it is not set.

  bool is_number() const { return kind == OptionKind::Number || kind == OptionKind::Integer; }
  bool has_choice(std::string_view text) const;
  std::string choices_text() const;  ///< "a|b|c".
  std::string source_text() const;   ///< " [R, A36]" to stand after the meaning; may be empty.
};

/// All options that have a name, in the order of grasp files.
const std::vector<PlannerOption>& planner_option_table();

/// Sets an option of the table. "theta-max-deg" sets the angle of targets and of the measure,
/// "fingers" sets the number of contacts, too, and 0 as "weak-thickness-mm" means that nothing is
/// weak. Ranges are checked by `PlannerOptions::validate`. Precondition: `value` is of the option's
/// kind, a choice one of its names.
void set_option(PlannerOptions& options, const PlannerOption& option, const OptionValue& value);

}  // namespace graspfit::grasp
