#pragma once

#include <string>

#include "graspfit/grasp/grasp_io.hpp"

/// \file
/// World files of GraspIt! [GraspIt! manual, "Worlds"; graspit-simulator/graspit, src/world.cpp,
/// src/body.cpp and src/dof.cpp].

namespace graspfit::exchange {

/// What GraspIt! is to load; its paths are relative to $GRASPIT.
struct GraspItWorldOptions {
  std::string body_file;   ///< `<filename>` of a body XML or a mesh in millimeters; empty: a
                           ///< `<body>` with the recorded file, scaled to millimeters.
  std::string robot_file;  ///< Robot XML; empty: the hand's description as recorded.
};

/// The text of a world with the object at its origin and the hand in the grasp `index` of the file.
///
/// Lengths are in millimeters; `<fullTransform>` is (w x y z)[x y z]. `<dofValues>` are in radians
/// and millimeters, in the order of the robot file's degrees of freedom, with the flags of those
/// that break away. The degrees of freedom are known for hands read from a GraspIt! robot XML; for
/// other hands the independent joints are written in the hand's order.
/// @throws InvalidInput if the file has no such grasp.
/// @throws IoError if the hand's GraspIt! description can no longer be read.
std::string graspit_world_xml(const grasp::GraspFile& file, std::size_t index,
                              const GraspItWorldOptions& options = {});

/// Whether the hand was described by a GraspIt! robot XML.
bool is_graspit_hand(const hands::HandModel& hand);

}  // namespace graspfit::exchange
