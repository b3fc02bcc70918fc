// Question: do the planner's grasps hold in a physics engine, per attempt and per returned grasp,
// under the protocols by which others judge theirs (DexGraspBench's with 100 g, Dexonomy's hard
// mode, MultiDex's with 0.05 g), and where are the others lost?
//
// Answered by one row per object and grip (a hand in precision or power): all attempts are counted,
// every valid grasp is tested, and nothing is filtered by the simulator. What others publish was
// found on other objects; what is aimed at is Allegro precision above 0.605 per attempt (hard mode
// 0.272), Shadow or human power above 0.242, and under MultiDex's protocol Barrett above 0.881 and
// Allegro above 0.932.
//
// The summary has the quartiles of the margins, the smallest loads that fail, of the first grasps
// of the cells of each grip, where the configuration asks for margins.
#include <array>

#include "cells/hold_cell.hpp"
#include "cells/prediction_statistics.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace hold_rates_parts {
namespace {

std::vector<sweep::Column> summary_columns() {
  std::vector<sweep::Column> columns = {{"grip", "", "hand and style, or all"},
                                        {"cells", "1", "finished"},
                                        {"grasps", "1", "tested"}};
  for (const TestedProtocol& protocol : kTestedProtocols) {
    columns.push_back({std::string(protocol.prefix) + "held", "1",
                       std::string("grasps held under ") + protocol.name});
  }
  for (sweep::Column& column : margin_columns()) columns.push_back(std::move(column));
  return columns;
}

sweep::ResultRow summary_row(const std::string& grip,
                             const std::vector<const sweep::FinishedCell*>& cells,
                             const std::vector<sweep::Column>& details) {
  std::int64_t grasps = 0;
  std::array<std::int64_t, kTestedProtocols.size()> held{};
  std::array<std::vector<double>, kMarginColumns.size()> margins;
  for (const sweep::FinishedCell* cell : cells) {
    for (const std::vector<std::string>& grasp : cell->details) {
      const auto field_of = [&](const std::string& name) {
        return grasp[column_index(details, name)];
      };
      ++grasps;
      for (std::size_t p = 0; p < held.size(); ++p) {
        if (field_of(std::string(kTestedProtocols[p].prefix) + kStageColumn) == kHeldStage) {
          ++held[p];
        }
      }
      for (std::size_t i = 0; i < margins.size(); ++i) {
        if (const auto margin = sweep::csv_number(field_of(kMarginColumns[i])))
          margins[i].push_back(*margin);
      }
    }
  }
  sweep::ResultRow row(summary_columns());
  row.set("grip", grip);
  row.set("cells", static_cast<std::int64_t>(cells.size()));
  row.set("grasps", grasps);
  for (std::size_t p = 0; p < held.size(); ++p) {
    row.set(std::string(kTestedProtocols[p].prefix) + "held", held[p]);
  }
  row.set("margins", static_cast<std::int64_t>(margins[0].size()));
  for (std::size_t i = 0; i < margins.size(); ++i) {
    for (const auto& [name, share] : kQuartiles) {
      if (const auto value = quantile(margins[i], share)) {
        row.set(std::string(name) + kMarginColumns[i], *value);
      }
    }
  }
  return row;
}

}  // namespace
}  // namespace hold_rates_parts

sweep::Experiment hold_rates() {
  using namespace hold_rates_parts;
  sweep::Experiment experiment = hold_experiment("hold_rates");
  experiment.summaries.push_back(
      {"summary", summary_columns(),
       [details = experiment.details](const sweep::ParameterSweep& sweep,
                                      const std::vector<sweep::FinishedCell>& cells) {
         std::vector<sweep::ResultRow> rows;
         for (const auto& [grip, members] : cells_by_grip(sweep, cells)) {
           rows.push_back(summary_row(grip, members, details));
         }
         return rows;
       }});
  return experiment;
}

}  // namespace graspfit::experiments::internal
