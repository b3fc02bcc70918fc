#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "exchanged_grasps.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/exchange/dexgraspbench.hpp"
#include "npz_bytes.hpp"
#include "support/catch.hpp"
#include "support/damaged.hpp"
#include "support/temporary_folder.hpp"

namespace test_dexgraspbench_reader {

namespace {

using namespace graspfit;
using exchange::DexGraspBenchGrasps;
using exchange::read_dexgraspbench;
using testing::Contains;
using testing::npy;
using testing::npy_file;
using testing::npy_single;
using testing::random_grasps;
using testing::TemporaryFolder;
using testing::zip;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A grasp of the shipped parallel gripper: position, quaternion, right_slide, left_slide.
const std::vector<double> kRow = {0.01, -0.02, 0.3, 1, 0, 0, 0, 0.02, 0.02};

std::vector<double> with(std::size_t index, double value, std::vector<double> row = kRow) {
  row[index] = value;
  return row;
}

std::string file_of(const std::string& grasps) { return zip({{"grasp_qpos.npy", grasps}}); }

std::string names_of(const std::string& type, const std::string& shape, const std::string& data) {
  return npy_file("{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }",
                  data);
}

/// Returns the message with which bytes are refused.
std::string refusal(const TemporaryFolder& folder, const hands::HandModel& hand,
                    const std::string& bytes) {
  try {
    read_dexgraspbench(folder.write("grasps.npz", bytes), hand);
  } catch (const base::IoError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("Arrays read again have every bit of positions and joints, rotations to 1e-15",
          "[exchange][dexgraspbench]") {
  const TemporaryFolder folder;
  for (const char* name : {"barrett", "human_hand_coupled", "parallel_gripper"}) {
    const grasp::GraspFile file = random_grasps(hands::find_hand(name), folder, 12);
    const DexGraspBenchGrasps read =
        read_dexgraspbench(folder.write("a.npz", exchange::dexgraspbench_npz(file)), file.hand);
    CHECK(read.notes.empty());
    CHECK(read.meters_per_file_unit == 1.0);
    REQUIRE(read.grasps.size() == file.grasps.size());
    for (std::size_t i = 0; i < read.grasps.size(); ++i) {
      const grasp::Grasp& written = file.grasps[i];
      const hands::HandConfiguration& configuration = read.grasps[i].configuration;
      CHECK(read.grasps[i].name == "grasp_" + std::to_string(i));
      CHECK(configuration.q == written.configuration.q);
      CHECK(configuration.X_OH.translation() == written.configuration.X_OH.translation());
      CHECK((configuration.X_OH.linear() - written.configuration.X_OH.linear())
                .cwiseAbs()
                .maxCoeff() < 1e-15);
      REQUIRE(read.grasps[i].pre_grasp_q.has_value() == written.pre_grasp.has_value());
      if (written.pre_grasp) {
        CHECK(*read.grasps[i].pre_grasp_q == written.pre_grasp->configuration.q);
      }
    }
  }
}

TEST_CASE("One row or several, stored or deflated, double or single precision are read alike",
          "[exchange][dexgraspbench]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  std::vector<double> two = kRow;
  two.insert(two.end(), kRow.begin(), kRow.end());
  for (const bool is_deflated : {false, true}) {
    for (const auto& [bytes, count] :
         std::vector<std::pair<std::string, std::size_t>>{{npy("(9,)", kRow), 1},
                                                          {npy("(1, 9)", kRow), 1},
                                                          {npy("(2, 9)", two), 2},
                                                          {npy_single("(2, 9)", two), 2}}) {
      const DexGraspBenchGrasps read = read_dexgraspbench(
          folder.write("a.npz", zip({{"grasp_qpos.npy", bytes}}, {.is_deflated = is_deflated})),
          hand);
      REQUIRE(read.grasps.size() == count);
      const hands::HandConfiguration& configuration = read.grasps.back().configuration;
      CHECK(configuration.X_OH.translation().z() == Approx(0.3).epsilon(1e-7));
      CHECK(configuration.q[0] == Approx(0.02).epsilon(1e-7));
      CHECK_FALSE(read.grasps.back().pre_grasp_q);
      CHECK_FALSE(read.meters_per_file_unit);
      REQUIRE(read.notes.size() == 1);
      CHECK_THAT(read.notes[0], Contains("no joint_names"));
    }
  }
}

TEST_CASE("Joints are found by name, in any order, and followers may be left out",
          "[exchange][dexgraspbench]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const std::string swapped = std::string("left_slide\0right_slide", 22);
  const auto read = read_dexgraspbench(
      folder.write("a.npz", zip({{"grasp_qpos.npy", npy("(9,)", kRow)},
                                 {"joint_names.npy", names_of("|S11", "(2,)", swapped)}})),
      hand);
  CHECK(read.notes.empty());
  CHECK(read.grasps.at(0).configuration.q[hand.joint_index("right_slide")] == 0.02);

  const std::vector<double> leader(kRow.begin(), kRow.end() - 1);
  const auto completed = read_dexgraspbench(
      folder.write("a.npz", zip({{"grasp_qpos.npy", npy("(8,)", leader)},
                                 {"joint_names.npy", names_of("|S11", "(1,)", "right_slide")}})),
      hand);
  CHECK(completed.grasps.at(0).configuration.q == read.grasps.at(0).configuration.q);
  const auto unnamed =
      read_dexgraspbench(folder.write("a.npz", file_of(npy("(8,)", leader))), hand);
  CHECK(unnamed.grasps.at(0).configuration.q == read.grasps.at(0).configuration.q);
  CHECK_THAT(unnamed.notes.at(0), Contains("the independent ones only"));
}

TEST_CASE("Poses are brought from the world into the object's frame, one pose or one per grasp",
          "[exchange][dexgraspbench]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  // The object is turned by 90 degrees about z and shifted: p_O = R^T (p_W - t), and R^T takes
  // (x, y, z) to (y, -x, z).
  const double half = std::numbers::sqrt2 / 2;
  const std::vector<double> pose = {0.1, 0.2, 0.05, half, 0, 0, half};
  std::vector<double> two = kRow;
  two.insert(two.end(), kRow.begin(), kRow.end());
  std::vector<double> poses = pose;
  poses.insert(poses.end(), {0, 0, 0, 1, 0, 0, 0});
  for (const auto& [shape, values] : std::vector<std::pair<std::string, std::vector<double>>>{
           {"(7,)", pose}, {"(2, 7)", poses}}) {
    const auto read =
        read_dexgraspbench(folder.write("a.npz", zip({{"grasp_qpos.npy", npy("(2, 9)", two)},
                                                      {"obj_pose.npy", npy(shape, values)},
                                                      {"obj_scale.npy", npy("()", {0.07})}})),
                           hand);
    CHECK(read.meters_per_file_unit == 0.07);
    const Eigen::Vector3d expected(-0.02 - 0.2, -(0.01 - 0.1), 0.3 - 0.05);
    CHECK((read.grasps.at(0).configuration.X_OH.translation() - expected).norm() < 1e-15);
    if (shape == "(2, 7)") {
      CHECK(read.grasps.at(1).configuration.X_OH.translation().x() == 0.01);
    }
  }
}

TEST_CASE("Rows with NaN are left out and pre-grasps with the palm elsewhere, both with notes",
          "[exchange][dexgraspbench]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  std::vector<double> grasps = with(2, kNaN);
  std::vector<double> before = kRow;
  const auto add = [&](const std::vector<double>& at, const std::vector<double>& open) {
    grasps.insert(grasps.end(), at.begin(), at.end());
    before.insert(before.end(), open.begin(), open.end());
  };
  add(kRow, with(7, 0.03, with(8, 0.03)));
  add(kRow, with(2, 0.31));
  add(kRow, with(0, kNaN));
  const auto read =
      read_dexgraspbench(folder.write("a.npz", zip({{"grasp_qpos.npy", npy("(4, 9)", grasps)},
                                                    {"pregrasp_qpos.npy", npy("(4, 9)", before)},
                                                    {"extra.npy", "no array at all"}})),
                         hand);
  REQUIRE(read.grasps.size() == 3);
  CHECK(read.grasps[0].name == "grasp_1");
  REQUIRE(read.grasps[0].pre_grasp_q);
  CHECK((*read.grasps[0].pre_grasp_q)[0] == 0.03);
  CHECK_FALSE(read.grasps[1].pre_grasp_q);
  CHECK_FALSE(read.grasps[2].pre_grasp_q);
  REQUIRE(read.notes.size() == 3);
  CHECK_THAT(read.notes[1], Contains("grasp_qpos[0] has NaN"));
  CHECK_THAT(read.notes[2], Contains("grasp_2: its pre-grasp has the palm elsewhere"));
}

TEST_CASE("Arrays that cannot be used are refused with file, array, row and value",
          "[exchange][dexgraspbench]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const std::string good = npy("(9,)", kRow);
  const std::string data = good.substr(good.find('\n') + 1);
  const auto headed = [&](const std::string& header) { return file_of(npy_file(header, data)); };
  const auto beside = [&](const std::string& name, const std::string& array) {
    return zip({{"grasp_qpos.npy", good}, {name + ".npy", array}});
  };
  const std::string whole = file_of(good);
  const struct {
    std::string bytes;
    const char* says;
  } cases[] = {
      {"", "is no NPZ file"},
      {"\x93NUMPY", "save its arrays with numpy.savez"},
      {"PK", "is cut off"},
      {whole.substr(0, whole.size() / 2), "is cut off"},
      {whole.substr(0, whole.size() - 1), "is cut off"},
      {zip({}), "grasp_qpos: no such array; the file has none"},
      {zip({{"qpos.npy", good}}), "grasp_qpos: no such array; the file has qpos"},
      {zip({{"grasp_qpos.npy", good}, {"grasp_qpos.npy", good}}), "grasp_qpos: is there twice"},
      {zip({{"grasp_qpos.npy", good}}, {.method = 14}), "is packed by method 14"},
      {zip({{"grasp_qpos.npy", good}}, {.flags = 1}), "is encrypted"},
      {zip({{"grasp_qpos.npy", good}}, {.stated_size = 2000000000}),
       "has 2000000000 bytes, more than the 1 GiB"},
      {zip({{"grasp_qpos.npy", good}}, {.is_deflated = true, .stated_size = 1000000}),
       "its stated sizes cannot be"},
      {zip({{"grasp_qpos.npy", good}}, {.is_deflated = true, .stated_size = 300}),
       "cannot be inflated to its stated size"},
      {zip({{"grasp_qpos.npy", good}}, {.method = 8}), "cannot be inflated"},
      {file_of("text"), "grasp_qpos: is no array of NumPy"},
      {file_of(good.substr(0, 40)), "grasp_qpos: is cut off"},
      {file_of(good.substr(0, good.size() - 8)), "has 64 bytes of data, not 9 times the 8"},
      {headed("{'descr': '|O', 'fortran_order': False, 'shape': (9,), }"),
       "holds Python objects; save plain arrays"},
      {headed("{'descr': '<f8', 'fortran_order': True, 'shape': (3, 3), }"), "is in Fortran order"},
      {headed("{'descr': '>f8', 'fortran_order': False, 'shape': (9,), }"), "big-endian"},
      {headed("{'descr': '<c8', 'fortran_order': False, 'shape': (9,), }"), "elements of type <c8"},
      {headed("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (9,), }"),
       "several fields"},
      {headed("{'descr': '<f8', 'shape': (9,), }"), "a header that is not understood"},
      {headed("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999,), }"),
       "which cannot be"},
      {headed("{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296), }"),
       "which is larger than the file"},
      {file_of(npy("()", {1.0})), "has the shape [], not rows"},
      {file_of(npy("(1, 1, 9)", kRow)), "has the shape [1, 1, 9], not rows"},
      {file_of(npy("(7,)", std::vector<double>(7, 0.5))), "7 + dof"},
      {file_of(npy("(0, 9)", std::vector<double>{})), "grasp_qpos: holds no grasp"},
      {file_of(npy("(9,)", with(3, kNaN))), "grasp_qpos: holds no grasp"},
      {file_of(npy("(9,)", with(1, std::numeric_limits<double>::infinity()))),
       "grasp_qpos[0][1]: is not a finite number"},
      {file_of(npy("(9,)", with(3, 0.5))), "grasp_qpos[0]: its quaternion (w x y z) is no unit"},
      {file_of(npy("(9,)", with(7, 0.9))), "grasp_qpos[0]: joint right_slide is 0.9, outside"},
      {file_of(npy("(9,)", with(8, 0.03))),
       "grasp_qpos[0]: joint left_slide is 0.03, but its leader right_slide puts it at 0.02"},
      {file_of(npy("(10,)", std::vector<double>(10, 0.0))),
       "has 3 joints in a row; hand parallel_gripper has 2, 1 of them independent"},
      {beside("pregrasp_qpos", npy("(8,)", std::vector<double>(8, 0.0))),
       "pregrasp_qpos: has the shape [8], but grasp_qpos has [9]"},
      {beside("pregrasp_qpos", npy("(9,)", with(7, -1))), "pregrasp_qpos[0]: joint right_slide"},
      {beside("obj_pose", npy("(4,)", {1, 0, 0, 0})), "obj_pose: has the shape [4], not [7]"},
      {beside("obj_pose", npy("(2, 7)", std::vector<double>(14, 0.5))), "nor 7 numbers for each"},
      {beside("obj_pose", npy("(7,)", {0, 0, 0, 2, 0, 0, 0})), "obj_pose: its quaternion"},
      {beside("obj_pose", npy("(7,)", {0, 0, kNaN, 1, 0, 0, 0})), "is not a finite number"},
      {beside("obj_scale", npy("()", {-1})), "obj_scale: -1 is not a finite number above 0"},
      {beside("obj_scale", npy("(2,)", {1, 2})), "obj_scale: 2 differs from 1"},
      {beside("joint_names", names_of("|O", "(2,)", "pickle")), "holds Python objects"},
      {beside("joint_names", names_of("|S1", "(1,)", "a")), "but grasp_qpos has 2 joints"},
      {beside("joint_names", names_of("|S1", "(2,)", "ab")),
       "joint_names[0]: \"a\": hand parallel_gripper has no such joint; it has right_slide"},
      {beside("joint_names", names_of("|S11", "(2,)", "right_slideright_slide")),
       "joint_names[1]: \"right_slide\" is there twice"},
      {beside("joint_names", npy("(2,)", {1, 2})), "which are no texts"},
  };
  for (const auto& [bytes, says] : cases) {
    const std::string message = refusal(folder, hand, bytes);
    CHECK_THAT(message, Contains("grasps.npz: "));
    CHECK_THAT(message, Contains(says));
    CHECK(message.find('\n') == std::string::npos);
  }
  CHECK_THROWS_AS(read_dexgraspbench(folder.path() / "none.npz", hand), base::IoError);
}

TEST_CASE("Whatever becomes of a file's bytes, it is read or refused",
          "[exchange][dexgraspbench]") {
  const TemporaryFolder folder;
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const grasp::GraspFile file = random_grasps(hand, folder, 2);
  const std::string stored = exchange::dexgraspbench_npz(file);
  const std::string packed = zip({{"grasp_qpos.npy", npy("(9,)", kRow)}}, {.is_deflated = true});
  const std::vector<std::string> words = {"PK\1\2", "PK\3\4",   "PK\5\6", "(9,)", "'<U9'", "'|S0'",
                                          "-1",     "\xff\xff", "True",   "O",    ""};
  base::Random random(3);
  int num_refused = 0;
  for (int i = 0; i < 400; ++i) {
    const std::string bytes = testing::damaged(i % 2 == 0 ? stored : packed, words, random);
    if (refusal(folder, hand, bytes) != "accepted") ++num_refused;
  }
  CHECK(num_refused > 200);
}

}  // namespace test_dexgraspbench_reader
