#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// Where an object came from and what was done to it before planning.
struct ObjectRecord {
  std::string file;  ///< As given.
  std::string sha256;
  double meters_per_file_unit = 1.0;
  geometry::MeshAnalysis analysis;  ///< After repair.
  std::vector<geometry::RepairStep> repairs;
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();
  double normalizing_radius = 0.0;
};

/// A grasp file (`grasps.json`): everything needed to recompute every number without this program.
/// Its schema is grasp/grasps.schema.json.
struct GraspFile {
  ObjectRecord object;
  hands::HandModel hand;  ///< As loaded again from the files recorded.
  PlannerOptions options;
  double voxel_size = 0.0;
  double clip_thickness = 0.0;
  std::vector<Grasp> grasps;
  PlannerStatistics statistics;
  PlannerStop stop = PlannerStop::Attempts;
  PlannerTimings timings;
};

/// The file's text: results in one object, timings in another, numbers in shortest round-trip form
/// in the C locale, keys in fixed order. Same result, same bytes (but for `timings`).
std::string to_json(const GraspFile& file);

/// Writes `to_json` atomically. @throws IoError.
void write_grasps(const std::filesystem::path& path, const GraspFile& file);

/// Reads a grasp file and the hand it names; checks the hand's hashes. A hand file that is not
/// where the record says is looked for among the shipped hands.
/// @throws IoError (file, JSON path, what) for malformed files, unknown versions, hash mismatch.
GraspFile read_grasps(const std::filesystem::path& path);

/// One row per grasp, units in the column names (`grasps.csv`).
std::string to_csv(const GraspFile& file);

/// The object file of a grasp file, read, scaled and repaired as the record says; checks its hash.
geometry::TriangleMesh read_object(const ObjectRecord& record);

/// Posed hand links and the object as one mesh in frame O [m].
geometry::TriangleMesh posed_scene(const geometry::TriangleMesh& object,
                                   const hands::HandModel& hand,
                                   const hands::HandConfiguration& configuration);

}  // namespace graspfit::grasp
