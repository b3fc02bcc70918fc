#include "methods/reach_sides.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "graspfit/base/units.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/palm_pose.hpp"
#include "methods/firmness.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;

// A draw ends with a candidate that is firm enough for the postures that were tried, or after so
// much work. Nearly all candidates of a firmness of 0.035 close. Where none is found soon, what
// further postures add is seldom 0.01, so that less is asked: several short draws whose candidates
// are refined find more than a long one (docs/performance.md).
constexpr double kEnough = 0.1;
struct Aim {
  int postures;
  double firmness;
};
constexpr std::array<Aim, 3> kAims = {{{20, 0.06}, {40, 0.03}, {70, 0.005}}};
constexpr int kMostPostures = kAims.back().postures;
constexpr int kMostPairs = 500000;     // of points, or points for the palm
constexpr int kMostProposals = 20000;  // small objects and wide fingertips need most of them
// Further candidates cost little unless the first ones fail.
constexpr std::size_t kMostStarts = 2;
constexpr int kProposals = 16;      // of new candidates, of which one is laid onto the surface
constexpr double kMostCost = 0.03;  // of one of them [m]
constexpr int kVariations = 4;      // of the firmest candidate, of which one is laid

// A posture that is in the object is lifted off it: refinement closes gaps more often than it frees
// a hand, and moves contacts less.
constexpr double kLiftStep = 0.2;  // [voxels]
constexpr int kMostLifts = 6;

// Grips are drawn by the squares of the firmness that the firmest of some proposals find for
// each, in the mean, times the squared share of the attempt's tries that gave a candidate: where
// the firmest places are such that a hand can never be laid there, as in a small mug, nearly all
// postures would be spent on them. Of 384 attempts (four objects, two sizes, four hands) all closed
// with these few as with the firmest five of 200, and were as firm.
constexpr int kProposalsOfGrip = 64;
constexpr int kFirmestOfGrip = 2;
constexpr double kLeastShare = 0.1;  // of the share of the firmest grip

// Variations of the firmest candidate. Two to four times as many of them are good as of new ones.
constexpr double kShareVaried = 0.6;  // of all postures
constexpr double kLeastScale = 0.1;   // of a variation; drawn, as small and large ones help
constexpr double kMostShift = 0.012;  // of the palm [m]
constexpr double kMostTurn = 0.24;    // of the palm and of joints [rad; m of prismatic ones]

// A posture is given up on its way if its places are less firm by more than this share than what it
// is to exceed, unless that is hardly firm: there, on a mug, many become firmer late.
constexpr double kLeastHope = 0.1;
constexpr double kHardlyFirm = 0.02;

// Postures. Pads that lean more touch with their edges only. Refinement closes gaps more often than
// it frees a hand that is in the object, above all one whose links lie around it: lifted off on one
// side, they leave gaps on another.
constexpr double kMostLean = 65 * base::kRadiansPerDegree;
constexpr double kMostGap = 0.003;           // [m]
constexpr double kMostDepth = 0.003;         // [m]
constexpr double kMostDepthOfWraps = 0.001;  // [m]

std::vector<bool> is_in_pool(const TargetPlaces& targets, std::size_t num_places) {
  std::vector<bool> is_in(num_places, false);
  for (const PoolPoint& point : targets.pool()) is_in[point.place] = true;
  return is_in;
}

std::vector<bool> have_normal(const std::vector<SurfacePlace>& places) {
  std::vector<bool> have(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) have[i] = places[i].has_normal;
  return have;
}

/// What a candidate must promise after so many postures of a draw of so much effort.
double wanted_firmness(int num_postures, double effort) {
  if (num_postures < kAims.front().postures) return kEnough;
  const auto next = std::find_if(kAims.begin() + 1, kAims.end() - 1,
                                 [&](const Aim& aim) { return num_postures < aim.postures; });
  const Aim& last = *(next - 1);
  const bool is_end = next + 1 == kAims.end();
  const double end = is_end ? effort * next->postures : next->postures;
  const double share = (num_postures - last.postures) / (end - last.postures);
  return last.firmness + share * (next->firmness - last.firmness);
}

