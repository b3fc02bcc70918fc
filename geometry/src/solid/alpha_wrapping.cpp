#include "solid/alpha_wrapping.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/exceptions.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "exact/predicates.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "solid/crossing_faces.hpp"
#include "solid/mesh_edges.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Stops a wrap that does not terminate: CGAL's refinement cycles where rounding puts a new point
/// on an old one, as on a needle 3e8 times as long as thick.
class WrapLimit : public CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
 public:
  struct Exceeded {};

  explicit WrapLimit(std::int64_t most_facets) : facets_left_(most_facets) {}

  template <class Wrapper, class Gate>
  void before_facet_treatment(const Wrapper&, const Gate&) {
    if (--facets_left_ < 0) throw Exceeded();
  }

 private:
  std::int64_t facets_left_;
};

bool has_area(const TriangleMesh& mesh) {
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    if (!is_degenerate(mesh, face)) return true;
  }
  return false;
}

}  // namespace

TriangleMesh alpha_wrap(const TriangleMesh& given, double alpha_rel, double offset_rel,
                        double extent) {
  if (!std::isfinite(extent)) return {};
  // CGAL's exact numbers end the program where products of coordinates leave the range of doubles.
  // So a mesh is wrapped at an extent of 1/2 to 1, which rounds nothing, and what is nearer to zero
  // than kLeast there becomes zero.
  constexpr double kLeast = 1e-45;
  int exponent = 0;
  std::frexp(extent, &exponent);
  TriangleMesh mesh = given;
  for (Vector3d& vertex : mesh.vertices) {
    for (double& x : vertex) {
      x = std::ldexp(x, -exponent);
      if (std::abs(x) < kLeast) x = 0.0;
    }
  }
  // CGAL leaves degenerate faces out, and requires that others remain.
  if (!has_area(mesh)) return {};
  const double alpha = std::ldexp(alpha_rel * extent, -exponent);
  const double offset = std::ldexp(offset_rel * extent, -exponent);
  std::vector<Kernel::Point_3> points;
  for (const Vector3d& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  CGAL::Surface_mesh<Kernel::Point_3> wrap;
  // A surface has on the order of (extent / alpha)^2 facets of size alpha. Wraps of scans, cars
  // and open tubes take 20 to 80 times as many steps.
  constexpr double kMostStepsRel = 2000.0;
  const double size = 1.0 / alpha_rel;
  WrapLimit limit(static_cast<std::int64_t>(kMostStepsRel * (size * size + 10.0)));
  // CGAL 5 looks for the visitor among the parameters of the output, CGAL 6 among those of the
  // input; where it does not look, it says nothing.
  const auto visited = CGAL::parameters::visitor(std::ref(limit));
  try {
    CGAL::alpha_wrap_3(points, mesh.faces, alpha, offset, wrap, visited, visited);
  } catch (const WrapLimit::Exceeded&) {
    return {};
  } catch (const CGAL::Failure_exception&) {
    // In builds with assertions CGAL reports where rounding defeated it before it starts to cycle.
    return {};
  }
  TriangleMesh result;
  for (const auto vertex : wrap.vertices()) {
    const Kernel::Point_3& p = wrap.point(vertex);
    result.vertices.emplace_back(std::ldexp(p.x(), exponent), std::ldexp(p.y(), exponent),
                                 std::ldexp(p.z(), exponent));
  }
  for (const auto face : wrap.faces()) {
    Face& corners = result.faces.emplace_back();
    int k = 0;
    for (const auto vertex : wrap.vertices_around_face(wrap.halfedge(face))) {
      corners[k++] = static_cast<std::int32_t>(vertex.idx());
    }
  }
  return result;
}

bool encloses(const TriangleMesh& wrap, const TriangleMesh& mesh) {
  std::vector<std::int32_t> side(wrap.faces.size(), 0);
  side.resize(wrap.faces.size() + mesh.faces.size(), 1);
  if (!crossing_faces(concatenated({wrap, mesh}), side).empty()) return false;
  const MeshQuery query(wrap);
  return std::all_of(mesh.faces.begin(), mesh.faces.end(), [&](const Face& face) {
    return std::all_of(face.begin(), face.end(), [&](std::int32_t vertex) {
      return query.containment(mesh.vertices[vertex]) == Containment::Inside;
    });
  });
}

}  // namespace graspfit::geometry::internal
