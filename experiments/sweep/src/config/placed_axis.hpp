#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/base/json_value.hpp"
#include "graspfit/sweep/parameter_sweep.hpp"

namespace graspfit::sweep::internal {

/// An axis with the locations at which its values were written, for messages.
struct PlacedAxis {
  Axis axis;
  std::vector<std::string> locations;  ///< One per value.
  bool is_picked = false;  ///< Whether `quick` or the command line asked for the axis as it is.
};

/// Returns a number, a text, true or false as a label.
std::string plain_label(const nlohmann::json& value);

/// "there are a, b, c", and which of these labels an unknown one is near to.
std::string labels_text(const Axis& axis, const std::string& unknown);

/// Returns the index of the value with that label; empty if there is none.
std::optional<std::size_t> find_value(const Axis& axis, const std::string& label);

/// The root of a configuration. @throws IoError: file and place.
base::JsonValue parsed_config(const std::string& file, const std::string& text);

/// An axis of a configuration in `folder`, where `{"values_of": SLUG, "only": [labels]}` are values
/// of another configuration there.
PlacedAxis read_axis(const std::string& name, const base::JsonValue& node,
                     const std::filesystem::path& folder);

/// The axis seed from a number of seeds.
PlacedAxis seed_axis(const base::JsonValue& node);

/// Reduces an axis to what `quick` picks: values by their labels, in their old order, then its own.
void pick_values(const base::JsonValue& picks, PlacedAxis& placed);

}  // namespace graspfit::sweep::internal
