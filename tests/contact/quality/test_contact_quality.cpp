#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "contact/ball_directions.hpp"
#include "contact/pad_hand.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "support/catch.hpp"

namespace test_contact_quality {

using namespace graspfit;
using namespace graspfit::contact;
using Eigen::Vector3d;
using graspfit::testing::ball_contact;
using graspfit::testing::bipyramid;
using graspfit::testing::equator;
using graspfit::testing::octahedron;
using graspfit::testing::pad_hand;
using graspfit::testing::tetrahedron;
using testing::Contains;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadius = 0.05;

// Sums of a few products of numbers near one are off by at most a hundred roundings.
constexpr double kRounding = 1e-13;

/// Returns contacts of fingers 0, 1, … on a ball around the origin.
std::vector<Contact> ball_contacts(const hands::HandModel& hand,
                                   const std::vector<Vector3d>& directions) {
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    contacts.push_back(ball_contact(hand, static_cast<int>(i), directions[i], kRadius));
  }
  return contacts;
}

/// Returns the measure around the center of the hull, so that D = 0.
ContactQuality centered_quality(const hands::HandModel& hand, const std::vector<Contact>& contacts,
                                QualityOptions options = {}) {
  QualityContext context{
      .center_of_mass_O = Vector3d::Zero(), .normalizing_radius = kRadius, .hand = &hand};
  options.beta = 0.0;
  return contact_quality(contacts, context, options);
}

/// Returns five contacts without any symmetry, three of them in stable pairs, on a hand of five
/// fingers.
std::vector<Contact> irregular_contacts(const hands::HandModel& hand) {
  std::vector<Contact> contacts = ball_contacts(
      hand, {Vector3d(1, 0.1, 0.2).normalized(), Vector3d(-0.9, 0.4, 0.1).normalized(),
             Vector3d(-0.2, -1, 0.3).normalized(), Vector3d(0.1, 0.3, -1).normalized(),
             Vector3d(0.3, 0.5, 1).normalized()});
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].area *= 0.5 + 0.1 * static_cast<double>(i);
    contacts[i].pad_boundary_distance *= 0.9 - 0.1 * static_cast<double>(i);
  }
  return contacts;
}

}  // namespace

TEST_CASE("Three contacts on a ball have the measure of the angles between them",
          "[contact][contact_quality]") {
  // Contacts s degrees apart see each other at theta = 90 - s/2, so the pair counts 1 - theta/45 if
  // s > 90. The triangle's angles are half the arcs opposite, its edges 2 sin(s/2). A row holds the
  // arcs, M2, R, and M/M1 with R of angles alone and with both. An independent program computed the
  // values to two decimals.
  struct Row {
    double first, second, m2, r, ratio_angles, ratio;
  };
  const auto row =
      GENERATE(Row{120, 120, 1.000, 1.00, 1.00, 1.00}, Row{130, 130, 1.000, 0.88, 0.96, 0.94},
               Row{150, 150, 1.333, 0.62, 1.15, 1.05}, Row{160, 160, 1.556, 0.48, 1.27, 1.08});
  CAPTURE(row.first, row.second);
  const hands::HandModel hand = pad_hand(3);
  const std::vector<Contact> contacts = ball_contacts(hand, equator(row.first, row.second));
  const ContactQuality quality = centered_quality(hand, contacts);
  CHECK(quality.m2 == Approx(row.m2).margin(0.0006));
  CHECK(quality.regularity == Approx(row.r).margin(0.006));
  CHECK(quality.m / quality.m1 == Approx(row.ratio).margin(0.006));
  const ContactQuality by_angles =
      centered_quality(hand, contacts, {.regularity = Regularity::AngleOnly});
  CHECK(by_angles.m / by_angles.m1 == Approx(row.ratio_angles).margin(0.006));
}

