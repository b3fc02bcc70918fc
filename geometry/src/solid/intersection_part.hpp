#pragma once

#include <boost/variant/get.hpp>
#include <variant>

namespace graspfit::geometry::internal {

/// What CGAL::intersection has found, if it is a `Part` (a point, a segment, ...), otherwise null.
/// CGAL before 6 returns Boost's optional variant, from then on the standard library's.
template <typename Part, typename Common>
const Part* intersection_part(const Common& common) {
  if (!common) return nullptr;
  if constexpr (requires { std::get_if<Part>(&*common); }) {
    return std::get_if<Part>(&*common);
  } else {
    return boost::get<Part>(&*common);
  }
}

}  // namespace graspfit::geometry::internal
