// This program links every layer down to the physics engine from nothing but an installed graspfit.
// It tests a grasp of its own making of a cube in jaws.
#include <cstdio>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hold_test/hold_test.hpp"

int main() {
  using namespace graspfit;
  const hands::HandModel gripper = hands::find_hand("parallel_gripper");
  const geometry::TriangleMesh cube = geometry::box({0.04, 0.04, 0.04});  // meters
  const hold_test::HoldProtocol protocol = hold_test::hold_protocol("dexgraspbench-100g");
  const hold_test::HoldHand hand = hold_test::prepare_hold_hand(gripper);
  const hold_test::HoldObject object = hold_test::prepare_hold_object(cube);
  if (!hold_test::is_available()) {
    try {
      hold_test::HoldTest(hand, object, protocol);
    } catch (const base::InvalidInput& error) {
      std::printf("%s\n", error.what());
      return 0;
    }
    return 1;
  }
  // The jaws stand wide open beside the cube, and nothing holds it.
  grasp::Grasp open;
  open.configuration = hands::open_configuration(gripper);
  open.configuration.X_OH.translation() = Eigen::Vector3d(0.0, 0.0, 0.5);
  open.pre_grasp.emplace().configuration = open.configuration;
  open.squeeze.emplace().configuration = open.configuration;
  const hold_test::HoldVerdict verdict = hold_test::HoldTest(hand, object, protocol).test(open);
  std::printf("open hand: %s, %zu loads, squeezed with %.1f N\n",
              verdict.stage == hold_test::HoldStage::Load ? "lost under load" : "unexpected",
              verdict.directions.size(), verdict.squeeze_force);
  return verdict.stage == hold_test::HoldStage::Load && verdict.squeeze_force == 0.0 ? 0 : 1;
}
