#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/weak_regions.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/object_file.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// Version of this library, such as "0.2.0".
const char* library_version();

/// What stands around the object, as it can be read again.
struct SurroundingsRecord {
  std::optional<double> table_z_O;      ///< Everything at or below z = this is solid [m].
  std::vector<ObjectRecord> obstacles;  ///< Files in frame O; `center_of_mass_O` and the like too.
  double table_clearance = 0.0;         ///< As `Surroundings::table_clearance` [m].
};

/// Names of files beside a grasp file that hold the meshes as they were used: scaled, repaired,
/// closed, in meters; for whoever recomputes numbers without this program.
struct UsedMeshFiles {
  std::string object;                  ///< In O.
  std::vector<std::string> links;      ///< In L each; empty text for a link without faces.
  std::vector<std::string> obstacles;  ///< In O.
};

/// What a physics test (component hold_test) left of the planned grasps.
struct HoldRecord {
  std::string protocol;                        ///< Its name.
  std::map<std::string, std::int64_t> stages;  ///< How many planned grasps came how far:
                                               ///< "rejected", "approach", "load", "held".
  std::vector<double> margins;  ///< Smallest failing force of each grasp of the file [N]; empty:
                                ///< not measured.
};

/// Where grasps come from that were not planned here (component exchange).
struct ImportRecord {
  std::string format;  ///< With its version: "isaac_grasp 1.0".
  std::string file;    ///< As given.
  std::string sha256;  ///< Of that file's bytes.
};

/// A grasp file (`grasps.json`): everything needed to recompute every number without this program.
/// Its schema is grasp/grasps.schema.json.
///
/// Paths in it are as they were given, those of shipped hands relative to the folder of shipped
/// hands, and each is written as its `base::path_text`; hashes tell whether a file that is found is
/// the recorded one.
struct GraspFile {
  ObjectRecord object;
  SurroundingsRecord surroundings;
  std::optional<UsedMeshFiles> used_meshes;   ///< Empty: not written.
  hands::HandModel hand;                      ///< As loaded again from the files recorded.
  std::vector<std::string> link_mesh_sha256;  ///< One per link, of its mesh files one after the
                                              ///< other; empty text where it has none.
  std::string preset;  ///< Name of the preset that `options` started from, before other options
                       ///< were set; empty: none.
  PlannerOptions options;
  std::string version = library_version();  ///< Of the library that planned.
  /// Names of the requested fingers, the thumb first, as `options` select them.
  std::vector<std::string> fingers;
  bool palm = false;            ///< Whether the palm is requested, too.
  double voxel_size = 0.0;      ///< [m]
  double clip_thickness = 0.0;  ///< Used where a pad states none [m].
  double merge_distance = 0.0;  ///< Used by the measure [m].
  std::vector<Grasp> grasps;  ///< As `RankRule` says; with `hold` and no rank asked for, by margin.
  std::optional<HoldRecord> hold;  ///< Empty: not tested while planning.
  /// Empty: the grasps were planned; else `options` only served to measure them.
  std::optional<ImportRecord> imported;
  PlannerStatistics statistics;
  PlannerStop stop = PlannerStop::Attempts;
  PlannerTimings timings;
};

/// The gap up to which contacts of the file's grasps bear forces [m]: for planned grasps the
/// planner's; empty for imported grasps, which were not refined: all their contacts bear forces.
std::optional<double> bearing_gap(const GraspFile& file);

/// The record of a run of the planner.
/// @throws IoError if a link mesh of the hand can no longer be read.
GraspFile make_grasp_file(const ObjectRecord& record, const hands::HandModel& hand,
                          const PlannerOptions& options, const ObjectModel& object,
                          const PlannerResult& result, const SurroundingsRecord& surroundings = {});

/// The file's text: results in one object, timings in another, numbers in shortest round-trip form
/// in the C locale, keys in fixed order. Same result, same bytes (but for `timings`).
///
/// Rotations are written as quaternions; read again they give link poses within about 1e-15.
std::string to_json(const GraspFile& file);

/// Writes `to_json` atomically. @throws IoError.
void write_grasps(const std::filesystem::path& path, const GraspFile& file);

/// Writes the meshes of object, obstacles and links as PLY (doubles) to a folder: "object.ply",
/// "obstacle_1.ply", ..., "link_00_palm.ply", ... @throws IoError.
UsedMeshFiles write_used_meshes(const std::filesystem::path& folder, const hands::HandModel& hand,
                                const geometry::TriangleMesh& object,
                                const Surroundings& surroundings = {});

/// Reads a grasp file and the hand it names; checks the hashes of the hand's files. A hand that is
/// not where the record says is looked for relative to the grasp file, then beside it, then among
/// the shipped hands by the name of its description.
/// Options that the file lacks, as those that are newer than it, have their defaults.
/// @throws IoError (file, JSON path, what) for malformed files, versions before 4 (their grasps
/// lack what is measured today), unknown options, hash mismatch.
GraspFile read_grasps(const std::filesystem::path& path);

/// `schema`, the text of `grasps.schema.json`, with the options that the planner has now. `file` is
/// what messages call it. @throws IoError if it is no JSON or has no `/$defs/options`.
std::string with_option_schema(const std::string& schema, const std::string& file);

/// One row per grasp, units in the column names (`grasps.csv`).
std::string to_csv(const GraspFile& file);

/// The surroundings of a record; `files` gives the path of each obstacle's file; empty: the paths
/// of the record.
/// @throws IoError if a file is missing or its SHA-256 is another one.
Surroundings read_surroundings(const SurroundingsRecord& record,
                               const std::vector<std::filesystem::path>& files = {});

/// The largest gap of a contact of the grasp [m]; zero without contacts.
double largest_contact_gap(const Grasp& grasp);

/// The same over the contacts that were asked for (`Contact::is_target`).
double largest_requested_gap(const Grasp& grasp);

/// The deepest overlap found, with the object or of the hand with itself [m].
double largest_penetration(const Grasp& grasp);

/// Everything that the measures of a file's grasps depend on, prepared again from the meshes.
class RecordedScene {
 public:
  /// `object` and `surroundings` must be the records' own; `file` must outlive this. Weak features
  /// are found again if `file` was planned with them, or come from the user's cache.
  RecordedScene(const GraspFile& file, geometry::TriangleMesh object, Surroundings surroundings);
  RecordedScene(const RecordedScene&) = delete;
  RecordedScene& operator=(const RecordedScene&) = delete;

  /// As `measure_grasp`, for the fingers and palm that the file's grasps were to touch with.
  Grasp measure(const hands::HandConfiguration& configuration) const;

  /// The same for a grasp of the file: where its style leaves to each grasp which parts touch, for
  /// the parts that its targets are for.
  Grasp measure(const Grasp& recorded) const;

 private:
  Grasp measure(const hands::HandConfiguration& configuration,
                const RequestedParts& requested) const;

  const GraspFile& file_;
  geometry::MeshQuery object_;
  hands::HandCollision collision_;
  SurroundingsCollision surroundings_;
  std::optional<geometry::WeakRegions> weak_;
  RequestedParts requested_;
};

/// Posed hand links and the object as one mesh in frame O [m].
geometry::TriangleMesh posed_scene(const geometry::TriangleMesh& object,
                                   const hands::HandModel& hand,
                                   const hands::HandConfiguration& configuration);

/// The same as the text of an OBJ file with a part for each body: "o object", "o link <name>".
std::string posed_scene_obj(const geometry::TriangleMesh& object, const hands::HandModel& hand,
                            const hands::HandConfiguration& configuration);

}  // namespace graspfit::grasp
