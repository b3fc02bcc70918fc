#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "geometry/solid_checks.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/everyday_shapes.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/named_shapes.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_everyday_shapes {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Eigen::Vector3d;
using graspfit::testing::check_solid;
using graspfit::testing::volume_limit;
using std::numbers::pi;

namespace {

struct Case {
  std::string name;
  int segments;    // default
  int most_faces;  // at the default
  int genus;
  double min_angle_deg;  // that every face keeps at the default
  Vector3d low, high;
  std::function<TriangleMesh(int segments)> build;
};

std::vector<Case> cases() {
  return {{"bottle",
           96,
           30000,
           0,
           20,
           {-0.03725, -0.03725, 0},
           {0.03725, 0.03725, 0.3},
           [](int n) { return bottle({}, n); }},
          {"bowling_pin",
           96,
           30000,
           0,
           20,
           {-2.383 * 0.0254, -2.383 * 0.0254, 0},
           {2.383 * 0.0254, 2.383 * 0.0254, 0.381},
           [](int n) { return bowling_pin({}, n); }},
          // Its rims are arcs of 1.8 mm with edges of 0.7 mm along and 4 mm around.
          {"flower_pot",
           120,
           30000,
           0,
           6,
           {-0.075, -0.075, 0},
           {0.075, 0.075, 0.13},
           [](int n) { return flower_pot({}, n); }},
          {"mug",
           150,
           60000,
           1,
           25,
           {-0.041, -0.041, 0},
           {0.041 + 0.027 + 0.011, 0.041, 0.095},
           [](int n) { return mug({}, n); }},
          {"bowling_ball", 220, 60000, 0, 25, Vector3d::Constant(-0.10795),
           Vector3d::Constant(0.10795), [](int n) { return bowling_ball({}, n); }},
          {"octopus",
           100,
           60000,
           0,
           25,
           {-0.18, -0.18, 0},
           {0.18, 0.18, 0.16},
           [](int n) { return octopus({}, n); }},
          {"wire_cage", 10, 60000, 19, 25, {-0.08, -0.06, 0}, {0.08, 0.06, 0.12}, [](int n) {
             return wire_cage({}, n);
           }}};
}

double smallest_angle_deg(const TriangleMesh& mesh) {
  double least = pi;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto p = corners(mesh, f);
    for (int i = 0; i < 3; ++i) {
      const Vector3d u = p[(i + 1) % 3] - p[i];
      const Vector3d v = p[(i + 2) % 3] - p[i];
      least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  }
  return least * 180 / pi;
}

double frustum(double r, double s, double height) {
  return pi / 3 * height * (r * r + r * s + s * s);
}

}  // namespace

TEST_CASE("Everyday shapes are closed, outward, free of crossings and of their genus",
          "[geometry][everyday_shapes]") {
  for (const Case& shape : cases()) {
    INFO(shape.name);
    const TriangleMesh mesh = shape.build(shape.segments);
    check_solid(mesh, shape.genus);
    CHECK(mesh.faces.size() < static_cast<std::size_t>(shape.most_faces));
    CHECK(smallest_angle_deg(mesh) > shape.min_angle_deg);
    const Eigen::AlignedBox3d box = bounding_box(mesh);
    // These are a few ulps of lengths below 0.4 m, by which the numbers above may be off.
    constexpr double kUlps = 2e-16;
    CHECK((box.min() - shape.low).cwiseAbs().maxCoeff() <= kUlps);
    CHECK((box.max() - shape.high).cwiseAbs().maxCoeff() <= kUlps);
    CHECK(named_shape(shape.name) == mesh);  // It is built again with the same bytes.
  }
  check_solid(bin(), 0);
  CHECK(named_shape("bin") == bin());
  check_solid(table(), 0);
  CHECK(named_shape("table") == table());
}

