// The baseline MA of the paper's Table 1 [Przybylski, Asfour & Dillmann 2011], after facts read in
// its first author's implementation: hands are put around the balls of the medial axis
// by the symmetry of their neighborhoods. Balls come from shrinking instead of a power crust [R].
//
// There are two variants: `ma` backs a colliding hand off by at most 5 steps of 3 mm and then
// closes it wherever it is, as that implementation does; `ma-full-retreat` backs it off until it is
// clear, and gives the attempt up where it is not.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/palm_pose.hpp"
#include "methods/guidance_list.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Vector3d;

// Of the retreat, as published.
constexpr double kPublishedStep = 0.003;  // [m]
constexpr int kPublishedSteps = 5;

/// The candidates that may be tried, in a random order.
std::vector<MedialCandidate> shuffled_candidates(const std::vector<MedialSymmetry>& symmetries,
                                                 const PlannerOptions& options) {
  std::vector<MedialCandidate> candidates = medial_candidates(symmetries, options.seed);
  std::erase_if(candidates, [&](const MedialCandidate& candidate) {
    return !(hands::angle_from_approach(-candidate.outward_O, options.approach_O) <=
             options.approach_angle);
  });
  // A stream that neither samples nor balls use: theirs are counted from zero.
  base::Random random =
      base::Random::stream(options.seed, std::numeric_limits<std::uint64_t>::max());
  for (std::size_t i = candidates.size(); i > 1; --i) {
    std::swap(candidates[i - 1], candidates[random.index(i)]);
  }
  return candidates;
}

class MedialGuidance : public GraspGuidance {
 public:
  MedialGuidance(const GuidanceScene& scene, RetreatRule retreat)
      : scene_(scene),
        retreat_(std::move(retreat)),
        axis_H_(hands::closing_axis_H(scene.hand.model())),
        center_H_(hands::grasp_center_H(scene.hand.model())),
        symmetries_(
            medial_symmetries(scene.object, scene.options.medial_symmetry, scene.options.seed)),
        candidates_(shuffled_candidates(symmetries_, scene.options)) {}

  GuidedStarts starts(std::int64_t number) const override {
    GuidedStarts result;
    if (number >= std::ssize(candidates_)) {
      result.is_exhausted = true;
      if (number == 0) result.failure = kNoCandidate;
      return result;
    }
    const MedialCandidate& candidate = candidates_[number];
    const hands::HandModel& hand = scene_.hand.model();
    hands::HandConfiguration start = hands::open_configuration(hand);
    start.X_OH = hands::palm_pose(hand, axis_H_, center_H_, -candidate.outward_O, candidate.axis_O,
                                  candidate.center_O);
    result.starts.push_back({{}, [&scene = scene_, start, &retreat = retreat_] {
                               return close_hand(scene, scene.options.style, scene.parts, start,
                                                 retreat, scene.options.fitting);
                             }});
    return result;
  }

  /// The medial balls: centers, radii, and what was found around them (kind: as `SymmetryKind`).
  GuidanceModel model() const override {
    GuidanceModel model;
    model.columns = {"x_m",       "y_m",  "z_m",   "radius_m", "object_angle_deg",
                     "neighbors", "kind", "ratio", "axis_x",   "axis_y",
                     "axis_z"};
    for (const MedialSymmetry& symmetry : symmetries_) {
      const Vector3d& c = symmetry.ball.center;
      const Vector3d& a = symmetry.first_axis_O;
      model.rows.push_back({c.x(), c.y(), c.z(), symmetry.ball.radius,
                            symmetry.ball.object_angle_deg, static_cast<double>(symmetry.neighbors),
                            static_cast<double>(symmetry.kind), symmetry.ratio, a.x(), a.y(),
                            a.z()});
    }
    return model;
  }

  std::vector<std::string> failures() const override { return {kNoCandidate}; }

  std::map<std::string, std::int64_t> counts() const override {
    constexpr std::array kinds = {
        std::pair{SymmetryKind::Alone, "balls alone"},
        std::pair{SymmetryKind::Axis, "balls on an axis"},
        std::pair{SymmetryKind::Rim, "balls on a rim"},
        std::pair{SymmetryKind::Interior, "balls inside a plane or blob"},
        std::pair{SymmetryKind::Point, "balls at one point, tried from random directions"}};
    std::map<std::string, std::int64_t> counts;
    for (const auto& [kind, name] : kinds) {
      counts[name] = std::count_if(symmetries_.begin(), symmetries_.end(),
                                   [&, k = kind](const MedialSymmetry& s) { return s.kind == k; });
    }
    counts["candidates"] = static_cast<std::int64_t>(candidates_.size());
    return counts;
  }

 private:
  static constexpr const char* kNoCandidate = "no candidate";

  const GuidanceScene scene_;
  const RetreatRule retreat_;
  const Vector3d axis_H_;
  const Vector3d center_H_;
  const std::vector<MedialSymmetry> symmetries_;
  const std::vector<MedialCandidate> candidates_;
};

}  // namespace

std::unique_ptr<GraspGuidance> medial_guidance(const GuidanceScene& scene) {
  return std::make_unique<MedialGuidance>(scene, RetreatRule{.step = kPublishedStep,
                                                             .most_steps = kPublishedSteps,
                                                             .closes_in_collision = true});
}

std::unique_ptr<GraspGuidance> medial_guidance_with_full_retreat(const GuidanceScene& scene) {
  return std::make_unique<MedialGuidance>(scene, RetreatRule{.step = kPublishedStep});
}

}  // namespace graspfit::grasp::internal
