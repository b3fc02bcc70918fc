#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "graspfit/base/list_text.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
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
template <class Enum>
NamedValue(Enum, const char*) -> NamedValue<Enum>;

/// All values of an enumeration with their names, in the order of declaration. The specializations
/// below are for the enumerations of the planner, of its measures, of wrench conventions and of
/// mesh repair; use with any other enumeration does not compile.
template <class Enum>
inline constexpr auto kNames = nullptr;
template <>
inline constexpr std::array kNames<GraspStyle> = {NamedValue{GraspStyle::Precision, "precision"},
                                                  NamedValue{GraspStyle::Power, "power"},
                                                  NamedValue{GraspStyle::Auto, "auto"}};
template <>
inline constexpr std::array kNames<Acceptance> = {NamedValue{Acceptance::Valid, "valid"},
                                                  NamedValue{Acceptance::Usable, "usable"}};
template <>
inline constexpr std::array kNames<MissingContact> = {
    NamedValue{MissingContact::Fails, "fails"}, NamedValue{MissingContact::Measured, "measured"}};
template <>
inline constexpr std::array kNames<ApproachSource> = {
    NamedValue{ApproachSource::Surface, "surface"},
    NamedValue{ApproachSource::BoxRays, "box-rays"}};
template <>
inline constexpr std::array kNames<SearchRule> = {NamedValue{SearchRule::Best, "best"},
                                                  NamedValue{SearchRule::First, "first"},
                                                  NamedValue{SearchRule::Closed, "closed"}};
template <>
inline constexpr std::array kNames<RankRule> = {NamedValue{RankRule::M, "m"},
                                                NamedValue{RankRule::Epsilon, "epsilon"},
                                                NamedValue{RankRule::Margin, "margin"}};
template <>
inline constexpr std::array kNames<IdleFingers> = {NamedValue{IdleFingers::Stay, "stay"},
                                                   NamedValue{IdleFingers::Close, "close"}};
template <>
inline constexpr std::array kNames<CandidateOrder> = {
    NamedValue{CandidateOrder::Pads, "pads"}, NamedValue{CandidateOrder::Balance, "balance"}};
template <>
inline constexpr std::array kNames<KeptCandidate> = {
    NamedValue{KeptCandidate::First, "first"}, NamedValue{KeptCandidate::Balanced, "balanced"},
    NamedValue{KeptCandidate::Strongest, "strongest"},
    NamedValue{KeptCandidate::Firmest, "firmest"}};
template <>
inline constexpr std::array kNames<PenetrationGuard> = {
    NamedValue{PenetrationGuard::Voxels, "voxels"}, NamedValue{PenetrationGuard::Meshes, "meshes"}};
template <>
inline constexpr std::array kNames<Rejection> = {NamedValue{Rejection::None, "none"},
                                                 NamedValue{Rejection::Deviation, "deviation"},
                                                 NamedValue{Rejection::Quality, "quality"}};
template <>
inline constexpr std::array kNames<ContactState> = {
    NamedValue{ContactState::Closed, "closed"},
    NamedValue{ContactState::FirstGraze, "first-graze"}};
template <>
inline constexpr std::array kNames<PalmAfterContact> = {
    NamedValue{PalmAfterContact::Frozen, "frozen"},
    NamedValue{PalmAfterContact::Recentred, "recentred"}};
template <>
inline constexpr std::array kNames<contact::CountedPads> = {
    NamedValue{contact::CountedPads::All, "all"},
    NamedValue{contact::CountedPads::TipsAndPalm, "tips-and-palm"}};
template <>
inline constexpr std::array kNames<contact::ContactPieces> = {
    NamedValue{contact::ContactPieces::Joined, "joined"},
    NamedValue{contact::ContactPieces::Separate, "separate"}};
template <>
inline constexpr std::array kNames<contact::ContactFaces> = {
    NamedValue{contact::ContactFaces::All, "all"},
    NamedValue{contact::ContactFaces::Facing, "facing"}};
template <>
inline constexpr std::array kNames<geometry::PatchAveraging> = {
    NamedValue{geometry::PatchAveraging::AreaWeighted, "area-weighted"},
    NamedValue{geometry::PatchAveraging::Plain, "plain"}};