TEST_CASE("At any number of segments a shape is sound or refused", "[geometry][everyday_shapes]") {
  for (const Case& shape : cases()) {
    int num_built = 0;
    for (const double share : {0.08, 0.1, 0.13, 0.2, 0.27, 0.4, 0.5, 0.6, 0.75, 1.25}) {
      const int step = shape.segments % 4 == 0 ? 4 : 1;
      const int segments = static_cast<int>(share * shape.segments) / step * step;
      INFO(shape.name << ' ' << segments);
      TriangleMesh mesh;
      try {
        mesh = shape.build(segments);
      } catch (const InvalidInput& error) {
        CHECK_THAT(error.what(), graspfit::testing::StartsWith(shape.name + ": ") &&
                                     graspfit::testing::Contains("segments"));
        continue;
      }
      ++num_built;
      check_solid(mesh, shape.genus);
    }
    CHECK(num_built >= 3);
  }
}

TEST_CASE("Fine shapes are as sound as coarse ones", "[geometry][everyday_shapes][full]") {
  for (const Case& shape : cases()) {
    INFO(shape.name);
    check_solid(shape.build(3 * shape.segments / 4 * 4), shape.genus);
  }
}

TEST_CASE("A shape twice as large is the same shape, bit for bit", "[geometry][everyday_shapes]") {
  // Powers of two change no rounding, so that nothing may depend on an absolute length.
  for (const ShapeDescription& description : shape_descriptions()) {
    INFO(description.name);
    std::vector<ShapeDimension> doubled = description.dimensions;
    for (ShapeDimension& d : doubled) {
      const bool is_count =
          d.name.ends_with("segments") || d.name == "subdivisions" || d.name == "bars_per_side";
      if (!is_count) d.value *= 2;
    }
    CHECK(named_shape(description.name, doubled) == scaled(named_shape(description.name), 2));
  }
}

TEST_CASE("Volumes of turned shapes are those of their cones", "[geometry][everyday_shapes]") {
  // With roundings of 1 um the solid is cylinders and cones. A rounding changes the area of the
  // profile by less than its square, and so the volume by less than 1e-11 of 1e-3 m³ here.
  BottleDimensions b;
  b.shoulder_radius = b.base_radius = b.lip_radius = 1e-6;
  CHECK(volume_limit([&](int n) { return bottle(b, n); }, 768) ==
        Approx(frustum(0.03725, 0.03725, 0.185) + frustum(0.03725, 0.0145, 0.035) +
               frustum(0.0145, 0.0145, 0.08))
            .epsilon(1e-7));
  FlowerPotDimensions p;
  p.edge_radius = 1e-6;
  // The outside of the wall widens from 50 mm at z = 0 to 71 mm at z = 130 mm.
  const auto outer = [](double z) { return 0.050 + 0.021 / 0.130 * z; };
  CHECK(volume_limit([&](int n) { return flower_pot(p, n); }, 768) ==
        Approx(frustum(outer(0), outer(0.1), 0.1) + frustum(0.075, 0.075, 0.03) -
               frustum(outer(0.006) - 0.006, 0.065, 0.124))
            .epsilon(1e-7));
}

