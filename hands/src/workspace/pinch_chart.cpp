#include "graspfit/hands/pinch_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/base/units.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/kinematic_chain.hpp"
#include "workspace/joint_samples.hpp"
#include "workspace/tip_pair.hpp"

namespace graspfit::hands {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using internal::JointGroup;
using internal::JointSamples;
using internal::SampledHand;
using internal::Tip;

// Of each class of openings a configuration is kept per so much lean, so that where the squarest
// one brings links into each other there is another.
constexpr double kLeanStep = 4.0 * base::kRadiansPerDegree;
constexpr std::size_t kLeanClasses = 20;  // to 80 degrees
// Most positions of one side, whose kinematics are computed one by one.
constexpr double kMostPoses = 1 << 14;
// Points nearer than this count as one, with no line between them [m].
constexpr double kSamePoint = 1e-9;
// Larger grids change leans by less than local search does, and cost kinematics.
constexpr int kMostPerGroup = 512;
// Two fingers are side by side if their normals are nearer to each other than this angle's cosine:
// 15 degrees.
constexpr double kCosSideBySide = 0.96592582628906831;
// Random steps in all groups at once, per group, of a round of local search, and the share of a
// grid step at which it ends. More and finer ones take longer and change leans by tenths of a
// degree.
constexpr int kDrawnPerGroup = 2;
constexpr double kFinest = 0.02;
// By so much a class's pinch must be squarer for its neighbor to be improved from it [rad].
constexpr double kWorthTrying = 0.3 * base::kRadiansPerDegree;

/// Two sides that press against each other: the pads of each.
struct Sides {
  int pad_a = 0;
  std::vector<int> pads_b;
};

/// The independent joints of a pair of sides, in groups that move alike.
struct SideJoints {
  std::vector<JointGroup> shared, only_a, only_b, all;
};

SideJoints joints_of(const HandModel& model, const Sides& sides) {
  // Joints that move all pads alike are no joints of the sides; those that can turn none are left
  // out.
  std::vector<std::vector<int>> relative;  // per pad of side b: what moves it against side a
  std::vector<int> shared;
  std::vector<int> only_a;
  for (const int pad : sides.pads_b) {
    internal::PairJoints pair =
        internal::joints_of_pair(model, model.pads[sides.pad_a].link, model.pads[pad].link);
    shared.insert(shared.end(), pair.shared.begin(), pair.shared.end());
    only_a.insert(only_a.end(), pair.only_a.begin(), pair.only_a.end());
    relative.push_back(std::move(pair.only_b));
  }
  const auto moves = [&](int joint, int pad) {
    const std::vector<int> leaders = leaders_of(model, joints_to(model, model.pads[pad].link));
    return std::binary_search(leaders.begin(), leaders.end(), joint);
  };
  // What moves side a and one finger of side b, but not the other, has one position for both sides.
  for (const int joint : only_a) {
    const bool moves_b = std::any_of(sides.pads_b.begin(), sides.pads_b.end(),
                                     [&](int pad) { return moves(joint, pad); });
    if (moves_b) shared.push_back(joint);
  }
  const auto make_unique = [](std::vector<int>& joints) {
    std::sort(joints.begin(), joints.end());
    joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  };
  make_unique(shared);
  make_unique(only_a);
  const auto is_no_own = [&](int joint) {
    const Joint& limits = model.joints[joint];
    return !(limits.upper > limits.lower) ||
           std::binary_search(shared.begin(), shared.end(), joint);
  };
  std::erase_if(only_a, is_no_own);
  for (std::vector<int>& own : relative) std::erase_if(own, is_no_own);
  std::erase_if(
      shared, [&](int joint) { return !(model.joints[joint].upper > model.joints[joint].lower); });

  SideJoints joints;
  if (relative.size() == 2) {
    // What moves both fingers of a side is moved alone; the others are paired from the tips.
    std::vector<int> common;
    std::set_intersection(relative[0].begin(), relative[0].end(), relative[1].begin(),
                          relative[1].end(), std::back_inserter(common));
    for (const int joint : common) {
      joints.only_b.push_back({joint});
      for (std::vector<int>& own : relative) std::erase(own, joint);
    }
    for (std::size_t k = 0; k < std::max(relative[0].size(), relative[1].size()); ++k) {
      JointGroup group;
      for (const std::vector<int>& own : relative) {
        if (k < own.size()) group.push_back(own[own.size() - 1 - k]);
      }
      joints.only_b.push_back(std::move(group));
    }
  } else {
    joints.only_b = internal::each_alone(relative.front());
  }
  joints.shared = internal::each_alone(shared);
  joints.only_a = internal::each_alone(only_a);
  for (const auto* part : {&joints.shared, &joints.only_a, &joints.only_b}) {
    joints.all.insert(joints.all.end(), part->begin(), part->end());
  }
  return joints;
}

/// A side's points and normals in H. The point of two fingers is in the middle between theirs.
struct Side {
  Vector3d point;
  std::array<Vector3d, 2> normals;  ///< The same twice for a single pad.
};

/// Where the sides of a configuration are, and how much they lean.
struct Facing {
  double opening = 0.0;
  double lean = 0.0;
};

/// Empty where the sides coincide, and where a side's two fingers are not side by side.
std::optional<Facing> facing_of(const Side& a, const Side& b) {
  if (b.normals[0].dot(b.normals[1]) < kCosSideBySide) return std::nullopt;
  const Vector3d line = b.point - a.point;
  const double opening = line.norm();
  if (opening < kSamePoint) return std::nullopt;
  const Vector3d along = line / opening;
  const double cosine =
      std::min({a.normals[0].dot(along), -b.normals[0].dot(along), -b.normals[1].dot(along)});
  return Facing{opening, std::acos(std::clamp(cosine, -1.0, 1.0))};
}

/// The configurations of one pair of sides.
class Pincher {
 public:
  Pincher(const SampledHand& hand, Sides sides, const PinchChartOptions& options)
      : hand_(hand),
        sides_(std::move(sides)),
        options_(options),
        joints_(joints_of(hand.model(), sides_)) {
    const auto fits = [&](int n) {
      const auto grid = [n](std::size_t size) { return std::pow(n, static_cast<double>(size)); };
      const std::size_t of_one =
          joints_.shared.size() + std::max(joints_.only_a.size(), joints_.only_b.size());
      return grid(joints_.all.size()) <= static_cast<double>(options.max_configurations) &&
             grid(of_one) <= kMostPoses;
    };
    per_group_ = kMostPerGroup;
    while (per_group_ > 2 && !fits(per_group_)) --per_group_;
    has_grid_ = fits(per_group_);
  }