TEST_CASE("Antipodal contacts reach M = M1", "[contact][contact_quality]") {
  // Two contacts have theta = 0 and R = 1, so that M2 = M3 = 1.
  const hands::HandModel hand = pad_hand(2);
  const ContactQuality quality =
      centered_quality(hand, ball_contacts(hand, {Vector3d::UnitX(), -Vector3d::UnitX()}));
  REQUIRE(quality.stable_pairs.size() == 1);
  CHECK(quality.stable_pairs[0].angle == 0.0);
  CHECK(quality.m2 == 1.0);
  CHECK(quality.regularity == 1.0);
  CHECK(quality.m == Approx(quality.m1).epsilon(kRounding));
  // They are in the middle of the pad and over 30 % of it: 1 + 2 * 0.3.
  CHECK(quality.m1 == Approx(1.6).epsilon(kRounding));
}

TEST_CASE("Contacts at the corners of regular solids have the pairs of the solid",
          "[contact][contact_quality]") {
  SECTION("tetrahedron: all six pairs, 109.47 degrees apart") {
    // Here cos s = -1/3 and theta = 90 - s/2 = 35.264 degrees, so that M2 = 6 (1 - theta/45) =
    // 1.298.
    const hands::HandModel hand = pad_hand(4);
    const ContactQuality quality = centered_quality(hand, ball_contacts(hand, tetrahedron()));
    CHECK(quality.stable_pairs.size() == 6);
    const double theta = kPi / 2 - std::acos(-1.0 / 3.0) / 2;
    CHECK(quality.m2 == Approx(6 * (1 - theta / (kPi / 4))).epsilon(kRounding));
    CHECK(quality.m2 == Approx(1.298).margin(0.0005));
    CHECK(quality.regularity == Approx(1.0).epsilon(kRounding));
  }
  SECTION("octahedron: the three antipodes; neighbors are at 45 degrees exactly and do not count") {
    const hands::HandModel hand = pad_hand(6);
    const ContactQuality quality = centered_quality(hand, ball_contacts(hand, octahedron()));
    CHECK(quality.stable_pairs.size() == 3);
    CHECK(quality.m2 == 3.0);
  }
  SECTION("triangular bipyramid: three pairs of 30 degrees on the equator and the poles") {
    const hands::HandModel hand = pad_hand(5);
    const ContactQuality quality = centered_quality(hand, ball_contacts(hand, bipyramid()));
    CHECK(quality.m2 == Approx(2.0).epsilon(kRounding));
    // Pole and equator are at 45 degrees up to the rounding of sines, so the check counts only
    // pairs that add something.
    CHECK(std::count_if(quality.stable_pairs.begin(), quality.stable_pairs.end(),
                        [](const StablePair& pair) { return pair.angle < kPi / 4 - 1e-9; }) == 4);
  }
}

TEST_CASE("A pair counts only strictly inside both cones", "[contact][contact_quality]") {
  const double theta_max = kPi / 4;
  const Vector3d a = Vector3d::Zero();
  const Vector3d b = 0.1 * Vector3d::UnitX();
  const auto inward = [](double angle, double sign) {
    return Vector3d(sign * std::cos(angle), std::sin(angle), 0.0);
  };
  const auto pair = [&](double angle_a, double angle_b) {
    return stable_pair_angle(a, inward(angle_a, 1), b, inward(angle_b, -1), theta_max);
  };
  SECTION("both angles zero") { CHECK(pair(0, 0) == std::optional(0.0)); }
  SECTION("the score is the mean of the two angles") {
    REQUIRE(pair(0.2, 0.6));
    CHECK(*pair(0.2, 0.6) == Approx(0.4).epsilon(kRounding));
  }
  SECTION("the mean cannot save an angle that is too large") { CHECK_FALSE(pair(0.0, 0.8)); }
  SECTION("1e-12 to either side of the limit, at either end") {
    CHECK(pair(theta_max - 1e-12, 0.0));
    CHECK(pair(0.0, theta_max - 1e-12));
    CHECK(pair(theta_max - 1e-12, theta_max - 1e-12));
    CHECK_FALSE(pair(theta_max + 1e-12, 0.0));
    CHECK_FALSE(pair(0.0, theta_max + 1e-12));
  }
  SECTION("at the limit itself, where the angle is a double: no") {
    CHECK_FALSE(stable_pair_angle(a, Vector3d(1, 1, 0), b, Vector3d(-1, 0, 0), theta_max));
    CHECK_FALSE(stable_pair_angle(a, Vector3d(1, 0, 0), b, Vector3d(-1, 0, 1), theta_max));
  }
  SECTION("a normal that looks away from the other contact") {
    CHECK_FALSE(stable_pair_angle(a, Vector3d(-1, 0, 0), b, Vector3d(-1, 0, 0), theta_max));
  }
  SECTION("coincident points have no line") {
    const Vector3d n = Vector3d::UnitX();
    CHECK_FALSE(stable_pair_angle(a, n, a, -n, theta_max));
    CHECK_FALSE(stable_pair_angle(a, n, 0.9e-9 * n, -n, theta_max));
    CHECK(stable_pair_angle(a, n, 1.1e-9 * n, -n, theta_max));
  }
}

