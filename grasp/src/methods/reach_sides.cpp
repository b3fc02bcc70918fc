#include "methods/reach_sides.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "graspfit/contact/epsilon_bound.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/hands/palm_pose.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using geometry::RigidTransform;

constexpr double kDegree = std::numbers::pi / 180.0;

// An attempt ends with a candidate that is strong enough, or after so much work. Twice the postures
// raise the median strength by a quarter.
constexpr double kEnough = 0.1;
constexpr int kMostPostures = 100;
constexpr int kMostPairs = 200000;    // of points, or points for the palm
constexpr int kMostProposals = 4000;  // small objects and wide fingertips need most of them
// Further candidates cost nothing unless the first ones fail.
constexpr std::size_t kMostStarts = 3;

// New candidates.
constexpr int kProposals = 4;                       // of which one is laid onto the surface
constexpr double kMostProposedLean = 60 * kDegree;  // of a pad on its point
constexpr int kRollDraws = 6;                       // about the line between two points
constexpr double kMostTilt = 30 * kDegree;          // of the palm on its point
constexpr double kLeanLever = 0.03;                 // [m/rad]: a lean beside a gap

// Grips are drawn by the squares of the strengths that a short search finds for each.
constexpr int kPosturesOfGrip = 12;
constexpr int kProposalsOfGrip = 500;
constexpr double kLeastShare = 0.03;  // of the share of the strongest grip

// Variations of the strongest candidate. Three times as many of them are good as of new ones.
constexpr double kShareVaried = 0.6;  // of all postures
constexpr double kLeastScale = 0.1;   // of a variation; drawn, as small and large ones help
constexpr double kMostShift = 0.012;  // of the palm [m]
constexpr double kMostTurn = 0.24;    // of the palm and of joints [rad; m of prismatic ones]

// Postures. Pads that lean more touch with their edges only. Refinement closes gaps more often than
// it frees a hand that is in the object.
constexpr double kMostLean = 65 * kDegree;
constexpr double kMostGap = 0.003;    // [m]
constexpr double kMostDepth = 0.003;  // [m]

std::vector<bool> is_in_pool(const TargetRules& rules, std::size_t num_patches) {
  std::vector<bool> is_in(num_patches, false);
  for (const PoolPoint& point : rules.pool()) is_in[static_cast<std::size_t>(*point.patch)] = true;
  return is_in;
}

std::vector<bool> have_normal(const std::vector<geometry::SurfacePatch>& patches) {
  std::vector<bool> have(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) have[i] = patches[i].has_normal;
  return have;
}

GripRule grip_rule(const PlannerOptions& options) {
  if (options.style != GraspStyle::Auto) return {};
  return {.may_add_finger = true,
          .may_add_palm = options.palm.value_or(true),
          .may_exchange = options.fingers.empty()};
}

/// Where a pad is and where it faces: of a sample in H, or as a point of the pool in O.
struct Facing {
  Vector3d point;
  Vector3d normal;
};

Facing facing(const hands::PadSamples& samples, std::int32_t sample) {
  return {samples.points_H.col(sample), samples.normals_H.col(sample)};
}
Facing facing(const PoolPoint& point) { return {point.point_O, point.inward_normal_O}; }

