#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "support/test_data.hpp"

namespace graspfit::testing {

/// A robot hand of the data folder as its manufacturer or its users describe it.
struct SharedHand {
  std::string folder;
  std::string urdf;
  int num_fingers = 0;
  int num_movable = 0;      ///< Number of joints of the file that move.
  int num_independent = 0;  ///< Number of those without <mimic>.
  std::string thumb_link;   ///< A link of the thumb; empty for grippers, whose fingers are alike.
  /// Number of movable joints before the palm (a wrist), which a reader may leave out.
  int num_before_palm = 0;
};

/// Returns the seven folders, with counts from the table in SOURCES.md of the data folder.
inline std::vector<SharedHand> shared_hands() {
  return {{"robotiq_2f_85", "robotiq_2f_85.urdf", 2, 6, 1, "", 0},
          {"panda_gripper", "franka_panda.urdf", 2, 2, 1, "", 0},
          {"barrett_hand", "bhand_model.urdf", 3, 8, 8, "finger_3_dist_link", 0},
          {"barrett_graspit", "Barrett.urdf", 3, 8, 8, "c_link3", 0},
          {"human_hand_20dof", "HumanHand.urdf", 5, 20, 20, "thumb3", 0},
          {"shadow_hand", "shadow_hand_right.urdf", 5, 24, 24, "thdistal", 2},
          {"allegro_hand", "allegro_hand_right.urdf", 4, 16, 16, "link_15.0", 0}};
}

inline std::optional<std::filesystem::path> find_urdf(const SharedHand& hand) {
  return find_data("hands/" + hand.folder + "/" + hand.urdf);
}

inline std::string why_skipped(const SharedHand& hand) {
  return "hands/" + hand.folder + "/" + hand.urdf + " is not there; set GRASPFIT_DATA";
}

}  // namespace graspfit::testing
