#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace graspfit::grasp::internal {

/// JSON text with two spaces of indentation, arrays of plain values on one line, and every number
/// in its shortest form that reads back as the same double (nlohmann's own output is round-trip,
/// but not always shortest). Independent of the locale. Precondition: numbers are finite.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace graspfit::grasp::internal
