#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/hand_workspace.hpp"
#include "graspfit/hands/tip_reach.hpp"
#include "support/catch.hpp"

namespace test_tip_reach {

namespace {

using namespace graspfit;
using Eigen::Vector3d;

TEST_CASE("A tip's reach is the cells that it visits, by the way its pad looks",
          "[hands][tip_reach]") {
  const double cell = 0.1;
  const hands::TipReach reach({{Vector3d::Zero(), Vector3d::UnitX()},
                               {Vector3d(1.0, 0.0, 0.0), Vector3d(1.0, 1.0, 0.0).normalized()}},
                              cell);
  const auto at = [&](double x, double y, const Vector3d& normal) {
    return reach.distance(Vector3d(x, y, 0.01), normal.normalized());
  };
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY();
  CHECK(at(0.0, 0.0, x) == 0.0);
  CHECK(at(1.0, 0.0, x) == 0.0);  // The normal is 45 degrees off.
  CHECK(at(1.0, 0.0, y) == 0.0);
  // Distances are floats of whole cells.
  CHECK(at(0.3, 0.0, x) == Approx(0.3).epsilon(1e-6));
  CHECK(at(0.0, 0.0, y) == Approx(1.0).epsilon(1e-6));
  CHECK(at(0.0, 0.0, -x) == std::numeric_limits<double>::infinity());
  CHECK(at(0.0, 0.0, Vector3d::UnitZ()) == std::numeric_limits<double>::infinity());
  CHECK(at(2.5, 0.0, x) > 1.0);  // This is beyond the lattice.
  CHECK_THROWS_AS(hands::TipReach({}, cell), base::InvalidInput);
  // A hand in millimeters, or of no finite size, has more cells than fit into memory or an int.
  for (const double far : {300.0, 1e300, std::numeric_limits<double>::infinity()}) {
    const Vector3d corner = Vector3d::Constant(far);
    CHECK_THROWS_AS(
        hands::TipReach({{-corner, Vector3d::UnitX()}, {corner, Vector3d::UnitX()}}, cell),
        base::InvalidInput);
  }
}

TEST_CASE("Whatever its joints, a tip is where its reach says", "[hands][tip_reach]") {
  struct Hand {
    const char* name;
    double spacing;  ///< Distance between samples at the tip, about [m].
  };
  for (const Hand& c :
       {Hand{"parallel_gripper", 0.001}, Hand{"barrett", 0.006}, Hand{"human_hand", 0.02}}) {
    INFO(c.name);
    const hands::HandModel hand = hands::find_hand(c.name);
    const auto reaches = hands::tip_reaches(hand);
    REQUIRE(reaches.size() == hand.fingers.size());
    base::Random random(5);
    hands::HandConfiguration configuration = hands::open_configuration(hand);
    const Eigen::VectorXd open = configuration.q;
    for (int sample = 0; sample < 300; ++sample) {
      configuration.q = open;
      for (std::size_t j = 0; j < hand.joints.size(); ++j) {
        if (hand.joints[j].coupling) continue;
        configuration.q[static_cast<Eigen::Index>(j)] =
            random.uniform(hand.joints[j].lower, hand.joints[j].upper);
      }
      hands::apply_couplings(hand, configuration.q);
      const auto X_HL = hands::forward_kinematics(hand, configuration);
      for (std::size_t f = 0; f < hand.fingers.size(); ++f) {
        const int pad = *hand.fingers[f].tip_pad;
        REQUIRE(reaches[f].has_value());
        const Vector3d point = hands::pad_contact_point(hand, pad, X_HL);
        const Vector3d normal = hands::pad_pose(hand, pad, X_HL).linear().col(2);
        // The reach may be off by a cell's diagonal and by the nearest sample.
        CHECK(reaches[f]->distance(point, normal) <= 0.006 * std::sqrt(3.0) + c.spacing);
        CHECK(reaches[f]->distance(point + Vector3d(0, 0, 1.0), normal) > 0.5);
      }
    }
  }
}

TEST_CASE("Palm distances alone are those of the whole workspace", "[hands][tip_reach]") {
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  CHECK(hands::palm_distances(hand) == hands::hand_workspace(hand).palm_to_tip);
  CHECK_THROWS_AS(hands::palm_distances(hand, {.samples_per_joint = 1}), base::InvalidInput);
}

}  // namespace

}  // namespace test_tip_reach
