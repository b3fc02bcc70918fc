#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <utility>

namespace graspfit::base {

/// A size or position of the standard library as an index of the toolkit, which is signed:
/// `as_index<std::int32_t>(mesh.vertices.size())` is the index of the vertex that is added next.
///
/// It must fit, and whoever reads or builds a container sees to it that it does; without that the
/// index is wrong. Where a size is only compared with an index, `std::ssize` does.
template <std::signed_integral Index>
constexpr Index as_index(std::size_t position) {
  assert(std::in_range<Index>(position));
  return static_cast<Index>(position);
}

}  // namespace graspfit::base
