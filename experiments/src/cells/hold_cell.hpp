#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cells/planning_table.hpp"
#include "graspfit/sweep/experiment.hpp"

namespace graspfit::experiments::internal {

/// Protocols by which every grasp is tested, with the prefixes of their columns.
struct TestedProtocol {
  const char* name;
  const char* prefix;
};
inline constexpr std::array<TestedProtocol, 3> kTestedProtocols = {
    {{"dexgraspbench-100g", "normal_"}, {"dexonomy-hard", "hard_"}, {"gendexgrasp", "multidex_"}}};

/// Those of objects that lie on a table.
inline constexpr std::array<TestedProtocol, 2> kTableProtocols = {
    {{"dexgraspbench-100g", "normal_"}, {"tabletop-lift", "lift_"}}};

/// Those of objects on which others report success, their own test the last.
inline constexpr std::array<TestedProtocol, 3> kMultidexProtocols = {
    {{"dexgraspbench-100g", "normal_"}, {"dexonomy-hard", "hard_"}, {"dro", "dro_"}}};

/// What a table of this kind has beside what all have.
struct HoldColumns {
  std::vector<sweep::Column> columns = {};
  std::function<void(const Planned&, sweep::ResultRow&)> fill = {};
};

/// Column names of a grasp's details that others read.
inline constexpr const char* kStageColumn = "stage";  ///< After a protocol's prefix.
inline constexpr const char* kHeldStage = "held";
inline constexpr std::array<const char*, 2> kMarginColumns = {"margin_force_n", "margin_torque_nm"};

/// Names of the quartiles of a margin, before its column's.
inline constexpr std::array<std::pair<const char*, double>, 3> kQuartiles = {
    {{"lower_quartile_", 0.25}, {"median_", 0.5}, {"upper_quartile_", 0.75}}};

/// Columns of the number of margins and of their quartiles.
std::vector<sweep::Column> margin_columns();

/// Returns the index of the column of that name. Precondition: there is one.
std::size_t column_index(const std::vector<sweep::Column>& columns, const std::string& name);

/// All finished cells ("all"), then those of each value of the axis `grip`.
std::vector<std::pair<std::string, std::vector<const sweep::FinishedCell*>>> cells_by_grip(
    const sweep::ParameterSweep& sweep, const std::vector<sweep::FinishedCell>& cells);

/// An experiment whose cell plans with a fixed number of attempts and puts every valid grasp to the
/// hold test; nothing is filtered by the simulator. A row per cell, and one per grasp in its
/// details. Cells are skipped in builds without a physics engine. Margins are those under the first
/// of the protocols, which outlive the experiment.
sweep::Experiment hold_experiment(const std::string& slug,
                                  std::span<const TestedProtocol> protocols = kTestedProtocols,
                                  const HoldColumns& more = {});

}  // namespace graspfit::experiments::internal
