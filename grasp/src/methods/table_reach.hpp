#pragma once

#include <vector>

#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "targets/target_places.hpp"

/// \file
/// What a hand can do above a table, found out early and roughly; nothing is decided here that is
/// not looked at exactly later.

namespace graspfit::grasp::internal {

/// Which proposals put parts of the hand below a table.
class TableReach {
 public:
  /// Refers to hand and surroundings.
  TableReach(const hands::HandModel& hand, const SurroundingsCollision& surroundings);

  bool has_table() const { return surroundings_.surroundings().table_z_O.has_value(); }

  /// Whether no link whose place is settled is far below the table: the palm's, and those whose
  /// joints from the palm on are all `is_fixed`. True without a table. Followers of couplings
  /// follow.
  bool is_above(hands::HandConfiguration configuration, const std::vector<bool>& is_fixed) const;

 private:
  const hands::HandModel& hand_;
  const SurroundingsCollision& surroundings_;
  std::vector<std::vector<int>> joints_;  ///< Per link, those from the palm to it.
};

/// Those points that some pad of the hand can touch while its link stays above the table, for some
/// turn about the point's normal and pads that lean by up to 30 degrees; all without a table.
std::vector<PoolPoint> touchable_above_table(std::vector<PoolPoint> pool,
                                             const hands::HandModel& hand,
                                             const SurroundingsCollision& surroundings);

}  // namespace graspfit::grasp::internal
