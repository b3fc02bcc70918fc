#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace graspfit::base {

/// Union–find with path halving over the items 0 to `size` − 1, each of which begins as a set of
/// its own. The root of a set is its smallest member, whatever the order in which sets were united.
///
/// Precondition, not checked: `size` is below 2^31, and no item is outside the range.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::int32_t root(std::int32_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  /// Makes one set of the sets of `a` and `b`. Returns whether they were two.
  bool unite(std::int32_t a, std::int32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

  /// The set of every item; sets are numbered from 0 in the order of their smallest members.
  std::vector<std::int32_t> numbered() {
    std::vector<std::int32_t> number(parent_.size());
    std::int32_t next = 0;
    for (std::int32_t item = 0; item < std::ssize(number); ++item) {
      const std::int32_t first = root(item);  // Numbered by now, unless it is the item itself.
      number[item] = first == item ? next++ : number[first];
    }
    return number;
  }

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace graspfit::base
