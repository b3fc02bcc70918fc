#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/likely_rest_pose.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::grasp {

/// How an object's file becomes a solid in meters.
struct ObjectReadOptions {
  double meters_per_file_unit = 1.0;     ///< > 0 and finite; not used if `longest_extent` is given.
  std::optional<double> longest_extent;  ///< Scale so that the longest edge of the bounding box has
                                         ///< this length [m], > 0.
  geometry::MeshRepairOptions repair;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// How an object was laid down before planning: in a rest pose, on the plane z = 0 of O. The pose
/// X_OF is that of the file's own frame F, in meters; its numbers are kept as they are written.
struct LaidPose {
  std::array<double, 4> rotation_wxyz = {1.0, 0.0, 0.0, 0.0};  ///< Unit quaternion, scalar first.
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();       ///< [m]
  int rank = 1;              ///< Among `geometry::likely_rest_poses`, the likeliest being 1.
  double probability = 0.0;  ///< Of that pose.
  geometry::RigidTransform X_OF() const;
};

/// Where an object came from and what was done to it before planning: enough to do it again.
struct ObjectRecord {
  std::string file;    ///< As given.
  std::string sha256;  ///< Of that file's bytes.
  double meters_per_file_unit = 1.0;
  geometry::MeshRepairOptions repair;
  std::optional<LaidPose> laid;     ///< After repair; empty: O is the file's own frame.
  geometry::MeshAnalysis analysis;  ///< After repair and laying down.
  std::vector<geometry::RepairStep> repairs;
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();  ///< [m]; zero if there is no volume.
  double volume = 0.0;              ///< [m³]; zero for a mesh left as it is that has none.
  double normalizing_radius = 0.0;  ///< `contact::normalizing_radius` of the box [m].
  /// A pose in O, seen from the file's own frame, in meters.
  geometry::RigidTransform in_file_frame(const geometry::RigidTransform& X_OB) const;
};

/// An object read from a file.
struct ObjectFile {
  geometry::TriangleMesh mesh;  ///< Scaled, repaired and perhaps laid down, in frame O [m].
  ObjectRecord record;
  geometry::MeshFileReport report;  ///< What reading did.
  geometry::MeshAnalysis before;    ///< After scaling, before repair.
};

/// Reads, scales and repairs an object.
///
/// The scale multiplies every coordinate once, after welding, so that a mesh read again by its
/// record has the same bits whichever way the scale was given the first time.
/// @throws IoError, InvalidInput, DegenerateGeometry as `read_mesh` and `repair_mesh`; all messages
/// name the file.
ObjectFile read_object_file(const std::filesystem::path& file,
                            const ObjectReadOptions& options = {});

/// The object laid down in a rest pose on the plane z = 0, its center of mass over the origin, with
/// the least turn that takes it there. `pose` is one of those of its mesh, in its own frame, `rank`
/// its number there.
/// @throws InvalidInput if it is laid down already.
ObjectFile laid_down(ObjectFile object, const geometry::LikelyRestPose& pose, int rank);

/// The object of a record, read, scaled, repaired and laid down as it says, from `file` (empty:
/// where the record says).
/// @throws IoError if the file is missing or its SHA-256 is another one.
geometry::TriangleMesh read_object(const ObjectRecord& record,
                                   const std::filesystem::path& file = {});

}  // namespace graspfit::grasp
