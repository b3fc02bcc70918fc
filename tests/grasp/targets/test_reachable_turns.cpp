#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/tip_reach.hpp"
#include "support/catch.hpp"
#include "targets/reachable_turns.hpp"

namespace test_reachable_turns {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using grasp::internal::kTurns;

TEST_CASE("Turns left out are those at which no visited cell is near, by looking at all of them",
          "[grasp][target_contacts][reachable_turns]") {
  constexpr double kTolerance = 0.015;
  for (const std::string name : {"barrett", "human_hand"}) {
    INFO(name);
    const hands::HandModel hand = hands::find_hand(name);
    const grasp::PalmReach palm{hand.palm.center_H, hand.palm.direction_H, 0.02, {}};
    const grasp::internal::PalmAxes axes(palm);
    const auto reaches = hands::tip_reaches(hand);
    base::Random random(3);
    int num_reached = 0;
    int num_kept = 0;
    for (const auto& tip : {reaches.front(), reaches.back()}) {
      const grasp::internal::ReachableTurns turns(axes, *tip, kTolerance);
      for (int sample = 0; sample < 60; ++sample) {
        // The point is near one that the tip gets to, and turned away by some angle.
        const Vector3d place = tip->visited_H()[random.index(tip->visited_H().size())] +
                               0.02 * Vector3d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                                               random.uniform(-1.0, 1.0));
        const Eigen::AngleAxisd away(random.uniform(0.0, 2.0 * std::numbers::pi), palm.direction_H);
        const Vector3d from_palm = away * (place - palm.center_H);
        const grasp::internal::Turns kept = turns.at(axes.place(from_palm));
        for (int k = 0; k < kTurns; ++k) {
          const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * k / kTurns, palm.direction_H);
          const Vector3d point = palm.center_H + turn * from_palm;
          bool is_near = false;
          for (const Vector3d& visited : tip->visited_H()) {
            is_near = is_near || (visited - point).norm() <= kTolerance;
          }
          if (is_near && !kept[static_cast<std::size_t>(k)]) FAIL_CHECK(sample << " turn " << k);
          num_reached += is_near ? 1 : 0;
          num_kept += kept[static_cast<std::size_t>(k)] ? 1 : 0;
        }
      }
    }
    CHECK(num_reached > 500);
    // Otherwise the table would be of no use.
    CHECK(num_kept < 4 * num_reached);
  }
}

TEST_CASE("Seen from the palm, turning by a turn's width moves on by one azimuth",
          "[grasp][target_contacts][reachable_turns]") {
  const grasp::PalmReach palm{Vector3d(0.1, 0.2, 0.3), Vector3d(1, 2, 2) / 3.0, 0.02, {}};
  const grasp::internal::PalmAxes axes(palm);
  const Vector3d aside = palm.direction_H.unitOrthogonal();
  for (int k = 0; k < kTurns; ++k) {
    const Eigen::AngleAxisd turn((k + 0.5) * 2.0 * std::numbers::pi / kTurns, palm.direction_H);
    const auto place = axes.place(0.07 * palm.direction_H + 0.04 * (turn * aside));
    CHECK(place.ahead == Approx(0.07));
    CHECK(place.aside == Approx(0.04));
    CHECK((place.azimuth -
           axes.place(0.04 *
                      (Eigen::AngleAxisd(0.5 * 2.0 * std::numbers::pi / kTurns, palm.direction_H) *
                       aside))
               .azimuth +
           kTurns) %
              kTurns ==
          k);
  }
}

}  // namespace

}  // namespace test_reachable_turns