  /// Calls `visit(facing, q)` for the configurations of the grid, or for random ones where not even
  /// two positions of each joint fit. `q` is a function that gives the joints' positions.
  template <class Visit>
  void for_each(const Visit& visit) const {
    const JointSamples shared = samples_of(joints_.shared);
    const JointSamples only_a = samples_of(joints_.only_a);
    const JointSamples only_b = samples_of(joints_.only_b);
    VectorXd q = hand_.open();
    std::vector<Side> all_b(only_b.size());
    for (std::int64_t s = 0; s < shared.size(); ++s) {
      shared.set(s, q);
      for (std::int64_t i = 0; i < only_b.size(); ++i) {
        only_b.set(i, q);
        all_b[i] = side_b(hand_.poses(q));
      }
      for (std::int64_t i = 0; i < only_a.size(); ++i) {
        only_a.set(i, q);
        const Side a = side_a(hand_.poses(q));
        for (std::int64_t j = 0; j < only_b.size(); ++j) {
          const std::optional<Facing> facing = facing_of(a, all_b[j]);
          if (!facing) continue;
          visit(*facing, [&] {
            only_b.set(j, q);
            return q;
          });
        }
      }
    }
  }

  /// The squarest pinch that local search finds in a class of openings from `q`, which may be of
  /// another class. Empty if it does not get into the class.
  template <class IsClear>
  std::optional<Pinch> improved(const VectorXd& q, double smallest, double largest,
                                const IsClear& is_clear) const {
    // Openings outside the class are worse than any lean in it, the more so the farther outside.
    const auto value_of = [&](const Facing& facing) {
      const double outside = std::max({0.0, smallest - facing.opening, facing.opening - largest});
      const bool is_inside = facing.opening >= smallest && facing.opening < largest;
      return is_inside ? -facing.lean : -std::numbers::pi - outside / options_.step;
    };
    const std::optional<Facing> start = facing_at(q);
    if (!start) return std::nullopt;
    const auto value = [&](const VectorXd& trial, double best) -> std::optional<double> {
      const std::optional<Facing> facing = facing_at(trial);
      if (!facing || !(value_of(*facing) > best) || !is_clear(trial)) return std::nullopt;
      return value_of(*facing);
    };
    const internal::SearchSteps steps{
        .first_share = has_grid_ ? 1.0 / (per_group_ - 1) : 0.5,
        .finest = kFinest,
        .num_drawn = kDrawnPerGroup * base::as_index<int>(joints_.all.size())};
    const VectorXd squarest =
        internal::move_on(hand_.model(), joints_.all, steps, {value_of(*start), q}, value).q;
    const Facing end = *facing_at(squarest);
    if (end.opening < smallest || end.opening >= largest) return std::nullopt;
    return Pinch{end.opening, end.lean, pads(), squarest};
  }

