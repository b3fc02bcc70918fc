#include "graspfit/grasp/finger_assignment.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fitting/finger_alignment.hpp"
#include "fitting/finger_swing.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::grasp {

TargetContacts assign_fingers(const hands::HandModel& hand, const TargetContacts& targets,
                              const RequestedParts& parts, const PalmPlacement& placement) {
  if (parts.size() != std::ssize(targets.contacts)) {
    throw base::InvalidInput("assign_fingers: " + std::to_string(parts.size()) + " parts for " +
                             std::to_string(targets.contacts.size()) + " targets");
  }
  if (parts.palm != targets.contacts.back().is_palm) {
    throw base::InvalidInput(
        "assign_fingers: the palm's target must be there exactly if the palm is asked for, and be "
        "the last one");
  }
  TargetContacts assigned = targets;
  std::vector<int> order = parts.fingers;
  std::sort(order.begin() + 1, order.end());
  const auto assign = [&] {
    for (std::size_t t = 0; t < order.size(); ++t) assigned.contacts[t].finger = order[t];
  };
  assign();
  // The hand's pose depends on the seed and on which fingers have targets, not on which finger has
  // which target; a finger's error depends on the targets of its own group (fingers that swing by
  // the same joint) alone.
  const hands::HandConfiguration start =
      internal::aligned_open_hand(hand, assigned, placement, hands::largest_reach(hand));
  std::map<std::vector<internal::FingerTarget>, double> known;
  const auto error_of = [&](std::optional<int> leader, std::vector<internal::FingerTarget> pairs) {
    if (const auto found = known.find(pairs); found != known.end()) return found->second;
    double error = 0.0;
    hands::HandConfiguration swung = start;
    if (leader) {
      swung.q[*leader] = internal::best_swing(hand, start, assigned, *leader, pairs);
      hands::apply_couplings(hand, swung.q);
    }
    for (const internal::FingerTarget& pair : pairs) {
      if (pair.target == 0) continue;  // the hand was turned to the seed
      const double e = internal::AzimuthOfFinger(hand, pair.finger)
                           .error(swung, assigned.contacts[pair.target].point_O);
      error += e * e;
    }
    known[std::move(pairs)] = error;
    return error;
  };
  std::vector<int> best = order;
  double best_error = std::numeric_limits<double>::infinity();
  do {
    assign();
    double error = 0.0;
    for (const auto& [leader, pairs] : internal::pairs_by_leader(hand, assigned)) {
      error += error_of(leader, pairs);
    }
    if (error < best_error) {
      best_error = error;
      best = order;
    }
  } while (std::next_permutation(order.begin() + 1, order.end()));
  order = best;
  assign();
  return assigned;
}

}  // namespace graspfit::grasp
