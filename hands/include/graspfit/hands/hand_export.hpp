#pragma once

#include <filesystem>
#include <vector>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Writes a hand so that every tool can load it: `<hand>.urdf`, one `<link>.obj` per link that has
/// a surface (in the link's frame, meters), and `<hand>.graspfit.json`. Couplings become `<mimic>`.
/// The folder is created if it does not exist. Files of these names are replaced; each is written
/// under a temporary name first. Reading the URDF back gives the same hand: names, limits and
/// surfaces exactly, poses to 1e-12. Returns the files written. @throws IoError if one cannot be
/// written; InvalidInput for link or hand names that are no file names.
std::vector<std::filesystem::path> export_hand(const HandModel& model,
                                               const std::filesystem::path& folder);

}  // namespace graspfit::hands
