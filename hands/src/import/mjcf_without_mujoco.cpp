#include "graspfit/base/errors.hpp"
#include "import/mjcf.hpp"

namespace graspfit::hands::internal {

RobotDescription parse_mjcf(const std::string&, const std::filesystem::path& file, Findings&) {
  throw base::IoError(file.string() +
                      ": this build has no MuJoCo, which reads MJCF: install libmujoco-dev and "
                      "libgl-dev, then configure with GRASPFIT_WITH_MUJOCO=ON");
}

}  // namespace graspfit::hands::internal
