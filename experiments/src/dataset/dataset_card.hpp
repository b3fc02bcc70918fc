#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "graspfit/sweep/experiment_config.hpp"

namespace graspfit::experiments::internal {

/// What a data set's tables say of one hand.
struct HandCounts {
  std::string name;
  std::int64_t cells = 0;        ///< Objects that were tried.
  std::int64_t failed = 0;       ///< Of these, those with a reason instead of results.
  std::int64_t with_grasps = 0;  ///< Of these, those with a grasp.
  std::int64_t attempts = 0;
  std::int64_t grasps = 0;
  std::int64_t held = 0;
};

/// What a card is made of.
struct DatasetCounts {
  std::vector<HandCounts> hands;
  std::int64_t objects = 0;                      ///< Values of the axis of objects.
  std::map<std::string, std::int64_t> reasons;   ///< Cells without results, by reason.
  std::map<std::string, std::int64_t> licenses;  ///< Cells by license; "": none stated.
  std::vector<std::string> arrays;               ///< Files, relative to the folder.
};

/// The card of a data set, in Markdown.
std::string dataset_card(const sweep::ExperimentConfig& config, const DatasetCounts& counts);

}  // namespace graspfit::experiments::internal
