#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "methods/hand_grips.hpp"
#include "methods/table_reach.hpp"
#include "object/nearest_places.hpp"
#include "targets/target_places.hpp"

namespace graspfit::grasp::internal {

/// A hand at the object, not yet laid onto it.
struct HandProposal {
  hands::HandConfiguration configuration;
  std::vector<bool> is_fixed;  ///< Per joint: a sample set its position.
  /// Per part of the hand; empty: it is not placed.
  std::vector<std::optional<std::int32_t>> places;
  /// Per part, which of its samples; meaningless where it is not placed.
  std::vector<std::int32_t> samples;
  double largest_cost = 0.0;  ///< Of placing a part where it is [m].
};

/// Hands whose pads are about on points of the pool: two of them, or the palm, by drawing points,
/// the others by looking where they can be then.
class HandProposals {
 public:
  /// Where a pad is and where it faces: of a sample in H, or as a point of the pool in O.
  struct Facing {
    Eigen::Vector3d point;
    Eigen::Vector3d normal;
  };

  /// Refers to all of them but `places`, the object's. `nearest` are the pool's.
  HandProposals(const hands::HandModel& hand, const std::vector<SurfacePlace>& places,
                const TargetPlaces& targets, const HandGrips& grips, const NearestPlaces& nearest,
                const TableReach& table);

  /// With the palm of the grip on a point, or two of its fingers on two points; empty where the
  /// hand's tables do not know that they can be there. Most draws are.
  std::optional<HandProposal> draw(const HandGrips::Grip& grip, base::Random& random) const;

  /// The proposal with the other parts of the grip placed, too. Empty if that costs no less than
  /// `most`, as soon as that is seen.
  std::optional<HandProposal> completed(const HandGrips::Grip& grip, double most,
                                        HandProposal proposal) const;

 private:
  std::optional<HandProposal> pinch(const HandGrips::Grip& grip, base::Random& random) const;
  std::optional<HandProposal> palm_first(const HandGrips::Grip& grip, base::Random& random) const;
  HandProposal proposal_at(const hands::RigidTransform& X_OH) const;
  /// A part of the hand at a place, as one of its samples is.
  struct Placing {
    std::size_t part = 0;
    std::int32_t sample = 0;
    std::int32_t place = 0;
    double cost = 0.0;  ///< [m]
  };
  HandProposal with(HandProposal proposal, const Placing& placing) const;
  std::optional<Placing> cheapest(const HandProposal& proposal, std::size_t part,
                                  double most) const;

  const hands::HandModel& hand_;
  const TargetPlaces& targets_;
  const HandGrips& grips_;
  const NearestPlaces& nearest_;
  const TableReach& table_;
  /// Per place of the object, facing inward: beside one another, for speed.
  std::vector<Facing> surface_;
};

}  // namespace graspfit::grasp::internal