TEST_CASE("M1 weighs boundary distance, area and strength in the units chosen",
          "[contact][contact_quality]") {
  // The pad is 2 x 4 cm: its area is 8 cm², its largest d 1 cm.
  const hands::HandModel hand = pad_hand(2, 0.02, 0.04);
  std::vector<Contact> contacts = ball_contacts(hand, {Vector3d::UnitX(), -Vector3d::UnitX()});
  contacts[0].pad_boundary_distance = 0.005;
  contacts[0].area = 2e-4;
  contacts[1].pad_boundary_distance = 0.010;
  contacts[1].area = 4e-4;
  SECTION("normalized: (0.5 + 2 * 0.25 + 1 + 2 * 0.5) / 2") {
    const ContactQuality quality = centered_quality(hand, contacts);
    CHECK(quality.m1 == Approx(1.5).epsilon(kRounding));
    REQUIRE(quality.terms.size() == 2);
    CHECK(quality.terms[0].boundary_distance == Approx(0.5).epsilon(kRounding));
    CHECK(quality.terms[0].area == Approx(0.25).epsilon(kRounding));
    CHECK(quality.terms[0].strength == 1.0);
  }
  SECTION("centimeters: (0.5 + 2 * 2 + 1 + 2 * 4) / 2") {
    const ContactQuality quality =
        centered_quality(hand, contacts, {.units = MeasureUnits::Centimeters});
    CHECK(quality.m1 == Approx(6.75).epsilon(kRounding));
  }
  SECTION("more surface than the pad has counts as a full pad") {
    contacts[1].area = 1.0;
    const ContactQuality quality = centered_quality(hand, contacts);
    CHECK(quality.terms[1].area == 1.0);
    CHECK(quality.m1 == Approx((0.5 + 0.5 + 1.0 + 2.0) / 2).epsilon(kRounding));
  }
  SECTION("a weak contact adds nothing but is still counted in n") {
    contacts[1].weak = true;
    const ContactQuality quality = centered_quality(hand, contacts);
    CHECK(quality.m1 == Approx((0.5 + 0.5) / 2).epsilon(kRounding));
    CHECK(quality.terms[1].strength == 0.0);
    CHECK(quality.is_usable());
  }
  SECTION("not weak and unknown are the same") {
    contacts[0].weak = false;
    CHECK(centered_quality(hand, contacts).m1 == Approx(1.5).epsilon(kRounding));
  }
}

