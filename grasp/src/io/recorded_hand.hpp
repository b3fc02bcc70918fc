#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp::internal {

/// What a grasp file says about the files of its hand.
struct RecordedHand {
  std::string description_file;
  std::string description_sha256;
  std::string sidecar_sha256;
  std::vector<std::string> link_mesh_sha256;
};

/// Finds and reads the hand of a record: at the recorded path, at that path relative to the grasp
/// file's folder, beside the grasp file, or the shipped hand whose description has the same name.
/// @throws IoError if there is none, or any of its files is not the one recorded.
hands::HandModel read_recorded_hand(const RecordedHand& record,
                                    const std::filesystem::path& grasp_folder);

}  // namespace graspfit::grasp::internal
