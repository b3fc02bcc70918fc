#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/motion/table_motion.hpp"
#include "graspfit/motion/table_tidying.hpp"

namespace graspfit::motion {

/// An object of a motion file: its mesh, where it starts and where it is to go.
struct MotionObject {
  std::string name;
  std::string file;    ///< Mesh file as given, relative to the mesh folder; "shape NAME" for one of
                       ///< `geometry::named_shape`.
  std::string sha256;  ///< SHA-256 of the mesh file; empty for a shape.
  double meters_per_file_unit = 1.0;
  geometry::RigidTransform X_WO_start = geometry::RigidTransform::Identity();
  geometry::RigidTransform X_WO_goal = geometry::RigidTransform::Identity();
};

/// What a motion file says of one move.
struct RecordedMove {
  int object = -1;
  double grasp_m = 0.0;                 ///< M of the grasp.
  int num_contacts = 0;                 ///< N' of the grasp.
  std::vector<MotionSegment> segments;  ///< Each begins where the last one ends.
};

/// A motion file (`motion.json`): the moves of a hand that tidies a table, as keyframes between
/// which palm, joints and objects are interpolated as `MotionSegment` says. All poses are in W;
/// units are meters and radians.
struct MotionFile {
  std::string title;
  std::string hand;                 ///< Name of a shipped hand, or path of a description, as given.
  std::string description_sha256;   ///< SHA-256 of the hand's description.
  std::vector<std::string> joints;  ///< Joint names, in the order of the positions.
  double clearance = 0.0;           ///< Clearance proven in Reach, Transport and Retreat [m].
  std::vector<MotionObject> objects;
  std::vector<RecordedMove> moves;
  std::vector<UnmovedObject> unmoved;
};

/// Makes the motion file of a result. `objects` states the mesh of every object, in the scene's
/// order; their poses are filled in. @throws InvalidInput unless there is one entry for each object
/// of the scene, and a goal.
MotionFile make_motion_file(const TableScene& scene, std::vector<MotionObject> objects,
                            const std::vector<geometry::RigidTransform>& X_WO_goal,
                            const TidyingResult& result, const TidyingOptions& options);

/// Returns the text of the file. Numbers are in shortest round-trip form in the C locale and keys
/// in fixed order, so that the same motion gives the same bytes. Rotations are written as
/// quaternions: poses read again are the same to about 1e-15.
std::string to_json(const MotionFile& file);

/// Reads a motion file. @throws IoError (file, JSON path, what), also for a motion that contradicts
/// itself by more than 1e-9: an object that moves while the hand is free; a hand that changes its
/// joints, or its pose relative to the object, while it carries; a move that begins elsewhere than
/// where the object stands or where the move before has left the hand.
MotionFile read_motion(const std::filesystem::path& path);

/// Reads the hand and the objects of a motion file from the files that it names. Names of object
/// files, and of hands that are not shipped, are relative to `mesh_folder`.
/// @throws IoError if a file is missing or is not the one recorded (SHA-256), or if the hand has
/// other joints or cannot take the joint positions of a keyframe (JSON path); as
/// `read_object_file`.
TableScene read_motion_scene(const MotionFile& file, const std::filesystem::path& mesh_folder);

/// Poses of all objects before each move, and after the last one.
std::vector<std::vector<geometry::RigidTransform>> object_poses(const MotionFile& file);

}  // namespace graspfit::motion