TEST_CASE("M3 subtracts the distance of the hull's centroid from the center of mass",
          "[contact][contact_quality]") {
  const hands::HandModel hand = pad_hand(4);
  const QualityContext context{
      .center_of_mass_O = {0.0, 0.03, 0.0}, .normalizing_radius = 0.06, .hand = &hand};
  SECTION("two contacts: the midpoint; D = 0.03 m, half the radius") {
    const std::vector<Contact> contacts =
        ball_contacts(hand, {Vector3d::UnitX(), -Vector3d::UnitX()});
    const ContactQuality quality = contact_quality(contacts, context);
    CHECK(quality.centroid_distance == Approx(0.03).epsilon(kRounding));
    CHECK(quality.scaled_centroid_distance == Approx(0.5).epsilon(kRounding));
    CHECK(quality.m3 == Approx(1 - 0.3 * 0.5).epsilon(kRounding));
    CHECK(quality.m == Approx(quality.m1 * std::sqrt(0.85)).epsilon(kRounding));
    const ContactQuality in_cm =
        contact_quality(contacts, context, {.units = MeasureUnits::Centimeters});
    CHECK(in_cm.scaled_centroid_distance == Approx(3.0).epsilon(kRounding));
    CHECK(in_cm.m3 == Approx(1 - 0.3 * 3).epsilon(kRounding));
  }
  SECTION("the area centroid and the mean of corners differ for a trapezoid") {
    // The corners are (-2,0), (2,0), (1,1), (-1,1) cm. The area centroid is at height (b + 2a)/(3(a
    // + b)) with parallel sides b = 4 below and a = 2 above, 4/9 cm; the corners' mean is at 1/2
    // cm.
    std::vector<Contact> contacts = ball_contacts(hand, equator(90, 90));
    contacts.push_back(ball_contact(hand, 3, Vector3d::UnitZ()));
    contacts[0].point_O = {-0.02, 0, 0};
    contacts[1].point_O = {0.02, 0, 0};
    contacts[2].point_O = {0.01, 0.01, 0};
    contacts[3].point_O = {-0.01, 0.01, 0};
    QualityContext at_origin = context;
    at_origin.center_of_mass_O.setZero();
    CHECK(contact_quality(contacts, at_origin).centroid_distance ==
          Approx(0.04 / 9).epsilon(kRounding));
    CHECK(contact_quality(contacts, at_origin, {.centroid = HullCentroid::Vertices})
              .centroid_distance == Approx(0.005).epsilon(kRounding));
  }
}

TEST_CASE("The normalizing radius is half the diagonal of the box", "[contact][contact_quality]") {
  // The diagonal of edges of 3, 4 and 12 is √(9 + 16 + 144) = 13.
  CHECK(normalizing_radius({Vector3d(-1, 2, 0), Vector3d(2, 6, 12)}) == 6.5);
  const Vector3d point(1, 2, 3);
  CHECK(normalizing_radius({point, point}) == 0.0);
  CHECK(std::isinf(normalizing_radius(Eigen::AlignedBox3d())));
}

TEST_CASE("Pairs form between contacts of different fingers only, the palm being one",
          "[contact][contact_quality]") {
  hands::HandModel hand = pad_hand(2);
  const auto num_pairs = [&](int finger_a, int finger_b) {
    std::vector<Contact> contacts = {ball_contact(hand, finger_a, Vector3d::UnitX()),
                                     ball_contact(hand, finger_b, -Vector3d::UnitX())};
    return centered_quality(hand, contacts).stable_pairs.size();
  };
  CHECK(num_pairs(0, 1) == 1);
  CHECK(num_pairs(-1, 0) == 1);
  CHECK(num_pairs(0, 0) == 0);
  CHECK(num_pairs(-1, -1) == 0);
}

