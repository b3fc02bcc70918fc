#include "methods/hand_proposals.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/angle.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using geometry::RigidTransform;

constexpr double kMostProposedLean = std::numbers::pi / 3;  // of a pad on its point
constexpr int kRollDraws = 6;                               // about the line between two points
constexpr double kMostTilt = std::numbers::pi / 6;          // of the palm on its point
constexpr double kLeanLever = 0.03;                         // [m/rad]: a lean beside a gap

using Facing = HandProposals::Facing;

Facing facing(const hands::PadSamples& samples, std::int32_t sample) {
  return {samples.points_H.col(sample), samples.normals_H.col(sample)};
}
Facing facing(const PoolPoint& point) { return {point.point_O, point.inward_normal_O}; }

/// What it costs to place a pad so far from a point and facing so: a length.
double cost(double gap, const Vector3d& pad_normal, const Vector3d& inward_normal) {
  const double cosine = pad_normal.dot(inward_normal);
  return gap + kLeanLever * std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// Of unit vectors.
bool is_within_proposed_lean(const Vector3d& a, const Vector3d& b) {
  // The angle is asked only where it is near the limit.
  static const double limit = std::cos(kMostProposedLean);
  const double cosine = a.dot(b);
  if (std::abs(cosine - limit) > 1e-6) return cosine > limit;
  return geometry::angle_between(a, b) <= kMostProposedLean;
}

/// The palm pose in which pads a and b lie on two points as squarely as they can; where their pads
/// leave the turn about the line open, it is drawn. Empty if a pad leans too much.
std::optional<RigidTransform> aligned(const Facing& a_H, const Facing& b_H, const Facing& a_O,
                                      const Facing& b_O, base::Random& random) {
  const Vector3d line_O = (b_O.point - a_O.point).normalized();
  const Matrix3d onto = Eigen::Quaterniond::FromTwoVectors(b_H.point - a_H.point, line_O)
                            .normalized()  // of nearly opposite vectors Eigen's is not
                            .toRotationMatrix();
  const Vector3d normal_a = onto * a_H.normal;
  const Vector3d normal_b = onto * b_H.normal;
  const auto leans_little = [&](double turn) {
    const Matrix3d roll = Eigen::AngleAxisd(turn, line_O).toRotationMatrix();
    return is_within_proposed_lean(roll * normal_a, a_O.normal) &&
           is_within_proposed_lean(roll * normal_b, b_O.normal);
  };
  std::optional<double> turn;
  for (int draw = 0; draw < kRollDraws && !turn; ++draw) {
    const double drawn = random.uniform(-std::numbers::pi, std::numbers::pi);
    if (leans_little(drawn)) turn = drawn;
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
    if (!leans_little(*turn)) return std::nullopt;
  }
  RigidTransform X_OH = RigidTransform::Identity();
  X_OH.linear() = Eigen::AngleAxisd(*turn, line_O).toRotationMatrix() * onto;
  X_OH.translation() =
      0.5 * (a_O.point + b_O.point) - X_OH.linear() * (0.5 * (a_H.point + b_H.point));
  return X_OH;
}

}  // namespace

HandProposals::HandProposals(const hands::HandModel& hand, const std::vector<SurfacePlace>& places,
                             const TargetPlaces& targets, const HandGrips& grips,
                             const NearestPlaces& nearest, const TableReach& table)
    : hand_(hand), targets_(targets), grips_(grips), nearest_(nearest), table_(table) {
  for (const SurfacePlace& place : places) {
    surface_.push_back({place.point_O, -place.outward_normal_O});
  }
}

std::optional<HandProposal> HandProposals::draw(const HandGrips::Grip& grip,
                                                base::Random& random) const {
  return grip.has_palm ? palm_first(grip, random) : pinch(grip, random);
}