TEST_CASE("A bin is its floor and its four sides", "[geometry][everyday_shapes]") {
  const auto agree = [](double length, double width, double height, double wall,
                        const TriangleMesh& mesh) {
    const double outer_length = length + 2 * wall;
    const double outer_width = width + 2 * wall;
    CHECK(signed_volume(mesh) ==
          Approx(outer_length * outer_width * (height + wall) - length * width * height)
              .epsilon(1e-13));
    // From above and from below the same area is seen, from the sides the outside and the inside.
    CHECK(surface_area(mesh) ==
          Approx(2 * outer_length * outer_width +
                 2 * (outer_length + outer_width) * (height + wall) + 2 * (length + width) * height)
              .epsilon(1e-13));
    const MeshQuery query(mesh);
    const auto is_solid = [&](double x, double y, double z) {
      return query.containment({x, y, z}) == Containment::Inside;
    };
    const double half = 0.5 * wall;
    CHECK(is_solid(0, 0, -half));
    for (const double side : {-1.0, 1.0}) {
      CHECK(is_solid(side * (0.5 * length + half), 0, 0.5 * height));
      CHECK(is_solid(0, side * (0.5 * width + half), 0.5 * height));
      CHECK_FALSE(is_solid(side * (0.5 * length - half), 0, 0.5 * height));
      CHECK_FALSE(is_solid(0, side * (0.5 * width - half), 0.5 * height));
    }
    CHECK_FALSE(is_solid(0, 0, half));
    CHECK_FALSE(is_solid(0, 0, height));
  };
  agree(0.346, 0.265, 0.12, 0.003, bin());
  agree(0.2, 0.3, 0.5, 0.04, bin({0.2, 0.3, 0.5, 0.04}));
  CHECK(bin().faces.size() == 92);
  // All sides of this one are sums of few powers of two, and so exact.
  const TriangleMesh mesh = bin({0.5, 0.25, 0.125, 0.0625});
  for (const double x : {-0.3125, -0.25, 0.25, 0.3125}) {
    for (const double y : {-0.1875, -0.125, 0.125, 0.1875}) {
      for (const double z : {-0.0625, 0.0, 0.125}) {
        CAPTURE(x, y, z);
        CHECK(std::count(mesh.vertices.begin(), mesh.vertices.end(), Vector3d(x, y, z)) == 1);
      }
    }
  }
}

TEST_CASE("A table is its top and its legs", "[geometry][everyday_shapes]") {
  const TriangleMesh mesh = table();
  CHECK(mesh.faces.size() == 172);
  CHECK(bounding_box(mesh).min() == Vector3d(-0.6, -0.35, 0));
  CHECK(bounding_box(mesh).max() == Vector3d(0.6, 0.35, 0.74));
  CHECK(signed_volume(mesh) == Approx(1.2 * 0.7 * 0.03 + 4 * 0.06 * 0.06 * 0.71).epsilon(1e-14));
  CHECK(surface_area(mesh) ==
        Approx(2 * (1.2 * 0.7 + 1.9 * 0.03) + 4 * 4 * 0.06 * 0.71).epsilon(1e-14));
}

