#include "methods/hand_grips.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/units.hpp"
#include "graspfit/geometry/angle.hpp"
#include "targets/target_feasibility.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// Samples of a pad: more find squarer pairs and take longer.
constexpr int kMostSamples = 1024;
constexpr std::size_t kMostTableSamples = 512;  // of each pad of a pair
constexpr std::size_t kMostPerClass = 64;
constexpr double kDistanceStep = 0.005;  // [m]
constexpr int kDistanceClasses = 80;
constexpr double kLeanStep = 9.0 * base::kRadiansPerDegree;
constexpr int kLeanClasses = 7;  // to 63 degrees
constexpr int kMostLess = 2;     // classes by which jaws may lean less

/// The class of a pair; empty beyond the last ones.
std::optional<std::size_t> class_of(double distance, double lean_a, double lean_b) {
  if (!(distance < kDistanceStep * kDistanceClasses) || !(lean_a < kLeanStep * kLeanClasses) ||
      !(lean_b < kLeanStep * kLeanClasses)) {
    return std::nullopt;
  }
  const int d = static_cast<int>(distance / kDistanceStep);
  const int a = static_cast<int>(lean_a / kLeanStep);
  const int b = static_cast<int>(lean_b / kLeanStep);
  return static_cast<std::size_t>((d * kLeanClasses + a) * kLeanClasses + b);
}

/// Whether two samples agree in the joints that move both pads.
bool do_agree(const hands::PadSamples& a, Index sample_a, const hands::PadSamples& b,
              Index sample_b) {
  for (int i = 0; i < std::ssize(a.joints); ++i) {
    for (int j = 0; j < std::ssize(b.joints); ++j) {
      if (a.joints[i] == b.joints[j] && a.positions(i, sample_a) != b.positions(j, sample_b)) {
        return false;
      }
    }
  }
  return true;
}

/// All sets of `size` of the numbers below `count`, 0 among them; each ascending.
std::vector<std::vector<std::size_t>> sets_with_first(std::size_t count, std::size_t size) {
  std::vector<std::vector<std::size_t>> sets = {{0}};
  for (std::size_t i = 1; i < size; ++i) {
    std::vector<std::vector<std::size_t>> larger;
    for (const std::vector<std::size_t>& set : sets) {
      for (std::size_t next = set.back() + 1; next < count; ++next) {
        larger.push_back(set);
        larger.back().push_back(next);
      }
    }
    sets = std::move(larger);
  }
  return sets;
}

/// The pad of a finger on its last link before its tip's that has one; empty if there is none.
std::optional<int> pad_before_tip(const hands::HandModel& hand, int finger) {
  const int tip_link = hand.pads[*hand.fingers[finger].tip_pad].link;
  std::optional<int> last;
  for (int p = 0; p < std::ssize(hand.pads); ++p) {
    const hands::ContactPad& pad = hand.pads[p];
    if (pad.finger != finger || pad.link >= tip_link) continue;
    if (!last || pad.link > hand.pads[*last].link) last = p;
  }
  return last;
}

/// A second pad on the link of the finger's tip; empty if there is none.
std::optional<int> end_pad(const hands::HandModel& hand, int finger) {
  const int tip_pad = *hand.fingers[finger].tip_pad;
  for (int p = 0; p < std::ssize(hand.pads); ++p) {
    if (p != tip_pad && hand.pads[p].finger == finger &&
        hand.pads[p].link == hand.pads[tip_pad].link) {
      return p;
    }
  }
  return std::nullopt;
}

}  // namespace