/// What it costs to place a pad so far from a point and facing so: a length.
double cost(double gap, const Vector3d& pad_normal, const Vector3d& inward_normal) {
  const double cosine = pad_normal.dot(inward_normal);
  return gap + kLeanLever * std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// The palm pose in which pads a and b lie on two points as squarely as they can; where their pads
/// leave the turn about the line open, it is drawn. Empty if a pad leans too much.
std::optional<RigidTransform> aligned(const Facing& a_H, const Facing& b_H, const Facing& a_O,
                                      const Facing& b_O, base::Random& random) {
  const Vector3d line_O = (b_O.point - a_O.point).normalized();
  const Matrix3d onto =
      Eigen::Quaterniond::FromTwoVectors(b_H.point - a_H.point, line_O).toRotationMatrix();
  const Vector3d normal_a = onto * a_H.normal;
  const Vector3d normal_b = onto * b_H.normal;
  const auto lean = [&](double turn) {
    const Eigen::AngleAxisd roll(turn, line_O);
    return std::max(angle_between(roll * normal_a, a_O.normal),
                    angle_between(roll * normal_b, b_O.normal));
  };
  std::optional<double> turn;
  for (int draw = 0; draw < kRollDraws && !turn; ++draw) {
    const double drawn = random.uniform(-std::numbers::pi, std::numbers::pi);
    if (lean(drawn) <= kMostProposedLean) turn = drawn;
  }
  if (!turn) {
    // Both normals' parts across the line turned onto those of the surface, as nearly as possible.
    double sine = 0.0;
    double cosine = 0.0;
    const auto add = [&](const Vector3d& from, const Vector3d& to) {
      const Vector3d u = from - from.dot(line_O) * line_O;
      const Vector3d v = to - to.dot(line_O) * line_O;
      sine += line_O.dot(u.cross(v));
      cosine += u.dot(v);
    };
    add(normal_a, a_O.normal);
    add(normal_b, b_O.normal);
    turn = std::atan2(sine, cosine);
    if (lean(*turn) > kMostProposedLean) return std::nullopt;
  }
  RigidTransform X_OH = RigidTransform::Identity();
  X_OH.linear() = Eigen::AngleAxisd(*turn, line_O).toRotationMatrix() * onto;
  X_OH.translation() =
      0.5 * (a_O.point + b_O.point) - X_OH.linear() * (0.5 * (a_H.point + b_H.point));
  return X_OH;
}

}  // namespace

ReachSides::ReachSides(const GuidanceScene& scene, const TargetRules& rules)
    : scene_(scene),
      rules_(rules),
      grips_(scene.hand.model(), scene.parts, grip_rule(scene.options)),
      nearest_(scene.object, have_normal(scene.object.patches)),
      places_(scene.object, is_in_pool(rules, scene.object.patches.size())),
      search_(scene.hand, scene.object, nearest_, places_),
      clearance_(scene.hand, scene.object, scene.surroundings),
      pool_of_patch_(scene.object.patches.size(), -1),
      wrench_object_(contact::wrench_object(scene.object.mesh(), scene.object.mass.center_of_mass)),
      strength_friction_(0.5 * (scene.options.friction + scene.options.squeeze_friction)) {
  for (std::size_t p = 0; p < rules.pool().size(); ++p) {
    pool_of_patch_[static_cast<std::size_t>(*rules.pool()[p].patch)] = static_cast<std::int32_t>(p);
  }
  const std::size_t num_grips = grips_.grips().size();
  shares_.assign(num_grips, 1.0);
  if (num_grips == 1 || rules.pool().size() < 2) return;
  for (std::size_t i = 0; i < num_grips; ++i) {
    base::Random random(1);
    const std::vector<Candidate> best =
        strongest(&grips_.grips()[i],
                  {.proposals_left = kProposalsOfGrip, .postures_left = kPosturesOfGrip}, random);
    const double strength = best.empty() ? 0.0 : std::max(0.0, best.front().strength);
    shares_[i] = strength * strength;
  }
  const double most = *std::max_element(shares_.begin(), shares_.end());
  for (double& share : shares_) share = most > 0.0 ? std::max(share, kLeastShare * most) : 1.0;
}

bool ReachSides::Work::is_done() const {
  return pairs >= kMostPairs || proposals_left <= 0 || postures_left <= 0;
}

std::vector<TargetSide> ReachSides::draw(base::Random& random) const {
  if (rules_.pool().size() < 2) return {};
  std::vector<TargetSide> sides;
  for (const Candidate& candidate : strongest(
           nullptr, {.proposals_left = kMostProposals, .postures_left = kMostPostures}, random)) {
    sides.push_back(side_of(candidate));
  }
  return sides;
}

/// The strongest of some candidates of a grip, or of grips as they are drawn, the strongest first.
std::vector<ReachSides::Candidate> ReachSides::strongest(const Grip* grip, Work work,
                                                         base::Random& random) const {
  std::vector<Candidate> best;
  while (!work.is_done() && (best.empty() || best.front().strength < kEnough)) {
    if (!best.empty() && random.uniform() < kShareVaried) {
      std::optional<Candidate> candidate = varied(best.front(), random, work);
      if (candidate && candidate->strength > best.front().strength) {
        best.front() = std::move(*candidate);
      }
      continue;
    }
    std::optional<Candidate> candidate = drawn(grip ? *grip : drawn_grip(random), random, work);
    if (!candidate) continue;
    const auto position = std::find_if(best.begin(), best.end(), [&](const Candidate& other) {
      return candidate->strength > other.strength;
    });
    best.insert(position, std::move(*candidate));
    if (best.size() > kMostStarts) best.pop_back();
  }
  return best;
}

