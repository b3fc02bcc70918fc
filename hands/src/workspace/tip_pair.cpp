#include "workspace/tip_pair.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "workspace/joint_samples.hpp"

namespace graspfit::hands::internal {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Configurations tried for collisions are this far apart in distance [m].
constexpr double kDiameterStep = 1e-3;
constexpr double kFarthest = 1e4;  // [m]; bounds the number of bins, one per step
// Contact points nearer than this count as one, with no line between them [m]; rounding is a
// millionth of it.
constexpr double kSamePoint = 1e-9;
// Most grid points of one finger; each costs forward kinematics.
constexpr double kMostPoses = 1 << 14;
// Number of grid points at each end of a range from which local search starts.
constexpr std::size_t kStarts = 4;
// Distance, in bins, between two of these starts where bins of distance are searched.
constexpr std::ptrdiff_t kBinsBetweenStarts = 4;
// Local search ends at this share of a grid step.
constexpr double kFinest = 1e-5;
// Number of random steps in all joints at once, per joint.
constexpr int kDrawnPerJoint = 4;

/// Samples per joint of the finest grid that the options and kMostPoses allow; 0 if not even 2 fit.
int grid_of(const PairJoints& joints, const WorkspaceOptions& options) {
  const auto fits = [&](int n) {
    const auto grid = [n](std::size_t size) { return std::pow(n, static_cast<double>(size)); };
    const std::size_t of_one =
        joints.shared.size() + std::max(joints.only_a.size(), joints.only_b.size());
    return grid(joints.all.size()) <= static_cast<double>(options.max_configurations) &&
           grid(of_one) <= kMostPoses;
  };
  int n = options.samples_per_joint;
  while (n > 2 && !fits(n)) --n;
  return fits(n) ? n : 0;
}

/// The few best of many starts; of equal ones the first come first.
class BestStarts {
 public:
  bool takes(double value) const {
    return starts_.size() < kStarts || value > starts_.back().value;
  }
  void add(double value, const VectorXd& q) {
    const auto position =
        std::find_if(starts_.begin(), starts_.end(),
                     [&](const ValuedPositions& start) { return value > start.value; });
    starts_.insert(position, {value, q});
    if (starts_.size() > kStarts) starts_.pop_back();
  }
  const std::vector<ValuedPositions>& list() const { return starts_; }

 private:
  std::vector<ValuedPositions> starts_;
};

/// Two tips that move one against the other.
class TipPair {
 public:
  TipPair(const SampledHand& hand, std::optional<int> pad_a, std::optional<int> pad_b,
          const WorkspaceOptions& options)
      : hand_(hand),
        pad_a_(pad_a),
        pad_b_(pad_b),
        options_(options),
        joints_(joints_of_pair(hand.model(), hand.link_of(pad_a), hand.link_of(pad_b))),
        per_joint_(grid_of(joints_, options)) {}

  DistanceRange distances() const {
    DistanceRange range{kInfinity, 0.0, error()};
    BestStarts nearest, farthest;
    for_each_row([&](VectorXd& q, const Tip& a, const std::vector<Tip>& all_b,
                     const JointSamples& samples_b) {
      std::size_t near = 0, far = 0;
      double least = kInfinity, most = -1.0;
      for (std::size_t i = 0; i < all_b.size(); ++i) {
        const double squared = (a.point - all_b[i].point).squaredNorm();
        if (squared < least) least = squared, near = i;
        if (squared > most) most = squared, far = i;
      }
      const auto offer = [&](BestStarts& starts, double value, std::size_t sample_b) {
        if (!starts.takes(value)) return;
        samples_b.set(static_cast<std::int64_t>(sample_b), q);
        starts.add(value, q);
      };
      offer(nearest, -std::sqrt(least), near);
      offer(farthest, std::sqrt(most), far);
    });
    range.smallest = -best_of(nearest, -1.0);
    range.largest = best_of(farthest, 1.0);
    return range;
  }