PinchTable::PinchTable(const hands::PadSamples& a, const hands::PadSamples& b)
    : are_jaws_(a.joints == b.joints),
      least_lean_(kDistanceClasses, std::numeric_limits<double>::infinity()),
      classes_(static_cast<std::size_t>((kDistanceClasses + 1) * kLeanClasses * kLeanClasses)) {
  // Every n-th sample; sizes are products of the counts of joints' positions, so that an n without
  // a common divisor leaves no joint at some of its positions.
  const auto stride = [](const hands::PadSamples& samples) {
    std::size_t n = (samples.size() + kMostTableSamples - 1) / kMostTableSamples;
    while (std::gcd(n, samples.size()) > 1) ++n;
    return n;
  };
  base::Random random(1);
  std::vector<std::uint64_t> num_seen(classes_.size(), 0);
  for (std::size_t i = 0; i < a.size(); i += stride(a)) {
    const auto sample_a = static_cast<Index>(i);
    for (std::size_t j = 0; j < b.size(); j += stride(b)) {
      const auto sample_b = static_cast<Index>(j);
      if (!do_agree(a, sample_a, b, sample_b)) continue;
      const Vector3d line = b.points_H.col(sample_b) - a.points_H.col(sample_a);
      if (!(line.norm() > 0.0)) continue;
      const double lean_a = geometry::angle_between(a.normals_H.col(sample_a), line);
      const double lean_b = geometry::angle_between(b.normals_H.col(sample_b), -line);
      const std::optional<std::size_t> number = class_of(line.norm(), lean_a, lean_b);
      if (!number) continue;
      double& least = least_lean_[static_cast<std::size_t>(line.norm() / kDistanceStep)];
      least = std::min(least, std::max(lean_a, lean_b));
      auto& entries = classes_[*number];
      const std::pair<std::int32_t, std::int32_t> entry(base::as_index<std::int32_t>(i),
                                                        base::as_index<std::int32_t>(j));
      // Of more than fit a uniform choice stays.
      const std::uint64_t seen = num_seen[*number]++;
      if (entries.size() < kMostPerClass) {
        entries.push_back(entry);
      } else if (const std::uint64_t at = random.index(seen + 1); at < kMostPerClass) {
        entries[at] = entry;
      }
    }
  }
}

bool PinchTable::may_have(double distance, double along_a, double along_b, bool may_lean) const {
  if (!(distance < kDistanceStep * kDistanceClasses)) return false;
  // With a margin for rounding, which is decided by angles.
  static const double usual = std::cos(kLeanStep * kLeanClasses) - 1e-6;
  static const double most = std::cos(kLeanStep * (kLeanClasses + kMostLess)) - 1e-6;
  const double least = (may_lean && are_jaws_ ? most : usual) * distance;
  return along_a > least && along_b > least;
}

std::optional<std::pair<std::int32_t, std::int32_t>> PinchTable::draw(double distance,
                                                                      double lean_a, double lean_b,
                                                                      base::Random& random,
                                                                      bool may_lean) const {
  const int most_less = may_lean && are_jaws_ ? kMostLess : 0;
  for (int less = 0; less <= most_less; ++less) {
    for (int of_a = less; of_a >= 0; --of_a) {
      for (int of_b = less; of_b >= 0; --of_b) {
        if (std::max(of_a, of_b) < less) continue;
        const std::optional<std::size_t> number =
            class_of(distance, std::max(0.0, lean_a - of_a * kLeanStep),
                     std::max(0.0, lean_b - of_b * kLeanStep));
        if (!number || classes_[*number].empty()) continue;
        return classes_[*number][random.index(classes_[*number].size())];
      }
    }
  }
  return std::nullopt;
}

std::optional<hands::OpeningRange> PinchTable::distances_up_to(double lean) const {
  std::optional<hands::OpeningRange> range;
  for (std::size_t d = 0; d < least_lean_.size(); ++d) {
    if (least_lean_[d] > lean) continue;
    if (!range) range = {static_cast<double>(d) * kDistanceStep, 0.0};
    range->largest = static_cast<double>(d + 1) * kDistanceStep;
  }
  return range;
}