/// A grip, by the shares.
const ReachSides::Grip& ReachSides::drawn_grip(base::Random& random) const {
  double left = random.uniform(0.0, std::accumulate(shares_.begin(), shares_.end(), 0.0));
  for (std::size_t i = 0; i + 1 < shares_.size(); ++i) {
    if (left < shares_[i]) return grips_.grips()[i];
    left -= shares_[i];
  }
  return grips_.grips().back();
}

/// Of some proposals that may become a grasp the one that costs least, laid; empty if there was
/// none or it is not good.
std::optional<ReachSides::Candidate> ReachSides::drawn(const Grip& grip, base::Random& random,
                                                       Work& work) const {
  std::optional<Proposal> best;
  for (int i = 0; i < kProposals; ++i) {
    std::optional<Proposal> proposal = this->proposal(grip, random, work);
    if (!proposal) break;
    if (best && proposal->largest_cost >= best->largest_cost) continue;
    std::vector<std::int32_t> patches;
    for (const std::size_t part : grip.parts) patches.push_back(*proposal->patches[part]);
    if (are_apart(patches) && has_stable_pair(patches)) best = std::move(proposal);
  }
  if (!best) return std::nullopt;
  return laid(grip, best->configuration, work);
}

/// A candidate's posture moved a little, and laid again.
std::optional<ReachSides::Candidate> ReachSides::varied(const Candidate& from, base::Random& random,
                                                        Work& work) const {
  const hands::HandModel& hand = scene_.hand.model();
  const double scale = random.uniform(kLeastScale, 1.0);
  const auto drawn = [&](double most) { return scale * random.uniform(-most, most); };
  hands::HandConfiguration configuration = from.posture.configuration;
  Vector3d pivot = Vector3d::Zero();
  for (const contact::Contact& contact : contacts_on(from.posture.patches)) {
    pivot += contact.point_O / static_cast<double>(from.posture.patches.size());
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
  return laid(*from.grip, configuration, work);
}

/// Empty if the posture that is laid from there is not good.
std::optional<ReachSides::Candidate> ReachSides::laid(const Grip& grip,
                                                      hands::HandConfiguration start,
                                                      Work& work) const {
  --work.postures_left;
  hands::apply_couplings(scene_.hand.model(), start.q);
  std::vector<int> pads;
  for (const std::size_t part : grip.parts) pads.push_back(grips_.parts()[part].samples.pad);
  Candidate candidate{&grip, search_.lay(pads, start)};
  if (!is_good(candidate.posture)) return std::nullopt;
  candidate.strength = strength(candidate.posture.patches);
  return candidate;
}

/// Empty once the work of an attempt is done.
std::optional<ReachSides::Proposal> ReachSides::proposal(const Grip& grip, base::Random& random,
                                                         Work& work) const {
  while (!work.is_done()) {
    ++work.pairs;
    std::optional<Proposal> proposal =
        grip.has_palm ? palm_first(grip, random) : pinch(grip, random);
    if (!proposal || !is_from_approach(proposal->configuration)) continue;
    --work.proposals_left;
    for (const std::size_t part : grip.parts) {
      if (!proposal->patches[part]) complete(part, *proposal);
    }
    return proposal;
  }
  return std::nullopt;
}

bool ReachSides::is_from_approach(const hands::HandConfiguration& configuration) const {
  const Vector3d palm = configuration.X_OH.linear() * scene_.hand.model().palm.direction_H;
  return hands::angle_from_approach(palm, scene_.options.approach_O) <=
         scene_.options.approach_angle;
}

bool ReachSides::are_apart(const std::vector<std::int32_t>& patches) const {
  for (std::size_t i = 0; i < patches.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (rules_.distance(point_of(patches[i]), point_of(patches[j])) <
          rules_.options().min_separation) {
        return false;
      }
    }
  }
  return true;
}

bool ReachSides::has_stable_pair(const std::vector<std::int32_t>& patches) const {
  for (std::size_t i = 0; i < patches.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (rules_.is_stable_pair(point_of(patches[j]), point_of(patches[i]))) return true;
    }
  }
  return false;
}