TEST_CASE("Everyday shapes refuse what does not fit and name it", "[geometry][everyday_shapes]") {
  // Every length of every shape is tried as not a number, zero, negative and infinite.
  for (const ShapeDescription& shape : shape_descriptions()) {
    for (const ShapeDimension& dimension : shape.dimensions) {
      const std::string field =
          shape.name == "box" ? std::string("size") : dimension.name;  // one vector for x, y, z
      for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        // A ball without subdivisions is an icosahedron.
        if (dimension.name == "subdivisions" && bad == 0.0) continue;
        INFO(shape.name << ' ' << dimension.name << ' ' << bad);
        CHECK_THROWS_WITH(
            named_shape(shape.name, {{dimension.name, bad}}),
            graspfit::testing::StartsWith(shape.name + ": ") && graspfit::testing::Contains(field));
      }
    }
  }
  const auto refuse = [](const std::string& shape, const std::vector<ShapeDimension>& dimensions,
                         const std::string& says) {
    INFO(shape << ' ' << dimensions.front().name);
    CHECK_THROWS_WITH(named_shape(shape, dimensions),
                      graspfit::testing::StartsWith(shape + ": " + says));
  };
  refuse("bottle", {{"neck_diameter", 0.1}}, "neck_diameter is 0.1, must be below body_diameter");
  refuse("bottle", {{"shoulder_bottom", 0.25}}, "shoulder_bottom is 0.25, must be below");
  refuse("bottle", {{"shoulder_top", 0.3}}, "shoulder_top is 0.3, must be below height, 0.3");
  refuse("bottle", {{"shoulder_radius", 0.3}}, "shoulder_radius is 0.3, too large for the lengths");
  refuse("bottle", {{"base_radius", 0.04}}, "base_radius is 0.04, too large");
  refuse("bottle", {{"lip_radius", 0.02}}, "lip_radius is 0.02, too large");
  refuse("bottle", {{"segments", 8}}, "segments is 8, must be in [12, 2048]");
  refuse("bottle", {{"height", 100}}, "a side of ");
  refuse("bottle", {{"segments", 90}}, "segments is 90, must be a multiple of 4");
  refuse("flower_pot", {{"base_diameter", 0.2}}, "base_diameter is 0.2, must be below");
  refuse("flower_pot", {{"rim_thickness", 0.005}}, "wall_thickness is 0.006, must be below rim");
  refuse("flower_pot", {{"rim_thickness", 0.04}}, "rim_thickness is 0.04, must be below");
  refuse("flower_pot", {{"rim_height", 0.13}}, "rim_height is 0.13, must be below");
  refuse("flower_pot", {{"edge_radius", 0.006}}, "edge_radius is 0.006, too large");
  refuse("mug", {{"wall_thickness", 0.05}}, "wall_thickness is 0.05, must be below half");
  refuse("mug", {{"base_radius", 0.004}}, "wall_thickness is 0.005, must be at most base_radius");
  refuse("mug", {{"handle_height", 0.09}}, "handle_height is 0.09, must be at most");
  refuse("mug", {{"handle_thickness", 0.03}}, "handle_thickness is 0.03, must be below half");
  refuse("mug", {{"handle_radius", 0.03}}, "handle_radius is 0.03, must be at most");
  refuse("mug", {{"handle_radius", 0.005}}, "handle_thickness is 0.011, must be below twice");
  refuse("mug", {{"fillet", 0.0151}, {"handle_height", 0.04}}, "fillet is 0.0151, must be below");
  refuse("mug", {{"segments", 20}}, "edges of ");
  refuse("mug", {{"segments", 16000}}, "edges of ");
  refuse("bowling_ball", {{"span", 0.2}}, "span is 0.2, must be below");
  refuse("bowling_ball", {{"span", 0.03}}, "finger_diameter is 0.025, must be below");
  refuse("bowling_ball", {{"finger_spacing", 0.03}}, "finger_diameter is 0.025, must be below");
  refuse("bowling_ball", {{"finger_depth", 0.1}}, "finger_depth is 0.1, must be below");
  refuse("bowling_ball", {{"thumb_depth", 0.02}}, "thumb_diameter is 0.028, must be below");
  refuse("bowling_ball", {{"thumb_depth", 0.09}, {"finger_depth", 0.09}}, "thumb_diameter is ");
  refuse("octopus", {{"mantle_height", 0.08}}, "mantle_diameter is 0.09, must be below");
  refuse("octopus", {{"arm_tip_diameter", 0.03}}, "arm_tip_diameter is 0.03, must be below");
  refuse("octopus", {{"height", 0.3}}, "height is 0.3, which leaves the arms' beginnings");
  refuse("wire_cage", {{"corner_radius", 0.06}}, "corner_radius is 0.06, must be below");
  refuse("wire_cage", {{"bar_diameter", 0.008}}, "bar_diameter is 0.008, must be at most");
  refuse("wire_cage", {{"bars_per_side", 51}}, "bars_per_side is 51, must be in [1, 50]");
  refuse("wire_cage", {{"bars_per_side", 20}}, "bar_diameter is 0.0055, must be below");
  refuse("table", {{"top_thickness", 0.8}}, "top_thickness is 0.8, must be below height, 0.74");
  refuse("table", {{"leg_width", 0.31}}, "leg_width is 0.31, must be below");
  refuse("mug", {{"hight", 1.0}}, "has no dimension \"hight\"; there are height, diameter, ");
  refuse("mug", {{"height", 0.1}, {"height", 0.1}}, "height is given twice");
  refuse("mug", {{"segments", 99.5}}, "segments is 99.5, must be an integer");
  CHECK_THROWS_WITH(named_shape("cup"),
                    graspfit::testing::StartsWith("there is no shape \"cup\"; there are "));
}

}  // namespace test_everyday_shapes