  /// Range of the distances at which the pads face each other; `is_clear(q)` is called for as few
  /// configurations as possible.
  DistanceRange facing_distances(const IsClear& is_clear) const {
    // For each millimeter of distance, a bin holds the configuration whose pads face each other
    // best.
    std::vector<ValuedPositions> bins;
    for_each_row([&](VectorXd& q, const Tip& a, const std::vector<Tip>& all_b,
                     const JointSamples& samples_b) {
      for (std::int64_t i = 0; i < std::ssize(all_b); ++i) {
        const double distance = (all_b[i].point - a.point).norm();
        const std::optional<double> facing = facing_cosine(a, all_b[i], distance);
        if (!facing) continue;
        // Written so that NaN fails.
        if (!(distance < kFarthest)) {
          throw base::InvalidInput("hand " + hand_.model().name + ": tips come " +
                                   base::shortest_decimal(distance) +
                                   " m apart; the limits of its slides are in another unit");
        }
        const auto bin = static_cast<std::size_t>(distance / kDiameterStep);
        if (bin >= bins.size()) bins.resize(bin + 1);
        if (!(*facing > bins[bin].value)) continue;
        samples_b.set(i, q);
        bins[bin] = {*facing, q};
      }
    });
    const auto end = [&](auto begin, auto finish, double sign) -> std::optional<double> {
      std::optional<double> best;
      std::size_t num_starts = 0;
      for (auto bin = begin; bin < finish && num_starts < kStarts; ++bin) {
        if (bin->q.size() == 0 || !is_clear(bin->q)) continue;
        ++num_starts;
        const auto value = [&](const VectorXd& trial, double to_beat) -> std::optional<double> {
          const auto [a, b] = tips_at(trial);
          const double distance = (b.point - a.point).norm();
          if (!(sign * distance > to_beat) || !facing_cosine(a, b, distance) || !is_clear(trial)) {
            return std::nullopt;
          }
          return sign * distance;
        };
        const double found =
            moved_on({sign * distance_at(bin->q), bin->q}, kDrawnPerJoint, value).value;
        best = std::max(best.value_or(-kInfinity), found);
        bin += std::min<std::ptrdiff_t>(kBinsBetweenStarts, finish - bin - 1);
      }
      return best;
    };
    const std::optional<double> nearest = end(bins.begin(), bins.end(), -1.0);
    if (!nearest) return {0.0, 0.0, kInfinity};
    return {-*nearest, *end(bins.rbegin(), bins.rend(), 1.0), kInfinity};
  }

 private:
  struct TwoTips {
    Tip a, b;
  };
  TwoTips tips_at(const VectorXd& q) const {
    const std::vector<RigidTransform> X_HL = hand_.poses(q);
    return {hand_.tip(pad_a_, X_HL), hand_.tip(pad_b_, X_HL)};
  }
  double distance_at(const VectorXd& q) const {
    const auto [a, b] = tips_at(q);
    return (a.point - b.point).norm();
  }

  /// Cosine of the larger of the angles between the pads' normals and the line between them; empty
  /// if this angle is beyond the facing angle. If the points coincide, the pads face each other
  /// along some line if their normals are opposite within twice the facing angle.
  std::optional<double> facing_cosine(const Tip& a, const Tip& b, double distance) const {
    const double least = std::cos(options_.facing_angle);
    if (distance < kSamePoint) {
      const double half = std::sqrt(std::max(0.0, 0.5 * (1.0 - a.normal.dot(b.normal))));
      return half >= least ? std::optional<double>(half) : std::nullopt;
    }
    const Vector3d along = (b.point - a.point) / distance;
    const double cosine = std::min(a.normal.dot(along), -b.normal.dot(along));
    return cosine >= least ? std::optional<double>(cosine) : std::nullopt;
  }

  JointSamples samples_of(const std::vector<int>& joints) const {
    const double most = std::cbrt(static_cast<double>(options_.max_configurations));
    return {hand_.model(), each_alone(joints), per_joint_, static_cast<std::int64_t>(most)};
  }

  /// Calls `visit(q, tip of a, all tips of b, the samples of b)` for every position of the joints
  /// that move a; q holds this position, and `visit` may change only the joints of b in it.
  template <class Visit>
  void for_each_row(const Visit& visit) const {
    const JointSamples shared = samples_of(joints_.shared);
    const JointSamples only_a = samples_of(joints_.only_a);
    const JointSamples only_b = samples_of(joints_.only_b);
    VectorXd q = hand_.open();
    std::vector<Tip> all_b(only_b.size());
    for (std::int64_t s = 0; s < shared.size(); ++s) {
      shared.set(s, q);
      for (std::int64_t i = 0; i < only_b.size(); ++i) {
        only_b.set(i, q);
        all_b[i] = hand_.tip(pad_b_, hand_.poses(q));
      }
      for (std::int64_t i = 0; i < only_a.size(); ++i) {
        only_a.set(i, q);
        visit(q, hand_.tip(pad_a_, hand_.poses(q)), all_b, only_b);
      }
    }
  }

  template <class Value>
  ValuedPositions moved_on(const ValuedPositions& start, int drawn_per_joint,
                           const Value& value) const {
    const SearchSteps steps{.first_share = per_joint_ > 0 ? 1.0 / (per_joint_ - 1) : 0.5,
                            .finest = kFinest,
                            .num_drawn = drawn_per_joint * base::as_index<int>(joints_.all.size())};
    return move_on(hand_.model(), each_alone(joints_.all), steps, start, value);
  }

