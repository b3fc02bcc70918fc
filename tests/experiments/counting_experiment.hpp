#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "graspfit/sweep/experiment_config.hpp"

namespace graspfit::testing {

/// A configuration of `counting_experiment` with 3 x 4 x 2 = 24 cells.
inline const std::string kCountingConfig = R"({
  "experiment": "counting",
  "question": "What do cells see?",
  "cell": "Adds.",
  "seed": 7,
  "seeds": 2,
  "settings": {"base": 100},
  "axes": {
    "letter": [{"name": "a", "amount": 1, "note": "the first"}, {"name": "b", "amount": 2},
               {"name": "c", "amount": 3}],
    "step": [0, 0.5, 1, 2]
  },
  "quick": {"axes": {"letter": ["b"]}, "settings": {"base": 0}, "seeds": 1}
})";

/// Returns an experiment without geometry. A cell adds its settings and its seed; the cell with
/// letter=c and step=1 fails. A setting that is no number is refused.
inline sweep::Experiment counting_experiment() {
  using namespace sweep;
  Experiment experiment;
  experiment.slug = "counting";
  experiment.columns = {{"sum", "1", "of amount, step and base"},
                        {"digits", "1", "last digits of the seed"},
                        {"text", "", "with a comma"}};
  experiment.timings = {{"nothing_s", "s", "always 0"}};
  experiment.check = [](const Cell& cell) {
    const nlohmann::json settings = nlohmann::json::parse(cell.settings);
    for (const auto& [key, value] : settings.items()) {
      if (key != "amount" && key != "step" && key != "base") {
        throw SettingError(key, "is no setting; there are amount, step, base");
      }
      if (!value.is_number()) throw SettingError(key, "is " + value.dump() + ", must be a number");
    }
  };
  experiment.run = [](const Cell& cell, const std::filesystem::path&) {
    const nlohmann::json settings = nlohmann::json::parse(cell.settings);
    if (cell.labels[0] == "c" && cell.labels[1] == "1") {
      throw base::InvalidInput("no sum for \"c\", says the test");
    }
    CellResult result{ResultRow({{"sum", "", ""}, {"digits", "", ""}, {"text", "", ""}}),
                      ResultRow({{"nothing_s", "s", ""}})};
    result.row.set("sum", settings.at("amount").get<double>() + settings.at("step").get<double>() +
                              settings.at("base").get<double>());
    result.row.set("digits", static_cast<std::int64_t>(cell.seed % 1000));
    result.row.set("text", "one, two");
    result.timings.set("nothing_s", 0.0);
    return result;
  };
  return experiment;
}

}  // namespace graspfit::testing