GripRule grip_rule(const GuidanceScene& scene) {
  const PlannerOptions& options = scene.options;
  GripRule rule;
  const bool is_over_table = scene.surroundings.surroundings().table_z_O.has_value();
  rule.along_pads = rule.may_pair = is_over_table;
  // Without refinement hands are fitted, which only fingertips' pads can be.
  rule.may_use_ends = options.refine && scene.contact_options.pads == contact::CountedPads::All;
  rule.may_wrap = rule.may_use_ends && options.style != GraspStyle::Precision;
  if (options.style == GraspStyle::Auto) {
    rule.may_add_finger = true;
    rule.may_add_palm = options.palm.value_or(true);
    rule.may_exchange = options.fingers.empty();
    rule.may_drop_finger = is_over_table;
  }
  return rule;
}

std::vector<const hands::PadSamples*> samples_of(const HandGrips& grips) {
  std::vector<const hands::PadSamples*> samples;
  for (const HandGrips::Part& part : grips.parts()) samples.push_back(&part.samples);
  return samples;
}

bool are_different(std::vector<std::int32_t> places) {
  std::sort(places.begin(), places.end());
  return std::adjacent_find(places.begin(), places.end()) == places.end();
}

}  // namespace

ReachSides::ReachSides(const GuidanceScene& scene, const std::vector<SurfacePlace>& places,
                       const TargetPlaces& targets)
    : scene_(scene),
      places_(places),
      targets_(targets),
      grips_(scene.hand.model(), scene.parts, grip_rule(scene)),
      nearest_(scene.object, places, have_normal(places)),
      nearest_of_pool_(scene.object, places, is_in_pool(targets, places.size())),
      search_(scene.hand, scene.object, places, nearest_, nearest_of_pool_, scene.surroundings),
      clearance_(scene.hand, scene.object, scene.surroundings),
      table_(scene.hand.model(), scene.surroundings, samples_of(grips_)),
      proposals_(scene.hand.model(), places, targets, grips_, nearest_of_pool_, table_),
      firmness_(scene.object, places, targets.pool(), firmness_friction(scene.options)),
      bones_(places.size() > scene.object.patches.size()
                 ? std::optional<FingerBones>(std::in_place, scene.hand.model(), scene.object.query,
                                              samples_of(grips_))
                 : std::nullopt),
      pool_of_place_(places.size(), -1) {
  for (std::int32_t p = 0; p < std::ssize(targets.pool()); ++p) {
    pool_of_place_[targets.pool()[p].place] = p;
  }
  const std::size_t num_grips = grips_.grips().size();
  shares_.assign(num_grips, 1.0);
  if (num_grips == 1 || targets.pool().size() < 2) return;
  base::Random random(scene.options.seed);
  for (std::size_t i = 0; i < num_grips; ++i) {
    const double firmness = firmness_of(grips_.grips()[i], random);
    shares_[i] = firmness * firmness;
  }
  const double most = *std::max_element(shares_.begin(), shares_.end());
  for (double& share : shares_) share = most > 0.0 ? std::max(share, kLeastShare * most) : 1.0;
}

/// How firm the places of some proposals of the grip are: the mean of the firmest few, of which
/// none counts for less than 0.
double ReachSides::firmness_of(const Grip& grip, base::Random& random) const {
  std::array<double, kFirmestOfGrip> firmest{};  // the firmest first
  Work work{.most_proposals = kProposalsOfGrip, .most_postures = 1};
  while (std::optional<HandProposal> begun = this->proposal(grip, random, work)) {
    const auto rated = completed(grip, std::move(*begun), firmest.back());
    if (!rated || rated->second <= firmest.back()) continue;
    firmest.back() = rated->second;
    std::sort(firmest.rbegin(), firmest.rend());
  }
  return std::accumulate(firmest.begin(), firmest.end(), 0.0) / kFirmestOfGrip;
}

bool ReachSides::Work::is_done() const {
  return pairs >= kMostPairs || proposals >= most_proposals || postures >= most_postures;
}