/// How strong a grasp with contacts on these patches would be [ε]; of two contacts, which cannot
/// close, how far their line is within the cones.
double ReachSides::strength(const std::vector<std::int32_t>& patches) const {
  const std::vector<contact::Contact> contacts = contacts_on(patches);
  if (contacts.size() == 2) {
    const Vector3d line = contacts[1].point_O - contacts[0].point_O;
    const double lean = std::max(angle_between(contacts[0].inward_normal_O, line),
                                 angle_between(contacts[1].inward_normal_O, -line));
    return lean < 0.5 * std::numbers::pi ? strength_friction_ - std::tan(lean) : -lean;
  }
  return contact::epsilon_bound(contact::contact_wrenches(
      contacts, contact::wrench_convention(contact::WrenchTool::Graspfit, wrench_object_, contacts,
                                           strength_friction_)));
}

/// Two fingers of the grip on two points of the pool, if its tables know that they can be there.
std::optional<ReachSides::Proposal> ReachSides::pinch(const Grip& grip,
                                                      base::Random& random) const {
  const std::vector<PoolPoint>& pool = rules_.pool();
  const HandGrips::Pinch& pinch = grips_.pinches()[grip.pinches[random.index(grip.pinches.size())]];
  const PoolPoint& a = pool[random.index(pool.size())];
  const PoolPoint& b = pool[random.index(pool.size())];
  const Facing a_O = facing(a);
  const Facing b_O = facing(b);
  const Vector3d line = b_O.point - a_O.point;
  if (!(line.norm() > 0.0) || line.norm() < rules_.options().min_separation) return std::nullopt;
  const auto samples = pinch.table.draw(line.norm(), angle_between(a_O.normal, line),
                                        angle_between(b_O.normal, -line), random);
  if (!samples) return std::nullopt;
  const std::optional<RigidTransform> X_OH =
      aligned(facing(grips_.parts()[pinch.part_a].samples, samples->first),
              facing(grips_.parts()[pinch.part_b].samples, samples->second), a_O, b_O, random);
  if (!X_OH) return std::nullopt;
  Proposal proposal = proposal_at(*X_OH);
  set(pinch.part_a, samples->first, *a.patch, proposal);
  set(pinch.part_b, samples->second, *b.patch, proposal);
  const auto charge = [&](std::size_t part, std::int32_t sample, const Facing& place_O) {
    const Facing pad_H = facing(grips_.parts()[part].samples, sample);
    const double gap = (*X_OH * pad_H.point - place_O.point).norm();
    proposal.largest_cost =
        std::max(proposal.largest_cost, cost(gap, X_OH->linear() * pad_H.normal, place_O.normal));
  };
  charge(pinch.part_a, samples->first, a_O);
  charge(pinch.part_b, samples->second, b_O);
  return proposal;
}

/// The palm on a point of the pool, leaning a little, turned anyhow.
ReachSides::Proposal ReachSides::palm_first(const Grip& grip, base::Random& random) const {
  const PoolPoint& point = rules_.pool()[random.index(rules_.pool().size())];
  const hands::PadSamples& palm = grips_.parts()[grip.parts.back()].samples;
  const auto sample = static_cast<std::int32_t>(random.index(palm.size()));
  const Facing pad = facing(palm, sample);
  const Eigen::AngleAxisd roll(random.uniform(-std::numbers::pi, std::numbers::pi),
                               point.inward_normal_O);
  const double around = random.uniform(-std::numbers::pi, std::numbers::pi);
  const double lean = random.uniform(0.0, kMostTilt);
  const Vector3d across = point.inward_normal_O.unitOrthogonal();
  const Eigen::AngleAxisd tilt(lean, Eigen::AngleAxisd(around, point.inward_normal_O) * across);
  RigidTransform X_OH = RigidTransform::Identity();
  X_OH.linear() =
      (tilt * roll).toRotationMatrix() *
      Eigen::Quaterniond::FromTwoVectors(pad.normal, point.inward_normal_O).toRotationMatrix();
  X_OH.translation() = point.point_O - X_OH.linear() * pad.point;
  Proposal proposal = proposal_at(X_OH);
  set(grip.parts.back(), sample, *point.patch, proposal);
  return proposal;
}

ReachSides::Proposal ReachSides::proposal_at(const RigidTransform& X_OH) const {
  const hands::HandModel& hand = scene_.hand.model();
  Proposal proposal;
  proposal.configuration = hands::open_configuration(hand);
  proposal.configuration.X_OH = X_OH;
  proposal.is_fixed.resize(hand.joints.size(), false);
  proposal.patches.resize(grips_.parts().size());
  return proposal;
}