TEST_CASE("M is zero when any requirement of the measure fails", "[contact][contact_quality]") {
  const hands::HandModel hand = pad_hand(3);
  std::vector<Contact> contacts = ball_contacts(hand, equator(120, 120));
  QualityContext context{
      .center_of_mass_O = Vector3d::Zero(), .normalizing_radius = kRadius, .hand = &hand};
  // Exponents of zero turn a zero factor into 0^0 = 1; that must not make a grasp usable.
  const QualityOptions options =
      GENERATE(QualityOptions{}, QualityOptions{.w1 = 0.0, .w2 = 0.0, .w3 = 0.0});
  const auto m = [&] { return contact_quality(contacts, context, options).m; };
  SECTION("nothing wrong: usable") { CHECK(m() > 0.0); }
  SECTION("no contact") {
    contacts.clear();
    const ContactQuality quality = contact_quality(contacts, context, options);
    CHECK(quality.m == 0.0);
    CHECK(quality.m1 == 0.0);
    CHECK(quality.regularity == 0.0);
  }
  SECTION("one contact") {
    contacts.resize(1);
    const ContactQuality quality = contact_quality(contacts, context, options);
    CHECK(quality.m == 0.0);
    CHECK(quality.m1 > 0.0);
    CHECK(quality.regularity == 0.0);
  }
  SECTION("no stable pair: all on one side") {
    contacts = ball_contacts(hand, equator(30, 30));
    CHECK(m() == 0.0);
  }
  SECTION("every contact weak") {
    for (Contact& contact : contacts) contact.weak = true;
    CHECK(m() == 0.0);
  }
  SECTION("neither boundary distance nor area") {
    for (Contact& contact : contacts) contact.area = contact.pad_boundary_distance = 0.0;
    CHECK(m() == 0.0);
  }
  SECTION("M3 below zero: the center of mass far away") {
    context.center_of_mass_O = Vector3d(0, 0, 4 * kRadius);
    CHECK(contact_quality(contacts, context, options).m3 == Approx(1 - 0.3 * 4).epsilon(kRounding));
    CHECK(m() == 0.0);
  }
}

TEST_CASE("M does not change under rigid motion, order, or the scale of hand and object together",
          "[contact][contact_quality]") {
  const hands::HandModel hand = pad_hand(5);
  const std::vector<Contact> contacts = irregular_contacts(hand);
  const QualityContext context{
      .center_of_mass_O = {0.003, -0.002, 0.004}, .normalizing_radius = 0.08, .hand = &hand};
  const ContactQuality quality = contact_quality(contacts, context);
  REQUIRE(quality.is_usable());
  // Angles and hull ratios are of points turned by rounded matrices, and off by some hundred
  // roundings.
  constexpr double kMotionRounding = 1e-11;

  SECTION("rigid motion") {
    geometry::RigidTransform X_AO = geometry::RigidTransform::Identity();
    X_AO.rotate(Eigen::AngleAxisd(1.1, Vector3d(1, 2, -0.5).normalized()));
    X_AO.pretranslate(Vector3d(0.3, -0.2, 0.7));
    std::vector<Contact> moved = contacts;
    for (Contact& contact : moved) {
      contact.point_O = X_AO * contact.point_O;
      contact.inward_normal_O = X_AO.linear() * contact.inward_normal_O;
    }
    QualityContext moved_context = context;
    moved_context.center_of_mass_O = X_AO * context.center_of_mass_O;
    const ContactQuality moved_quality = contact_quality(moved, moved_context);
    CHECK(moved_quality.m == Approx(quality.m).epsilon(kMotionRounding));
    CHECK(moved_quality.regularity == Approx(quality.regularity).epsilon(kMotionRounding));
    CHECK(moved_quality.centroid_distance ==
          Approx(quality.centroid_distance).epsilon(kMotionRounding));
  }
  SECTION("order") {
    std::vector<std::size_t> order = {0, 1, 2, 3, 4};
    do {
      std::vector<Contact> permuted;
      for (const std::size_t i : order) permuted.push_back(contacts[i]);
      CHECK(contact_quality(permuted, context).m == Approx(quality.m).epsilon(kMotionRounding));
    } while (std::next_permutation(order.begin(), order.end()));
  }
  SECTION("scale") {
    const double scale = 3.7;
    const hands::HandModel large_hand = pad_hand(5, scale * 0.02, scale * 0.04);
    std::vector<Contact> large = contacts;
    for (Contact& contact : large) {
      contact.point_O *= scale;
      contact.area *= scale * scale;
      contact.pad_boundary_distance *= scale;
    }
    const QualityContext large_context{.center_of_mass_O = scale * context.center_of_mass_O,
                                       .normalizing_radius = scale * context.normalizing_radius,
                                       .hand = &large_hand};
    CHECK(contact_quality(large, large_context).m == Approx(quality.m).epsilon(kMotionRounding));
  }
}