  std::vector<int> pads() const {
    std::vector<int> pads = {sides_.pad_a};
    pads.insert(pads.end(), sides_.pads_b.begin(), sides_.pads_b.end());
    return pads;
  }

 private:
  std::optional<Facing> facing_at(const VectorXd& q) const {
    const std::vector<RigidTransform> X_HL = hand_.poses(q);
    return facing_of(side_a(X_HL), side_b(X_HL));
  }

  JointSamples samples_of(const std::vector<JointGroup>& groups) const {
    const double most = std::cbrt(static_cast<double>(options_.max_configurations));
    return {hand_.model(), groups, has_grid_ ? per_group_ : 0, static_cast<std::int64_t>(most)};
  }

  Side side_a(const std::vector<RigidTransform>& X_HL) const {
    const Tip tip = hand_.tip(sides_.pad_a, X_HL);
    return {tip.point, {tip.normal, tip.normal}};
  }

  Side side_b(const std::vector<RigidTransform>& X_HL) const {
    const Tip first = hand_.tip(sides_.pads_b.front(), X_HL);
    const Tip last = hand_.tip(sides_.pads_b.back(), X_HL);
    return {0.5 * (first.point + last.point), {first.normal, last.normal}};
  }

  const SampledHand& hand_;
  const Sides sides_;
  const PinchChartOptions& options_;
  const SideJoints joints_;
  int per_group_ = 0;
  bool has_grid_ = false;
};

/// A configuration of the grid that may be the squarest of its opening.
struct Kept {
  double lean = 0.0;
  double opening = 0.0;
  std::size_t pincher = 0;
  VectorXd q;
};

/// A pinch of the chart and whose it is.
struct Found {
  Pinch pinch;
  std::size_t pincher = 0;
};

/// Per pair of sides and class of leans, the squarest configuration of a class of openings.
using Class = std::vector<std::array<std::optional<Kept>, kLeanClasses>>;

std::vector<Sides> sides_of(const HandModel& model, PinchKind kind) {
  std::vector<Sides> all;
  const int thumb = model.thumb();
  const std::optional<int>& thumb_pad = model.fingers[thumb].tip_pad;
  std::vector<int> others;  // tip pads
  for (int f = 0; f < std::ssize(model.fingers); ++f) {
    const Finger& finger = model.fingers[f];
    if (f != thumb && finger.tip_pad) others.push_back(*finger.tip_pad);
  }
  const auto is_tip = [&](int pad) {
    return std::any_of(model.fingers.begin(), model.fingers.end(),
                       [&](const Finger& finger) { return finger.tip_pad == pad; });
  };
  const auto num_pads = base::as_index<int>(model.pads.size());
  switch (kind) {
    case PinchKind::Tips:
      if (!thumb_pad) break;
      for (const int other : others) all.push_back({*thumb_pad, {other}});
      break;
    case PinchKind::TwoFingers:
      if (!thumb_pad) break;
      for (std::size_t i = 0; i + 1 < others.size(); ++i) {
        all.push_back({*thumb_pad, {others[i], others[i + 1]}});
      }
      break;
    case PinchKind::Palm:
      if (!model.palm.pad) break;
      for (const Finger& finger : model.fingers) {
        if (finger.tip_pad) all.push_back({*model.palm.pad, {*finger.tip_pad}});
      }
      break;
    case PinchKind::Proximal:
      for (int a = 0; a < num_pads; ++a) {
        if (model.pads[a].finger != thumb) continue;
        for (int b = 0; b < num_pads; ++b) {
          const std::optional<int>& finger = model.pads[b].finger;
          if (!finger || *finger == thumb || (is_tip(a) && is_tip(b))) continue;
          all.push_back({a, {b}});
        }
      }
      break;
  }
  return all;
}

}  // namespace

void PinchChartOptions::validate() const {
  const char* const where = "PinchChartOptions";
  base::require(step > 0.0 && std::isfinite(step), where, "step", step, "finite and > 0 m");
  base::require(max_configurations >= 2, where, "max_configurations", max_configurations, ">= 2");
  base::require(touch_depth > 0.0 && std::isfinite(touch_depth), where, "touch_depth", touch_depth,
                "finite and > 0 m");
}

