#include "sample_motion.hpp"

#include <array>
#include <numbers>

#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "sample_scene.hpp"

namespace graspfit::testing {
namespace {

using geometry::RigidTransform;
using motion::MotionPhase;
using motion::MotionSegment;

RigidTransform at(double x, double y, double z, double turn = 0.0) {
  RigidTransform X = RigidTransform::Identity();
  X.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}

/// Returns a configuration of the hand over an object, palm down.
hands::HandConfiguration over(const hands::HandModel& hand, const RigidTransform& X_WO,
                              double height, double q) {
  hands::HandConfiguration configuration{
      RigidTransform::Identity(),
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(hand.joints.size()), q)};
  configuration.X_OH.linear() =
      Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  configuration.X_OH.translation() = X_WO.translation() + Eigen::Vector3d(0.0, 0.0, 0.05 + height);
  configuration.X_OH.linear() = X_WO.linear() * configuration.X_OH.linear();
  return configuration;
}

motion::RecordedMove move(const hands::HandModel& hand, int object, double m,
                          const RigidTransform& from, const RigidTransform& to) {
  const auto raised = [](RigidTransform X) {
    X.translation().z() += 0.1;
    return X;
  };
  const auto home = over(hand, at(0, 0, 0), 0.3, -0.4);
  const auto before = over(hand, from, 0.06, -0.4);
  const auto hold = over(hand, from, 0.0, 0.0);
  const auto lifted = over(hand, raised(from), 0.0, 0.0);
  const auto arrived = over(hand, raised(to), 0.0, 0.0);
  const auto placed = over(hand, to, 0.0, 0.0);
  const auto after = over(hand, to, 0.06, -0.4);
  return {object,
          m,
          3,
          {{MotionPhase::Reach, object, home, before, from, from},
           {MotionPhase::Approach, object, before, hold, from, from},
           {MotionPhase::Lift, object, hold, lifted, from, raised(from)},
           {MotionPhase::Transport, object, lifted, arrived, raised(from), raised(to)},
           {MotionPhase::Place, object, arrived, placed, raised(to), to},
           {MotionPhase::Release, object, placed, after, to, to},
           {MotionPhase::Retreat, object, after, home, to, to}}};
}

}  // namespace

viewer::MotionInput sample_motion() {
  const SampleScene sample = sample_scene();
  const std::array<geometry::TriangleMesh, 3> meshes = {
      sample.object_O, geometry::box({0.04, 0.04, 0.04}), geometry::box({0.06, 0.06, 0.004})};
  const std::array<const char*, 3> names = {"ball", "red_block", "flat <box>"};
  const std::array<RigidTransform, 3> start = {at(-0.1, 0, 0.04), at(0.1, -0.1, 0.02),
                                               at(0.0, 0.15, 0.002)};
  const std::array<RigidTransform, 3> goal = {at(0.1, 0, 0.04, 0.5 * std::numbers::pi),
                                              at(0.1, 0.1, 0.02), at(0.2, 0.15, 0.002)};
  std::vector<motion::SceneObject> objects;
  motion::MotionFile file;
  file.title = "Two moves & a <flat> box";
  file.hand = sample.hand.name;
  for (const hands::Joint& joint : sample.hand.joints) file.joints.push_back(joint.name);
  file.clearance = 0.003;
  for (std::size_t i = 0; i < 3; ++i) {
    objects.push_back({names[i], geometry::MeshQuery(meshes[i]), Eigen::Vector3d::Zero()});
    file.objects.push_back({names[i], "", "", 1.0, start[i], goal[i]});
  }
  file.moves = {move(sample.hand, 0, 0.5, start[0], goal[0]),
                move(sample.hand, 1, 0.25, start[1], goal[1])};
  file.unmoved = {{2, "it is too flat"}};
  return {motion::TableScene(sample.hand, std::move(objects)), std::move(file)};
}

}  // namespace graspfit::testing
