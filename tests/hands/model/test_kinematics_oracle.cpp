#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/jacobian.hpp"
#include "hands/kdl_hand.hpp"
#include "hands/shared_hands.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"

namespace test_kinematics_oracle {

// These tests compare our reader, tree, kinematics and Jacobians with urdfdom and Orocos KDL, which
// share no line with them.
namespace {

using namespace graspfit;
using base::Random;
using Eigen::Vector3d;
using hands::HandConfiguration;
using hands::HandModel;
using hands::RigidTransform;
using testing::KdlHand;
namespace fs = std::filesystem;

// Both sides round some ten products of numbers below 1 per link, which leaves 1e-15.
// The unit is m, or an entry of a rotation or a Jacobian.
constexpr double kTolerance = 1e-9;

constexpr int kNumConfigurations = 1000;

RigidTransform random_pose(Random& random) {
  Eigen::Vector4d quaternion;
  do {
    for (int i = 0; i < 4; ++i) quaternion[i] = random.uniform(-1.0, 1.0);
  } while (quaternion.norm() < 0.1 || quaternion.norm() > 1.0);  // This is uniform over rotations.
  RigidTransform X = RigidTransform::Identity();
  X.linear() = Eigen::Quaterniond(quaternion.normalized()).toRotationMatrix();
  for (int i = 0; i < 3; ++i) X.translation()[i] = random.uniform(-1.0, 1.0);
  return X;
}

/// Draws a configuration within all limits; every second time coupled joints follow their leaders.
HandConfiguration random_configuration(const HandModel& hand, Random& random, int k) {
  HandConfiguration c{.X_OH = random_pose(random),
                      .q = Eigen::VectorXd(static_cast<Eigen::Index>(hand.joints.size()))};
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    c.q[static_cast<Eigen::Index>(j)] = random.uniform(hand.joints[j].lower, hand.joints[j].upper);
  }
  if (k % 2 == 0) hands::apply_couplings(hand, c.q);
  return c;
}

/// One link in both libraries, with KDL's chain to it from the palm, and our indices of its joints.
struct Compared {
  KdlHand::Chain chain;
  std::vector<Eigen::Index> joints;

  Eigen::VectorXd positions(const Eigen::VectorXd& q) const { return q(joints); }
};

std::vector<Compared> compared_links(const HandModel& hand, const KdlHand& kdl) {
  std::vector<Compared> result;
  const std::string palm = hand.links[static_cast<std::size_t>(hand.palm.link)].name;
  for (const hands::Link& link : hand.links) {
    Compared entry{kdl.chain(palm, link.name), {}};
    for (const std::string& joint : entry.chain.joints()) {
      entry.joints.push_back(hand.joint_index(joint));
    }
    result.push_back(std::move(entry));
  }
  return result;
}

/// Checks that every link that the file has is in the model, except what the palm itself hangs on.
void check_tree(const HandModel& hand, const KdlHand& kdl) {
  std::map<std::string, std::optional<std::string>> parents;
  std::set<std::string> missing;
  for (const KdlHand::Link& link : kdl.links()) {
    parents[link.name] = link.parent;
    missing.insert(link.name);
  }
  for (const hands::Link& link : hand.links) {
    CAPTURE(link.name);
    REQUIRE(missing.erase(link.name) == 1);
    if (link.parent_link) {
      CHECK(hand.links[static_cast<std::size_t>(*link.parent_link)].name == parents[link.name]);
    }
  }
  // What is left out does not hang on the palm.
  const std::string palm = hand.links[static_cast<std::size_t>(hand.palm.link)].name;
  for (const std::string& name : missing) {
    CAPTURE(name, palm);
    std::optional<std::string> above = name;
    while (above && *above != palm) above = parents[*above];
    CHECK_FALSE(above.has_value());
  }
}

/// Checks that types, limits and couplings are those that urdfdom reads.
void check_joints(const HandModel& hand, const KdlHand& kdl) {
  std::map<std::string, KdlHand::Joint> others;
  for (const KdlHand::Joint& joint : kdl.joints()) others[joint.name] = joint;
  for (const hands::Joint& joint : hand.joints) {
    CAPTURE(joint.name);
    REQUIRE(others.contains(joint.name));
    const KdlHand::Joint& other = others[joint.name];
    CHECK((joint.type == hands::JointType::Prismatic) == other.is_prismatic);
    CHECK(joint.lower == other.lower);
    CHECK(joint.upper == other.upper);
    // Sidecars couple joints besides, and repeat <mimic> with more digits than the URDF has.
    if (hand.sidecar_file.empty()) CHECK(joint.coupling.has_value() == other.mimic.has_value());
    if (!other.mimic) continue;
    REQUIRE(joint.coupling.has_value());
    CHECK(hand.joints[static_cast<std::size_t>(joint.coupling->leader)].name == other.mimic->joint);
    const double rounding = hand.sidecar_file.empty() ? 0.0 : 1e-9;
    CHECK(std::abs(joint.coupling->ratio - other.mimic->multiplier) <= rounding);
    CHECK(std::abs(joint.coupling->offset - other.mimic->offset) <= rounding);
  }
}

void check_poses(const HandModel& hand, const std::vector<Compared>& links) {
  Random random(41);
  double worst_position = 0.0, worst_rotation = 0.0;
  for (int k = 0; k < kNumConfigurations; ++k) {
    const HandConfiguration c = random_configuration(hand, random, k);
    const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, c);
    REQUIRE(X_OL.size() == links.size());
    for (std::size_t i = 0; i < links.size(); ++i) {
      const RigidTransform expected = c.X_OH * links[i].chain.pose(links[i].positions(c.q));
      worst_position =
          std::max(worst_position, (X_OL[i].translation() - expected.translation()).norm());
      worst_rotation =
          std::max(worst_rotation, (X_OL[i].linear() - expected.linear()).cwiseAbs().maxCoeff());
    }
  }
  CHECK(worst_position < kTolerance);
  CHECK(worst_rotation < kTolerance);
}

