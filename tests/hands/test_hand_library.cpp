#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/test_data.hpp"

namespace {

using namespace graspfit;
namespace fs = std::filesystem;

/// Sets an environment variable while it lives.
class Setting {
 public:
  Setting(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  ~Setting() {
    if (old_.empty()) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, old_.c_str(), 1);
    }
  }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

 private:
  const char* name_;
  std::string old_;
};

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
  CHECK_THROWS_AS(hands::find_hand("baret"), geometry::InvalidInput);
  CHECK_THROWS_WITH(hands::shipped_hand_file("baret"), testing::Contains("there are barrett"));
  CHECK_THROWS_AS(hands::find_hand("nowhere/hand.urdf"), geometry::IoError);
}

TEST_CASE("GRASPFIT_HANDS names the folder of hands, and must be one", "[hands][hand_library]") {
  {
    const Setting setting("GRASPFIT_HANDS",
                          (testing::source_directory() / "hands/models").string());
    CHECK(hands::shipped_hand_file("barrett") ==
          testing::source_directory() / "hands/models/barrett/barrett.urdf");
  }
  const Setting setting("GRASPFIT_HANDS", (testing::source_directory() / "LICENSE").string());
  CHECK_THROWS_WITH(hands::shipped_hands(), testing::Contains("LICENSE is not a folder"));
}

}  // namespace
