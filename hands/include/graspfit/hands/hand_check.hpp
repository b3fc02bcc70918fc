#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "graspfit/hands/hand_finding.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Everything that is missing or suspicious about a hand, in one report.
struct HandCheck {
  std::optional<HandModel> model;     ///< Empty if a fault keeps the hand from being used.
  std::vector<HandFinding> findings;  ///< Faults, then suspicious, then notes.

  /// The number of findings of a kind.
  std::size_t count(FindingKind kind) const;
};

/// Reads a hand as `read_hand` does, but goes on after every fault that lets it, and looks for what
/// a reader accepts and its author hardly meant. Bad content is reported, never thrown.
///
/// Faults are those of `read_hand`, all of a description's links, joints and meshes, and the first
/// of a sidecar. After a fault nothing is derived, and what needs the whole hand is not looked at,
/// nor is it of a hand larger than 1 m.
///
/// Suspicious, beside what the readers notice (axes that are not unit in a URDF: a lost
/// transmission ratio; limits of no width; limits beyond a turn or a meter, hands larger than 1 m
/// or smaller than 1 cm: other units):
/// - A hand that ends in a body without a mesh, or whose palm has none: nothing there can touch.
/// - Center of mass farther outside a link's box than half its diagonal, and inertia whose
///   principal moments no body has (negative, or one larger than the other two together), or whose
///   radius of gyration is below a twentieth of the diagonal or above all of it: other units, or
///   another link's. A solid box has 0.29 of it, whatever its shape, a hollow one at most 0.5.
/// - Joints that look coupled and are not, where the sidecar says nothing of couplings (an empty
///   list there says: none):
///   - The last joint of a finger has less than half the range of the one before it about a
///     parallel axis: the mark of a geared end joint (Barrett: 48 of 144 degrees). Independently
///     driven neighbors have like ranges.
///   - Two joints on the palm swing mirror images of one finger by a right angle or more, apart
///     from flexing: such fingers are regrouped by one drive (Barrett's spread). Abduction is far
///     narrower.
///   - Two sliding joints on the palm, parallel, of equal stroke and with nothing behind them: the
///     jaws of a parallel gripper.
///   - More than 20 joints and no coupling: no built hand drives more one by one (the Shadow hand
///     has 24 joints and 20 motors). Up to 20 it is a note that names the pairs.
/// - A closing joint that travels less than 0.1 rad or 1 mm, or whose travel takes the pad that it
///   moves backward; a finger without closing joint, or whose tip does not come nearer to the palm
///   or to any other tip by a tenth when it closes: closing signs or limits.
/// - A finger that closing leaves within a tenth of its way from open because links meet that are
///   apart while the hand is open (`closing_stops`): such pairs are named.
/// - Thumb and fingers between whose tips no ball fits (`hand_workspace`): they do not meet. If the
///   thumb meets another finger, it is a note.
/// - Links that overlap in the open configuration and are not excluded from collision.
///
/// Notes: what the readers did (meshes closed and how far they moved, meshes and members derived),
/// links between joints without mesh, links without mass, joints of no finger, the pairs that are
/// excluded from collision.
///
/// Cost: that of reading, one `hand_workspace` and one `closing_stops`.
/// @throws IoError only if the file cannot be read.
HandCheck check_hand(const std::filesystem::path& description_file);

}  // namespace graspfit::hands