TEST_CASE("The exponents and weights enter M as written", "[contact][contact_quality]") {
  const hands::HandModel hand = pad_hand(5);
  const std::vector<Contact> contacts = irregular_contacts(hand);
  const QualityContext context{
      .center_of_mass_O = {0.003, -0.002, 0.004}, .normalizing_radius = 0.08, .hand = &hand};
  const QualityOptions options{
      .alpha = 1.5, .beta = 0.2, .w1 = 2.0, .w2 = 0.7, .w3 = 1.3, .theta_max = 0.7};
  const ContactQuality quality = contact_quality(contacts, context, options);
  double m1 = 0.0;
  for (const SustainabilityTerm& term : quality.terms) {
    m1 += (term.boundary_distance + 1.5 * term.area) * term.strength / 5;
  }
  double m2 = 0.0;
  for (const StablePair& pair : quality.stable_pairs) {
    CHECK(pair.first < pair.second);
    m2 += 1 - pair.angle / 0.7;
  }
  REQUIRE(quality.is_usable());
  CHECK(quality.m1 == Approx(m1).epsilon(kRounding));
  CHECK(quality.m2 == Approx(m2).epsilon(kRounding));
  CHECK(quality.m3 ==
        Approx(quality.regularity - 0.2 * quality.scaled_centroid_distance).epsilon(kRounding));
  CHECK(
      quality.m ==
      Approx(std::pow(m1, 2.0) * std::pow(m2, 0.7) * std::pow(quality.m3, 1.3)).epsilon(kRounding));
}

TEST_CASE("The ideal measure takes its terms as given", "[contact][contact_quality]") {
  const hands::HandModel hand = pad_hand(3);
  std::vector<Contact> contacts = ball_contacts(hand, equator(120, 120));
  for (Contact& contact : contacts) {
    contact.pad.reset();
    contact.area = 0.0;
    contact.pad_boundary_distance = 0.0;
  }
  QualityContext context{
      .center_of_mass_O = Vector3d::Zero(), .normalizing_radius = kRadius, .hand = nullptr};
  SECTION("normalized, without a hand: M = M1 = 1 + 2 * 0.3 for the equilateral triangle") {
    const ContactQuality quality = ideal_quality(contacts, context, 1.0, 0.3);
    CHECK(quality.m1 == Approx(1.6).epsilon(kRounding));
    CHECK(quality.m == Approx(1.6).epsilon(kRounding));
  }
  SECTION("weak targets count as weak contacts do") {
    contacts[0].weak = true;
    CHECK(ideal_quality(contacts, context, 1.0, 0.3).m1 == Approx(1.6 * 2 / 3).epsilon(kRounding));
  }
  SECTION("centimeters, of the tip pads: 1 cm + 2 * 0.3 * 8 cm²") {
    const QualityOptions in_cm{.units = MeasureUnits::Centimeters};
    CHECK_THROWS_WITH(ideal_quality(contacts, context, 1.0, 0.3, in_cm), Contains("hand is null"));
    context.hand = &hand;
    CHECK(ideal_quality(contacts, context, 1.0, 0.3, in_cm).m1 == Approx(5.8).epsilon(kRounding));
  }
  SECTION("refusals") {
    CHECK_THROWS_WITH(ideal_quality(contacts, context, 1.5, 0.3),
                      Contains("boundary_distance_rel") && Contains("1.5"));
    CHECK_THROWS_WITH(ideal_quality(contacts, context, 1.0, -0.1),
                      Contains("area_rel") && Contains("-0.1"));
    contacts[2].finger = contacts[0].finger;
    CHECK_THROWS_WITH(ideal_quality(contacts, context, 1.0, 0.3), Contains("finger"));
  }
}

