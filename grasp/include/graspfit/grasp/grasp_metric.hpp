#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/contact/contact.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/pose_robustness.hpp"
#include "graspfit/hands/hand_model.hpp"

/// \file
/// Numbers that say how good a grasp is, by name. One metric is one function of the facts about a
/// grasp; grasp/README.md shows how to add one.

namespace graspfit::grasp {

struct PlannerOptions;

/// Everything that a metric may depend on. Contacts and the object's scales are enough for most
/// metrics; a metric has no value where a fact that it needs is not given. Everything pointed at
/// must outlive this.
struct GraspMetricFacts {
  std::vector<contact::Contact> contacts;
  /// Contacts with a larger gap bear no force [m]: they count in M and in the metrics of contacts,
  /// but not in wrench spaces and balances. Empty: all contacts bear forces.
  std::optional<double> bearing_gap = std::nullopt;
  contact::WrenchObject object;  ///< Center of mass and scales.
  double friction = 0.4;         ///< Coulomb's μ of all wrench metrics, ≥ 0.
  /// The tool whose wrench convention is used.
  contact::WrenchTool tool = contact::WrenchTool::Graspfit;
  const Grasp* grasp = nullptr;  ///< The measured grasp with these contacts, for penetration and M.
  const geometry::MeshQuery* surface = nullptr;  ///< Of the object: for pose robustness.
  /// For M where there is no `grasp`, and for pose robustness.
  std::optional<contact::QualityContext> quality_context = std::nullopt;
  contact::QualityOptions quality_options = {};
};

/// Facts and the intermediate results that several metrics share; each is computed once, when it is
/// first asked for. An input may be used by one thread at a time.
class GraspMetricInput {
 public:
  explicit GraspMetricInput(GraspMetricFacts facts);

  const GraspMetricFacts& facts() const { return facts_; }
  std::span<const contact::Contact> contacts() const { return facts_.contacts; }
  /// The contacts that bear forces.
  std::span<const contact::Contact> touching() const { return touching_; }

  /// The convention of `facts().tool`. Empty where no contact touches, and where the convention has
  /// no torque scale for the contacts (DexGraspBench, all contacts in one point). @throws
  /// InvalidInput for bad facts: a friction below 0, an object without extent.
  const std::optional<contact::WrenchConvention>& convention() const;

  /// The wrench space in that convention; null where there is no convention.
  /// @throws InvalidInput as `grasp_wrench_space`.
  const contact::GraspWrenchSpace* wrench_space() const;

  /// M and its parts: of the grasp, or from contacts and `quality_context`; null without both.
  const contact::ContactQuality* quality() const;

  /// Pose robustness at the default noise; null without contacts or `surface`.
  const PoseRobustness* robustness() const;

 private:
  GraspMetricFacts facts_;
  std::vector<contact::Contact> touching_;
  mutable bool has_asked_for_convention_ = false;
  mutable std::optional<contact::WrenchConvention> convention_;
  mutable std::optional<contact::GraspWrenchSpace> wrench_space_;
  mutable std::optional<contact::ContactQuality> quality_;
  mutable std::optional<PoseRobustness> robustness_;
};

/// Which of two values of a metric is the better one.
enum class BetterValue { Larger, Smaller };

/// A number about a grasp.
struct GraspMetric {
  std::string name;     ///< snake_case; what tables and the command line call it.
  std::string group;    ///< Heading that it is printed under, such as "wrench space".
  std::string unit;     ///< "1", "m", ...
  std::string meaning;  ///< One line.
  BetterValue better = BetterValue::Larger;
  /// Empty where the metric is not defined.
  std::function<std::optional<double>(const GraspMetricInput&)> value;
  /// What the value depends on besides the grasp, in one line; empty text: nothing.
  std::function<std::string(const GraspMetricInput&)> convention;
};

/// A metric's value with what it depends on: two values are comparable only if these agree.
struct GraspMetricValue {
  std::optional<double> value;  ///< Empty: not defined for this grasp.
  std::string convention;
};
GraspMetricValue evaluate(const GraspMetric& metric, const GraspMetricInput& input);

/// Metrics in the order in which they are printed, no two of one name.
class GraspMetrics {
 public:
  /// Adds a metric after the others of its group, or with a new group at the end.
  /// @throws InvalidInput unless it has a new name in snake_case, group, unit, meaning and value.
  void add(GraspMetric metric);

  std::span<const GraspMetric> all() const { return metrics_; }

  /// @throws InvalidInput for a name that is not here; says which are.
  const GraspMetric& at(std::string_view name) const;
  bool contains(std::string_view name) const;

  /// The metrics of the given names, in the order that they have in this list. @throws InvalidInput
  /// as `at`, and for a name given twice.
  GraspMetrics selected(std::span<const std::string> names) const;

 private:
  std::vector<GraspMetric> metrics_;
};

/// The metrics of this library. To use others too, copy it and `add` them.
const GraspMetrics& grasp_metrics();

/// All facts about a grasp that was planned on `object` with `options`. `object`, `hand` and
/// `grasp` must outlive the result.
GraspMetricFacts metric_facts(const ObjectModel& object, const hands::HandModel& hand,
                              const PlannerOptions& options, const Grasp& grasp);

}  // namespace graspfit::grasp
