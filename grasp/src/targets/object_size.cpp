#include "targets/object_size.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "graspfit/base/number_text.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {
namespace {

using base::shortest_decimal;

/// Shorter side of the box around a pad's outline [m].
double pad_width(const hands::ContactPad& pad) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : pad.outline) box.extend(corner);
  return box.sizes().minCoeff();
}

std::string extents_of(const geometry::TriangleMesh& mesh) {
  const Eigen::Vector3d size = geometry::bounding_box(mesh).sizes();
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text += (axis > 0 ? " x " : "") + shortest_decimal(std::round(size[axis] * 1e6) / 1e6);
  }
  return text + " m";
}

std::string in_tenths_of_millimeters(double length) {
  return shortest_decimal(std::round(length * 1e4) / 1e4) + " m";
}

/// Largest distance between two of the parts in any posture [m].
double widest_opening(const hands::HandModel& hand, const RequestedParts& parts) {
  const PartDistances distances = part_distances(hand, parts);
  double widest = 0.0;
  for (const int a : parts.fingers) {
    for (const int b : parts.fingers) {
      widest = std::max(widest, distances.tip_to_tip[a][b].largest);
    }
    if (parts.palm) widest = std::max(widest, distances.palm_to_tip[a].largest);
  }
  return widest;
}

/// Largest distance between two fingertips of the open hand [m].
double open_width(const hands::HandModel& hand, const std::vector<int>& fingers) {
  const std::vector<hands::RigidTransform> X_HL =
      hands::forward_kinematics(hand, hands::open_configuration(hand));
  double widest = 0.0;
  for (const int a : fingers) {
    for (const int b : fingers) {
      const auto tip = [&](int finger) {
        return hands::pad_contact_point(hand, hand.tip_pad_of(finger), X_HL);
      };
      widest = std::max(widest, (tip(a) - tip(b)).norm());
    }
  }
  return widest;
}

}  // namespace

double fingertip_width(const hands::HandModel& hand, const std::vector<int>& fingers) {
  double width = 0.0;
  for (const int finger : fingers) {
    width = std::max(width, pad_width(hand.pads[*hand.fingers[finger].tip_pad]));
  }
  return width;
}

std::optional<std::string> size_refusal(const geometry::TriangleMesh& mesh,
                                        const hands::HandModel& hand, const RequestedParts& parts) {
  // No hand has fingertips wider than the first, or opens less than the second: such a hand is in
  // another unit.
  constexpr double kWidestFingertip = 0.1;     // [m]
  constexpr double kNarrowestOpening = 0.005;  // [m]
  const double smallest = fingertip_width(hand, parts.fingers);
  const double thickness = geometry::bounding_box(mesh).sizes().minCoeff();
  // To search all postures takes a tenth of a second, and the open hand nearly always suffices.
  double widest = open_width(hand, parts.fingers);
  if (widest < std::max(thickness, kNarrowestOpening)) {
    widest = std::max(widest, widest_opening(hand, parts));
  }
  const std::string advice =
      smallest > kWidestFingertip || widest < kNarrowestOpening
          ? "; the hand's lengths look like another unit than meters (graspfit hand check)"
          : "; if the file is not in meters, say its unit (--mesh-unit) or its size (--longest)";
  if (thickness > widest) {
    return "the object measures " + extents_of(mesh) + ", hand " + hand.name + " spans at most " +
           in_tenths_of_millimeters(widest) + advice;
  }
  if (geometry::longest_extent(mesh) < smallest) {
    return "the object measures " + extents_of(mesh) + ", less than one fingertip of hand " +
           hand.name + " (" + in_tenths_of_millimeters(smallest) + ")" + advice;
  }
  return std::nullopt;
}

}  // namespace graspfit::grasp::internal
