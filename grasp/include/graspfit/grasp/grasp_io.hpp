#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/object_file.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// Version of this library, such as "0.1.0".
const char* library_version();

/// A grasp file (`grasps.json`): everything needed to recompute every number without this program.
/// Its schema is grasp/grasps.schema.json.
struct GraspFile {
  ObjectRecord object;
  hands::HandModel hand;                      ///< As loaded again from the files recorded.
  std::vector<std::string> link_mesh_sha256;  ///< One per link, of its mesh files one after the
                                              ///< other; empty text where it has none.
  PlannerOptions options;
  std::string version = library_version();  ///< Of the library that planned.
  std::vector<std::string> fingers;         ///< Requested, the thumb first; what `options` came to.
  double voxel_size = 0.0;                  ///< [m]
  double clip_thickness = 0.0;              ///< Used where a pad states none [m].
  double merge_distance = 0.0;              ///< Used by the measure [m].
  std::vector<Grasp> grasps;                ///< Best M first.
  PlannerStatistics statistics;
  PlannerStop stop = PlannerStop::Attempts;
  PlannerTimings timings;
};

/// The record of a run of the planner.
/// @throws IoError if a link mesh of the hand can no longer be read.
GraspFile make_grasp_file(const ObjectRecord& record, const hands::HandModel& hand,
                          const PlannerOptions& options, const ObjectModel& object,
                          const PlannerResult& result);

/// The file's text: results in one object, timings in another, numbers in shortest round-trip form
/// in the C locale, keys in fixed order. Same result, same bytes (but for `timings`).
///
/// Rotations are written as quaternions; read again they give link poses within about 1e-15.
std::string to_json(const GraspFile& file);

/// Writes `to_json` atomically. @throws IoError.
void write_grasps(const std::filesystem::path& path, const GraspFile& file);

/// Reads a grasp file and the hand it names; checks the hashes of the hand's files. A hand that is
/// not where the record says is looked for relative to the grasp file, then among the shipped hands
/// by the name of its description.
/// @throws IoError (file, JSON path, what) for malformed files, unknown versions, hash mismatch.
GraspFile read_grasps(const std::filesystem::path& path);

/// One row per grasp, units in the column names (`grasps.csv`).
std::string to_csv(const GraspFile& file);

/// The largest gap of a contact of the grasp [m]; zero without contacts.
double largest_contact_gap(const Grasp& grasp);

/// The deepest overlap found, with the object or of the hand with itself [m].
double largest_penetration(const Grasp& grasp);

/// What a grasp was measured with, as `measure_grasp` takes it: the mesh must be the record's own.
QualityContext quality_context(const GraspFile& file, const geometry::TriangleMesh& object);
ContactEstimationOptions contact_options(const GraspFile& file);
QualityOptions quality_options(const GraspFile& file);

/// Posed hand links and the object as one mesh in frame O [m].
geometry::TriangleMesh posed_scene(const geometry::TriangleMesh& object,
                                   const hands::HandModel& hand,
                                   const hands::HandConfiguration& configuration);

/// The same as the text of an OBJ file with a part for each body: "o object", "o link <name>".
std::string posed_scene_obj(const geometry::TriangleMesh& object, const hands::HandModel& hand,
                            const hands::HandConfiguration& configuration);

}  // namespace graspfit::grasp