std::optional<HandProposal> HandProposals::completed(const HandGrips::Grip& grip, double most,
                                                     HandProposal proposal) const {
  if (proposal.largest_cost >= most) return std::nullopt;
  for (const std::size_t part : grip.parts) {
    if (proposal.places[part]) continue;
    const std::optional<Placing> placing = cheapest(proposal, part, most);
    if (!placing) return std::nullopt;
    proposal = with(std::move(proposal), *placing);
  }
  return proposal;
}

/// Two fingers of the grip on two points of the pool, if its tables know that they can be there.
std::optional<HandProposal> HandProposals::pinch(const HandGrips::Grip& grip,
                                                 base::Random& random) const {
  const std::vector<PoolPoint>& pool = targets_.pool();
  const HandGrips::Pinch& pinch = grips_.pinches()[grip.pinches[random.index(grip.pinches.size())]];
  const PoolPoint& a = pool[random.index(pool.size())];
  const PoolPoint& b = pool[random.index(pool.size())];
  const Facing a_O = facing(a);
  const Facing b_O = facing(b);
  const Vector3d line = b_O.point - a_O.point;
  const double distance = line.norm();
  if (!(distance > 0.0)) return std::nullopt;
  const bool may_lean = table_.has_table();
  const double along_a = a_O.normal.dot(line);
  const double along_b = -b_O.normal.dot(line);
  if (!pinch.table.may_have(distance, along_a, along_b, may_lean)) return std::nullopt;
  // Pads that face each other need no space beside one another. Without a table, but for thin
  // walls, that makes no difference to what is found, but to its course.
  const bool may_be_near = (table_.has_table() || nearest_.other_side(a.place) >= 0) &&
                           a.inward_normal_O.dot(b.inward_normal_O) < 0.0;
  if (!may_be_near && targets_.is_too_near(distance)) return std::nullopt;
  const auto samples =
      pinch.table.draw(distance, geometry::angle_between(a_O.normal, line),
                       geometry::angle_between(b_O.normal, -line), random, may_lean);
  if (!samples) return std::nullopt;
  const std::optional<RigidTransform> X_OH =
      aligned(facing(grips_.parts()[pinch.part_a].samples, samples->first),
              facing(grips_.parts()[pinch.part_b].samples, samples->second), a_O, b_O, random);
  if (!X_OH || !table_.is_palm_above(*X_OH) ||
      !table_.is_above(pinch.part_a, samples->first, *X_OH) ||
      !table_.is_above(pinch.part_b, samples->second, *X_OH)) {
    return std::nullopt;
  }
  const auto placing = [&](std::size_t part, std::int32_t sample, const PoolPoint& place) {
    const Facing pad_H = facing(grips_.parts()[part].samples, sample);
    const double gap = (*X_OH * pad_H.point - place.point_O).norm();
    return Placing{part, sample, place.place,
                   cost(gap, X_OH->linear() * pad_H.normal, place.inward_normal_O)};
  };
  return with(with(proposal_at(*X_OH), placing(pinch.part_a, samples->first, a)),
              placing(pinch.part_b, samples->second, b));
}

/// The palm on a point of the pool, leaning a little, turned anyhow; empty if it is below a table.
std::optional<HandProposal> HandProposals::palm_first(const HandGrips::Grip& grip,
                                                      base::Random& random) const {
  const PoolPoint& point = targets_.pool()[random.index(targets_.pool().size())];
  const hands::PadSamples& palm = grips_.parts()[grip.parts.back()].samples;
  const auto sample = base::as_index<std::int32_t>(random.index(palm.size()));
  const Facing pad = facing(palm, sample);
  const Eigen::AngleAxisd roll(random.uniform(-std::numbers::pi, std::numbers::pi),
                               point.inward_normal_O);
  const double around = random.uniform(-std::numbers::pi, std::numbers::pi);
  const double lean = random.uniform(0.0, kMostTilt);
  const Vector3d across = point.inward_normal_O.unitOrthogonal();
  const Eigen::AngleAxisd tilt(lean, Eigen::AngleAxisd(around, point.inward_normal_O) * across);
  RigidTransform X_OH = RigidTransform::Identity();
  X_OH.linear() = (tilt * roll).toRotationMatrix() *
                  Eigen::Quaterniond::FromTwoVectors(pad.normal, point.inward_normal_O)
                      .normalized()
                      .toRotationMatrix();
  X_OH.translation() = point.point_O - X_OH.linear() * pad.point;
  if (!table_.is_palm_above(X_OH)) return std::nullopt;
  // The palm lies where it was put: that costs nothing.
  return with(proposal_at(X_OH), {grip.parts.back(), sample, point.place, 0.0});
}

