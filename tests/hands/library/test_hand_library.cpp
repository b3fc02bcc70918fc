#include <algorithm>
#include <filesystem>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/environment_variable.hpp"
#include "support/test_data.hpp"

namespace test_hand_library {

namespace {

using namespace graspfit;
namespace fs = std::filesystem;

TEST_CASE("The Barrett hand is shipped and read by name or by path", "[hands][hand_library]") {
  const std::vector<std::string> names = hands::shipped_hands();
  CHECK(std::find(names.begin(), names.end(), "barrett") != names.end());
  CHECK(std::is_sorted(names.begin(), names.end()));
  const fs::path file = hands::shipped_hand_file("barrett");
  CHECK(file.filename() == "barrett.urdf");
  CHECK(hands::find_hand(file.string()).name == hands::find_hand("barrett").name);
}

TEST_CASE("A hand that is not shipped is answered with those that are", "[hands][hand_library]") {
  CHECK_THROWS_WITH(hands::find_hand("baret"), testing::Contains("shipped hands are barrett"));
  CHECK_THROWS_AS(hands::find_hand("baret"), base::InvalidInput);
  CHECK_THROWS_WITH(hands::shipped_hand_file("baret"), testing::Contains("there are barrett"));
  CHECK_THROWS_AS(hands::find_hand("nowhere/hand.urdf"), base::IoError);
}

TEST_CASE("GRASPFIT_HANDS names the folder of hands, and must be one", "[hands][hand_library]") {
  {
    const testing::EnvironmentVariable setting(
        "GRASPFIT_HANDS", (testing::source_directory() / "hands/models").string());
    CHECK(hands::shipped_hand_file("barrett") ==
          testing::source_directory() / "hands/models/barrett/barrett.urdf");
  }
  const testing::EnvironmentVariable setting("GRASPFIT_HANDS",
                                             (testing::source_directory() / "LICENSE").string());
  CHECK_THROWS_WITH(hands::shipped_hands(), testing::Contains("LICENSE is not a folder"));
}

}  // namespace

}  // namespace test_hand_library
