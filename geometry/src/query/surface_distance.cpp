#include "graspfit/geometry/surface_distance.hpp"

#include <algorithm>
#include <cmath>

#include "graspfit/base/option_check.hpp"
#include "query/one_sided_distance.hpp"

namespace graspfit::geometry {
void HausdorffOptions::validate() const {
  base::require(tolerance > 0.0 && std::isfinite(tolerance), "HausdorffOptions", "tolerance",
                tolerance, "finite and > 0 m");
  base::require(max_steps >= 0, "HausdorffOptions", "max_steps", max_steps, "at least 0");
}

HausdorffDistance hausdorff_distance(const MeshQuery& a, const MeshQuery& b,
                                     const HausdorffOptions& options) {
  options.validate();
  using internal::OneSidedDistance;
  const auto from_to = [&options](const MeshQuery& from, const MeshQuery& to) {
    return internal::one_sided_distance(
        internal::triangles_of(from.mesh().vertices, from.mesh().faces), to, options);
  };
  const OneSidedDistance a_to_b = from_to(a, b);
  const OneSidedDistance b_to_a = from_to(b, a);
  HausdorffDistance result;
  result.upper = std::max(a_to_b.upper, b_to_a.upper);
  if (a_to_b.lower >= b_to_a.lower) {
    result.lower = a_to_b.lower;
    result.point_on_a = a_to_b.point;
    result.point_on_b = a_to_b.nearest;
  } else {
    result.lower = b_to_a.lower;
    result.point_on_a = b_to_a.nearest;
    result.point_on_b = b_to_a.point;
  }
  return result;
}

}  // namespace graspfit::geometry
