#include <string>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_mjcf_without_mujoco {

namespace {

using namespace graspfit;

TEST_CASE("MJCF: a build without MuJoCo says so, and what to install", "[hands][mjcf]") {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "hand.xml";
  base::write_file_atomically(file, "<mujoco/>");
  try {
    hands::read_hand(file);
    FAIL("accepted");
  } catch (const base::IoError& error) {
    CHECK(std::string(error.what()) ==
          file.string() +
              ": this build has no MuJoCo, which reads MJCF: install libmujoco-dev and libgl-dev, "
              "then configure with GRASPFIT_WITH_MUJOCO=ON");
  }
}

}  // namespace

}  // namespace test_mjcf_without_mujoco
