#include "graspfit/hold_test/hold_test.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/bounded_integer.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "hold_run.hpp"
#include "physics.hpp"

namespace graspfit::hold_test {

namespace {

using Eigen::Vector3d;
using internal::HoldRun;

/// +x −x +y −y +z −z of O.
const std::array<Vector3d, 6>& six_directions() {
  static const std::array<Vector3d, 6> directions = {Vector3d::UnitX(), -Vector3d::UnitX(),
                                                     Vector3d::UnitY(), -Vector3d::UnitY(),
                                                     Vector3d::UnitZ(), -Vector3d::UnitZ()};
  return directions;
}

/// Relative accuracy to which a failing load is found; below `kLeastLoad` times the largest load it
/// counts as zero.
constexpr double kLoadTolerance = 0.02;
constexpr double kLeastLoad = 1e-4;

/// Lever arm by which the largest force of a margin becomes its largest torque [m].
constexpr double kTorqueLever = 0.1;

/// Shares of the protocol's load by which a verdict counts as near a limit.
constexpr double kLessLoad = 0.9;
constexpr double kMoreLoad = 1.1;

/// First load of the search for a failing one, over the largest load.
constexpr double kFirstLoad = 0.02;

/// The smallest load in (0, `most`] at which `holds` is false, to `kLoadTolerance`: the returned
/// one fails, unless it is `most`; 0 if a load of at most `least` fails. Assumes that a grasp which
/// holds a load holds smaller ones.
template <class Holds>
double smallest_failing(double first, double most, double least, const Holds& holds) {
  double held = 0.0;
  double failed = std::numeric_limits<double>::infinity();
  double load = std::min(first, most);
  while (true) {
    (holds(load) ? held : failed) = load;
    if (held >= most) return most;
    if (failed <= least) return 0.0;
    if (failed * (1.0 - kLoadTolerance) <= held) return failed;
    if (std::isinf(failed)) {
      load = std::min(2.0 * held, most);
    } else {
      load = held == 0.0 ? failed / 2.0 : std::sqrt(held * failed);
    }
  }
}

/// Returns the smallest failing load over six directions, and its direction. `holds(direction,
/// load)` tests a load. A direction that holds nearly the smallest failing load so far is not
/// searched further.
template <class Holds>
std::pair<double, Vector3d> weakest(double most, const Holds& holds) {
  std::pair<double, Vector3d> result = {most, Vector3d::Zero()};
  for (const Vector3d& direction : six_directions()) {
    const bool is_first = &direction == six_directions().data();
    const double first = is_first ? kFirstLoad * most : result.first * (1.0 - kLoadTolerance);
    if (first <= 0.0) break;
    const auto at = [&](double load) { return holds(direction, load); };
    if (!is_first && at(first)) continue;
    const double failing = smallest_failing(is_first ? first : first / 2.0, is_first ? most : first,
                                            kLeastLoad * most, at);
    if (failing < most) result = {failing, direction};
  }
  return result;
}

}  // namespace

/// The protocol with mass and force for this object instead of a density.
HoldProtocol with_mass(HoldProtocol protocol, const HoldObject& object) {
  if (protocol.object_density == 0.0) return protocol;
  const double mass = protocol.object_density * object.volume;
  protocol.force *= mass / protocol.object_mass;
  protocol.object_mass = mass;
  return protocol;
}

struct HoldTest::Impl {
  Impl(HoldHand hand_, HoldObject object_, HoldProtocol protocol_)
      : hand(std::move(hand_)),
        object(std::move(object_)),
        protocol(with_mass(std::move(protocol_), object)),
        physics(hand, object, protocol),
        run(physics, hand, object, protocol) {}

  int num_directions() const {
    return protocol.load == HoldLoad::SixForces ? base::as_index<int>(six_directions().size()) : 1;
  }
  Vector3d direction(int index) const {
    switch (protocol.load) {
      case HoldLoad::SixForces:
        return six_directions()[index];
      case HoldLoad::SixInTurn:
        return Vector3d::Zero();
      case HoldLoad::Lift:
        break;
    }
    return Vector3d::UnitZ();
  }
  DirectionVerdict load(int index, const HoldRun::Watch& watch = {}, double share = 1.0) {
    if (protocol.load == HoldLoad::SixInTurn)
      return run.load_in_turn(share * protocol.force, watch);
    const Vector3d force = protocol.load == HoldLoad::Lift
                               ? Vector3d(0.0, 0.0, -protocol.gravity * protocol.object_mass)
                               : Vector3d(protocol.force * direction(index));
    return run.load(direction(index), share * force, Vector3d::Zero(), watch);
  }