void check_jacobians(const HandModel& hand, const std::vector<Compared>& links) {
  Random random(43);
  double worst = 0.0;
  for (int k = 0; k < kNumConfigurations / 10; ++k) {
    const HandConfiguration c = random_configuration(hand, random, k);
    const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, c);
    for (std::size_t i = 0; i < links.size(); ++i) {
      const Vector3d point_L = random_pose(random).translation();
      const auto own = hands::point_jacobian(hand, X_OL, static_cast<int>(i), point_L);
      // KDL's Jacobian is in the palm's frame and is turned into O; joints beside the chain do not
      // move the link.
      Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, c.q.size());
      const auto chain = links[i].chain.jacobian(links[i].positions(c.q), point_L);
      for (std::size_t j = 0; j < links[i].joints.size(); ++j) {
        const auto column = chain.col(static_cast<Eigen::Index>(j));
        expected.col(links[i].joints[j]) << c.X_OH.linear() * column.head<3>(),
            c.X_OH.linear() * column.tail<3>();
      }
      worst = std::max(worst, (own - expected).cwiseAbs().maxCoeff());
    }
  }
  CHECK(worst < kTolerance);
}

void check_hand(const HandModel& hand, const fs::path& urdf) {
  CAPTURE(urdf.string());
  const KdlHand kdl(urdf);
  check_tree(hand, kdl);
  check_joints(hand, kdl);
  const std::vector<Compared> links = compared_links(hand, kdl);
  check_poses(hand, links);
  check_jacobians(hand, links);
}

TEST_CASE("Every shipped hand has the kinematics that KDL gives its URDF",
          "[hands][kinematics_oracle]") {
  for (const std::string& name : hands::shipped_hands()) {
    check_hand(hands::find_hand(name), hands::shipped_hand_file(name));
  }
}

TEST_CASE("Every shared hand has the kinematics that KDL gives its URDF",
          "[hands][kinematics_oracle]") {
  for (const testing::SharedHand& shared : testing::shared_hands()) {
    const auto urdf = testing::find_urdf(shared);
    if (!urdf) GRASPFIT_SKIP_TEST(testing::why_skipped(shared));
    check_hand(hands::find_hand(urdf->string()), *urdf);
  }
}

}  // namespace

}  // namespace test_kinematics_oracle
