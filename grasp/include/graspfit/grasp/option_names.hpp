#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/grasp/contact_score_map.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/grasp/target_contacts.hpp"

/// \file
/// What the choices of the planner and of its measures are called in grasp files and on the command
/// line.

namespace graspfit::grasp {

/// One value of an enumeration and its name, such as "floor-median".
template <class Enum>
struct NamedValue {
  Enum value;
  std::string_view name;
};

/// All values of an enumeration of the planner and of wrench conventions, in their order of
/// declaration. Defined for the types listed below; no others link.
template <class Enum>
std::span<const NamedValue<Enum>> named_values();

template <>
std::span<const NamedValue<GraspStyle>> named_values<GraspStyle>();
template <>
std::span<const NamedValue<Acceptance>> named_values<Acceptance>();
template <>
std::span<const NamedValue<MissingContact>> named_values<MissingContact>();
template <>
std::span<const NamedValue<ApproachSource>> named_values<ApproachSource>();
template <>
std::span<const NamedValue<SearchRule>> named_values<SearchRule>();
template <>
std::span<const NamedValue<AttemptChoice>> named_values<AttemptChoice>();
template <>
std::span<const NamedValue<PenetrationGuard>> named_values<PenetrationGuard>();
template <>
std::span<const NamedValue<Rejection>> named_values<Rejection>();
template <>
std::span<const NamedValue<ContactState>> named_values<ContactState>();
template <>
std::span<const NamedValue<PalmAfterContact>> named_values<PalmAfterContact>();
template <>
std::span<const NamedValue<contact::CountedPads>> named_values<contact::CountedPads>();
template <>
std::span<const NamedValue<contact::ContactPieces>> named_values<contact::ContactPieces>();
template <>
std::span<const NamedValue<geometry::PatchAveraging>> named_values<geometry::PatchAveraging>();
template <>
std::span<const NamedValue<ScoreNormalization>> named_values<ScoreNormalization>();
template <>
std::span<const NamedValue<PlaneDistance>> named_values<PlaneDistance>();
template <>
std::span<const NamedValue<PairRule>> named_values<PairRule>();
template <>
std::span<const NamedValue<contact::MeasureUnits>> named_values<contact::MeasureUnits>();
template <>
std::span<const NamedValue<contact::Regularity>> named_values<contact::Regularity>();
template <>
std::span<const NamedValue<contact::HullCentroid>> named_values<contact::HullCentroid>();
template <>
std::span<const NamedValue<PlannerStop>> named_values<PlannerStop>();
template <>
std::span<const NamedValue<TargetSearch>> named_values<TargetSearch>();
template <>
std::span<const NamedValue<contact::WrenchTool>> named_values<contact::WrenchTool>();
template <>
std::span<const NamedValue<contact::ForceNorm>> named_values<contact::ForceNorm>();
template <>
std::span<const NamedValue<contact::ForceScaling>> named_values<contact::ForceScaling>();
template <>
std::span<const NamedValue<contact::OutsideValue>> named_values<contact::OutsideValue>();
template <>
std::span<const NamedValue<geometry::RepairMode>> named_values<geometry::RepairMode>();
template <>
std::span<const NamedValue<geometry::SelfIntersections>>
named_values<geometry::SelfIntersections>();

/// The name of a value; empty for a value that the enumeration does not have.
template <class Enum>
std::string_view name_of(Enum value) {
  for (const NamedValue<Enum>& named : named_values<Enum>()) {
    if (named.value == value) return named.name;
  }
  return {};
}

/// The value of a name, if there is one.
template <class Enum>
std::optional<Enum> value_named(std::string_view name) {
  for (const NamedValue<Enum>& named : named_values<Enum>()) {
    if (named.name == name) return named.value;
  }
  return std::nullopt;
}

/// All names as "a|b|c", for messages.
template <class Enum>
std::string names_of() {
  std::string names;
  for (const NamedValue<Enum>& named : named_values<Enum>()) {
    if (!names.empty()) names += '|';
    names += named.name;
  }
  return names;
}

}  // namespace graspfit::grasp