  HoldHand hand;
  HoldObject object;
  HoldProtocol protocol;
  internal::Physics physics;
  HoldRun run;
};

bool is_available() { return true; }

HoldTest::HoldTest(const HoldHand& hand, const HoldObject& object, const HoldProtocol& protocol) {
  protocol.validate();
  if (hand.links.size() != hand.model.links.size()) {
    throw base::InvalidInput("HoldTest: " + std::to_string(hand.links.size()) +
                             " links in pieces; hand " + hand.model.name + " has " +
                             std::to_string(hand.model.links.size()));
  }
  impl_ = std::make_unique<Impl>(hand, object, protocol);
}
HoldTest::~HoldTest() = default;
HoldTest::HoldTest(HoldTest&&) noexcept = default;
HoldTest& HoldTest::operator=(HoldTest&&) noexcept = default;

HoldVerdict HoldTest::test(const grasp::Grasp& grasp) {
  HoldVerdict verdict = impl_->run.approach(grasp);
  if (verdict.stage == HoldStage::Rejected) return verdict;
  for (int i = 0; i < impl_->num_directions(); ++i) {
    if (verdict.stage == HoldStage::Approach) {
      verdict.directions.push_back({impl_->direction(i), HoldStage::Approach, {}, 0.0, 0.0});
      continue;
    }
    verdict.directions.push_back(impl_->load(i));
    if (verdict.reason.empty()) verdict.reason = impl_->run.failure();
  }
  for (const DirectionVerdict& direction : verdict.directions) {
    verdict.stage = std::min(verdict.stage, direction.stage);
  }
  return verdict;
}

bool HoldTest::holds_at(const grasp::Grasp& grasp, double share) {
  base::require(share > 0.0 && std::isfinite(share), "HoldTest::holds_at", "share", share,
                "finite and > 0");
  bool holds = impl_->run.approach(grasp, {}, share).held();
  for (int i = 0; holds && i < impl_->num_directions(); ++i) {
    holds = impl_->load(i, {}, share).stage == HoldStage::Held;
  }
  return holds;
}

bool HoldTest::is_near_limit(const grasp::Grasp& grasp, const HoldVerdict& verdict) {
  const bool is_loaded =
      verdict.stage == HoldStage::Load || verdict.held() ||
      (verdict.stage == HoldStage::Approach && impl_->protocol.load == HoldLoad::Lift);
  if (!is_loaded) return false;
  // The likelier change comes first.
  const double first = verdict.held() ? kMoreLoad : kLessLoad;
  const double second = verdict.held() ? kLessLoad : kMoreLoad;
  return holds_at(grasp, first) != verdict.held() || holds_at(grasp, second) != verdict.held();
}

HoldMargin HoldTest::margin(const grasp::Grasp& grasp, double largest) {
  if (!impl_->protocol.has_margins()) {
    throw base::InvalidInput("HoldTest::margin: protocol " + impl_->protocol.name +
                             " does not load along six directions, each from the same state");
  }
  if (!(largest > 0.0) || !std::isfinite(largest)) {
    throw base::InvalidInput("HoldTest::margin: largest must be finite and > 0 N");
  }
  const HoldVerdict approach = impl_->run.approach(grasp);
  HoldMargin margin;
  if (approach.stage != HoldStage::Held) return margin;
  const auto is_held = [](const DirectionVerdict& verdict) {
    return verdict.stage == HoldStage::Held;
  };
  if (!is_held(impl_->run.load(Vector3d::UnitX(), Vector3d::Zero(), Vector3d::Zero()))) {
    return margin;
  }
  std::tie(margin.force, margin.force_direction_O) =
      weakest(largest, [&](const Vector3d& direction, double load) {
        return is_held(impl_->run.load(direction, load * direction, Vector3d::Zero()));
      });
  std::tie(margin.torque, margin.torque_axis_O) =
      weakest(largest * kTorqueLever, [&](const Vector3d& axis, double load) {
        return is_held(impl_->run.load(axis, Vector3d::Zero(), load * axis));
      });
  return margin;
}

std::vector<HoldFrame> HoldTest::replay(const grasp::Grasp& grasp, int direction, double interval) {
  if (direction < 0 || direction >= impl_->num_directions()) {
    throw base::InvalidInput("HoldTest::replay: direction " + std::to_string(direction) +
                             "; protocol " + impl_->protocol.name + " has " +
                             std::to_string(impl_->num_directions()));
  }
  if (!(interval > 0.0) || !std::isfinite(interval)) {
    throw base::InvalidInput("HoldTest::replay: interval must be finite and > 0 s");
  }
  std::vector<HoldFrame> frames;
  const double step = impl_->protocol.step;
  const int every =
      base::bounded_integer(std::round(interval / step), 1, std::numeric_limits<int>::max());
  int num_watched = 0;
  const auto frame = [&] {
    return HoldFrame{impl_->physics.time(), impl_->physics.X_OB(), impl_->physics.hand()};
  };
  const auto watch = [&] {
    if (num_watched++ % every == 0) frames.push_back(frame());
  };
  const HoldVerdict verdict = impl_->run.approach(grasp, watch);
  if (verdict.stage == HoldStage::Rejected) return frames;
  if (verdict.stage == HoldStage::Held) impl_->load(direction, watch);
  if ((num_watched - 1) % every != 0) frames.push_back(frame());
  return frames;
}

}  // namespace graspfit::hold_test
