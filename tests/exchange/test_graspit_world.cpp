#include <tinyxml2.h>

#include <cmath>
#include <sstream>

#include "exchanged_grasps.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/exchange/graspit_world.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

namespace test_graspit_world {

namespace {

using namespace graspfit;
using testing::TemporaryFolder;

std::string text_at(const tinyxml2::XMLElement* element, std::initializer_list<const char*> path) {
  for (const char* name : path) {
    REQUIRE(element != nullptr);
    element = element->FirstChildElement(name);
  }
  REQUIRE(element != nullptr);
  return element->GetText() ? element->GetText() : "";
}

std::vector<double> numbers_in(std::string text) {
  for (char& c : text) {
    if (c == '(' || c == ')' || c == '[' || c == ']') c = ' ';
  }
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (double number = 0.0; stream >> number;) numbers.push_back(number);
  return numbers;
}

}  // namespace

TEST_CASE("A world holds the palm's pose in millimeters, the object at the origin and its scale",
          "[exchange][graspit_world]") {
  const TemporaryFolder folder;
  grasp::GraspFile file = testing::random_grasps(hands::find_hand("barrett"), folder, 3);
  file.object.meters_per_file_unit = 0.0254;
  tinyxml2::XMLDocument document;
  REQUIRE(document.Parse(exchange::graspit_world_xml(file, 2).c_str()) == tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement* const world = document.RootElement();
  REQUIRE(std::string(world->Name()) == "world");
  CHECK(numbers_in(text_at(world, {"graspableBody", "transform", "fullTransform"})) ==
        std::vector<double>{1, 0, 0, 0, 0, 0, 0});
  CHECK(text_at(world, {"graspableBody", "body", "geometryFile"}) == file.object.file);
  CHECK(numbers_in(text_at(world, {"graspableBody", "body", "geometryScaling"}))[0] ==
        Approx(25.4).epsilon(1e-14));
  CHECK(text_at(world, {"robot", "filename"}) == file.hand.description_file);
  const std::vector<double> pose =
      numbers_in(text_at(world, {"robot", "transform", "fullTransform"}));
  REQUIRE(pose.size() == 7);
  const hands::HandConfiguration& configuration = file.grasps[2].configuration;
  const Eigen::Matrix3d rotation =
      Eigen::Quaterniond(pose[0], pose[1], pose[2], pose[3]).toRotationMatrix();
  CHECK((rotation - configuration.X_OH.linear()).norm() < 1e-14);
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(pose[static_cast<std::size_t>(4 + axis)] ==
          Approx(1000.0 * configuration.X_OH.translation()[axis]).epsilon(1e-15));
  }
  // The independent joints are the spread and three fingers.
  CHECK(numbers_in(text_at(world, {"robot", "dofValues"})).size() == 4);

  const std::string named = exchange::graspit_world_xml(
      file, 0, {.body_file = "models/objects/mug.xml", .robot_file = "models/robots/B & B.xml"});
  REQUIRE(document.Parse(named.c_str()) == tinyxml2::XML_SUCCESS);
  CHECK(text_at(document.RootElement(), {"graspableBody", "filename"}) == "models/objects/mug.xml");
  CHECK(text_at(document.RootElement(), {"robot", "filename"}) == "models/robots/B & B.xml");
  CHECK_THROWS_AS(exchange::graspit_world_xml(file, 3), base::InvalidInput);
}

TEST_CASE(
    "Degrees of freedom of a GraspIt! hand stand in its order, with the flags of its clutches",
    "[exchange][graspit_world]") {
  const auto robot = testing::find_data("hands/barrett_graspit/graspit_Barrett.xml");
  if (!robot) {
    GRASPFIT_SKIP_TEST("hands/barrett_graspit/graspit_Barrett.xml is not there; set GRASPFIT_DATA");
  }
  const hands::HandModel hand = hands::read_hand_model(*robot);
  CHECK(exchange::is_graspit_hand(hand));
  CHECK_FALSE(exchange::is_graspit_hand(hands::find_hand("barrett")));
  const TemporaryFolder folder;
  grasp::GraspFile file = testing::random_grasps(hand, folder, 1);
  Eigen::VectorXd& q = file.grasps[0].configuration.q;
  q.setZero();
  const auto set = [&](const std::string& joint, double value) {
    q[hand.joint_index(joint)] = value;
  };
  // The follower is at a third of 0.9 rad, by the ratio that the file writes with nine digits.
  set("d1_chain0_joint1", 0.9);
  set("d1_chain0_joint2", 0.333333333 * 0.9);
  // The proximal joint stopped at 0.6 rad; the distal one went on as far as 1.2 rad take it.
  set("d2_chain1_joint1", 0.6);
  set("d2_chain1_joint2", 0.333333333 * 1.2);
  set("d0_chain0_joint0", 0.25);
  set("d0_chain1_joint0", 0.25);
  tinyxml2::XMLDocument document;
  REQUIRE(document.Parse(exchange::graspit_world_xml(file, 0).c_str()) == tinyxml2::XML_SUCCESS);
  const std::vector<double> values =
      numbers_in(text_at(document.RootElement(), {"robot", "dofValues"}));
  // There is one number for the rigid spread, then for each clutch its value and a flag per joint,
  // followed by where the joint stopped if it did, as in GraspIt!'s own world barrettGlassDyn.xml.
  const std::vector<double> expected = {0.25, 0.9, 0, 0, 1.2, 1, 0.6, 0, 0, 0, 0};
  REQUIRE(values.size() == expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(values[i] == Approx(expected[i]).margin(1e-12));
  }
}

}  // namespace test_graspit_world
