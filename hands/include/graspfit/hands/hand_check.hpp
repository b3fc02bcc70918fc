#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "graspfit/hands/hand_finding.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Everything that is missing or suspicious about a hand, in one report.
struct HandCheck {
  std::optional<HandModel> model;     ///< Empty if a fault keeps the hand from being used.
  std::vector<HandFinding> findings;  ///< Faults, then suspicious, then notes.

  /// The number of findings of a kind.
  std::size_t count(FindingKind kind) const;
};

/// Reads a hand as `read_hand` does, but goes on after every fault that lets it, and looks for what
/// a reader accepts and its author hardly meant: axes that are not unit (a lost transmission
/// ratio), joints that look coupled and are not, zero-width limits, open or overlapping meshes,
/// fingers that never close or whose tips never meet. Bad content is reported, never thrown.
/// @throws IoError only if the file cannot be read.
HandCheck check_hand(const std::filesystem::path& description_file);

}  // namespace graspfit::hands
