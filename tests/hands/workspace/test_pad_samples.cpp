#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/hands/contact_pad.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/pad_samples.hpp"
#include "support/catch.hpp"

namespace test_pad_samples {

using namespace graspfit;
using hands::HandModel;
using hands::PadSamples;

TEST_CASE("Samples are where forward kinematics puts the pad", "[hands][pad_samples]") {
  for (const char* name : {"barrett", "human_hand", "parallel_gripper"}) {
    CAPTURE(name);
    const HandModel hand = hands::find_hand(name);
    std::vector<int> pads;
    for (std::size_t pad = 0; pad < hand.pads.size(); ++pad) pads.push_back(static_cast<int>(pad));
    for (const PadSamples& samples : hands::pad_samples(hand, pads, 500)) {
      CAPTURE(samples.pad);
      CHECK(samples.size() >= 1);
      CHECK(samples.size() <= 500);
      for (Eigen::Index sample = 0; sample < samples.points_H.cols(); sample += 7) {
        hands::HandConfiguration configuration = hands::open_configuration(hand);
        for (std::size_t j = 0; j < samples.joints.size(); ++j) {
          configuration.q[samples.joints[j]] =
              samples.positions(static_cast<Eigen::Index>(j), sample);
        }
        hands::apply_couplings(hand, configuration.q);
        const auto X_HL = hands::forward_kinematics(hand, configuration);
        CHECK((hands::pad_contact_point(hand, samples.pad, X_HL) - samples.points_H.col(sample))
                  .norm() < 1e-12);
        CHECK((hands::pad_pose(hand, samples.pad, X_HL).linear().col(2) -
               samples.normals_H.col(sample))
                  .norm() < 1e-12);
      }
    }
  }
}

TEST_CASE("Contact points lie all along long flat pads where that is asked for",
          "[hands][pad_samples]") {
  const HandModel hand = hands::find_hand("barrett");
  const std::vector<int> pads = {*hand.fingers[0].tip_pad, *hand.fingers[1].tip_pad,
                                 *hand.palm.pad};
  const std::vector<PadSamples> middle = hands::pad_samples(hand, pads, 400);
  const std::vector<PadSamples> along = hands::pad_samples(hand, pads, 400, true);
  for (std::size_t i = 0; i < pads.size(); ++i) {
    CHECK(along[i].positions == middle[i].positions);
    CHECK(along[i].normals_H == middle[i].normals_H);
    double nearest = 1.0;
    double farthest = 0.0;
    for (Eigen::Index sample = 0; sample < middle[i].points_H.cols(); ++sample) {
      const Eigen::Vector3d shift = along[i].points_H.col(sample) - middle[i].points_H.col(sample);
      CHECK(std::abs(shift.dot(middle[i].normals_H.col(sample))) < 1e-12);
      nearest = std::min(nearest, shift.norm());
      farthest = std::max(farthest, shift.norm());
    }
    if (i == 2) continue;  // the palm's one sample
    // The distal pads are 52 mm long; their ends are left free by 2 mm.
    CHECK(farthest <= 0.024 + 1e-12);
    CHECK(farthest > 0.022);
    CHECK(nearest < 0.002);
  }
  // Toward the fingertip, away from the joint: farther from the link's origin.
  const hands::ContactPad& pad = hand.pads[pads[0]];
  CHECK((pad.X_LC * hands::pad_point_toward_end_C(pad, 1.0)).norm() >
        (pad.X_LC * hands::pad_point_toward_end_C(pad, 0.0)).norm() + 0.01);
  // A bulging tip touches where it bulges.
  const HandModel human = hands::find_hand("human_hand");
  for (const hands::ContactPad& other : human.pads) {
    if (other.surface.empty()) continue;
    CHECK(hands::pad_point_toward_end_C(other, 1.0) == hands::pad_contact_point_C(other));
  }
}

TEST_CASE("Samples that agree in shared joints are a range, of the same positions for all pads",
          "[hands][pad_samples]") {
  const HandModel hand = hands::find_hand("barrett");
  const std::vector<int> pads = {*hand.fingers[0].tip_pad, *hand.fingers[1].tip_pad,
                                 *hand.fingers[2].tip_pad};
  const std::vector<PadSamples> all = hands::pad_samples(hand, pads, 400);
  const int spread = hand.joint_index("finger_1_spread");
  CHECK(all[2].size() == 64);  // of one joint
  std::vector<std::set<double>> positions;
  for (const PadSamples& samples : all) {
    const auto found = std::find(samples.joints.begin(), samples.joints.end(), spread);
    if (found == samples.joints.end()) {
      CHECK(samples.num_shared == 0);
      continue;
    }
    REQUIRE(samples.num_shared == 1);
    REQUIRE(found == samples.joints.end() - 1);
    const Eigen::VectorXd row = samples.positions.bottomRows(1).transpose();
    CHECK(std::is_sorted(row.begin(), row.end()));
    positions.emplace_back(row.begin(), row.end());
  }
  REQUIRE(positions.size() == 2);
  CHECK(positions[0] == positions[1]);
  CHECK(positions[0].size() == 20);  // 20 x 20 samples of two joints
  CHECK_THROWS_AS(hands::pad_samples(hand, pads, 0), base::InvalidInput);
}

TEST_CASE("Pads behind a tip are sampled as finely as their own joints allow, and tips as without",
          "[hands][pad_samples]") {
  const HandModel hand = hands::find_hand("human_hand");
  std::vector<int> tips;
  for (const hands::Finger& finger : hand.fingers) tips.push_back(*finger.tip_pad);
  std::vector<int> all = tips;
  for (std::size_t pad = 0; pad < hand.pads.size(); ++pad) {
    const auto number = static_cast<int>(pad);
    const bool is_tip = std::count(tips.begin(), tips.end(), number) > 0;
    if (hand.pads[pad].finger && !is_tip) all.push_back(number);
  }
  REQUIRE(all.size() > tips.size());
  const std::vector<PadSamples> alone = hands::pad_samples(hand, tips, 1024);
  const std::vector<PadSamples> together = hands::pad_samples(hand, all, 1024);
  for (std::size_t i = 0; i < tips.size(); ++i) {
    CHECK(together[i].positions == alone[i].positions);
    CHECK(together[i].points_H == alone[i].points_H);
  }
  for (std::size_t i = tips.size(); i < all.size(); ++i) {
    const PadSamples own = hands::pad_samples(hand, {all[i]}, 1024).front();
    if (together[i].num_shared == 0) CHECK(together[i].size() == own.size());
    CHECK(together[i].size() <= own.size());
  }
}

}  // namespace test_pad_samples
