// What it measures: tests of a link against the object, for the Barrett hand on the bunny (75 408
// faces, 0.15 m, 30 voxels), at the poses that lead to grasps, and the workspace of every shipped
// hand.
//
// How to read it: it prints the time of one exact test by how far the hand was closed, which is
// what a bound that comes first could spare. Run: build/unity/bin/graspfit_benchmarks "[hands]".
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/hand_workspace.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"
#include "timing.hpp"

namespace {

using namespace graspfit;
using testing::seconds_of;

TEST_CASE("Exact collision tests on the way to a grasp", "[!benchmark][hands]") {
  const auto file = testing::packaged_mesh("bunny00.off");
  if (!file)
    GRASPFIT_SKIP_TEST("bunny00.off of libcgal-demo is not unpacked; run ./quickstart once");
  geometry::TriangleMesh mesh = geometry::read_mesh(*file).mesh;
  mesh = geometry::repair_mesh(geometry::scaled(mesh, 0.15 / geometry::longest_extent(mesh))).mesh;
  const hands::HandModel hand = hands::find_hand("barrett");
  grasp::PlannerOptions options;
  options.max_attempts = 60;
  options.count = 60;
  options.acceptance = grasp::Acceptance::Usable;
  options.search = grasp::SearchRule::First;
  const grasp::ObjectModel object = grasp::prepare_object(mesh, hand, options);
  const std::vector<grasp::Grasp> grasps = grasp::plan_grasps(object, hand, options).grasps;
  REQUIRE_FALSE(grasps.empty());

  const hands::HandCollision collision(hand);
  struct Row {
    double exact_s = 0.0;
    int poses = 0, clear = 0;
  };
  // These are shares of the way from the open hand to the grasp.
  constexpr std::array<double, 6> kShares = {0.0, 0.5, 0.8, 0.95, 0.99, 1.0};
  std::printf("\n%-8s %7s %7s %11s\n", "closed", "poses", "clear", "exact");
  for (const double share : kShares) {
    Row row;
    for (const grasp::Grasp& grasp : grasps) {
      hands::HandConfiguration c = hands::open_configuration(hand);
      c.q += share * (grasp.configuration.q - c.q);
      c.X_OH = grasp.configuration.X_OH;
      const auto X_OL = hands::forward_kinematics(hand, c);
      for (std::size_t i = 0; i < hand.links.size(); ++i) {
        const int link = static_cast<int>(i);
        bool intersects = false;
        row.exact_s += seconds_of(
            [&] { intersects = collision.link_intersects(object.query, link, X_OL[i]); });
        ++row.poses;
        row.clear += intersects ? 0 : 1;
      }
    }
    std::printf("%5.0f %% %8d %7d %8.2f us\n", 100 * share, row.poses, row.clear,
                1e6 * row.exact_s / row.poses);
  }
}

TEST_CASE("Workspaces of the shipped hands", "[!benchmark][hands]") {
  std::printf("\n%-20s %10s %10s\n", "hand", "tips", "whole");
  for (const std::string& name : hands::shipped_hands()) {
    const hands::HandModel hand = hands::find_hand(name);
    hands::HandWorkspace workspace;
    const double tips_s = seconds_of([&] { workspace.tip_to_tip = hands::tip_distances(hand); });
    const double whole_s = seconds_of([&] { workspace = hands::hand_workspace(hand); });
    std::printf("%-20s %7.0f ms %7.0f ms   graspable %.1f to %.1f mm\n", name.c_str(), 1e3 * tips_s,
                1e3 * whole_s, 1e3 * workspace.any_graspable_diameter.smallest,
                1e3 * workspace.any_graspable_diameter.largest);
  }
}

}  // namespace
