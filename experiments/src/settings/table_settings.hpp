#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/motion/table_tidying.hpp"

namespace graspfit::experiments::internal {

/// How an object rests on the table.
struct RestSettings {
  Eigen::Vector3d up_O;  ///< The rest pose whose up is nearest to this is taken.
  double turn = 0.0;     ///< Rotation about z [rad].
  Eigen::Vector2d place_W = Eigen::Vector2d::Zero();  ///< Point of the table under the center of
                                                      ///< mass [m].
};

struct TableObject {
  std::string name;
  ObjectSettings object;
  RestSettings start;
  RestSettings goal;
};

/// A table and what is to be done on it.
struct TableSettings {
  std::string title;
  std::string hand;
  std::vector<TableObject> objects;
  Eigen::Vector3d home_palm_W = Eigen::Vector3d::Zero();       ///< Palm center at home [m].
  Eigen::Vector3d home_direction_W = Eigen::Vector3d::Zero();  ///< Palm direction at home.
  double home_turn = 0.0;          ///< Rotation about the palm direction [rad].
  double frame_step = 0.0;         ///< Largest motion of any point between two frames [m].
  motion::TidyingOptions tidying;  ///< All but the home of the hand.
};

/// The settings beside those of the planner.
std::vector<sweep::Column> table_setting_names();

/// @throws SettingError for what cannot be used.
TableSettings table_settings(const sweep::Cell& cell);

/// Returns the open hand with palm center and palm direction as set: the hand is turned from its
/// own frame by the least rotation, then by `home_turn`. `X_OH` is X_WH.
hands::HandConfiguration home_of(const TableSettings& settings, const hands::HandModel& hand);

/// The files of objects and hand, for manifests.
std::vector<std::filesystem::path> table_inputs(const TableSettings& settings);

}  // namespace graspfit::experiments::internal
