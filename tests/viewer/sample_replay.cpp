#include "sample_replay.hpp"

#include <algorithm>
#include <cmath>

#include "graspfit/geometry/shapes.hpp"
#include "sample_scene.hpp"

namespace graspfit::testing {
namespace {

using geometry::RigidTransform;
using hold_test::HoldFrame;

constexpr double kInterval = 0.02;  // [s]
constexpr double kClosing = 0.2;
constexpr double kSqueezing = 0.2;
constexpr double kHolding = 0.6;

/// Returns the pose of the ball at this time after the load began.
RigidTransform ball_pose(bool slides, double t) {
  RigidTransform X = RigidTransform::Identity();
  if (slides) {
    X.linear() = Eigen::AngleAxisd(t, Eigen::Vector3d::UnitX()).toRotationMatrix();
    X.translation().y() = 2.5 * t * t;
  } else {
    X.translation().x() = 0.001 * std::min(1.0, t / 0.1);
  }
  return X;
}

std::vector<HoldFrame> frames(const hands::HandConfiguration& grasp, bool slides) {
  std::vector<HoldFrame> list;
  const int num = static_cast<int>(std::lround((kClosing + kSqueezing + kHolding) / kInterval));
  for (int i = 0; i <= num; ++i) {
    HoldFrame frame;
    frame.time = i * kInterval;
    const double open = std::max(0.0, 1.0 - frame.time / kClosing);
    frame.hand = grasp;
    frame.hand.X_OH.translation().z() -= 0.03 * open;
    frame.hand.q.setConstant(-0.4 * open);
    frame.X_OB = ball_pose(slides, std::max(0.0, frame.time - kClosing - kSqueezing));
    list.push_back(frame);
  }
  return list;
}

geometry::ConvexDecomposition octants(double half) {
  geometry::ConvexDecomposition shape;
  for (int k = 0; k < 8; ++k) {
    RigidTransform X = RigidTransform::Identity();
    X.translation() = 0.5 * half * Eigen::Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    shape.pieces.push_back(geometry::transformed(geometry::box(half * Eigen::Vector3d::Ones()), X));
  }
  return shape;
}

}  // namespace

viewer::ReplayInput sample_replay() {
  const SampleScene scene = sample_scene();
  viewer::ReplayInput input;
  input.title = "Ball <40 mm>, grasp 1";
  input.object_O = scene.object_O;
  input.object.shape = octants(0.04);
  input.hand.model = scene.hand;
  for (const hands::Link& link : scene.hand.links) {
    input.hand.links.push_back({.pieces = {link.mesh_L}});
  }
  input.protocol.name = "sample";
  input.protocol.source = "made up";
  input.protocol.approach_time = kClosing;
  input.protocol.squeeze_time = kSqueezing;
  input.protocol.hold_time = kHolding;
  input.protocol.check_interval = 0.1;
  const hands::HandConfiguration& grasp = scene.grasps[0].configuration;
  using hold_test::HoldStage;
  input.verdict.stage = HoldStage::Load;
  input.verdict.squeeze_force = 12.5;
  input.verdict.directions = {
      {Eigen::Vector3d::UnitX(), HoldStage::Held, std::nullopt, 0.001, 0.0},
      {-Eigen::Vector3d::UnitX(), HoldStage::Held, std::nullopt, 0.001, 0.0},
      {Eigen::Vector3d::UnitY(), HoldStage::Load, 0.2, 0.1, 0.2}};
  input.replays = {frames(grasp, false), frames(grasp, false), frames(grasp, true)};
  return input;
}

}  // namespace graspfit::testing