HandGrips::HandGrips(const hands::HandModel& hand, const RequestedParts& requested,
                     const GripRule& rule) {
  RequestedParts all = requested;
  if (rule.may_add_finger || rule.may_exchange) {
    for (int finger = 0; finger < std::ssize(hand.fingers); ++finger) {
      const bool is_asked = std::count(all.fingers.begin(), all.fingers.end(), finger) > 0;
      if (!is_asked && hand.fingers[finger].tip_pad) all.fingers.push_back(finger);
    }
  }
  const bool may_add_palm = rule.may_add_palm && hand.palm.pad.has_value() && !requested.palm;
  all.palm = requested.palm || may_add_palm;
  std::vector<int> pads = requested_pads(hand, all);
  const std::size_t num_usual = pads.size();
  const bool may_wrap = rule.may_wrap && all.palm;
  if (may_wrap) {
    for (const int finger : requested.fingers) {
      if (const std::optional<int> pad = pad_before_tip(hand, finger)) pads.push_back(*pad);
    }
  }
  const std::size_t num_before_ends = pads.size();
  if (rule.may_use_ends) {
    for (const int finger : requested.fingers) {
      if (const std::optional<int> pad = end_pad(hand, finger)) pads.push_back(*pad);
    }
  }
  for (hands::PadSamples& samples : hands::pad_samples(hand, pads, kMostSamples, rule.along_pads)) {
    Part& part = parts_.emplace_back();
    part.finger = hand.pads[samples.pad].finger;
    if (parts_.size() > num_usual) part.other_pad = samples.pad;
    part.samples = std::move(samples);
  }
  const std::size_t num_asked = requested.fingers.size();
  const std::size_t palm = all.fingers.size();
  std::vector<std::size_t> asked(num_asked);
  std::iota(asked.begin(), asked.end(), 0);
  const auto finger_sets = [&](std::size_t size) {
    std::vector<std::vector<std::size_t>> sets = sets_with_first(palm, size);
    std::erase_if(sets, [&](const std::vector<std::size_t>& set) {
      return !rule.may_exchange &&
             !std::includes(set.begin(), set.end(), asked.begin(), asked.end());
    });
    return sets;
  };
  for (const std::vector<std::size_t>& set : finger_sets(num_asked)) {
    std::vector<std::size_t> with_palm = set;
    with_palm.push_back(palm);
    if (!requested.palm) add(set);
    if (all.palm) add(std::move(with_palm));
  }
  if (rule.may_add_finger && !requested.palm) {
    for (std::vector<std::size_t>& set : finger_sets(num_asked + 1)) add(std::move(set));
  }
  if (rule.may_drop_finger && num_asked > 3) {
    for (std::vector<std::size_t>& set : sets_with_first(num_asked, num_asked - 1)) {
      if (requested.palm) set.push_back(palm);
      add(std::move(set));
    }
  }
  if (num_before_ends > num_usual) {
    std::vector<std::size_t> wrap = with_other_pads(num_usual, num_before_ends, requested.fingers);
    wrap.push_back(palm);
    add(std::move(wrap));
  }
  if (parts_.size() > num_before_ends && !requested.palm) {
    add(with_other_pads(num_before_ends, parts_.size(), requested.fingers));
  }
  if (rule.may_pair || (!rule.may_add_finger && !rule.may_add_palm)) return;
  const auto cannot_close = [](const Grip& grip) { return grip.parts.size() == 2; };
  if (!std::all_of(grips_.begin(), grips_.end(), cannot_close)) {
    std::erase_if(grips_, cannot_close);
  }
}

std::optional<hands::OpeningRange> HandGrips::square_widths(double friction) const {
  std::optional<hands::OpeningRange> range;
  for (const Pinch& pinch : pinches_) {
    const auto own = pinch.table.distances_up_to(std::atan(friction));
    if (!own) continue;
    if (!range) range = own;
    range->smallest = std::min(range->smallest, own->smallest);
    range->largest = std::max(range->largest, own->largest);
  }
  return range;
}

/// The requested fingers' parts, the parts from `first` to before `last` in their fingers' places.
std::vector<std::size_t> HandGrips::with_other_pads(std::size_t first, std::size_t last,
                                                    const std::vector<int>& fingers) const {
  std::vector<std::size_t> parts(fingers.size());
  std::iota(parts.begin(), parts.end(), 0);
  for (std::size_t other = first; other < last; ++other) {
    const auto finger = std::find(fingers.begin(), fingers.end(), *parts_[other].finger);
    parts[finger - fingers.begin()] = other;
  }
  return parts;
}

void HandGrips::add(std::vector<std::size_t> parts) {
  if (parts.size() > kMostParts) return;
  Grip grip;
  grip.parts = std::move(parts);
  grip.has_palm = !parts_[grip.parts.back()].finger;
  grip.wraps = grip.has_palm && std::any_of(grip.parts.begin(), grip.parts.end(), [&](auto part) {
                 return parts_[part].other_pad.has_value();
               });
  const std::size_t first = grip.parts.front();
  for (const std::size_t other : grip.parts) {
    if (other == first || grip.has_palm) continue;
    const auto known = std::find_if(pinches_.begin(), pinches_.end(), [&](const Pinch& pinch) {
      return pinch.part_a == first && pinch.part_b == other;
    });
    grip.pinches.push_back(static_cast<std::size_t>(known - pinches_.begin()));
    if (known != pinches_.end()) continue;
    pinches_.push_back({first, other, PinchTable(parts_[first].samples, parts_[other].samples)});
  }
  grips_.push_back(std::move(grip));
}

}  // namespace graspfit::grasp::internal
