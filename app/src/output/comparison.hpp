#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/wilson_interval.hpp"

namespace graspfit::app {

/// What a comparison looks at of one grasp. What was not looked for is empty.
struct ComparedGrasp {
  bool touches = false;       ///< Every requested part has contact within the accepted gap.
  bool is_clear = false;      ///< Enters nothing: object, hand itself, surroundings. Exact.
  std::optional<bool> valid;  ///< Both, M > 0, and a free way in.
  bool is_closed = false;     ///< Force closure at the friction of epsilon.
  std::optional<bool> held;   ///< In the physics test.
  std::vector<double> gaps;   ///< Of the contacts that were asked for [m].
  double depth = 0.0;         ///< Largest penetration [m].
  double m = 0.0;
  double epsilon = 0.0;                 ///< 0 where the grasp is not closed.
  std::optional<double> margin_force;   ///< Smallest force that fails [N].
  std::optional<double> margin_torque;  ///< Smallest torque that fails [N m].
};

/// The grasps of one side on one object, or on all.
struct ComparedSet {
  std::vector<ComparedGrasp> grasps;
  int num_clusters = 0;                   ///< Of `grasp::grasp_diversity`, added over objects.
  std::vector<double> first_axis_shares;  ///< The same; one for each object that has it.
  double seconds = 0.0;                   ///< Planning time of those grasps that have one [s].
  std::size_t num_timed = 0;              ///< How many have one.

  void add(const ComparedSet& other);
};

enum class ComparedSide { A, B };

/// An object that both sides have grasps of.
struct ComparedObject {
  std::string name;
  std::string sha256;  ///< Of its file.
  std::array<ComparedSet, 2> sides;
};

struct SetComparison {
  std::array<std::string, 2> names;     ///< What the sides are called: their paths, as UTF-8.
  std::string protocol;                 ///< Of the physics test; empty: it was left out.
  std::vector<ComparedObject> objects;  ///< At least one.

  /// The grasps of a side on all objects.
  ComparedSet all(ComparedSide side) const;
};

/// How many grasps have a property, among those of which it is known.
struct ComparedRate {
  std::int64_t num_hits = 0;
  std::int64_t num_known = 0;

  double share() const { return static_cast<double>(num_hits) / static_cast<double>(num_known); }
  base::ShareInterval interval() const { return base::wilson_interval(num_hits, num_known); }
};

/// The properties whose rates are compared: "touching", "clear", "valid", "closed", "held".
inline constexpr std::array<std::string_view, 5> kComparedRates = {"touching", "clear", "valid",
                                                                   "closed", "held"};

/// The rate of the property at an index of `kComparedRates`; empty if it is known of no grasp.
std::optional<ComparedRate> rate_of(const ComparedSet& set, std::size_t property);

/// The comparison as text: a table of both sides on all objects, and a line for each object where
/// there are several. Rates have their 95 % intervals behind them.
std::string comparison_text(const SetComparison& comparison);

/// The comparison as CSV: two rows for each object, A and B, and two for all objects together.
std::string comparison_csv(const SetComparison& comparison);

}  // namespace graspfit::app
