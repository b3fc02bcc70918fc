#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "description/robot_description.hpp"
#include "description/sidecar.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// What the files of a hand say. Where faults are thrown, `tree` is never empty.
struct HandSources {
  RobotDescription description;
  std::optional<HandModel> tree;  ///< With surfaces and couplings; no fingers, pads, palm.
  Sidecar sidecar;  ///< Content of the sidecar beside the description, if there is one.
};

/// Reads a description, the sidecar beside it and the link meshes. Faults go to `findings`; where
/// they are collected, reading goes on.
/// @throws IoError if the description cannot be read; the first fault where faults are thrown.
HandSources read_sources(const std::filesystem::path& description_file, Findings& findings);

/// The text of a complete sidecar for `sources`, whose tree must not be empty: members that the
/// sidecar has are kept, the others are derived. @throws as `completed`.
std::string completed_sidecar_text(const HandSources& sources, Findings& findings);

/// The whole hand from its sources; members that the sidecar leaves out are derived. Where faults
/// are collected, it is empty after a fault that leaves no hand. @throws the first fault where
/// faults are thrown.
std::optional<HandModel> assemble(const HandSources& sources, Findings& findings);

}  // namespace graspfit::hands::internal