HandProposal HandProposals::proposal_at(const RigidTransform& X_OH) const {
  HandProposal proposal;
  proposal.configuration = hands::open_configuration(hand_);
  proposal.configuration.X_OH = X_OH;
  proposal.is_fixed.resize(hand_.joints.size(), false);
  proposal.places.resize(grips_.parts().size());
  proposal.samples.resize(grips_.parts().size());
  return proposal;
}

/// The proposal with one more part placed.
HandProposal HandProposals::with(HandProposal proposal, const Placing& placing) const {
  const hands::PadSamples& samples = grips_.parts()[placing.part].samples;
  for (int j = 0; j < std::ssize(samples.joints); ++j) {
    proposal.configuration.q[samples.joints[j]] = samples.positions(j, placing.sample);
    proposal.is_fixed[samples.joints[j]] = true;
  }
  proposal.places[placing.part] = placing.place;
  proposal.samples[placing.part] = placing.sample;
  proposal.largest_cost = std::max(proposal.largest_cost, placing.cost);
  return proposal;
}

/// Of a part's samples that agree with the parts placed already the one that is nearest to the
/// surface and leans least there; empty if each costs no less than `most`.
std::optional<HandProposals::Placing> HandProposals::cheapest(const HandProposal& proposal,
                                                              std::size_t part, double most) const {
  const hands::PadSamples& samples = grips_.parts()[part].samples;
  const RigidTransform& X_OH = proposal.configuration.X_OH;
  double least = most;
  std::optional<std::size_t> best;
  std::int32_t best_place = 0;
  for (std::size_t from = 0; from < samples.size(); from += samples.range_size) {
    bool fits = true;
    for (std::size_t j = samples.joints.size() - samples.num_shared;
         j < samples.joints.size() && fits; ++j) {
      const int joint = samples.joints[j];
      fits = !proposal.is_fixed[joint] ||
             proposal.configuration.q[joint] == samples.positions(j, from);
    }
    if (!fits) continue;
    for (std::size_t number = from; number < from + samples.range_size; ++number) {
      const auto sample = static_cast<Index>(number);
      const Vector3d point = X_OH * samples.points_H.col(sample);
      const auto normal_O = [&] { return Vector3d(X_OH.linear() * samples.normals_H.col(sample)); };
      std::int32_t index = nearest_.at(point);
      if (nearest_.other_side(index) >= 0) index = nearest_.at(point, normal_O());
      const Facing& place = surface_[index];
      const double squared = (point - place.point).squaredNorm();
      if (squared >= least * least) continue;
      const double gap = std::sqrt(squared);
      const Vector3d normal = normal_O();
      // An angle is no less than its chord.
      const double lean_left = (least - gap) / kLeanLever;
      if (2.0 - 2.0 * normal.dot(place.normal) >= lean_left * lean_left) continue;
      const double its_cost = cost(gap, normal, place.normal);
      if (its_cost >= least) continue;
      if (!table_.is_above(part, base::as_index<std::int32_t>(number), X_OH)) continue;
      least = its_cost;
      best = number;
      best_place = index;
    }
  }
  if (!best) return std::nullopt;
  return Placing{part, base::as_index<std::int32_t>(*best), best_place, least};
}

}  // namespace graspfit::grasp::internal