std::vector<TargetSide> ReachSides::draw(base::Random& random, double effort) const {
  if (targets_.pool().size() < 2) return {};
  std::vector<Candidate> best = firmest(random, effort);
  bool is_any_clear = false;
  for (Candidate& candidate : best) is_any_clear = clear(candidate) || is_any_clear;
  std::vector<TargetSide> sides;
  for (const Candidate& candidate : best) {
    // Refinement frees few hands that are in the object.
    if (candidate.is_clear || !is_any_clear) sides.push_back(side_of(candidate));
  }
  return sides;
}

/// The firmest candidates of a draw, the firmest first.
std::vector<ReachSides::Candidate> ReachSides::firmest(base::Random& random, double effort) const {
  std::vector<Candidate> best;
  Work work{.most_proposals = kMostProposals,
            .most_postures = static_cast<int>(effort * kMostPostures)};
  const auto is_enough = [&] {
    return !best.empty() && best.front().firmness >= wanted_firmness(work.postures, effort);
  };
  std::vector<Tries> tries(shares_.size());
  while (!work.is_done()) {
    if (is_enough()) {
      if (clear(best.front())) break;
      best.erase(best.begin());
      continue;
    }
    if (!best.empty() && random.uniform() < kShareVaried) {
      std::optional<Candidate> candidate = varied(best.front(), random, work);
      if (candidate) best.front() = std::move(*candidate);
      continue;
    }
    const double least =
        best.size() < kMostStarts ? -std::numeric_limits<double>::infinity() : best.back().firmness;
    const std::size_t grip = drawn_grip(tries, random);
    std::optional<Candidate> candidate = drawn(grips_.grips()[grip], least, random, work);
    ++tries[grip].all;
    if (!candidate) continue;
    ++tries[grip].good;
    const auto position = std::find_if(best.begin(), best.end(), [&](const Candidate& other) {
      return candidate->firmness > other.firmness;
    });
    best.insert(position, std::move(*candidate));
    if (best.size() > kMostStarts) best.pop_back();
  }
  return best;
}

/// A grip, by the shares and by how often the attempt's tries of it were good.
std::size_t ReachSides::drawn_grip(const std::vector<Tries>& tries, base::Random& random) const {
  std::vector<double> weights(shares_.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double rate = (tries[i].good + 1.0) / (tries[i].all + 1.0);
    weights[i] = shares_[i] * rate * rate;
  }
  double left = random.uniform(0.0, std::accumulate(weights.begin(), weights.end(), 0.0));
  std::size_t i = 0;
  while (i + 1 < weights.size() && left >= weights[i]) left -= weights[i++];
  return i;
}

/// Of some proposals that may become a grasp the one whose places are firmest, laid; empty if
/// there was none, or it is not good or not firmer than `least`.
std::optional<ReachSides::Candidate> ReachSides::drawn(const Grip& grip, double least,
                                                       base::Random& random, Work& work) const {
  std::optional<HandProposal> best;
  double firmest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kProposals; ++i) {
    std::optional<HandProposal> begun = this->proposal(grip, random, work);
    if (!begun) break;
    auto rated = completed(grip, std::move(*begun), firmest);
    if (!rated || (best && rated->second <= firmest)) continue;
    best = std::move(rated->first);
    firmest = rated->second;
  }
  if (!best) return std::nullopt;
  return laid(grip, best->configuration, least, work);
}

/// The proposal with all parts of the grip placed, and how firm its places are (of what is no
/// more than `least` only so much is known); empty if that costs too much or cannot become a grasp.
std::optional<std::pair<HandProposal, double>> ReachSides::completed(const Grip& grip,
                                                                     HandProposal begun,
                                                                     double least) const {
  std::optional<HandProposal> proposal = proposals_.completed(grip, kMostCost, std::move(begun));
  if (!proposal) return std::nullopt;
  std::vector<std::int32_t> places;
  for (const std::size_t part : grip.parts) places.push_back(*proposal->places[part]);
  if (!are_apart(places) || !has_stable_pair(places) || goes_through_wall(grip, *proposal)) {
    return std::nullopt;
  }
  return std::pair(std::move(*proposal), firmness_.nominal(places, least));
}

