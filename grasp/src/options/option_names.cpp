#include "graspfit/grasp/option_names.hpp"

#include <array>

#include "graspfit/grasp/planner_result.hpp"

namespace graspfit::grasp {

using geometry::PatchAveraging;
using geometry::RepairMode;
using geometry::SelfIntersections;

template <>
std::span<const NamedValue<GraspStyle>> named_values<GraspStyle>() {
  static constexpr std::array names = {
      NamedValue<GraspStyle>{GraspStyle::Precision, "precision"},
      NamedValue<GraspStyle>{GraspStyle::Power, "power"},
  };
  return names;
}

template <>
std::span<const NamedValue<Acceptance>> named_values<Acceptance>() {
  static constexpr std::array names = {NamedValue<Acceptance>{Acceptance::Valid, "valid"},
                                       NamedValue<Acceptance>{Acceptance::Usable, "usable"}};
  return names;
}

template <>
std::span<const NamedValue<Rejection>> named_values<Rejection>() {
  static constexpr std::array names = {NamedValue<Rejection>{Rejection::None, "none"},
                                       NamedValue<Rejection>{Rejection::Deviation, "deviation"},
                                       NamedValue<Rejection>{Rejection::Quality, "quality"}};
  return names;
}

template <>
std::span<const NamedValue<MissingContact>> named_values<MissingContact>() {
  static constexpr std::array names = {
      NamedValue<MissingContact>{MissingContact::Fails, "fails"},
      NamedValue<MissingContact>{MissingContact::Measured, "measured"}};
  return names;
}

template <>
std::span<const NamedValue<ApproachSource>> named_values<ApproachSource>() {
  static constexpr std::array names = {
      NamedValue<ApproachSource>{ApproachSource::Surface, "surface"},
      NamedValue<ApproachSource>{ApproachSource::BoxRays, "box-rays"}};
  return names;
}

template <>
std::span<const NamedValue<SearchRule>> named_values<SearchRule>() {
  static constexpr std::array names = {NamedValue<SearchRule>{SearchRule::Best, "best"},
                                       NamedValue<SearchRule>{SearchRule::First, "first"}};
  return names;
}

template <>
std::span<const NamedValue<AttemptChoice>> named_values<AttemptChoice>() {
  static constexpr std::array names = {
      NamedValue<AttemptChoice>{AttemptChoice::First, "first"},
      NamedValue<AttemptChoice>{AttemptChoice::Balanced, "balanced"},
      NamedValue<AttemptChoice>{AttemptChoice::Strongest, "strongest"}};
  return names;
}

template <>
std::span<const NamedValue<PenetrationGuard>> named_values<PenetrationGuard>() {
  static constexpr std::array names = {
      NamedValue<PenetrationGuard>{PenetrationGuard::Voxels, "voxels"},
      NamedValue<PenetrationGuard>{PenetrationGuard::Meshes, "meshes"}};
  return names;
}

template <>
std::span<const NamedValue<ContactState>> named_values<ContactState>() {
  static constexpr std::array names = {
      NamedValue<ContactState>{ContactState::Closed, "closed"},
      NamedValue<ContactState>{ContactState::FirstGraze, "first-graze"}};
  return names;
}

template <>
std::span<const NamedValue<PalmAfterContact>> named_values<PalmAfterContact>() {
  static constexpr std::array names = {
      NamedValue<PalmAfterContact>{PalmAfterContact::Frozen, "frozen"},
      NamedValue<PalmAfterContact>{PalmAfterContact::Recentred, "recentred"}};
  return names;
}

template <>
std::span<const NamedValue<contact::CountedPads>> named_values<contact::CountedPads>() {
  static constexpr std::array names = {
      NamedValue<contact::CountedPads>{contact::CountedPads::All, "all"},
      NamedValue<contact::CountedPads>{contact::CountedPads::TipsAndPalm, "tips-and-palm"}};
  return names;
}

template <>
std::span<const NamedValue<contact::ContactPieces>> named_values<contact::ContactPieces>() {
  static constexpr std::array names = {
      NamedValue<contact::ContactPieces>{contact::ContactPieces::Joined, "joined"},
      NamedValue<contact::ContactPieces>{contact::ContactPieces::Separate, "separate"}};
  return names;
}

template <>
std::span<const NamedValue<PatchAveraging>> named_values<PatchAveraging>() {
  static constexpr std::array names = {
      NamedValue<PatchAveraging>{PatchAveraging::AreaWeighted, "area-weighted"},
      NamedValue<PatchAveraging>{PatchAveraging::Plain, "plain"}};
  return names;
}

template <>
std::span<const NamedValue<ScoreNormalization>> named_values<ScoreNormalization>() {
  static constexpr std::array names = {
      NamedValue<ScoreNormalization>{ScoreNormalization::FloorMedian, "floor-median"},
      NamedValue<ScoreNormalization>{ScoreNormalization::Max, "max"},
      NamedValue<ScoreNormalization>{ScoreNormalization::Raw, "raw"}};
  return names;
}

template <>
std::span<const NamedValue<PlaneDistance>> named_values<PlaneDistance>() {
  static constexpr std::array names = {
      NamedValue<PlaneDistance>{PlaneDistance::Unsigned, "unsigned"},
      NamedValue<PlaneDistance>{PlaneDistance::SignedMean, "signed-mean"}};
  return names;
}

template <>
std::span<const NamedValue<PairRule>> named_values<PairRule>() {
  static constexpr std::array names = {NamedValue<PairRule>{PairRule::Seed, "seed"},
                                       NamedValue<PairRule>{PairRule::AllPairs, "all-pairs"}};
  return names;
}

template <>
std::span<const NamedValue<contact::MeasureUnits>> named_values<contact::MeasureUnits>() {
  static constexpr std::array names = {
      NamedValue<contact::MeasureUnits>{contact::MeasureUnits::Normalized, "normalized"},
      NamedValue<contact::MeasureUnits>{contact::MeasureUnits::Centimeters, "cm"}};
  return names;
}

template <>
std::span<const NamedValue<contact::Regularity>> named_values<contact::Regularity>() {
  static constexpr std::array names = {
      NamedValue<contact::Regularity>{contact::Regularity::Combined, "combined"},
      NamedValue<contact::Regularity>{contact::Regularity::AngleOnly, "angle-only"},
      NamedValue<contact::Regularity>{contact::Regularity::EdgeOnly, "edge-only"}};
  return names;
}

template <>
std::span<const NamedValue<contact::HullCentroid>> named_values<contact::HullCentroid>() {
  static constexpr std::array names = {
      NamedValue<contact::HullCentroid>{contact::HullCentroid::Measure, "measure"},
      NamedValue<contact::HullCentroid>{contact::HullCentroid::Vertices, "vertices"}};
  return names;
}

template <>
std::span<const NamedValue<PlannerStop>> named_values<PlannerStop>() {
  static constexpr std::array names = {
      NamedValue<PlannerStop>{PlannerStop::Count, "count"},
      NamedValue<PlannerStop>{PlannerStop::Attempts, "attempts"},
      NamedValue<PlannerStop>{PlannerStop::Exhausted, "exhausted"},
      NamedValue<PlannerStop>{PlannerStop::WallClock, "wall-clock"},
      NamedValue<PlannerStop>{PlannerStop::Iterations, "iterations"},
      NamedValue<PlannerStop>{PlannerStop::Interrupted, "interrupted"}};
  return names;
}

template <>
std::span<const NamedValue<TargetSearch>> named_values<TargetSearch>() {
  static constexpr std::array names = {NamedValue<TargetSearch>{TargetSearch::Random, "random"},
                                       NamedValue<TargetSearch>{TargetSearch::Ranked, "ranked"}};
  return names;
}

template <>
std::span<const NamedValue<contact::WrenchTool>> named_values<contact::WrenchTool>() {
  static constexpr std::array names = {
      NamedValue<contact::WrenchTool>{contact::WrenchTool::House, "house"},
      NamedValue<contact::WrenchTool>{contact::WrenchTool::GraspIt, "graspit"},
      NamedValue<contact::WrenchTool>{contact::WrenchTool::Simox, "simox"},
      NamedValue<contact::WrenchTool>{contact::WrenchTool::DexNet, "dex-net"},
      NamedValue<contact::WrenchTool>{contact::WrenchTool::Frogger, "frogger"},
      NamedValue<contact::WrenchTool>{contact::WrenchTool::DexGraspBench, "dexgraspbench"}};
  return names;
}

template <>
std::span<const NamedValue<contact::ForceNorm>> named_values<contact::ForceNorm>() {
  static constexpr std::array names = {
      NamedValue<contact::ForceNorm>{contact::ForceNorm::L1, "l1"}};
  return names;
}

template <>
std::span<const NamedValue<contact::ForceScaling>> named_values<contact::ForceScaling>() {
  static constexpr std::array names = {
      NamedValue<contact::ForceScaling>{contact::ForceScaling::UnitNormal, "unit-normal"},
      NamedValue<contact::ForceScaling>{contact::ForceScaling::UnitEdge, "unit-edge"}};
  return names;
}

template <>
std::span<const NamedValue<contact::OutsideValue>> named_values<contact::OutsideValue>() {
  static constexpr std::array names = {
      NamedValue<contact::OutsideValue>{contact::OutsideValue::Zero, "zero"},
      NamedValue<contact::OutsideValue>{contact::OutsideValue::MinusOne, "minus-one"},
      NamedValue<contact::OutsideValue>{contact::OutsideValue::Signed, "signed"}};
  return names;
}

template <>
std::span<const NamedValue<RepairMode>> named_values<RepairMode>() {
  static constexpr std::array names = {NamedValue<RepairMode>{RepairMode::Repair, "repair"},
                                       NamedValue<RepairMode>{RepairMode::Strict, "strict"},
                                       NamedValue<RepairMode>{RepairMode::AsIs, "as-is"}};
  return names;
}

template <>
std::span<const NamedValue<SelfIntersections>> named_values<SelfIntersections>() {
  static constexpr std::array names = {
      NamedValue<SelfIntersections>{SelfIntersections::Leave, "leave"},
      NamedValue<SelfIntersections>{SelfIntersections::Report, "report"},
      NamedValue<SelfIntersections>{SelfIntersections::Resolve, "resolve"}};
  return names;
}

}  // namespace graspfit::grasp
