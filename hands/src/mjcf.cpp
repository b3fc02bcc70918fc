#include "internal/mjcf.hpp"

#include "graspfit/geometry/errors.hpp"

namespace graspfit::hands::internal {

RobotDescription parse_mjcf(const std::string&, const std::filesystem::path& file, Findings&) {
  throw geometry::IoError(file.string() + ": MJCF is not read by this build");
}

}  // namespace graspfit::hands::internal
