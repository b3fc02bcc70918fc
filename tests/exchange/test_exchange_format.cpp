#include <fstream>

#include "exchanged_grasps.hpp"
#include "graspfit/exchange/dexgraspbench.hpp"
#include "graspfit/exchange/exchange_format.hpp"
#include "graspfit/exchange/graspit_world.hpp"
#include "graspfit/exchange/isaac_grasp.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_exchange_format {

using namespace graspfit;
using exchange::ExchangeFormat;
using testing::TemporaryFolder;

namespace {

constexpr ExchangeFormat kAll[] = {ExchangeFormat::IsaacGrasp, ExchangeFormat::DexGraspBench,
                                   ExchangeFormat::MoveItGrasp, ExchangeFormat::GraspItWorld,
                                   ExchangeFormat::PosedGlb};

bool mentions(const std::vector<std::string>& limits, const std::string& what) {
  for (const std::string& limit : limits) {
    if (limit.find(what) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("Every format is found by its name and its extension", "[exchange][exchange_format]") {
  for (const ExchangeFormat format : kAll) {
    CHECK(exchange::format_named(exchange::name_of(format)) == format);
    const auto by_extension =
        exchange::format_of("a." + std::string(exchange::extension_of(format)));
    REQUIRE(by_extension);
    CHECK((by_extension == format ||
           (format == ExchangeFormat::MoveItGrasp && by_extension == ExchangeFormat::IsaacGrasp)));
  }
  CHECK(exchange::format_of("a.yml") == ExchangeFormat::IsaacGrasp);
  CHECK_FALSE(exchange::format_of("a.json"));
  CHECK_FALSE(exchange::format_of("yaml"));
  CHECK_FALSE(exchange::format_named("Isaac"));
}

TEST_CASE("What a format leaves out of these very grasps is said", "[exchange][exchange_format]") {
  const testing::TemporaryFolder folder;
  // Grasps 1 and 4 have a pre-grasp; in grasps 2 and 4 joints have gone on closing by the clutch.
  grasp::GraspFile file = testing::random_grasps(hands::find_hand("barrett"), folder, 4);
  for (const ExchangeFormat format : kAll) {
    CHECK_FALSE(exchange::limits_of(format, file).empty());
    CHECK_FALSE(mentions(exchange::limits_of(format, file), "obstacles"));
  }
  const auto isaac = [&] { return exchange::limits_of(ExchangeFormat::IsaacGrasp, file); };
  CHECK(mentions(isaac(), "grasps 2 and 3: no pregrasp_cspace_position"));
  CHECK_FALSE(mentions(isaac(), "retreat"));
  file.grasps[3].pre_grasp->retreat = 0.02;
  CHECK(mentions(isaac(), "grasp 4: the palm's retreat"));
  CHECK_FALSE(mentions(isaac(), "multiplied"));
  file.object.meters_per_file_unit = 0.001;
  CHECK(mentions(isaac(), "multiplied by 0.001"));
  CHECK(mentions(exchange::limits_of(ExchangeFormat::MoveItGrasp, file), "a clutch"));
  CHECK(mentions(exchange::limits_of(ExchangeFormat::DexGraspBench, file),
                 "all grasps: no squeeze, its row of squeeze_qpos is NaN"));
  CHECK(mentions(exchange::limits_of(ExchangeFormat::GraspItWorld, file), "does not read"));
  file.surroundings.table_z_O = 0.0;
  for (const ExchangeFormat format : kAll) {
    CHECK(mentions(exchange::limits_of(format, file), "table and obstacles are left out"));
  }
}

TEST_CASE("Poses around an object that was laid down are written in its file's frame, or with it",
          "[exchange][exchange_format]") {
  const TemporaryFolder folder;
  const grasp::GraspFile usual = testing::random_grasps(hands::find_hand("barrett"), folder, 3);
  grasp::GraspFile laid = usual;
  grasp::LaidPose& pose = laid.object.laid.emplace();
  pose.rotation_wxyz = {0.5, 0.5, -0.5, 0.5};
  pose.translation = {0.1, -0.2, 0.3};
  for (grasp::Grasp& grasp : laid.grasps) {
    for (hands::HandConfiguration* const at :
         {&grasp.configuration, grasp.pre_grasp ? &grasp.pre_grasp->configuration : nullptr}) {
      if (at != nullptr) at->X_OH = pose.X_OF() * at->X_OH;
    }
  }
  const auto path = folder.path() / "laid.yaml";
  std::ofstream(path) << exchange::isaac_grasp_yaml(laid);
  const auto read = exchange::read_isaac_grasps(path, laid.hand);
  REQUIRE(read.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const geometry::RigidTransform& X_FH = usual.grasps[i].configuration.X_OH;
    CHECK((read[i].configuration.X_OH.matrix() - X_FH.matrix()).norm() < 1e-12);
  }
  // The others have a pose for the object.
  CHECK(exchange::dexgraspbench_npz(laid) != exchange::dexgraspbench_npz(usual));
  const std::string world = exchange::graspit_world_xml(laid, 0);
  CHECK(world.find("[100 -200 300]") != std::string::npos);
  CHECK(mentions(exchange::limits_of(ExchangeFormat::PosedGlb, laid), "those of the table"));
}

}  // namespace test_exchange_format