TEST_CASE("Quality options out of range are refused by field and value",
          "[contact][contact_quality]") {
  struct Case {
    std::string field, value;
    std::function<void(QualityOptions&)> set;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Case> cases = {
      {"alpha", "-1", [](QualityOptions& o) { o.alpha = -1; }},
      {"beta", "-0.5", [](QualityOptions& o) { o.beta = -0.5; }},
      {"w1", "-2", [](QualityOptions& o) { o.w1 = -2; }},
      {"w2", "inf", [](QualityOptions& o) { o.w2 = std::numeric_limits<double>::infinity(); }},
      {"w3", "nan", [nan](QualityOptions& o) { o.w3 = nan; }},
      {"theta_max", "0", [](QualityOptions& o) { o.theta_max = 0; }},
      {"theta_max", "1.6", [](QualityOptions& o) { o.theta_max = 1.6; }},
      // These are degrees by mistake.
      {"theta_max", "45", [](QualityOptions& o) { o.theta_max = 45; }},
      {"merge_distance", "-0.25", [](QualityOptions& o) { o.merge_distance = -0.25; }},
  };
  const hands::HandModel hand = pad_hand(2);
  const QualityContext context{
      .center_of_mass_O = Vector3d::Zero(), .normalizing_radius = kRadius, .hand = &hand};
  CHECK_NOTHROW(QualityOptions{}.validate());
  for (const Case& bad : cases) {
    QualityOptions options;
    bad.set(options);
    CHECK_THROWS_AS(options.validate(), base::InvalidInput);
    CHECK_THROWS_WITH(options.validate(),
                      Contains("QualityOptions") && Contains(bad.field + " = " + bad.value));
    CHECK_THROWS_AS(contact_quality({}, context, options), base::InvalidInput);
  }
}

TEST_CASE("Contacts and context that make no sense are refused", "[contact][contact_quality]") {
  const hands::HandModel hand = pad_hand(2);
  std::vector<Contact> contacts = ball_contacts(hand, {Vector3d::UnitX(), -Vector3d::UnitX()});
  QualityContext context{
      .center_of_mass_O = Vector3d::Zero(), .normalizing_radius = kRadius, .hand = &hand};
  const auto measure = [&] { return contact_quality(contacts, context); };
  CHECK_NOTHROW(measure());
  SECTION("radius") {
    context.normalizing_radius = 0.0;
    CHECK_THROWS_WITH(measure(), Contains("normalizing_radius = 0"));
  }
  SECTION("hand") {
    context.hand = nullptr;
    CHECK_THROWS_WITH(measure(), Contains("hand is null"));
  }
  SECTION("pad") {
    contacts[1].pad = 7;
    CHECK_THROWS_WITH(measure(), Contains("pad = 7"));
    contacts[1].pad.reset();
    CHECK_THROWS_WITH(measure(), Contains("pad = none"));
  }
  SECTION("normal") {
    contacts[1].inward_normal_O *= 2;
    CHECK_THROWS_WITH(measure(), Contains("contact 1") && Contains("inward_normal_O = 2"));
  }
  SECTION("point") {
    contacts[0].point_O.x() = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(measure(), Contains("contact 0") && Contains("point_O"));
  }
  SECTION("area") {
    contacts[0].area = -0.5;
    CHECK_THROWS_WITH(measure(), Contains("area = -0.5"));
  }
  SECTION("regularity's own arguments") {
    CHECK_THROWS_WITH(regularity(std::vector<Vector3d>{}, Regularity::Combined, -1.0),
                      Contains("merge_distance = -1"));
    CHECK_THROWS_AS(
        regularity(std::vector<Vector3d>{contacts[0].point_O, Vector3d::Constant(std::nan(""))},
                   Regularity::Combined),
        base::InvalidInput);
  }
}

}  // namespace test_contact_quality