PinchChart pinch_chart(const HandModel& model, PinchKind kind, const PinchChartOptions& options) {
  options.validate();
  validate(model);
  const SampledHand hand(model);
  const HandCollision collision(model);
  const internal::IsClear is_clear =
      internal::clear_of_itself(hand, collision, options.touch_depth);
  std::vector<Pincher> pinchers;
  for (Sides& sides : sides_of(model, kind)) pinchers.emplace_back(hand, std::move(sides), options);

  std::vector<Class> classes;
  for (std::size_t p = 0; p < pinchers.size(); ++p) {
    pinchers[p].for_each([&](const Facing& facing, const auto& q) {
      // Written so that NaN fails.
      if (!(facing.opening < PinchChart::kMostClasses * options.step)) {
        throw base::InvalidInput(
            "hand " + model.name + ": pads come " + base::shortest_decimal(facing.opening) +
            " m apart, too far for a step of " + base::shortest_decimal(options.step) + " m");
      }
      const auto lean_class = static_cast<std::size_t>(facing.lean / kLeanStep);
      if (lean_class >= kLeanClasses) return;
      const auto number = static_cast<std::size_t>(facing.opening / options.step);
      if (number >= classes.size()) classes.resize(number + 1, Class(pinchers.size()));
      std::optional<Kept>& kept = classes[number][p][lean_class];
      if (kept && kept->lean <= facing.lean) return;
      kept = Kept{facing.lean, facing.opening, p, q()};
    });
  }

  std::vector<std::optional<Found>> found(classes.size());
  const auto improve = [&](std::size_t number, std::size_t p, const VectorXd& q) {
    const auto first = static_cast<double>(number);
    std::optional<Pinch> pinch =
        pinchers[p].improved(q, first * options.step, (first + 1.0) * options.step, is_clear);
    if (!pinch || (found[number] && found[number]->pinch.lean <= pinch->lean)) return;
    found[number] = Found{std::move(*pinch), p};
  };
  for (std::size_t number = 0; number < classes.size(); ++number) {
    std::vector<const Kept*> all;
    for (const auto& of_sides : classes[number]) {
      for (const std::optional<Kept>& kept : of_sides) {
        if (kept) all.push_back(&*kept);
      }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Kept* a, const Kept* b) { return a->lean < b->lean; });
    const auto clear =
        std::find_if(all.begin(), all.end(), [&](const Kept* kept) { return is_clear(kept->q); });
    if (clear != all.end()) improve(number, (*clear)->pincher, (*clear)->q);
  }
  // Grids in many joints are coarse: the neighbor of a squarer one is squarer, too.
  const auto improve_from = [&](std::size_t number, std::size_t neighbor) {
    if (!found[neighbor]) return;
    const bool is_squarer =
        !found[number] || found[neighbor]->pinch.lean < found[number]->pinch.lean - kWorthTrying;
    if (!is_squarer) return;
    const Found from = *found[neighbor];
    improve(number, from.pincher, from.pinch.q);
  };
  for (std::size_t k = 1; k < found.size(); ++k) improve_from(k, k - 1);
  for (std::size_t k = found.size(); k > 1; --k) improve_from(k - 2, k - 1);

  PinchChart chart{kind, options.step, base::as_index<int>(pinchers.size()), {}};
  for (std::optional<Found>& one : found) {
    chart.pinches.emplace_back();
    // The search gets into classes beyond the least cosine that the grid is asked for.
    if (!one || one->pinch.lean >= kLeanStep * static_cast<double>(kLeanClasses)) continue;
    HandConfiguration configuration{RigidTransform::Identity(), std::move(one->pinch.q)};
    apply_couplings(model, configuration.q);
    one->pinch.q = std::move(configuration.q);
    chart.pinches.back() = std::move(one->pinch);
  }
  while (!chart.pinches.empty() && !chart.pinches.back()) chart.pinches.pop_back();
  return chart;
}

const Pinch* squarest(const PinchChart& chart) {
  const Pinch* best = nullptr;
  for (const std::optional<Pinch>& pinch : chart.pinches) {
    if (pinch && (!best || pinch->lean < best->lean)) best = &*pinch;
  }
  return best;
}

std::vector<OpeningRange> square_widths(const PinchChart& chart, double friction) {
  std::vector<OpeningRange> ranges;
  bool is_within = false;
  for (const std::optional<Pinch>& pinch : chart.pinches) {
    const bool is_square = pinch && pinch->lean <= std::atan(friction);
    if (is_square && !is_within) ranges.push_back({pinch->opening, pinch->opening});
    if (is_square) ranges.back().largest = pinch->opening;
    is_within = is_square;
  }
  return ranges;
}

}  // namespace graspfit::hands