  /// The best of some starts, improved by local search where the grid had to be coarser than
  /// requested.
  double best_of(const BestStarts& starts, double sign) const {
    double best = starts.list().front().value;
    if (per_joint_ == options_.samples_per_joint) return best;
    for (const ValuedPositions& start : starts.list()) {
      const auto value = [&](const VectorXd& trial, double to_beat) -> std::optional<double> {
        const double found = sign * distance_at(trial);
        return found > to_beat ? std::optional<double>(found) : std::nullopt;
      };
      best = std::max(best, moved_on(start, 0, value).value);
    }
    return best;
  }

  /// Bound of the error: every configuration is within half a step of a grid point in each joint
  /// (within the whole range of a random one).
  double error() const {
    double sum = 0.0;
    for (const int joint : joints_.all) {
      const Joint& limits = hand_.model().joints[joint];
      const double range = limits.upper - limits.lower;
      const double off = per_joint_ > 0 ? 0.5 * range / (per_joint_ - 1) : range;
      for (const auto& pad : {pad_a_, pad_b_})
        sum += off * hand_.speed(pad, joint, joints_.carrying);
    }
    return sum;
  }

  const SampledHand& hand_;
  const std::optional<int> pad_a_, pad_b_;  ///< Empty: the palm's center.
  const WorkspaceOptions& options_;
  const PairJoints joints_;
  const int per_joint_;  ///< 0: random configurations instead of a grid.
};

}  // namespace

SampledHand::SampledHand(const HandModel& model)
    : model_(model), open_(open_configuration(model).q) {
  for (const ContactPad& pad : model.pads) {
    contact_points_C_.push_back(pad_contact_point_C(pad));
  }
  // Coupled joints start at their open limits, so that breakaway joints keep only what their
  // couplings ask for.
  for (std::size_t joint = 0; joint < model.joints.size(); ++joint) {
    const Joint& description = model.joints[joint];
    if (!description.coupling) continue;
    open_[joint] = description.closing_sign < 0 ? description.upper : description.lower;
  }
}

std::vector<RigidTransform> SampledHand::poses(const VectorXd& q) const {
  HandConfiguration configuration{RigidTransform::Identity(), q};
  apply_couplings(model_, configuration.q);
  return forward_kinematics(model_, configuration);
}

Tip SampledHand::tip(std::optional<int> pad, const std::vector<RigidTransform>& X_HL) const {
  if (!pad) return {model_.palm.center_H, model_.palm.direction_H};
  const RigidTransform X_HC = pad_pose(model_, *pad, X_HL);
  return {X_HC * contact_points_C_[*pad], X_HC.linear().col(2)};
}

double SampledHand::speed(std::optional<int> pad, int leader,
                          const std::vector<int>& standing) const {
  if (!pad) return 0.0;
  double reach = (model_.pads[*pad].X_LC * contact_points_C_[*pad]).norm();
  double total = 0.0;
  for (const Link* link = &model_.links[link_of(pad)]; link->parent_link;
       link = &model_.links[*link->parent_link]) {
    if (!link->parent_joint) {
      reach += link->X_PL_fixed.translation().norm();
      continue;
    }
    const int index = *link->parent_joint;
    const Joint& joint = model_.joints[index];
    const bool stands = std::find(standing.begin(), standing.end(), index) != standing.end();
    double share = index == leader ? 1.0 : 0.0;
    if (joint.coupling && joint.coupling->leader == leader) share = std::abs(joint.coupling->ratio);
    const bool is_prismatic = joint.type == JointType::Prismatic;
    if (!stands) total += share * (is_prismatic ? 1.0 : reach);
    if (is_prismatic) reach += std::max(std::abs(joint.lower), std::abs(joint.upper));
    reach += joint.X_PJ.translation().norm();
  }
  return total;
}

DistanceRange tip_distance_range(const SampledHand& hand, std::optional<int> pad_a,
                                 std::optional<int> pad_b, const WorkspaceOptions& options) {
  return TipPair(hand, pad_a, pad_b, options).distances();
}

IsClear clear_of_itself(const SampledHand& hand, const HandCollision& collision,
                        double touch_depth) {
  std::optional<std::pair<int, int>> last;
  return [&hand, &collision, touch_depth, last](const VectorXd& q) mutable {
    const auto found = collision.pair_deeper_than(hand.poses(q), touch_depth, last);
    if (found) last = found;
    return !found;
  };
}

DistanceRange facing_distance_range(const SampledHand& hand, int pad_a, int pad_b,
                                    const WorkspaceOptions& options, const IsClear& is_clear) {
  return TipPair(hand, pad_a, pad_b, options).facing_distances(is_clear);
}

}  // namespace graspfit::hands::internal
