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

/// Reads a hand as `read_hand` does, but goes on after every fault that allows it, and looks for
/// what a reader accepts although the author can hardly have meant it. Bad content is reported,
/// never thrown.
///
/// Faults are what `read_hand` throws: all faults of a description's links, joints and meshes, and
/// the first fault of a sidecar. After a fault nothing is derived. Checks that need the whole hand
/// are skipped after a fault, and for a hand larger than 1 m.
///
/// Suspicious findings are those of the readers (axes that are not unit in a URDF suggest a lost
/// transmission ratio; limits of no width; limits beyond a turn or a meter, and hands larger than
/// 1 m or smaller than 1 cm suggest other units), and:
/// - A hand that ends in a body without a mesh, or whose palm has none: nothing there can touch.
/// - A center of mass farther outside a link's box than half the box's diagonal, and an inertia
///   whose principal moments no body has (negative, or one larger than the other two together), or
///   whose radius of gyration is below a twentieth of the diagonal or above the diagonal: the
///   values have other units or belong to another link. The radius of gyration of a solid box is
///   0.29 of its diagonal, whatever its shape, that of a hollow box at most 0.5.
/// - Joints that look coupled and are not, where the sidecar has no list of couplings (an empty
///   list states that there are none):
///   - The last joint of a finger has less than half the range of the joint before it, which has a
///     parallel axis: this is typical of a geared distal joint (Barrett: 48 of 144 degrees).
///     Independently driven neighbors have similar ranges.
///   - Two joints on the palm do not flex but swing two fingers, which are mirror images of each
///     other, by equal ranges of a right angle or more: one drive regroups such fingers (Barrett's
///     spread). Abduction has a far smaller range.
///   - Two prismatic joints on the palm are parallel, have equal strokes and carry no further
///     joints: they are the jaws of a parallel gripper.
///   - More than 20 joints and no coupling: no built hand drives more of them one by one (the
///     Shadow hand has 24 joints and 20 motors). Up to 20 joints, this is a note that names the
///     pairs of neighbors.
/// - A closing joint that travels less than 0.1 rad or 1 mm, or whose travel takes the pad that it
///   moves backward; a finger without closing joint, or whose tip does not come nearer to the palm
///   or to any other tip by a tenth when it closes: closing signs or limits are wrong.
/// - A finger that stops within the first tenth of its closing motion because links meet that are
///   apart while the hand is open (`closing_stops`). The finding names the pair of links.
/// - A thumb and fingers between whose tips no ball fits (`hand_workspace`): they never face each
///   other. This is only a note if the thumb faces another finger.
/// - Links that overlap in the open configuration and are not excluded from collision.
///
/// Notes report what the readers did (meshes closed and how far they moved, meshes and members
/// derived), links between joints without mesh, links without mass, joints that belong to no
/// finger, and the pairs that are excluded from collision.
///
/// Cost: that of reading, one `hand_workspace` and one `closing_stops`.
/// @throws IoError only if the file cannot be read.
HandCheck check_hand(const std::filesystem::path& description_file);

}  // namespace graspfit::hands
