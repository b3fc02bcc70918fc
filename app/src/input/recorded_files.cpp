#include "input/recorded_files.hpp"

#include <optional>
#include <system_error>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "output/progress_bar.hpp"

namespace graspfit::app {
namespace {

constexpr const char* kObjectFile = "the object's file";

/// Finds a recorded mesh file: at the recorded path, or beside the grasp file.
std::filesystem::path find_mesh(const std::filesystem::path& grasp_file,
                                const grasp::ObjectRecord& record, const std::string& what) {
  const std::filesystem::path file = record.file;
  const std::filesystem::path beside = grasp_file.parent_path() / file.filename();
  std::error_code error;
  for (const std::filesystem::path& candidate : {file, beside}) {
    if (std::filesystem::exists(candidate, error)) return candidate;
  }
  throw base::IoError(what + " " + record.file + " is not there, nor beside the grasp file" +
                      (what == kObjectFile ? "; --object FILE says where it is" : ""));
}

}  // namespace

void add_object_flag(boost::program_options::options_description& options) {
  add_option(options, "object", "FILE", std::nullopt,
             "the object's file, if it is no longer where the grasp file says");
}

geometry::TriangleMesh load_recorded_object(const Flags& flags, const grasp::GraspFile& file,
                                            const std::filesystem::path& grasp_file) {
  const std::filesystem::path mesh_file = flags.has("object")
                                              ? std::filesystem::path(flags.text("object"))
                                              : find_mesh(grasp_file, file.object, kObjectFile);
  const SecondsBar seconds(!flags.has("quiet"), "reading and repairing " + mesh_file.string());
  return grasp::read_object(file.object, mesh_file);
}

geometry::TriangleMesh load_recorded_object(const Flags& flags, const grasp::GraspFile& file) {
  return load_recorded_object(flags, file, flags.positional());
}

grasp::Surroundings load_recorded_surroundings(const grasp::GraspFile& file,
                                               const std::filesystem::path& grasp_file) {
  std::vector<std::filesystem::path> files;
  for (const grasp::ObjectRecord& obstacle : file.surroundings.obstacles) {
    files.push_back(find_mesh(grasp_file, obstacle, "the obstacle"));
  }
  return grasp::read_surroundings(file.surroundings, files);
}

}  // namespace graspfit::app
