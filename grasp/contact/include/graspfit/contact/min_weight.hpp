#pragma once

#include <optional>

#include "graspfit/contact/wrench.hpp"

namespace graspfit::contact {

/// How evenly wrenches can cancel [Li, Culbertson, Burdick & Ames 2023, FRoGGeR].
struct MinWeight {
  /// l*: the largest l such that Σ α_i w_i = 0 with Σ α_i = 1 and all α_i ≥ l. It is at most 1 over
  /// the number of wrenches, negative where the wrenches cancel only if some of them pull, and
  /// empty where no weights cancel them.
  std::optional<double> weight;
  double normalized = 0.0;  ///< l* times the number of wrenches, at most 1; 0 if empty.
  int rank = 0;  ///< Rank of the wrenches: number of singular values above 1e-9 of the largest.
  double smallest_singular = 0;  ///< σ_min, the sixth singular value of the wrenches; 0 for fewer.

  /// l* > 0 means force closure at rank 6 only: two hard-finger contacts opposite each other have a
  /// large l* and no closure.
  bool is_force_closure() const { return rank == 6 && weight && *weight > 0.0; }
};

/// The min-weight of any wrenches, by linear programming. ε (L1) is at least ½ l* σ_min.
///
/// The wrenches are rounded to multiples of a power of two, 2^-52 of the largest component times
/// their number; for these the sign of l* is exact and its value good to a few units in the last
/// place (`geometry::maximize_linear`). The rank is decided in doubles, because wrenches that are
/// dependent but for rounding have one more dimension in exact arithmetic, and an l* that means
/// nothing. @throws InvalidInput for numbers that are not finite.
MinWeight min_weight(const Wrenches& wrenches);

}  // namespace graspfit::contact