template <>
inline constexpr std::array kNames<ScoreNormalization> = {
    NamedValue{ScoreNormalization::FloorMedian, "floor-median"},
    NamedValue{ScoreNormalization::Max, "max"}, NamedValue{ScoreNormalization::Raw, "raw"}};
template <>
inline constexpr std::array kNames<PlaneDistance> = {
    NamedValue{PlaneDistance::Unsigned, "unsigned"},
    NamedValue{PlaneDistance::SignedMean, "signed-mean"}};
template <>
inline constexpr std::array kNames<PairRule> = {NamedValue{PairRule::Seed, "seed"},
                                                NamedValue{PairRule::AllPairs, "all-pairs"}};
template <>
inline constexpr std::array kNames<contact::MeasureUnits> = {
    NamedValue{contact::MeasureUnits::Normalized, "normalized"},
    NamedValue{contact::MeasureUnits::Centimeters, "cm"}};
template <>
inline constexpr std::array kNames<contact::Regularity> = {
    NamedValue{contact::Regularity::Combined, "combined"},
    NamedValue{contact::Regularity::AngleOnly, "angle-only"},
    NamedValue{contact::Regularity::EdgeOnly, "edge-only"}};
template <>
inline constexpr std::array kNames<contact::HullCentroid> = {
    NamedValue{contact::HullCentroid::Measure, "measure"},
    NamedValue{contact::HullCentroid::Vertices, "vertices"}};
template <>
inline constexpr std::array kNames<PlannerStop> = {
    NamedValue{PlannerStop::Count, "count"},
    NamedValue{PlannerStop::Attempts, "attempts"},
    NamedValue{PlannerStop::Exhausted, "exhausted"},
    NamedValue{PlannerStop::WallClock, "wall-clock"},
    NamedValue{PlannerStop::Iterations, "iterations"},
    NamedValue{PlannerStop::Interrupted, "interrupted"}};
template <>
inline constexpr std::array kNames<TargetSearch> = {NamedValue{TargetSearch::Random, "random"},
                                                    NamedValue{TargetSearch::Ranked, "ranked"},
                                                    NamedValue{TargetSearch::Reach, "reach"}};
template <>
inline constexpr std::array kNames<contact::WrenchTool> = {
    NamedValue{contact::WrenchTool::Graspfit, "graspfit"},
    NamedValue{contact::WrenchTool::GraspIt, "graspit"},
    NamedValue{contact::WrenchTool::Simox, "simox"},
    NamedValue{contact::WrenchTool::DexNet, "dex-net"},
    NamedValue{contact::WrenchTool::Frogger, "frogger"},
    NamedValue{contact::WrenchTool::DexGraspBench, "dexgraspbench"}};
template <>
inline constexpr std::array kNames<contact::ForceScaling> = {
    NamedValue{contact::ForceScaling::UnitNormal, "unit-normal"},
    NamedValue{contact::ForceScaling::UnitEdge, "unit-edge"}};
template <>
inline constexpr std::array kNames<contact::OutsideValue> = {
    NamedValue{contact::OutsideValue::Zero, "zero"},
    NamedValue{contact::OutsideValue::MinusOne, "minus-one"},
    NamedValue{contact::OutsideValue::Signed, "signed"}};
template <>
inline constexpr std::array kNames<geometry::RepairMode> = {
    NamedValue{geometry::RepairMode::Repair, "repair"},
    NamedValue{geometry::RepairMode::Strict, "strict"},
    NamedValue{geometry::RepairMode::AsIs, "as-is"}};
template <>
inline constexpr std::array kNames<geometry::SelfIntersections> = {
    NamedValue{geometry::SelfIntersections::Leave, "leave"},
    NamedValue{geometry::SelfIntersections::Report, "report"},
    NamedValue{geometry::SelfIntersections::Resolve, "resolve"}};

template <class Enum>
constexpr std::span<const NamedValue<Enum>> named_values() {
  return kNames<Enum>;
}

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
  return base::list_text(named_values<Enum>(), &NamedValue<Enum>::name, "|");
}

}  // namespace graspfit::grasp
