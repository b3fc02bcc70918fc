#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "graspfit/hands/pad_samples.hpp"
#include "targets/target_places.hpp"

/// \file
/// What a hand can do above a table, found out early and roughly; nothing is decided here that is
/// not looked at exactly later.

namespace graspfit::grasp::internal {

/// Whether palm and fingers of proposals are above the table, to about 5 mm: by a few corners of
/// each link. All are without a table.
class TableReach {
 public:
  /// Refers to hand and surroundings. The samples are of the hand's pads.
  TableReach(const hands::HandModel& hand, const SurroundingsCollision& surroundings,
             const std::vector<const hands::PadSamples*>& samples);

  bool has_table() const { return surroundings_.surroundings().table_z_O.has_value(); }

  /// Whether no link that is fixed to the palm is far below the table.
  bool is_palm_above(const geometry::RigidTransform& X_OH) const;

  /// Whether no link between the palm and the pad is far below the table where the sample has it.
  /// @param samples index into those of the constructor
  bool is_above(std::size_t samples, std::int32_t sample,
                const geometry::RigidTransform& X_OH) const;

 private:
  /// Corners of the links from the palm to a pad, as many per sample.
  struct Corners {
    Eigen::Index per_sample = 0;
    Eigen::Matrix3Xd points_H;  ///< [m], of sample after sample.
  };
  template <class Columns>
  bool are_above(const Columns& points_H, const geometry::RigidTransform& X_OH) const;

  const SurroundingsCollision& surroundings_;
  Eigen::Matrix3Xd palm_H_;  ///< Corners of links that are fixed to the palm [m].
  std::vector<Corners> corners_;
};

/// Those points that some pad of the hand can touch while its link stays above the table, for some
/// turn about the point's normal and pads that lean by up to 30 degrees; all without a table.
std::vector<PoolPoint> touchable_above_table(std::vector<PoolPoint> pool,
                                             const hands::HandModel& hand,
                                             const SurroundingsCollision& surroundings);

/// Those points by which the object can be carried well: by its weight and by pushes it turns in
/// the hand the more the farther they are from its center of mass, so that those stay that are no
/// more than 0.12 m farther, along the table, than the nearest one [R]. All without a table.
std::vector<PoolPoint> carrying_above_table(std::vector<PoolPoint> pool,
                                            const Eigen::Vector3d& center_of_mass_O,
                                            const SurroundingsCollision& surroundings);

}  // namespace graspfit::grasp::internal
