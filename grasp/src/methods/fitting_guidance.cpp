// Hand-object geometric fitting, the paper's method: contacts to reach are chosen on the object by
// their scores and the hand's kinematics, and the hand is fitted to them.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/contact/grasp_balance.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/grasp/random_targets.hpp"
#include "graspfit/grasp/ranked_targets.hpp"
#include "methods/guidance_list.hpp"
#include "methods/reach_sides.hpp"
#include "methods/table_reach.hpp"
#include "methods/target_sides.hpp"

namespace graspfit::grasp::internal {
namespace {

// Sides of a set that count as one draw: those of a triangle. Two targets have 16, so fewer such
// sets are drawn.
constexpr int kSidesPerDraw = 2;
// Of the only draw of an attempt, in efforts: about a thousand postures, as large and small objects
// need some of them.
constexpr double kOnlyDraw = 14.0;

const char* failure_name(TargetFailure failure) {
  switch (failure) {
    case TargetFailure::NoSeed:
      return "no seed";
    case TargetFailure::NoSecond:
      return "no second";
    case TargetFailure::NoFurther:
      return "no further";
    case TargetFailure::NoPalm:
      return "no palm";
  }
  return "";
}

class FittingGuidance : public GraspGuidance {
 public:
  explicit FittingGuidance(const GuidanceScene& scene)
      : scene_(scene),
        torque_scale_(
            geometry::largest_radius(scene.object.mesh(), scene.object.mass.center_of_mass)) {
    const TargetOptions& targets = scene.options.targets;
    if (targets.search == TargetSearch::Reach) {
      surface_ = surface_places(scene.object,
                                scene.options.contact_faces == contact::ContactFaces::Facing);
      std::vector<PoolPoint> pool = touchable_above_table(pool_of(scene.object, surface_, targets),
                                                          scene.hand.model(), scene.surroundings);
      pool = carrying_above_table(std::move(pool), scene.object.mass.center_of_mass,
                                  scene.surroundings);
      places_.emplace(scene.object, scene.parts, targets, std::move(pool));
      reach_.emplace(scene_, surface_, *places_);
      return;
    }
    distances_ = part_distances(scene.hand.model());
    if (targets.search == TargetSearch::Ranked) {
      ranked_.emplace(scene.object, distances_, scene.parts, targets);
    } else {
      selector_.emplace(scene.object, distances_, scene.parts, targets,
                        IdealMeasure{&scene.hand.model(), scene.options.quality});
    }
  }

  GuidedStarts starts(std::int64_t number) const override {
    if (reach_) {
      return reach_starts(
          base::Random::stream(scene_.options.seed, static_cast<std::uint64_t>(number)),
          scene_.options.max_redraws > 0 ? 1.0 : kOnlyDraw);
    }
    GuidedStarts result;
    result.starts =
        starts_from(ranked_ ? ranked_sides(number, result) : drawn_sides(number, result), scene_);
    return result;
  }

  std::vector<std::string> failures() const override {
    std::vector<std::string> names;
    for (const TargetFailure failure : {TargetFailure::NoSeed, TargetFailure::NoSecond,
                                        TargetFailure::NoFurther, TargetFailure::NoPalm}) {
      names.emplace_back(failure_name(failure));
    }
    return names;
  }

  /// Of a search by reach, what fingertips can pinch squarely.
  std::map<std::string, std::int64_t> counts() const override {
    if (!reach_) return {};
    const auto widths = reach_->grips().square_widths(scene_.options.friction);
    if (!widths) return {};
    const auto in_millimeters = [](double length) { return std::llround(1e3 * length); };
    return {{std::string(kNarrowestPinch), in_millimeters(widths->smallest)},
            {std::string(kWidestPinch), in_millimeters(widths->largest)}};
  }

  /// The score map: one point per partial voxel.
  GuidanceModel model() const override {
    GuidanceModel model;
    model.columns = {"x_m",
                     "y_m",
                     "z_m",
                     "nx",
                     "ny",
                     "nz",
                     "score",
                     "mean_plane_distance_voxels",
                     "mean_normal_angle_deg"};
    const ContactScoreMap& scores = scene_.object.scores;
    for (std::size_t i = 0; i < scene_.object.patches.size(); ++i) {
      const geometry::SurfacePatch& patch = scene_.object.patches[i];
      model.rows.push_back({patch.centroid.x(), patch.centroid.y(), patch.centroid.z(),
                            patch.outward_normal.x(), patch.outward_normal.y(),
                            patch.outward_normal.z(), scores.scores[i],
                            scores.mean_plane_distance[i], scores.mean_normal_angle_deg[i]});
    }
    return model;
  }

 private:
  /// The sides of the ranked set with this number, ordered by `by_misfit`.
  std::vector<TargetSide> ranked_sides(std::int64_t number, GuidedStarts& result) const {
    const std::optional<TargetContacts> targets = ranked_targets(number);
    if (!targets) {
      result.is_exhausted = true;
      if (number == 0) result.failure = failure_name(ranked_->failure());
      return {};
    }
    std::vector<TargetSide> sides = sides_of(*targets, scene_, true);
    if (sides.empty()) result.failure = failure_name(TargetFailure::NoFurther);
    std::stable_sort(sides.begin(), sides.end(), by_misfit);
    return sides;
  }

