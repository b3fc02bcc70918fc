#pragma once

#include <array>
#include <string>

#include "graspfit/geometry/everyday_shapes.hpp"
#include "shapes/shape_limits.hpp"

/// \file
/// The dimensions of everyday shapes as lists: one place that knows their names.

namespace graspfit::geometry::internal {

/// A dimension and its name.
template <class Dimensions>
struct DimensionField {
  const char* name;
  double Dimensions::*member;
};

#define GRASPFIT_FIELD(type, name) \
  DimensionField<type> { #name, &type::name }

inline constexpr std::array kBottleFields = {GRASPFIT_FIELD(BottleDimensions, height),
                                             GRASPFIT_FIELD(BottleDimensions, body_diameter),
                                             GRASPFIT_FIELD(BottleDimensions, neck_diameter),
                                             GRASPFIT_FIELD(BottleDimensions, shoulder_bottom),
                                             GRASPFIT_FIELD(BottleDimensions, shoulder_top),
                                             GRASPFIT_FIELD(BottleDimensions, shoulder_radius),
                                             GRASPFIT_FIELD(BottleDimensions, base_radius),
                                             GRASPFIT_FIELD(BottleDimensions, lip_radius)};
inline constexpr std::array kBowlingPinFields = {GRASPFIT_FIELD(BowlingPinDimensions, height)};
inline constexpr std::array kFlowerPotFields = {GRASPFIT_FIELD(FlowerPotDimensions, height),
                                                GRASPFIT_FIELD(FlowerPotDimensions, top_diameter),
                                                GRASPFIT_FIELD(FlowerPotDimensions, base_diameter),
                                                GRASPFIT_FIELD(FlowerPotDimensions, wall_thickness),
                                                GRASPFIT_FIELD(FlowerPotDimensions, rim_height),
                                                GRASPFIT_FIELD(FlowerPotDimensions, rim_thickness),
                                                GRASPFIT_FIELD(FlowerPotDimensions, edge_radius)};
inline constexpr std::array kMugFields = {GRASPFIT_FIELD(MugDimensions, height),
                                          GRASPFIT_FIELD(MugDimensions, diameter),
                                          GRASPFIT_FIELD(MugDimensions, wall_thickness),
                                          GRASPFIT_FIELD(MugDimensions, base_radius),
                                          GRASPFIT_FIELD(MugDimensions, handle_height),
                                          GRASPFIT_FIELD(MugDimensions, handle_clearance),
                                          GRASPFIT_FIELD(MugDimensions, handle_thickness),
                                          GRASPFIT_FIELD(MugDimensions, handle_radius),
                                          GRASPFIT_FIELD(MugDimensions, fillet)};
inline constexpr std::array kBowlingBallFields = {
    GRASPFIT_FIELD(BowlingBallDimensions, diameter),
    GRASPFIT_FIELD(BowlingBallDimensions, finger_diameter),
    GRASPFIT_FIELD(BowlingBallDimensions, finger_depth),
    GRASPFIT_FIELD(BowlingBallDimensions, finger_spacing),
    GRASPFIT_FIELD(BowlingBallDimensions, thumb_diameter),
    GRASPFIT_FIELD(BowlingBallDimensions, thumb_depth),
    GRASPFIT_FIELD(BowlingBallDimensions, span),
    GRASPFIT_FIELD(BowlingBallDimensions, edge_radius)};
inline constexpr std::array kOctopusFields = {GRASPFIT_FIELD(OctopusDimensions, height),
                                              GRASPFIT_FIELD(OctopusDimensions, mantle_diameter),
                                              GRASPFIT_FIELD(OctopusDimensions, mantle_height),
                                              GRASPFIT_FIELD(OctopusDimensions, arm_reach),
                                              GRASPFIT_FIELD(OctopusDimensions, arm_root_diameter),
                                              GRASPFIT_FIELD(OctopusDimensions, arm_tip_diameter),
                                              GRASPFIT_FIELD(OctopusDimensions, fillet)};
inline constexpr std::array kWireCageFields = {GRASPFIT_FIELD(WireCageDimensions, width),
                                               GRASPFIT_FIELD(WireCageDimensions, depth),
                                               GRASPFIT_FIELD(WireCageDimensions, height),
                                               GRASPFIT_FIELD(WireCageDimensions, frame_diameter),
                                               GRASPFIT_FIELD(WireCageDimensions, bar_diameter),
                                               GRASPFIT_FIELD(WireCageDimensions, corner_radius),
                                               GRASPFIT_FIELD(WireCageDimensions, fillet)};
inline constexpr std::array kBinFields = {
    GRASPFIT_FIELD(BinDimensions, inner_length), GRASPFIT_FIELD(BinDimensions, inner_width),
    GRASPFIT_FIELD(BinDimensions, inner_height), GRASPFIT_FIELD(BinDimensions, wall_thickness)};
inline constexpr std::array kTableFields = {
    GRASPFIT_FIELD(TableDimensions, length),    GRASPFIT_FIELD(TableDimensions, width),
    GRASPFIT_FIELD(TableDimensions, height),    GRASPFIT_FIELD(TableDimensions, top_thickness),
    GRASPFIT_FIELD(TableDimensions, leg_width), GRASPFIT_FIELD(TableDimensions, leg_inset)};

#undef GRASPFIT_FIELD

template <class Dimensions, std::size_t n>
void require_positive(const std::string& shape, const Dimensions& dimensions,
                      const std::array<DimensionField<Dimensions>, n>& fields) {
  for (const auto& field : fields) require_positive(shape, field.name, dimensions.*field.member);
}

}  // namespace graspfit::geometry::internal
