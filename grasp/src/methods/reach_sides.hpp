#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "fitting/surface_posture.hpp"
#include "graspfit/base/random.hpp"
#include "methods/finger_bones.hpp"
#include "methods/hand_grips.hpp"
#include "methods/hand_proposals.hpp"
#include "methods/place_firmness.hpp"
#include "methods/table_reach.hpp"
#include "methods/target_sides.hpp"
#include "scene/clearance.hpp"
#include "targets/target_places.hpp"

/// \file
/// Targets that the hand can meet [R]. Many times a hand is proposed that is about where its pads
/// lie on points that may be targets: by two pads that can face each other as the points do, or by
/// the palm. Of some such proposals the one whose places are firmest is laid onto the surface,
/// and where its pads then lie are the targets: the hand meets them before anything is decided
/// exactly. The firmest such posture is then varied and laid again.

namespace graspfit::grasp::internal {

/// Draws candidates for one object and hand. Const members are safe to call from several threads.
class ReachSides {
 public:
  /// Refers to all of them; the targets' pool is of the object's places.
  ReachSides(const GuidanceScene& scene, const std::vector<SurfacePlace>& places,
             const TargetPlaces& targets);

  /// The firmest candidates of a draw, the firmest first, each with its posture
  /// (`TargetSide::goal`), from which it is refined: lifted off the object until it is clear of it.
  /// Those that cannot be are left out, unless none of them can, and do not end the search.
  /// Firmness is that which `PlaceFirmness` expects. New candidates and variations of the firmest
  /// one take turns, at random, until one that can be clear is firm enough, for which less is
  /// asked the more postures were tried, or a budget of work is spent: on thin and jagged objects
  /// even the firmest may not be expected to close, of which about half do. Empty if none was
  /// found.
  /// @param effort at most so many times the postures of a first draw
  std::vector<TargetSide> draw(base::Random& random, double effort) const;

  const HandGrips& grips() const { return grips_; }

 private:
  using Grip = HandGrips::Grip;

  /// A posture in which all parts of a grip lie on the object.
  struct Candidate {
    const Grip* grip = nullptr;
    SurfacePosture posture;
    double firmness = 0.0;
    bool is_clear = false;  ///< Of the world and of itself, exactly; false: perhaps not.
  };

  /// Work done in an attempt.
  struct Work {
    int pairs = 0;
    int proposals = 0;
    int postures = 0;
    int most_proposals = 0;
    int most_postures = 0;
    bool is_done() const;
  };

  /// Tries of a grip in an attempt, and how many of them gave a candidate.
  struct Tries {
    int all = 0;
    int good = 0;
  };

  std::size_t drawn_grip(const std::vector<Tries>& tries, base::Random& random) const;
  double firmness_of(const Grip& grip, base::Random& random) const;
  std::vector<Candidate> firmest(base::Random& random, double effort) const;
  bool goes_through_wall(const Grip& grip, const HandProposal& proposal) const;
  std::optional<std::pair<HandProposal, double>> completed(const Grip& grip, HandProposal begun,
                                                           double least) const;
  std::optional<Candidate> drawn(const Grip& grip, double least, base::Random& random,
                                 Work& work) const;
  std::optional<Candidate> varied(const Candidate& from, base::Random& random, Work& work) const;
  hands::HandConfiguration moved(const SurfacePosture& posture, base::Random& random) const;
  std::optional<Candidate> laid(const Grip& grip, hands::HandConfiguration start, double least,
                                Work& work) const;
  bool is_from_approach(const hands::HandConfiguration& configuration) const;
  std::optional<HandProposal> proposal(const Grip& grip, base::Random& random, Work& work) const;
  bool clear(Candidate& candidate) const;
  std::vector<int> pads_of(const Grip& grip) const;
  bool is_good(const SurfacePosture& posture) const;
  bool is_clear_of_surroundings(const SurfacePosture& posture) const;
  bool are_apart(const std::vector<std::int32_t>& places) const;
  bool has_stable_pair(const std::vector<std::int32_t>& places) const;
  std::int32_t point_of(std::int32_t place) const;
  TargetSide side_of(const Candidate& candidate) const;

  const GuidanceScene& scene_;
  const std::vector<SurfacePlace>& places_;
  const TargetPlaces& targets_;
  const HandGrips grips_;
  const NearestPlaces nearest_;
  const NearestPlaces nearest_of_pool_;
  const SurfaceSearch search_;
  const Clearance clearance_;
  const TableReach table_;
  const HandProposals proposals_;
  const PlaceFirmness firmness_;
  const std::optional<FingerBones> bones_;   ///< Where the object has walls thinner than voxels.
  std::vector<std::int32_t> pool_of_place_;  ///< −1 where a place is not in the pool.
  std::vector<double> shares_;               ///< Per grip: how often it is drawn first.
};

}  // namespace graspfit::grasp::internal
