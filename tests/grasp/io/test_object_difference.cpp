#include "graspfit/grasp/object_difference.hpp"
#include "support/catch.hpp"

namespace test_object_difference {

using namespace graspfit;
using grasp::difference_from_file;
using grasp::reason_against_wrap;

namespace {

grasp::ObjectRecord record_of(std::vector<geometry::RepairStep> steps) {
  grasp::ObjectRecord record;
  record.file = "/meshes/cup.off";
  record.volume = 2e-4;
  record.analysis.box = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.05, 0.1, 0.02)};
  record.repairs = std::move(steps);
  return record;
}

}  // namespace

TEST_CASE("A solid that differs from its file is said with its steps and shares",
          "[grasp][object_difference]") {
  // Here 4.2e-6 of 2e-4 m3 are 2.1 %, and 0.0032 of 0.1 m are 3.2 %.
  CHECK(difference_from_file(record_of({{"filled holes", 5, 4.2e-6, 0.0032}})) ==
        "cup.off: the solid differs from the file: filled 5 holes (volume +2.1 %, surface up to "
        "3.2 % of the extent)");
  CHECK(difference_from_file(record_of({{"welded vertices", 1, 0.0, 0.0001},
                                        {"filled holes", 1, -1e-6, 0.0002},
                                        {"turned parts", 1, 4e-4, 0.0},
                                        {"filled holes", 2, -3e-6, 0.0003}})) ==
        "cup.off: the solid differs from the file: welded 1 vertex, filled 3 holes (volume -2 %, "
        "surface up to 0.6 % of the extent)");
  CHECK(difference_from_file(record_of({{"wrapped", 6280, 0.0, 0.002}})) ==
        "cup.off: the solid differs from the file: wrapped (volume 0 %, surface up to 2 % of the "
        "extent)");
}

TEST_CASE("Small differences and steps that keep the surface are not said",
          "[grasp][object_difference]") {
  CHECK(!difference_from_file(record_of({})));
  CHECK(!difference_from_file(record_of({{"turned parts", 1, 4e-4, 0.0}})));
  CHECK(!difference_from_file(record_of({{"filled holes", 1, 1.9e-6, 0.00049}})));
  CHECK(difference_from_file(record_of({{"filled holes", 1, 2.1e-6, 0.00049}})));
  CHECK(difference_from_file(record_of({{"filled holes", 1, -1.9e-6, 0.00051}})));
  CHECK(!difference_from_file(record_of({{"filled holes", 1, 2.1e-6, 0.00049}}),
                              {.volume_rel = 0.02}));
  grasp::ObjectRecord open = record_of({{"filled holes", 1, 1.0, 1.0}});
  open.volume = 0.0;
  CHECK(!difference_from_file(open));
}

TEST_CASE("A wrap that was asked for and not made has its reason", "[grasp][object_difference]") {
  grasp::ObjectRecord record =
      record_of({{"filled holes", 2, 0.0, 0.001}, {"filled holes", 1, 0.0, 0.0}});
  CHECK(!reason_against_wrap(record));
  record.repair.wrap = geometry::AlphaWrap{};
  CHECK(reason_against_wrap(record) ==
        "--wrap: not needed: the mesh was closed by filling 3 holes");
  record.repairs = {{"turned faces", 2, 0.0, 0.0}};
  CHECK(reason_against_wrap(record) == "--wrap: not needed: the mesh was mended without it");
  record.repairs = {};
  CHECK(reason_against_wrap(record) == "--wrap: not needed: the mesh is closed as it is");
  record.repairs = {{"wrapped", 100, 0.0, 0.001}};
  CHECK(!reason_against_wrap(record));
}

}  // namespace test_object_difference
