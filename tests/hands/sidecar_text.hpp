#pragma once

#include <string>
#include <vector>

#include "support/catch.hpp"

namespace graspfit::testing {

/// Returns the least that a sidecar can say: one finger of one link and joint, no pads. It is
/// enough for the kinematics of any description.
inline std::string least_sidecar(const std::string& palm, const std::string& link,
                                 const std::string& joint,
                                 const std::vector<std::string>& closing) {
  std::string signs;
  for (const std::string& name : closing) signs += (signs.empty() ? "\"" : ", \"") + name + "\": 1";
  return R"({"format": {"name": "graspfit hand sidecar", "version": 1},
  "fingers": [{"name": "finger", "links": [")" +
         link + R"("], "joints": [")" + joint + R"("]}], "pads": [],
  "palm": {"link": ")" +
         palm + R"(", "center_m": [0, 0, 0], "direction": [0, 0, 1]},
  "closing": {)" +
         signs + R"(}, "exclusions": []})";
}

/// Returns `text` with the only occurrence of `old` replaced.
inline std::string with(std::string text, const std::string& old, const std::string& fresh) {
  INFO(old);
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  REQUIRE(text.find(old, at + 1) == std::string::npos);
  return text.replace(at, old.size(), fresh);
}

}  // namespace graspfit::testing
