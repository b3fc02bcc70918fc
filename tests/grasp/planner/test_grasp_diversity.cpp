#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/grasp/grasp_diversity.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_grasp_diversity {

using namespace graspfit;
using namespace graspfit::grasp;
using Eigen::AngleAxisd;
using Eigen::Vector3d;
using hands::HandConfiguration;
using Configurations = std::vector<HandConfiguration>;

namespace {

const hands::HandModel& barrett() {
  static const hands::HandModel hand = hands::find_hand("barrett");
  return hand;
}

HandConfiguration at(const Vector3d& place) {
  HandConfiguration configuration = hands::open_configuration(barrett());
  configuration.X_OH.translation() = place;
  return configuration;
}

}  // namespace

TEST_CASE("Grasps linked by chains of like ones are one cluster", "[grasp][grasp_diversity]") {
  // The steps are 6 mm, where up to 10 mm counts as alike; then there is a gap of 20 mm.
  Configurations grasps;
  for (const double x : {0.0, 0.006, 0.012, 0.018, 0.038, 0.044}) {
    grasps.push_back(at({x, 0.0, 0.0}));
  }
  const GraspDiversity diversity = grasp_diversity(barrett(), grasps);
  CHECK(diversity.num_grasps == 6);
  CHECK(diversity.num_clusters == 2);
  // All are on a line.
  CHECK(*diversity.first_axis_share == Approx(1.0).epsilon(1e-12));
  CHECK(grasp_diversity(barrett(), grasps, {.translation = 0.005}).num_clusters == 6);
  CHECK(grasp_diversity(barrett(), grasps, {.translation = 0.02}).num_clusters == 1);

  std::reverse(grasps.begin(), grasps.end());
  std::swap(grasps[1], grasps[4]);
  const GraspDiversity reordered = grasp_diversity(barrett(), grasps);
  CHECK(reordered.num_clusters == 2);
  CHECK(*reordered.first_axis_share == Approx(*diversity.first_axis_share).epsilon(1e-12));
}

TEST_CASE("The share of the first axis is that of the variances", "[grasp][grasp_diversity]") {
  // Positions at ±e_i have the same variance three ways; twice as far in x it has 4 of 6 parts.
  for (const double stretch : {1.0, 2.0}) {
    Configurations grasps;
    for (int axis = 0; axis < 3; ++axis) {
      const double length = axis == 0 ? 0.05 * stretch : 0.05;
      grasps.push_back(at(length * Vector3d::Unit(axis)));
      grasps.push_back(at(-length * Vector3d::Unit(axis)));
    }
    const double part = stretch * stretch;
    CHECK(*grasp_diversity(barrett(), grasps).first_axis_share ==
          Approx(part / (part + 2.0)).epsilon(1e-12));
  }
  // A joint and a position are each as far apart as what tells grasps apart: half and half.
  Configurations grasps = {at({0.01, 0, 0}), at({-0.01, 0, 0}), at({0, 0, 0}), at({0, 0, 0})};
  grasps[2].q[barrett().joint_index("thumb_proximal")] += 0.2;
  grasps[3].q[barrett().joint_index("thumb_proximal")] -= 0.2;
  CHECK(*grasp_diversity(barrett(), grasps).first_axis_share == Approx(0.5).epsilon(1e-12));
  // A small turn about the palm center counts as its angle.
  const DistinctOptions options;
  const double angle = 1e-3 * options.rotation;
  grasps = {at({1e-3 * options.translation, 0, 0}), at({-1e-3 * options.translation, 0, 0}),
            at({0, 0, 0}), at({0, 0, 0})};
  for (const int i : {2, 3}) {
    HandConfiguration& turned = grasps[static_cast<std::size_t>(i)];
    const Vector3d center = turned.X_OH * barrett().palm.center_H;
    turned.X_OH.linear() =
        AngleAxisd(i == 2 ? angle : -angle, Vector3d::UnitZ()).toRotationMatrix();
    turned.X_OH.translation() += center - turned.X_OH * barrett().palm.center_H;
  }
  CHECK(*grasp_diversity(barrett(), grasps).first_axis_share == Approx(0.5).epsilon(1e-6));
}

TEST_CASE("Diversity does not change with the object's frame", "[grasp][grasp_diversity]") {
  base::Random random(31);
  Configurations grasps;
  for (int i = 0; i < 12; ++i) {
    HandConfiguration grasp = at(0.01 * testing::random_direction(random));
    grasp.X_OH.linear() =
        AngleAxisd(random.uniform(0.0, 0.4), testing::random_direction(random)).toRotationMatrix();
    grasp.q[barrett().joint_index("thumb_proximal")] += random.uniform(0.0, 0.5);
    grasps.push_back(grasp);
  }
  const GraspDiversity before = grasp_diversity(barrett(), grasps);
  CHECK(before.num_clusters > 1);
  geometry::RigidTransform motion = geometry::RigidTransform::Identity();
  motion.linear() = AngleAxisd(1.1, testing::random_direction(random)).toRotationMatrix();
  motion.translation() << 0.3, -0.2, 0.1;
  for (HandConfiguration& grasp : grasps) grasp.X_OH = motion * grasp.X_OH;
  const GraspDiversity after = grasp_diversity(barrett(), grasps);
  CHECK(after.num_clusters == before.num_clusters);
  CHECK(*after.first_axis_share == Approx(*before.first_axis_share).epsilon(1e-9));
}

TEST_CASE("No grasp, one and equal ones have no first axis", "[grasp][grasp_diversity]") {
  CHECK(grasp_diversity(barrett(), {}).num_clusters == 0);
  CHECK_FALSE(grasp_diversity(barrett(), {}).first_axis_share.has_value());
  const Configurations same(5, at({0.1, 0.2, 0.3}));
  CHECK(grasp_diversity(barrett(), same).num_clusters == 1);
  CHECK_FALSE(grasp_diversity(barrett(), same).first_axis_share.has_value());
  CHECK_THROWS_WITH(grasp_diversity(barrett(), same, {.rotation = 0.0}),
                    testing::Contains("rotation = 0"));
  Configurations wrong = same;
  wrong.back().q.resize(1);
  CHECK_THROWS_AS(grasp_diversity(barrett(), wrong), base::InvalidInput);
}

}  // namespace test_grasp_diversity