void ReachSides::set(std::size_t part, std::int32_t sample, std::int32_t patch,
                     Proposal& proposal) const {
  const hands::PadSamples& samples = grips_.parts()[part].samples;
  for (std::size_t j = 0; j < samples.joints.size(); ++j) {
    proposal.configuration.q[samples.joints[j]] = samples.positions(static_cast<Index>(j), sample);
    proposal.is_fixed[static_cast<std::size_t>(samples.joints[j])] = true;
  }
  proposal.patches[part] = patch;
}

/// Places a part by the sample that is nearest to the surface and leans least there.
void ReachSides::complete(std::size_t part, Proposal& proposal) const {
  const hands::PadSamples& samples = grips_.parts()[part].samples;
  const RigidTransform& X_OH = proposal.configuration.X_OH;
  double least = std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  std::int32_t best_patch = 0;
  for (std::size_t from = 0; from < samples.size(); from += samples.range_size) {
    bool fits = true;
    for (std::size_t j = samples.joints.size() - samples.num_shared;
         j < samples.joints.size() && fits; ++j) {
      const int joint = samples.joints[j];
      fits = !proposal.is_fixed[static_cast<std::size_t>(joint)] ||
             proposal.configuration.q[joint] ==
                 samples.positions(static_cast<Index>(j), static_cast<Index>(from));
    }
    if (!fits) continue;
    for (std::size_t number = from; number < from + samples.range_size; ++number) {
      const auto sample = static_cast<Index>(number);
      const Vector3d point = X_OH * samples.points_H.col(sample);
      const std::int32_t index = places_.at(point);
      const geometry::SurfacePatch& patch = scene_.object.patches[index];
      const double gap = (point - patch.centroid).norm();
      if (gap >= least) continue;
      const double its_cost =
          cost(gap, X_OH.linear() * samples.normals_H.col(sample), -patch.outward_normal);
      if (its_cost >= least) continue;
      least = its_cost;
      best = number;
      best_patch = index;
    }
  }
  set(part, static_cast<std::int32_t>(best), best_patch, proposal);
  proposal.largest_cost = std::max(proposal.largest_cost, least);
}

bool ReachSides::is_good(const SurfacePosture& posture) const {
  if (posture.largest_gap > kMostGap || posture.largest_lean > kMostLean ||
      posture.largest_depth > kMostDepth) {
    return false;
  }
  if (!is_from_approach(posture.configuration)) return false;
  return are_apart(posture.patches) && has_stable_pair(posture.patches) &&
         is_clear_of_surroundings(posture) && clearance_.is_clear_of_itself(posture.X_OL);
}

bool ReachSides::is_clear_of_surroundings(const SurfacePosture& posture) const {
  if (scene_.surroundings.surroundings().is_empty()) return true;
  for (std::size_t link = 0; link < posture.X_OL.size(); ++link) {
    const auto number = static_cast<int>(link);
    if (scene_.surroundings.touches(scene_.hand.collision(), number, posture.X_OL[link])) {
      return false;
    }
  }
  return true;
}

std::int32_t ReachSides::point_of(std::int32_t patch) const {
  return pool_of_patch_[static_cast<std::size_t>(patch)];
}

std::vector<contact::Contact> ReachSides::contacts_on(
    const std::vector<std::int32_t>& patches) const {
  std::vector<contact::Contact> contacts;
  for (const std::int32_t patch : patches) {
    contact::Contact contact;
    contact.point_O = scene_.object.patches[patch].centroid;
    contact.inward_normal_O = -scene_.object.patches[patch].outward_normal;
    contacts.push_back(contact);
  }
  return contacts;
}

TargetSide ReachSides::side_of(const Candidate& candidate) const {
  const hands::HandModel& hand = scene_.hand.model();
  std::vector<std::int32_t> points;
  for (const std::int32_t patch : candidate.posture.patches) {
    points.push_back(point_of(patch));
  }
  TargetSide side;
  side.targets = rules_.as_targets(points, std::nullopt, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    TargetContact& target = side.targets.contacts[i];
    target.finger = grips_.parts()[candidate.grip->parts[i]].finger;
    target.is_palm = !target.finger;
  }
  side.goal = candidate.posture.configuration;
  side.is_at_goal = true;
  side.misfit = -candidate.strength;
  side.placement.direction_O = (side.goal->X_OH.linear() * hand.palm.direction_H).normalized();
  return side;
}

}  // namespace graspfit::grasp::internal