/// Whether a finger that is on a side of a thin wall seems to go through one.
bool ReachSides::goes_through_wall(const Grip& grip, const HandProposal& proposal) const {
  if (!bones_) return false;
  return std::any_of(grip.parts.begin(), grip.parts.end(), [&](std::size_t part) {
    return !bones_->is_free(part, proposal.samples[part], proposal.configuration.X_OH);
  });
}

/// A candidate's posture moved a little, and laid again: of some such motions the one after which
/// the places nearest to the pads are firmest.
std::optional<ReachSides::Candidate> ReachSides::varied(const Candidate& from, base::Random& random,
                                                        Work& work) const {
  const hands::HandModel& hand = scene_.hand.model();
  const std::vector<int> pads = pads_of(*from.grip);
  std::optional<hands::HandConfiguration> best;
  double firmest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kVariations; ++i) {
    hands::HandConfiguration configuration = moved(from.posture, random);
    const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
    std::vector<std::int32_t> places;
    for (const int pad : pads) {
      places.push_back(nearest_of_pool_.at(hands::pad_contact_point(hand, pad, X_OL),
                                           hands::pad_pose(hand, pad, X_OL).linear().col(2)));
    }
    const double firmness = firmness_.nominal(places, firmest);
    if (best && firmness <= firmest) continue;
    firmest = firmness;
    best = std::move(configuration);
  }
  return laid(*from.grip, *best, from.firmness, work);
}

/// A posture moved a little, palm and joints.
hands::HandConfiguration ReachSides::moved(const SurfacePosture& posture,
                                           base::Random& random) const {
  const hands::HandModel& hand = scene_.hand.model();
  const double scale = random.uniform(kLeastScale, 1.0);
  const auto drawn = [&](double most) { return scale * random.uniform(-most, most); };
  hands::HandConfiguration configuration = posture.configuration;
  Vector3d pivot = Vector3d::Zero();
  for (const std::int32_t place : posture.places) {
    pivot += places_[place].point_O / static_cast<double>(posture.places.size());
  }
  Vector3d shift, turn;
  for (double& x : shift) x = drawn(kMostShift);
  for (double& x : turn) x = drawn(kMostTurn);
  const Eigen::AngleAxisd rotation(turn.norm(), turn.stableNormalized());
  RigidTransform& X_OH = configuration.X_OH;
  X_OH.linear() = (Eigen::Quaterniond(rotation) * Eigen::Quaterniond(X_OH.linear()))
                      .normalized()
                      .toRotationMatrix();
  X_OH.translation() = pivot + rotation * Vector3d(X_OH.translation() - pivot) + shift;
  for (double& q : configuration.q) q += drawn(kMostTurn);
  hands::clamp_to_limits(hand, configuration.q);
  hands::apply_couplings(hand, configuration.q);
  return configuration;
}

/// Empty if the posture that is laid from there is not good, or not firmer than `least`.
std::optional<ReachSides::Candidate> ReachSides::laid(const Grip& grip,
                                                      hands::HandConfiguration start, double least,
                                                      Work& work) const {
  ++work.postures;
  hands::apply_couplings(scene_.hand.model(), start.q);
  const double hopeless = (1.0 - kLeastHope) * least;
  const auto is_hopeful = [&](const std::vector<std::int32_t>& places) {
    return least <= kHardlyFirm || firmness_.nominal(places, hopeless) > hopeless;
  };
  SurfacePosture posture = search_.lay(pads_of(grip), start, 0.0, is_hopeful);
  if (!is_good(posture)) return std::nullopt;
  if (bones_ && !bones_->are_free(pads_of(grip), posture.X_OL)) return std::nullopt;
  if (grip.wraps && posture.largest_depth > kMostDepthOfWraps) return std::nullopt;
  const double firmness = firmness_.expected(posture.places, least);
  if (!(firmness > least) || !clearance_.is_clear_of_itself(posture.X_OL)) return std::nullopt;
  return Candidate{&grip, std::move(posture), firmness};
}

