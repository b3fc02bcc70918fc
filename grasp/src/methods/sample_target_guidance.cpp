// The baseline GS of the paper's Table 1, read from its words: the paper chooses "desirable target
// contacts ... rather than randomly selecting target contacts as in GS". A
// reconstruction [R]. Targets are drawn at random among surface samples, one set per attempt; hands
// are fitted to them, closed and measured as to the paper's own.
#include <algorithm>

#include "methods/guidance_list.hpp"
#include "methods/sample_model.hpp"
#include "methods/target_sides.hpp"
#include "targets/sample_targets.hpp"

namespace graspfit::grasp::internal {
namespace {

class SampleTargetGuidance : public GraspGuidance {
 public:
  explicit SampleTargetGuidance(const GuidanceScene& scene)
      : scene_(scene),
        distances_(part_distances(scene.hand.model())),
        samples_(approach_samples(scene.object, scene.options.sampling, scene.options.seed)),
        targets_(scene.object, distances_, scene.parts, scene.options.targets, samples_) {}

  GuidedStarts starts(std::int64_t number) const override {
    GuidedStarts result;
    // Sample k was drawn from the stream (seed, k): see `SamplingGuidance`.
    base::Random random =
        base::Random::stream(scene_.options.seed, static_cast<std::uint64_t>(number));
    const TargetSelection selection = targets_.select(random);
    result.seeds_tried = selection.seeds_tried;
    if (!selection.targets) {
      result.failure = kNoSet;
      return result;
    }
    std::vector<TargetSide> sides = sides_of(*selection.targets, scene_, true);
    if (sides.empty()) result.failure = kNoSet;  // no side within the cone of approach
    std::stable_sort(sides.begin(), sides.end(), by_misfit);
    result.starts = starts_from(std::move(sides), scene_);
    return result;
  }

  GuidanceModel model() const override { return sample_model(samples_); }

  std::vector<std::string> failures() const override { return {kNoSet}; }

  std::map<std::string, std::int64_t> counts() const override {
    return {{"samples", static_cast<std::int64_t>(samples_.size())}};
  }

 private:
  static constexpr const char* kNoSet = "no set";

  const GuidanceScene scene_;
  const PartDistances distances_;  ///< Outlives the search, which refers to it.
  const std::vector<geometry::SurfaceSample> samples_;
  const SampleTargets targets_;
};

}  // namespace

std::unique_ptr<GraspGuidance> sample_target_guidance(const GuidanceScene& scene) {
  return std::make_unique<SampleTargetGuidance>(scene);
}

}  // namespace graspfit::grasp::internal
