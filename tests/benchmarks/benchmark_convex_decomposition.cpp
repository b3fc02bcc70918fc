// What it measures: convex decompositions of shapes built in code, 0.15 m long, at 1 mm, with 64
// and with 256 pieces.
//
// How to read it: it prints wall time, pieces, deviations and volume error as the result states
// them. "ok" means that the result is within 1 mm; otherwise the pieces did not suffice. Run:
// build/unity/bin/graspfit_benchmarks "[convex_decomposition]".
#include <cstdio>

#include "graspfit/geometry/convex_decomposition.hpp"
#include "graspfit/geometry/named_shapes.hpp"
#include "support/catch.hpp"
#include "timing.hpp"

using namespace graspfit::geometry;

TEST_CASE("Convex decomposition of named shapes", "[!benchmark][convex_decomposition]") {
  constexpr double kExtent = 0.15;  // [m]
  constexpr double kMillimeters = 1e3;
  for (const ShapeDescription& shape : shape_descriptions()) {
    TriangleMesh mesh = named_shape(shape.name);
    mesh = scaled(mesh, kExtent / longest_extent(mesh));
    for (const int max_pieces : {64, 256}) {
      ConvexDecomposition result;
      const double seconds = graspfit::testing::seconds_of(
          [&] { result = convex_decomposition(mesh, {.max_pieces = max_pieces}); });
      std::printf(
          "  %-16s %6zu faces  %3zu pieces  out %6.3f mm  in %6.3f mm  volume %+8.4f  "
          "%6.2f s %s\n",
          shape.name.c_str(), mesh.faces.size(), result.pieces.size(),
          result.outward_deviation * kMillimeters, result.inward_deviation * kMillimeters,
          result.volume_error, seconds, result.is_within_deviation ? "ok" : "");
    }
  }
}
