#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/object_file.hpp"
#include "graspfit/grasp/surroundings.hpp"

namespace graspfit::app {

/// The flags that say how an object's file becomes a solid in meters.
boost::program_options::options_description object_options();

/// Meters in the unit that a flag names: m, cm, mm or in. @throws UsageError for any other.
double meters_per(const Flags& flags, const std::string& flag);

/// The options that the flags of `object_options` give. @throws UsageError, InvalidInput.
grasp::ObjectReadOptions object_read_options(const Flags& flags);

/// The flags of the object's surroundings: table and obstacles.
boost::program_options::options_description surroundings_options();

/// The object of a file, laid down on a table in every pose that the flags of
/// `surroundings_options` ask for; as it is where they ask for none. @throws as `load_object`,
/// UsageError.
std::vector<grasp::ObjectFile> load_placed_objects(const Flags& flags, const std::string& file);

/// Whether these are all likely rest poses, be they one or more.
bool asks_for_all_rest_poses(const Flags& flags);

/// "43 %" of a rest pose's probability.
std::string probability_text(double probability);

/// The object's surroundings, as read and as recorded.
struct LoadedSurroundings {
  grasp::Surroundings surroundings;
  grasp::SurroundingsRecord record;
};

/// Reads the surroundings that the flags of `surroundings_options` give. `object_O` is the object
/// to be grasped; an object that lies wholly under the table is refused. @throws UsageError,
/// InvalidInput, IoError, DegenerateGeometry.
LoadedSurroundings load_surroundings(const Flags& flags, const geometry::TriangleMesh& object_O);

/// Reads an object's file. Repair may take long: unless the command is to be quiet, the terminal
/// shows for how many seconds it has.
grasp::ObjectFile load_object(const Flags& flags, const std::string& file);

/// The same by other options than those of the flags.
grasp::ObjectFile load_object(const Flags& flags, const std::string& file,
                              const grasp::ObjectReadOptions& options);

/// Throws InvalidInput unless the object's surface is closed and faces outward (a mesh that was
/// left as it is may not).
void require_solid(const grasp::ObjectFile& object);

/// Prints on standard error, a line each, where the solids of these records differ from their
/// files, and why a wrap that was requested was not made.
void warn_of_differences(const std::string& command, const grasp::ObjectRecord& object,
                         const std::vector<grasp::ObjectRecord>& obstacles = {});

/// "0.15 x 0.148 x 0.116 m", rounded to a micrometer; four digits each below a millimeter.
std::string extents_text(const geometry::TriangleMesh& mesh);

}  // namespace graspfit::app
