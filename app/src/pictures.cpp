#include "pictures.hpp"

#include <cstdlib>
#include <string>
#include <vector>

#include "graspfit/geometry/errors.hpp"
#include "interrupts.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;

/// The picture script: beside an installed program wherever it was moved, else in the sources of
/// the build, else where it was installed.
fs::path find_script() {
  const fs::path name = "render_grasps.py";
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
  throw geometry::IoError("--pictures: the script " + name.string() +
                          " is not installed (looked for " + candidates.front().string() + ")");
}

/// The last line with something in it.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \n\r");
  if (end == std::string::npos) return "no reason given";
  const std::size_t start = text.find_last_of("\n\r", end);
  return text.substr(start == std::string::npos ? 0 : start + 1,
                     start == std::string::npos ? end + 1 : end - start);
}

}  // namespace

void require_pictures() {
  find_script();
  if (run_program({GRASPFIT_PYTHON, "-c", "import vtkmodules"}).code != 0) {
    throw geometry::IoError("--pictures: needs VTK for " GRASPFIT_PYTHON "; install python3-vtk9");
  }
  const bool has_display = std::getenv("DISPLAY") != nullptr;
  if (!has_display && run_program({"/bin/sh", "-c", "command -v xvfb-run"}).code != 0) {
    throw geometry::IoError("--pictures: there is no display; install xvfb and xauth");
  }
}

void draw_pictures(const fs::path& folder) {
  const ProgramEnd end = run_program({GRASPFIT_PYTHON, find_script().string(), folder.string()});
  if (end.code != 0) {
    throw geometry::IoError("--pictures: " + last_line(end.errors) + " (exit code " +
                            std::to_string(end.code) + ")");
  }
}

}  // namespace graspfit::app