  GuidedStarts reach_starts(base::Random random, double effort) const {
    GuidedStarts result;
    std::vector<TargetSide> sides = reach_->draw(random, effort);
    if (sides.empty()) {
      result.failure = failure_name(places_->pool().empty()       ? TargetFailure::NoSeed
                                    : places_->pool().size() == 1 ? TargetFailure::NoSecond
                                                                  : TargetFailure::NoFurther);
    }
    result.starts = starts_from(std::move(sides), scene_);
    result.redraw = [this, random](double more) { return reach_starts(random, more); };
    return result;
  }

  /// The sides of the random set whose best side goes first or, where the strongest grasp is kept,
  /// of all sets drawn.
  std::vector<TargetSide> drawn_sides(std::int64_t number, GuidedStarts& result) const {
    const PlannerOptions& options = scene_.options;
    base::Random random = base::Random::stream(options.seed, static_cast<std::uint64_t>(number));
    std::vector<TargetSide> best;
    TargetFailure failure = TargetFailure::NoFurther;  // no side within the cone of approach
    int num_judged = 0;
    // Where sets are rare, the seeds of one search are the budget of all draws together.
    const auto may_draw = [&](int draw) {
      return draw < num_draws() && num_judged < kSidesPerDraw * num_draws() &&
             (best.empty() || result.seeds_tried < options.targets.max_seeds);
    };
    for (int draw = 0; may_draw(draw); ++draw) {
      const TargetSelection selection = selector_->select(random);
      result.seeds_tried += selection.seeds_tried;
      if (!selection.targets) {
        failure = selection.failure;
        break;  // the search gave up after many seeds of its own
      }
      std::vector<TargetSide> sides =
          sides_of(*selection.targets, scene_, options.target_draws > 1);
      if (sides.empty()) continue;
      num_judged += base::as_index<int>(sides.size());
      if (options.target_draws == 1) return sides;
      if (options.candidate_order == CandidateOrder::Balance) {
        const int set_imbalance = imbalance(*selection.targets);
        for (TargetSide& side : sides) side.imbalance = set_imbalance;
      }
      std::stable_sort(sides.begin(), sides.end(), by_misfit);
      if (compares_all_sets(options.kept)) {
        std::move(sides.begin(), sides.end(), std::back_inserter(best));
      } else if (best.empty() || by_misfit(sides.front(), best.front())) {
        best = std::move(sides);
      }
    }
    std::stable_sort(best.begin(), best.end(), by_misfit);
    if (best.empty()) result.failure = failure_name(failure);
    return best;
  }

  /// 0: forces at the targets balance one another as a squeeze must, within its cones; 1: within
  /// those of `friction` only; 2: within neither.
  int imbalance(const TargetContacts& targets) const {
    const std::vector<contact::Contact> contacts = contacts_at(targets);
    const PlannerOptions& options = scene_.options;
    const auto do_balance = [&](double friction) {
      const contact::BalanceForces forces = contact::balance_forces(
          contacts, scene_.object.mass.center_of_mass, contact::Wrench::Zero(),
          {.friction = friction, .least_normal_sum = 1.0, .torque_scale = torque_scale_});
      return forces.residual_norm <= options.squeeze.largest_residual;
    };
    if (do_balance(options.squeeze_friction)) return 0;
    return do_balance(options.friction) ? 1 : 2;
  }

  /// Number of sets to draw; fewer with a target for the palm, since such sets are chosen by the
  /// fingers' reach already.
  int num_draws() const {
    const int draws = scene_.options.target_draws;
    return scene_.parts.palm ? std::max(1, draws / 4) : draws;
  }

  std::optional<TargetContacts> ranked_targets(std::int64_t number) const {
    const std::lock_guard<std::mutex> lock(ranked_lock_);
    while (std::ssize(ranked_sets_) <= number) {
      std::optional<TargetContacts> next = ranked_->next();
      if (!next) return std::nullopt;
      ranked_sets_.push_back(std::move(*next));
    }
    return ranked_sets_[number];
  }

  const GuidanceScene scene_;
  const double torque_scale_;               ///< The torque scale of squeezes [m].
  PartDistances distances_;                 ///< Outlives the other searches, which refer to it.
  std::optional<TargetSelector> selector_;  ///< Of the random search.
  std::vector<SurfacePlace> surface_;       ///< Of the search by reach, which refers to it.
  std::optional<TargetPlaces> places_;      ///< Likewise.
  std::optional<ReachSides> reach_;
  mutable std::mutex ranked_lock_;
  mutable std::optional<RankedTargets> ranked_;
  mutable std::vector<TargetContacts> ranked_sets_;  ///< Those that `ranked_` gave so far.
};

}  // namespace

std::unique_ptr<GraspGuidance> fitting_guidance(const GuidanceScene& scene) {
  return std::make_unique<FittingGuidance>(scene);
}

}  // namespace graspfit::grasp::internal
