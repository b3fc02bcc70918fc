#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/motion/table_motion.hpp"
#include "graspfit/motion/table_tidying.hpp"

namespace graspfit::motion {

/// An object of a motion file: where it is from, where it begins and where it is to go.
struct MotionObject {
  std::string name;
  std::string file;    ///< As given, relative to the folder that meshes are looked for in; "shape
                       ///< NAME" for one of `geometry::named_shape`.
  std::string sha256;  ///< Of the file's bytes; empty for a shape.
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
/// which palm, joints and objects go straight (`MotionSegment`); all in W, meters and radians.
struct MotionFile {
  std::string title;
  std::string hand;                 ///< A shipped hand, or a description, as given.
  std::string description_sha256;   ///< Of the hand's description.
  std::vector<std::string> joints;  ///< Names, in the order of the positions.
  double clearance = 0.0;  ///< Proven for the segments of Reach, Transport and Retreat [m].
  std::vector<MotionObject> objects;
  std::vector<RecordedMove> moves;
  std::vector<UnmovedObject> unmoved;
};

/// The record of a result. `objects` says where they are from, in the scene's order; poses are
/// filled in. @throws InvalidInput unless there is one for each object of the scene, and a goal.
MotionFile make_motion_file(const TableScene& scene, std::vector<MotionObject> objects,
                            const std::vector<geometry::RigidTransform>& X_WO_goal,
                            const TidyingResult& result, const TidyingOptions& options);

/// The file's text: numbers in shortest round-trip form in the C locale, keys in fixed order, so
/// the same bytes for the same motion. Rotations are quaternions: poses read again are the same to
/// about 1e-15.
std::string to_json(const MotionFile& file);

/// Reads a motion file. @throws IoError (file, JSON path, what), also for a motion that contradicts
/// itself by more than 1e-9: an object that moves while the hand is free; a hand that changes its
/// joints, or its place against the object, while it carries; a move that begins elsewhere than
/// where the object stands and the hand was left.
MotionFile read_motion(const std::filesystem::path& path);

/// Hand and objects of a motion file, from the files that it names; `mesh_folder` is what relative
/// names of object files, and of hands that are not shipped, are relative to.
/// @throws IoError if one is missing or not the one recorded (SHA-256), or if the hand has other
/// joints or cannot have them where a keyframe does (JSON path); as `read_object_file`.
TableScene read_motion_scene(const MotionFile& file, const std::filesystem::path& mesh_folder);

/// Poses of all objects before each move, and after the last one.
std::vector<std::vector<geometry::RigidTransform>> object_poses(const MotionFile& file);

}  // namespace graspfit::motion
