#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "description/robot_description.hpp"
#include "description/sidecar.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// What the files of a hand say. Where faults are thrown, `tree` is there.
struct HandSources {
  RobotDescription description;
  std::optional<HandModel> tree;  ///< With surfaces and couplings; no fingers, pads, palm.
  Sidecar sidecar;                ///< As the file beside the description says it, if there is one.
};

/// Reads a description, the sidecar beside it and the link meshes. Faults go to `findings`; reading
/// goes on after those that can be collected.
/// @throws IoError if the description cannot be read; the first fault where they are thrown.
HandSources read_sources(const std::filesystem::path& description_file, Findings& findings);

/// The text of a complete sidecar for `sources`, whose tree must be there: what they say is kept,
/// the rest derived. @throws as `completed`.
std::string completed_sidecar_text(const HandSources& sources, Findings& findings);

/// The whole hand from its sources: what no sidecar says is derived. Empty after a fault that
/// leaves no hand, where they are collected. @throws the first fault where they are thrown.
std::optional<HandModel> assemble(const HandSources& sources, Findings& findings);

}  // namespace graspfit::hands::internal
