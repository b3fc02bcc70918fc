// What it measures: convex hulls in 6-D beside Qhull on the same points, and what grasps need of
// them. Points are random, wrenches of random contacts on a sphere (all edges of a contact lie in
// one plane but for rounding: the hard case), and wrenches of contacts on a box (many exactly
// coplanar). Then epsilon as a whole, from contacts to the number, beside Qhull on the same
// wrenches, and the other measures of wrenches.
//
// How to read it: wall time per hull, the median over several sets, both sides in turn. "ratio" is
// ours over Qhull's, below 1 is faster. Ours keeps every facet that rounding makes, Qhull merges
// them and is therefore no exact answer; the numbers of facets say so.
// Run: build/unity/bin/graspfit_benchmarks "[polytope]".
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/contact/epsilon_linf.hpp"
#include "graspfit/contact/grasp_balance.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/contact/min_weight.hpp"
#include "graspfit/geometry/convex_polytope.hpp"
#include "support/catch.hpp"
#include "support/qhull.hpp"
#include "timing.hpp"

namespace {

using namespace graspfit;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using geometry::ConvexPolytope;
using testing::median;
using testing::seconds_of;

constexpr double kMilli = 1e3;
constexpr double kMicro = 1e6;
constexpr int kSets = 41;

Vector3d random_point(base::Random& random) {
  Vector3d point;
  for (double& x : point) x = random.uniform(-1.0, 1.0);
  return point;
}

std::vector<contact::Contact> contacts_on_ball(base::Random& random, int count) {
  std::vector<contact::Contact> contacts(static_cast<std::size_t>(count));
  for (contact::Contact& contact : contacts) {
    const Vector3d normal = random_point(random).normalized();
    contact.inward_normal_O = -normal;
    contact.point_O = normal + 0.2 * random_point(random);
  }
  return contacts;
}

std::vector<contact::Contact> contacts_on_box(base::Random& random, int count) {
  std::vector<contact::Contact> contacts(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const Vector3d normal = (i % 2 != 0 ? 1.0 : -1.0) * Vector3d::Unit(i % 3);
    contacts[i].inward_normal_O = -normal;
    for (double& x : contacts[i].point_O) x = static_cast<double>(random.index(5)) / 4.0 - 0.5;
    contacts[i].point_O[i % 3] = normal[i % 3];
  }
  return contacts;
}

contact::Wrenches wrenches_of(const std::vector<contact::Contact>& contacts) {
  return contact::contact_wrenches(contacts, {.options = {.friction = 0.5, .torque_scale = 1.0}});
}

void compare(const std::string& name, const std::function<MatrixXd()>& next_points) {
  std::vector<double> ours, theirs, our_facets, their_facets;
  for (int set = 0; set < kSets; ++set) {
    const MatrixXd points = next_points();
    ours.push_back(seconds_of([&] { our_facets.push_back(ConvexPolytope(points).num_facets()); }));
    theirs.push_back(seconds_of([&] {
      their_facets.push_back(static_cast<double>(testing::qhull(points).planes.cols()));
    }));
  }
  std::printf("  %-28s %8.3f ms  Qhull %8.3f ms  ratio %5.2f  facets %6.0f against %6.0f\n",
              name.c_str(), median(ours) * kMilli, median(theirs) * kMilli,
              median(ours) / median(theirs), median(our_facets), median(their_facets));
}

using NextContacts = std::function<std::vector<contact::Contact>()>;

/// Compares the way from contacts to epsilon: wrenches, hull, nearest facet. Qhull gets the
/// wrenches for free.
void compare_epsilon(const std::string& name, const NextContacts& next_contacts) {
  std::vector<double> ours, theirs;
  double largest_difference = 0.0;
  for (int set = 0; set < kSets; ++set) {
    const std::vector<contact::Contact> contacts = next_contacts();
    const contact::Wrenches wrenches = wrenches_of(contacts);
    double epsilon = 0.0;
    double other = 0.0;
    ours.push_back(seconds_of([&] {
      epsilon = contact::epsilon_quality(contact::grasp_wrench_space(
          contacts, Vector3d::Zero(), {.friction = 0.5, .torque_scale = 1.0}));
    }));
    theirs.push_back(seconds_of([&] {
      const testing::QhullResult hull = testing::qhull(wrenches);
      other = hull.is_full ? std::max(0.0, -hull.planes.row(6).maxCoeff()) : 0.0;
    }));
    largest_difference = std::max(largest_difference, std::abs(epsilon - other));
  }
  std::printf("  %-28s %8.3f ms  Qhull %8.3f ms  ratio %5.2f  largest difference %.0e\n",
              name.c_str(), median(ours) * kMilli, median(theirs) * kMilli,
              median(ours) / median(theirs), largest_difference);
}

void time_measures(const std::string& name, const NextContacts& next_contacts) {
  std::vector<double> linf, weight, points;
  for (int set = 0; set < kSets; ++set) {
    const std::vector<contact::Contact> contacts = next_contacts();
    const contact::Wrenches wrenches = wrenches_of(contacts);
    contact::LInfinityEpsilon epsilon;
    const double seconds = seconds_of([&] {
      epsilon =
          contact::epsilon_linf(contacts, {.options = {.friction = 0.5, .torque_scale = 1.0}});
    });
    weight.push_back(seconds_of([&] { contact::min_weight(wrenches); }));
    if (epsilon.upper == 0.0) continue;  // This is seen at once.
    linf.push_back(seconds);
    points.push_back(epsilon.num_points);
  }
  std::printf(
      "  %-28s epsilon L-infinity of %zu closed ones %8.3f ms, %.0f points; min-weight %.3f ms\n",
      name.c_str(), linf.size(), linf.empty() ? 0.0 : median(linf) * kMilli,
      points.empty() ? 0.0 : median(points), median(weight) * kMilli);
}

double microseconds(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < kSets; ++i) times.push_back(seconds_of(work));
  return median(times) * kMicro;
}

