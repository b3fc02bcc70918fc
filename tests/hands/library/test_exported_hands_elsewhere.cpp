#include <array>
#include <filesystem>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#ifdef GRASPFIT_WITH_MUJOCO
#include <mujoco/mujoco.h>
#endif

#include "graspfit/hands/hand_export.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_exported_hands_elsewhere {

namespace {

using namespace graspfit;
namespace fs = std::filesystem;
using hands::HandModel;
using hands::RigidTransform;
using Folder = testing::TemporaryFolder;

fs::path exported(const HandModel& hand, const fs::path& folder) {
  return hands::export_hand(hand, folder).back();
}

TEST_CASE("KDL's parser finds every exported joint where forward kinematics puts it",
          "[hands][hand_export]") {
  for (const std::string& name : hands::shipped_hands()) {
    CAPTURE(name);
    const HandModel hand = hands::find_hand(name);
    const Folder folder;
    KDL::Tree tree;
    REQUIRE(kdl_parser::treeFromFile(exported(hand, folder.path()).string(), tree));
    CHECK(tree.getNrOfJoints() == hand.joints.size());
    for (const hands::Joint& joint : hand.joints) {
      const KDL::SegmentMap::const_iterator at =
          tree.getSegment(hand.links[static_cast<std::size_t>(joint.child_link)].name);
      REQUIRE(at != tree.getSegments().end());
      for (const double q : {0.0, joint.lower, 0.3 * joint.lower + 0.7 * joint.upper}) {
        const KDL::Frame X = at->second.segment.pose(q);
        RigidTransform moved = joint.X_PJ;
        if (joint.type == hands::JointType::Revolute) {
          moved = moved * Eigen::AngleAxisd(q, joint.axis_J);
        } else {
          moved = moved * Eigen::Translation3d(q * joint.axis_J);
        }
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 4; ++j) CHECK(X(i, j) == Approx(moved(i, j)).margin(1e-12));
        }
      }
    }
  }
}

#ifdef GRASPFIT_WITH_MUJOCO
TEST_CASE("MuJoCo loads every exported hand with its joints, limits and surfaces",
          "[hands][hand_export]") {
  for (const std::string& name : hands::shipped_hands()) {
    CAPTURE(name);
    const HandModel hand = hands::find_hand(name);
    const Folder folder;
    std::array<char, 1000> error{};
    mjModel* const model = mj_loadXML(exported(hand, folder.path()).c_str(), nullptr, error.data(),
                                      static_cast<int>(error.size()));
    INFO(error.data());
    REQUIRE(model != nullptr);
    CHECK(model->njnt == static_cast<int>(hand.joints.size()));
    for (const hands::Joint& joint : hand.joints) {
      const int id = mj_name2id(model, mjOBJ_JOINT, joint.name.c_str());
      REQUIRE(id >= 0);
      CHECK(model->jnt_range[2 * id] == Approx(joint.lower).margin(1e-12));
      CHECK(model->jnt_range[2 * id + 1] == Approx(joint.upper).margin(1e-12));
    }
    int num_surfaces = 0;
    for (const hands::Link& link : hand.links) num_surfaces += link.mesh_L.faces.empty() ? 0 : 1;
    CHECK(model->nmesh == num_surfaces);
    mj_deleteModel(model);
  }
}
#endif

}  // namespace

}  // namespace test_exported_hands_elsewhere
