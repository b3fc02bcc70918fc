#include "output/pictures.hpp"

#include <cstdlib>
#include <string>
#include <vector>

#include "cli/interrupts.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "output/working_folder.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGraspScript = "render_grasps.py";
constexpr const char* kHandScript = "render_hand.py";
constexpr const char* kHoldScript = "render_hold.py";
constexpr const char* kMotionScript = "render_motion.py";

/// Finds a picture script: beside an installed program wherever it was moved, else in the sources
/// of the build, else where it was installed.
fs::path find_script(const std::string& flag, const fs::path& name) {
  std::error_code error;
  std::vector<fs::path> candidates;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    candidates.push_back(program.parent_path().parent_path() / "share/graspfit" / name);
  }
  candidates.push_back(fs::path(GRASPFIT_SOURCE_VIEWER) / name);
  candidates.push_back(fs::path(GRASPFIT_INSTALLED_DATA) / name);
  for (const fs::path& candidate : candidates) {
    if (fs::is_regular_file(candidate, error)) return candidate;
  }
  throw base::IoError(flag + ": the script " + name.string() + " is not installed (looked for " +
                      candidates.front().string() + ")");
}

/// The last line that is not empty.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \n\r");
  if (end == std::string::npos) return "no reason given";
  const std::size_t start = text.find_last_of("\n\r", end);
  return text.substr(start == std::string::npos ? 0 : start + 1,
                     start == std::string::npos ? end + 1 : end - start);
}

void run_script(const std::string& flag, const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {GRASPFIT_PYTHON};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const ProgramEnd end = run_program(command);
  if (end.code != 0) {
    throw base::IoError(flag + ": " + last_line(end.errors) + " (exit code " +
                        std::to_string(end.code) + ")");
  }
}

/// Draws a scene, given as JSON of the viewer, by a script that takes the paths of the scene and of
/// the picture. The picture's extension says what is drawn.
void draw_scene(const std::string& flag, const char* script, const std::string& scene_json,
                const char* extension, const fs::path& picture) {
  WorkingFolder folder(fs::temp_directory_path());
  const CleanupOnInterrupt cleanup([&folder] { folder.remove(); });
  const fs::path scene = folder.path() / "scene.json";
  const fs::path drawn = folder.path() / (std::string("picture") + extension);
  base::write_file_atomically(scene, scene_json);
  run_script(flag, {find_script(flag, script).string(), scene.string(), drawn.string()});
  base::write_file_atomically(picture, base::read_file(drawn));
}

}  // namespace

void require_pictures(const std::string& flag) {
  find_script(flag, kGraspScript);
  find_script(flag, kHandScript);
  if (run_program({GRASPFIT_PYTHON, "-c", "import vtkmodules"}).code != 0) {
    throw base::IoError(flag + ": needs VTK for " GRASPFIT_PYTHON "; install python3-vtk9");
  }
  const bool has_display = std::getenv("DISPLAY") != nullptr;
  if (!has_display && run_program({"/bin/sh", "-c", "command -v xvfb-run"}).code != 0) {
    throw base::IoError(flag + ": there is no display; install xvfb and xauth");
  }
}

void draw_pictures(const fs::path& folder, const std::string& note) {
  std::vector<std::string> arguments = {find_script("--pictures", kGraspScript).string(),
                                        folder.string()};
  if (!note.empty()) arguments.push_back("--note=" + note);
  run_script("--pictures", arguments);
}

void require_animations(const std::string& flag) {
  require_pictures(flag);
  find_script(flag, kHoldScript);
  find_script(flag, kMotionScript);
  if (run_program({GRASPFIT_PYTHON, "-c", "import PIL"}).code != 0) {
    throw base::IoError(flag + ": needs Pillow for " GRASPFIT_PYTHON "; install python3-pil");
  }
}

void draw_hand_picture(const std::string& scene_json, const fs::path& picture) {
  draw_scene("--png", kHandScript, scene_json, ".png", picture);
}

void draw_replay_picture(const std::string& scene_json, const fs::path& picture) {
  draw_scene("--gif", kHoldScript, scene_json, ".gif", picture);
}

void draw_motion_picture(const std::string& flag, const std::string& scene_json,
                         const fs::path& picture) {
  draw_scene(flag, kMotionScript, scene_json, flag == "--gif" ? ".gif" : ".png", picture);
}

}  // namespace graspfit::app