TEST_CASE("Convex hulls in six dimensions beside Qhull", "[!benchmark][polytope]") {
  base::Random random(5);
  std::printf("\nHulls in 6-D\n");
  for (const int count : {3, 5}) {
    const std::string size = std::to_string(count) + " x 8 ";
    compare(size + "random points", [&] {
      MatrixXd points(6, 8 * count);
      for (double& x : points.reshaped()) x = random.uniform(-1.0, 1.0);
      return points;
    });
    compare(size + "wrenches on a ball",
            [&] { return MatrixXd(wrenches_of(contacts_on_ball(random, count))); });
    compare(size + "wrenches on a box",
            [&] { return MatrixXd(wrenches_of(contacts_on_box(random, count))); });
  }

  std::printf("\nEpsilon as a whole, from contacts\n");
  for (const int count : {3, 5}) {
    const std::string size = std::to_string(count) + " x 8 ";
    const NextContacts on_ball = [&] { return contacts_on_ball(random, count); };
    compare_epsilon(size + "contacts on a ball", on_ball);
    compare_epsilon(size + "contacts on a box", [&] { return contacts_on_box(random, count); });
    time_measures(size + "contacts on a ball", on_ball);
  }

  std::printf("\nGrasps on a ball, 8 edges, microseconds\n");
  for (const int count : {2, 3, 4, 5}) {
    const std::vector<contact::Contact> contacts = contacts_on_ball(random, count);
    const contact::Wrenches wrenches = wrenches_of(contacts);
    const contact::GraspWrenchSpace space = contact::grasp_wrench_space(
        contacts, Vector3d::Zero(), {.friction = 0.5, .torque_scale = 1.0});
    bool is_no = false;
    const double early =
        microseconds([&] { is_no = contact::is_surely_no_force_closure(wrenches); });
    const double epsilon = microseconds([&] { contact::epsilon_quality(space); });
    const contact::Wrench load = -contact::Wrench::Unit(2);
    const double balance = microseconds([&] {
      contact::balance_forces(contacts, Vector3d::Zero(), load,
                              {.friction = 0.5, .least_normal_sum = 10.0, .torque_scale = 1.0});
    });
    std::printf("  %d contacts: early no %.1f (%s), epsilon of a space %.1f, balance %.1f\n", count,
                early, is_no ? "no" : "not sure", epsilon, balance);
  }
}

}  // namespace
