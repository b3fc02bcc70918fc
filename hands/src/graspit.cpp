#include "internal/graspit.hpp"

#include "graspfit/geometry/errors.hpp"

namespace graspfit::hands::internal {

RobotDescription parse_graspit(const std::string&, const std::filesystem::path& file, Findings&) {
  throw geometry::IoError(file.string() + ": GraspIt! XML is not read by this build");
}

}  // namespace graspfit::hands::internal
