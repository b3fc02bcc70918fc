#include <cmath>
#include <limits>
#include <numbers>

#include "graspfit/experiments/grasp_predicates.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_grasp_predicates {

using namespace graspfit::experiments;
using graspfit::contact::Contact;
using graspfit::grasp::Grasp;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kAnyGap = std::numeric_limits<double>::infinity();

/// Returns a torus around y with its center of mass at (1, 2, 3), R = 0.05 and r = 0.0125.
PredicateObject torus() {
  PredicateObject object;
  object.center_of_mass_O = {1.0, 2.0, 3.0};
  const Eigen::Vector3d half(0.0625, 0.0125, 0.0625);
  object.box_O = {object.center_of_mass_O - half, object.center_of_mass_O + half};
  return object;
}

/// Returns a contact on the torus, `around` its axis and `tube` around the tube: 0 outermost, π
/// innermost.
Contact on_torus(double around, double tube, int finger = 0) {
  const Eigen::Vector3d radial(std::cos(around), 0.0, std::sin(around));
  const Eigen::Vector3d outward =
      std::cos(tube) * radial + std::sin(tube) * Eigen::Vector3d::UnitY();
  Contact contact;
  contact.point_O = torus().center_of_mass_O + 0.05 * radial + 0.0125 * outward;
  contact.inward_normal_O = -outward;
  contact.finger = finger;
  return contact;
}

double deg(double angle) { return angle * kPi / 180.0; }

}  // namespace

TEST_CASE("Contacts on the outer half of a torus are on its outer side",
          "[experiments][grasp_predicates]") {
  const std::vector<Contact> outer = {on_torus(0.3, deg(89)), on_torus(2.0, deg(-89)),
                                      on_torus(4.0, 0.0)};
  CHECK(contacts_on_outer_side(outer, torus(), 1));
  CHECK_FALSE(contacts_on_outer_side({}, torus(), 1));
  for (const double tube : {91.0, -91.0, 180.0}) {
    std::vector<Contact> mixed = outer;
    mixed.push_back(on_torus(1.0, deg(tube)));
    CHECK_FALSE(contacts_on_outer_side(mixed, torus(), 1));
  }
}

TEST_CASE("A contact inside the hole points to the axis, within the angle",
          "[experiments][grasp_predicates]") {
  const std::vector<Contact> through = {on_torus(0.0, 0.0), on_torus(0.1, deg(180 - 59))};
  CHECK(normal_points_to_axis(through, torus(), 1, deg(60)));
  CHECK_FALSE(normal_points_to_axis(through, torus(), 1, deg(58)));
  const std::vector<Contact> outside = {on_torus(0.0, 0.0), on_torus(0.1, deg(89))};
  CHECK_FALSE(normal_points_to_axis(outside, torus(), 1, deg(90)));
  CHECK_FALSE(normal_points_to_axis({}, torus(), 1, deg(60)));
}

TEST_CASE("Regions are boxes in shares of the bounding box", "[experiments][grasp_predicates]") {
  // It is at x = 1, y = z = 0.5 of the box.
  const std::vector<Contact> contacts = {on_torus(0.0, 0.0)};
  const auto is_clear = [&](Eigen::Vector3d lower, Eigen::Vector3d upper) {
    const std::vector<RelativeBox> region = {{{0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}}, {lower, upper}};
    return no_contact_in_region(contacts, torus(), region);
  };
  CHECK_FALSE(is_clear({0.9, 0.4, 0.4}, {1.1, 0.6, 0.6}));
  CHECK(is_clear({0.0, 0.0, 0.0}, {0.9, 1.0, 1.0}));
  CHECK(is_clear({0.9, 0.6, 0.0}, {1.1, 1.0, 1.0}));
  CHECK_FALSE(no_contact_in_region({}, torus(), {}));
}

TEST_CASE("Contacts are counted by gap", "[experiments][grasp_predicates]") {
  std::vector<Contact> contacts(4);
  contacts[3].gap = 0.002;
  CHECK(num_contacts(contacts, 4, std::nullopt, kAnyGap));
  CHECK_FALSE(num_contacts(contacts, 4, std::nullopt, 1e-4));
  CHECK(num_contacts(contacts, 3, 3, 1e-4));
  CHECK_FALSE(num_contacts(contacts, 3, 3, kAnyGap));
  CHECK_FALSE(num_contacts({}, 0, std::nullopt, kAnyGap));
}

TEST_CASE("Parts that touch are told by name", "[experiments][grasp_predicates]") {
  const auto hand = graspfit::hands::find_hand("barrett");
  std::vector<Contact> contacts(3);
  contacts[0].finger = 0;
  contacts[1].finger.reset();  // This contact is the palm's.
  contacts[2].finger = 1;
  contacts[2].gap = 0.001;
  const std::string first = hand.fingers[0].name;
  const std::string second = hand.fingers[1].name;
  CHECK(parts_touch(contacts, hand, {first, "palm"}, 1e-4, true));
  CHECK_FALSE(parts_touch(contacts, hand, {first, "palm"}, kAnyGap, true));
  CHECK(parts_touch(contacts, hand, {first, "palm"}, kAnyGap, false));
  CHECK_FALSE(parts_touch(contacts, hand, {first, second}, 1e-4, false));
  CHECK_FALSE(parts_touch({}, hand, {}, kAnyGap, true));
}

TEST_CASE("The palm's direction is seen from the object", "[experiments][grasp_predicates]") {
  const auto hand = graspfit::hands::find_hand("barrett");
  Grasp grasp;
  grasp.contacts.resize(1);
  const Eigen::Vector3d wanted(0.0, -2.0, 0.0);
  const auto turned = [&](double angle) {
    const Eigen::Quaterniond to_wanted =
        Eigen::Quaterniond::FromTwoVectors(hand.palm.direction_H, wanted);
    grasp.configuration.X_OH.linear() =
        (Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()) * to_wanted).toRotationMatrix();
    return approaches_along(grasp, hand, wanted, deg(45));
  };
  CHECK(turned(0.0));
  CHECK(turned(deg(44)));
  CHECK_FALSE(turned(deg(46)));
  CHECK_FALSE(turned(kPi));
}

TEST_CASE("Unknown strength is not called strong", "[experiments][grasp_predicates]") {
  std::vector<Contact> contacts(2);
  CHECK_FALSE(no_contact_on_weak(contacts));
  contacts[0].weak = false;
  CHECK(no_contact_on_weak(contacts));
  contacts[1].weak = true;
  CHECK_FALSE(no_contact_on_weak(contacts));
}

TEST_CASE("A mode wins by the larger M alone", "[experiments][grasp_predicates]") {
  CHECK(best_style_by_m({{"pinch", 0.5}, {"grip", 0.4}}, "pinch"));
  CHECK(best_style_by_m({{"pinch", 0.5}}, "pinch"));
  CHECK_FALSE(best_style_by_m({{"pinch", 0.5}, {"grip", 0.5}}, "pinch"));
  CHECK_FALSE(best_style_by_m({{"pinch", 0.5}, {"grip", 0.6}}, "pinch"));
  CHECK_FALSE(best_style_by_m({{"grip", 0.6}}, "pinch"));
}

}  // namespace test_grasp_predicates
