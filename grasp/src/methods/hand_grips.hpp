#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/pad_samples.hpp"
#include "graspfit/hands/pinch_chart.hpp"

/// \file
/// What a hand can do, as look-ups: where its pads can be, which pairs of pads can face each other
/// at which distance, and which parts touch together.

namespace graspfit::grasp::internal {

/// Pairs of samples of two pads by the distance of their contact points and by how far the pads
/// lean against the line between these.
class PinchTable {
 public:
  PinchTable(const hands::PadSamples& a, const hands::PadSamples& b);

  /// Whether `draw` may know a pair whose pads lean so at this distance: its cheap first question.
  /// @param along_a, along_b of the pads' normals, the parts along the line between them [m]
  bool may_have(double distance, double along_a, double along_b, bool may_lean) const;

  /// A pair, sample of a and of b, of about this distance [m] and these leans [rad] (within 5 mm
  /// and 9 degrees); empty if there is none. @param may_lean where there is none, one of jaws
  /// that leans by up to 18 degrees less may do: they always face each other
  std::optional<std::pair<std::int32_t, std::int32_t>> draw(double distance, double lean_a,
                                                            double lean_b, base::Random& random,
                                                            bool may_lean = false) const;

  /// The smallest and largest distance at which neither pad need lean more than `lean` [rad], to
  /// 5 mm; between them it may not be so everywhere. Empty if there is none.
  std::optional<hands::OpeningRange> distances_up_to(double lean) const;

 private:
  bool are_jaws_;                   ///< Moved by the same joints.
  std::vector<double> least_lean_;  ///< Per class of distances: of the pad that leans more [rad].
  std::vector<std::vector<std::pair<std::int32_t, std::int32_t>>> classes_;
};

/// Which parts may touch beside the requested ones.
struct GripRule {
  bool may_add_finger = false;
  bool may_add_palm = false;
  bool may_exchange = false;  ///< Other fingers instead of the requested ones but the first.
  /// A finger less, never the first, where three parts are left: on what is narrow over a table
  /// four fingertips crowd.
  bool may_drop_finger = false;
  /// Long pads may touch anywhere from their middles to their ends.
  bool along_pads = false;
  /// Grips of two parts stay beside those that can close: by its palm, a gripper that stands above
  /// a table does not reach what is low.
  bool may_pair = false;
  /// The palm together with the pads behind the requested fingers' tips instead of these, where the
  /// palm may touch.
  bool may_wrap = false;
  /// The ends of the requested fingers instead of their tips' pads: second pads of the tips' links.
  bool may_use_ends = false;
};

/// The parts of a hand that may touch, and the grips: which of them touch together.
class HandGrips {
 public:
  /// A part that may touch, and where it can be.
  struct Part {
    std::optional<int> finger;     ///< Empty: the palm.
    std::optional<int> other_pad;  ///< Of the finger; empty: its tip's.
    hands::PadSamples samples;
  };
  struct Pinch {
    std::size_t part_a = 0;
    std::size_t part_b = 0;
    PinchTable table;
  };
  struct Grip {
    std::vector<std::size_t> parts;    ///< In the order of the targets: fingers, then the palm.
    std::vector<std::size_t> pinches;  ///< Of the first finger with the others; none with the palm.
    bool has_palm = false;
    bool wraps = false;  ///< With pads behind tips.
  };

  /// Grips of the requested parts, and others that the rule allows where the hand has them with
  /// pads: with the palm or a finger more, not both, or wrapped around the object: with the palm
  /// and, of each requested finger that has one, the last pad before its tip's link; or with all of
  /// their ends. No more than `kMostParts` parts. Two contacts cannot close, so that where parts
  /// may be added there are grips of two only if the hand has no others or the rule allows them. At
  /// least one finger is requested.
  HandGrips(const hands::HandModel& hand, const RequestedParts& requested, const GripRule& rule);

  const std::vector<Part>& parts() const { return parts_; }
  const std::vector<Pinch>& pinches() const { return pinches_; }
  const std::vector<Grip>& grips() const { return grips_; }

  /// What two fingertips of the hand can pinch squarely at a friction, from the narrowest to the
  /// widest (`PinchTable::distances_up_to`); empty for nothing.
  std::optional<hands::OpeningRange> square_widths(double friction) const;

 private:
  void add(std::vector<std::size_t> parts);
  std::vector<std::size_t> with_other_pads(std::size_t first, std::size_t last,
                                           const std::vector<int>& fingers) const;

  std::vector<Part> parts_;
  std::vector<Pinch> pinches_;
  std::vector<Grip> grips_;
};

}  // namespace graspfit::grasp::internal
