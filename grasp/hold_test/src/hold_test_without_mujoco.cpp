#include "graspfit/base/errors.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::hold_test {

namespace {

[[noreturn]] void refuse() {
  throw base::InvalidInput(
      "HoldTest: this build has no MuJoCo, the physics engine of the hold test: install "
      "libmujoco-dev and libgl-dev, then configure with GRASPFIT_WITH_MUJOCO=ON");
}

}  // namespace

struct HoldTest::Impl {};

bool is_available() { return false; }

HoldTest::HoldTest(const HoldHand&, const HoldObject&, const HoldProtocol& protocol) {
  protocol.validate();
  refuse();
}
HoldTest::~HoldTest() = default;
HoldTest::HoldTest(HoldTest&&) noexcept = default;
HoldTest& HoldTest::operator=(HoldTest&&) noexcept = default;

HoldVerdict HoldTest::test(const grasp::Grasp&) { refuse(); }
bool HoldTest::holds_at(const grasp::Grasp&, double) { refuse(); }
bool HoldTest::is_near_limit(const grasp::Grasp&, const HoldVerdict&) { refuse(); }
HoldMargin HoldTest::margin(const grasp::Grasp&, double) { refuse(); }
std::vector<HoldFrame> HoldTest::replay(const grasp::Grasp&, int, double) { refuse(); }

}  // namespace graspfit::hold_test
