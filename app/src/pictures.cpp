#include "pictures.hpp"

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

}  // namespace

void require_pictures() { find_script(); }

void draw_pictures(const fs::path& folder) {
  const int code = run_program({GRASPFIT_PYTHON, find_script().string(),
                                (folder / "grasps.json").string(), "--out", folder.string()});
  if (code != 0) {
    throw geometry::IoError("--pictures: the script failed with exit code " + std::to_string(code));
  }
}

}  // namespace graspfit::app