/// Lifts the candidate off the object until it is clear of it, exactly, and says whether that was
/// possible; leaves it as it is where it takes too much, or pads then lie where they should not.
bool ReachSides::clear(Candidate& candidate) const {
  if (candidate.is_clear) return true;
  const std::vector<int> pads = pads_of(*candidate.grip);
  const double step = kLiftStep * scene_.object.grid.lattice.voxel_size;
  SurfacePosture posture = candidate.posture;
  for (int i = 0; i <= kMostLifts; ++i) {
    if (i > 0) posture = search_.lay(pads, posture.configuration, i * step);
    if (!clearance_.is_clear_of_world(posture.X_OL) ||
        !clearance_.is_clear_of_itself(posture.X_OL)) {
      continue;
    }
    candidate.is_clear = is_good(posture);
    if (candidate.is_clear) candidate.posture = std::move(posture);
    break;
  }
  return candidate.is_clear;
}

std::vector<int> ReachSides::pads_of(const Grip& grip) const {
  std::vector<int> pads;
  for (const std::size_t part : grip.parts) pads.push_back(grips_.parts()[part].samples.pad);
  return pads;
}

/// Not yet complete. Empty once the work of an attempt is done.
std::optional<HandProposal> ReachSides::proposal(const Grip& grip, base::Random& random,
                                                 Work& work) const {
  while (!work.is_done()) {
    ++work.pairs;
    std::optional<HandProposal> proposal = proposals_.draw(grip, random);
    if (!proposal || !is_from_approach(proposal->configuration)) continue;
    ++work.proposals;
    return proposal;
  }
  return std::nullopt;
}

bool ReachSides::is_from_approach(const hands::HandConfiguration& configuration) const {
  const Vector3d palm = configuration.X_OH.linear() * scene_.hand.model().palm.direction_H;
  return hands::angle_from_approach(palm, scene_.options.approach_O) <=
         scene_.options.approach_angle;
}

/// Whether pads could touch side by side. Laid there, links that would overlap are kept apart.
bool ReachSides::are_apart(const std::vector<std::int32_t>& places) const {
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::int32_t a = point_of(places[i]);
      const std::int32_t b = point_of(places[j]);
      // Pads that face each other need no space beside one another.
      const std::vector<PoolPoint>& pool = targets_.pool();
      if (pool[a].inward_normal_O.dot(pool[b].inward_normal_O) < 0.0) continue;
      if (targets_.is_too_near(targets_.distance(a, b))) return false;
    }
  }
  return true;
}

bool ReachSides::has_stable_pair(const std::vector<std::int32_t>& places) const {
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (targets_.is_stable_pair(point_of(places[j]), point_of(places[i]))) return true;
    }
  }
  return false;
}

bool ReachSides::is_good(const SurfacePosture& posture) const {
  if (posture.largest_gap > kMostGap || posture.largest_lean > kMostLean ||
      posture.largest_depth > kMostDepth || !are_different(posture.places)) {
    return false;
  }
  if (!is_from_approach(posture.configuration)) return false;
  return has_stable_pair(posture.places) && is_clear_of_surroundings(posture);
}

bool ReachSides::is_clear_of_surroundings(const SurfacePosture& posture) const {
  if (scene_.surroundings.surroundings().is_empty()) return true;
  for (int link = 0; link < std::ssize(posture.X_OL); ++link) {
    if (scene_.surroundings.touches(scene_.hand.collision(), link, posture.X_OL[link])) {
      return false;
    }
  }
  return true;
}

std::int32_t ReachSides::point_of(std::int32_t place) const { return pool_of_place_[place]; }

TargetSide ReachSides::side_of(const Candidate& candidate) const {
  const hands::HandModel& hand = scene_.hand.model();
  std::vector<std::int32_t> points;
  for (const std::int32_t place : candidate.posture.places) {
    points.push_back(point_of(place));
  }
  TargetSide side;
  side.targets = targets_.as_targets(points, std::nullopt, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    TargetContact& target = side.targets.contacts[i];
    const HandGrips::Part& part = grips_.parts()[candidate.grip->parts[i]];
    target.finger = part.finger;
    target.pad = part.other_pad;
    target.is_palm = !target.finger;
  }
  side.goal = candidate.posture.configuration;
  side.is_at_goal = true;
  side.promised_firmness = candidate.firmness;
  side.placement.direction_O = (side.goal->X_OH.linear() * hand.palm.direction_H).normalized();
  return side;
}

}  // namespace graspfit::grasp::internal
