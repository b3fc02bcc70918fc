#include <clocale>
#include <cstdlib>
#include <sstream>
#include <string>

#include "graspfit/base/random.hpp"
#include "hands/bad_hand_files.hpp"
#include "support/damaged.hpp"
#include "support/skip.hpp"

namespace test_damaged_hand_files {

namespace {

using namespace graspfit;
using namespace graspfit::testing;

/// Returns whether the hand was read. Refusals are of our own and in one line, and what is read
/// holds the model's promises.
bool is_read(const fs::path& file) {
  try {
    const hands::HandModel hand = hands::read_hand_model(file);
    hands::validate(hand);
    for (const hands::RigidTransform& X :
         hands::forward_kinematics(hand, hands::open_configuration(hand))) {
      REQUIRE(X.matrix().allFinite());
    }
    return true;
  } catch (const Error& refusal) {
    INFO(refusal.what());
    REQUIRE(is_one_line(refusal.what()));
    return false;
  }
}

TEST_CASE("Every prefix of a hand's files is read or refused in one line",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  int num_read = 0;
  for (std::string HandFiles::*member : {&HandFiles::urdf, &HandFiles::sidecar, &HandFiles::mesh}) {
    const std::string whole = HandFiles{}.*member;
    // A sidecar is only read when the URDF is good, which takes longer.
    const std::size_t step = member == &HandFiles::urdf ? 1 : 3;
    for (std::size_t size = 0; size < whole.size(); size += step) {
      HandFiles files;
      files.*member = whole.substr(0, size);
      CAPTURE(files.*member);
      bool read = false;
      REQUIRE_NOTHROW(read = is_read(write(folder, files)));
      num_read += read;
    }
  }
  CHECK(num_read < 60);  // It may lack the line feed at the end, or be an OBJ of fewer faces.
}

void damage_the_hand(int times) {
  const TemporaryFolder folder;
  base::Random random(11);
  int num_read = 0;
  for (int k = 0; k < times; ++k) {
    HandFiles files;
    std::string& file = k % 2 == 0 ? files.urdf : files.sidecar;
    file = testing::damaged(file, testing::kWordsForHands, random);
    INFO("round " << k);
    CAPTURE(file);
    bool read = false;
    REQUIRE_NOTHROW(read = is_read(write(folder, files)));
    num_read += read;
  }
  // Both happen, as names and numbers may change without harm.
  CHECK(num_read > times / 200);
  CHECK(num_read < times / 2);
}

TEST_CASE("Damaged URDFs and sidecars are read or refused in one line", "[hands][bad_hand_files]") {
  damage_the_hand(400);  // These are the first ones of those below.
}

TEST_CASE("Many more damaged URDFs and sidecars are read or refused in one line",
          "[hands][bad_hand_files][full]") {
  damage_the_hand(200000);
}

/// Returns a chain of links, every joint but the first of one type; its finger has the first.
HandFiles long_chain(int num_links, const std::string& type, bool is_coupled) {
  std::ostringstream urdf;
  urdf << "<robot name=\"chain\"><link name=\"l0\"/>";
  for (int i = 1; i < num_links; ++i) {
    urdf << "<link name=\"l" << i << "\"/><joint name=\"j" << i << "\" type=\""
         << (i == 1 ? "continuous" : type) << "\"><parent link=\"l" << i - 1
         << "\"/><child link=\"l" << i << "\"/><origin xyz=\"0 0 0.001\"/>";
    if (is_coupled && i > 1) urdf << "<mimic joint=\"j" << i - 1 << "\"/>";
    urdf << "</joint>";
  }
  urdf << "</robot>";
  return {.urdf = urdf.str(), .sidecar = R"({
  "format": {"name": "graspfit hand sidecar", "version": 1},
  "fingers": [{"name": "one", "links": ["l1"], "joints": ["j1"]}],
  "pads": [], "palm": {"link": "l0", "center_m": [0, 0, 0], "direction": [0, 0, 1]},
  "closing": {}, "couplings": [], "exclusions": []})"};
}

TEST_CASE("A chain of ten thousand links uses up neither stack nor patience",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  constexpr int kNumLinks = 10000;
  for (const char* type : {"continuous", "fixed"}) {
    CAPTURE(type);
    const hands::HandModel hand =
        hands::read_hand_model(write(folder, long_chain(kNumLinks, type, false)));
    REQUIRE(hand.links.size() == kNumLinks);
    const auto X_OL = hands::forward_kinematics(hand, hands::open_configuration(hand));
    // The sum of ten thousand roundings is of at most half a unit in the last place of 10 m each.
    CHECK(X_OL.back().translation().z() == Approx(0.001 * (kNumLinks - 1)).margin(1e-11));
  }
  const hands::HandModel coupled =
      hands::read_hand_model(write(folder, long_chain(kNumLinks, "continuous", true)));
  CHECK(coupled.num_intrinsic_dof() == 1);
  CHECK(coupled.joints.back().coupling->leader == 0);
}

/// Sets a locale whose decimals have a comma while it lives: the system's, or one compiled here.
class GermanLocale {
 public:
  GermanLocale() : old_(std::setlocale(LC_ALL, nullptr)) {
    is_set_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
    if (is_set_) return;
    const std::string file = (folder_.path() / "de_DE.UTF-8").string();
    const std::string command = "localedef -i de_DE -f UTF-8 '" + file + "' > /dev/null 2>&1";
    if (std::system(command.c_str()) == -1) return;
    ::setenv("LOCPATH", folder_.path().c_str(), 1);
    is_set_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  }
  ~GermanLocale() {
    std::setlocale(LC_ALL, old_.c_str());
    ::unsetenv("LOCPATH");
  }
  bool is_set() const { return is_set_; }

 private:
  TemporaryFolder folder_;
  std::string old_;
  bool is_set_ = false;
};

TEST_CASE("A German locale changes neither numbers nor what is refused",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  const fs::path file = write(folder, {});
  const hands::HandModel expected = hands::read_hand_model(file);
  const GermanLocale german;
  if (!german.is_set()) {
    GRASPFIT_SKIP_TEST("no German locale, and none could be compiled; install the package locales");
  }
  REQUIRE(std::strtod("1,5", nullptr) == 1.5);
  const hands::HandModel hand = hands::read_hand_model(file);
  REQUIRE(hand.joints.size() == expected.joints.size());
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    CHECK(hand.joints[j].X_PJ.matrix() == expected.joints[j].X_PJ.matrix());
    CHECK(hand.joints[j].lower == expected.joints[j].lower);
    CHECK(hand.joints[j].upper == expected.joints[j].upper);
  }
  for (std::size_t p = 0; p < hand.pads.size(); ++p) {
    CHECK(hand.pads[p].X_LC.matrix() == expected.pads[p].X_LC.matrix());
    CHECK(hand.pads[p].outline == expected.pads[p].outline);
  }
  for (std::size_t i = 0; i < hand.links.size(); ++i) {
    CHECK(hand.links[i].mesh_L == expected.links[i].mesh_L);
  }
  HandFiles comma;
  comma.urdf = with(comma.urdf, R"(upper="0.03")", R"(upper="0,03")");
  check_refused(write(folder, comma), Refusal::Invalid, {"slide", "0,03"});
  check_refused(write(folder, {.urdf = with(kSmallHandUrdf, R"(upper="0.03")", R"(upper="-0.5")")}),
                Refusal::Invalid, {"slide", "-0.5"});
}

}  // namespace

}  // namespace test_damaged_hand_files
