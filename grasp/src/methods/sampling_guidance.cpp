// The baseline GS of the paper's Table 1: surface samples with normals guide the hand. A
// reconstruction [R]: the paper says that much, and the work it cites could not be identified with
// certainty. A sample is drawn at random; the palm faces against the sample's normal, turned about
// it at random, and is put at the sample, where it may touch, or a little before it; the hand backs
// off until it is clear and closes.
#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/palm_pose.hpp"
#include "methods/guidance_list.hpp"
#include "methods/sample_model.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Vector3d;

/// How the open hand may stand before it closes.
struct Preshape {
  double spread_share;  ///< Of the range of joints that neither open nor close.
  /// Angle by which revolute closing joints are closed from their open limits.
  double closed_by_rad;
};

// [R] Spreads of 0, 60, 90 and 180 degrees of the Barrett hand's 180.
constexpr std::array kSurfacePreshapes = {Preshape{0.0, 0.0}, Preshape{1.0 / 3.0, 0.0},
                                          Preshape{0.5, 0.0}, Preshape{1.0, 0.0}};
// Preshapes of OpenRAVE's grasp database for the Barrett hand.
constexpr std::array kBoxPreshapes = {Preshape{1.0 / 3.0, 0.5}, Preshape{0.0, 0.5},
                                      Preshape{0.5, 0.0}};
constexpr int kBoxRolls = 4;  // as there

class SamplingGuidance : public GraspGuidance {
 public:
  explicit SamplingGuidance(const GuidanceScene& scene)
      : scene_(scene),
        axis_H_(hands::closing_axis_H(scene.hand.model())),
        samples_(approach_samples(scene.object, scene.options.sampling, scene.options.seed)) {
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (is_approached(-samples_[i].normal)) usable_.push_back(i);
    }
  }

  GuidedStarts starts(std::int64_t number) const override {
    GuidedStarts result;
    if (usable_.empty()) {
      result.is_exhausted = true;
      result.failure = kNoSample;
      return result;
    }
    // Sample k was drawn from the stream (seed, k), so an attempt begins with the numbers that
    // placed the sample of its own number.
    base::Random random =
        base::Random::stream(scene_.options.seed, static_cast<std::uint64_t>(number));
    const geometry::SurfaceSample& sample = samples_[usable_[random.index(usable_.size())]];
    const bool is_box = scene_.options.sampling.source == ApproachSource::BoxRays;
    const double roll =
        is_box ? static_cast<double>(random.index(kBoxRolls)) / kBoxRolls : random.uniform();
    const Preshape preshape = is_box ? kBoxPreshapes[random.index(kBoxPreshapes.size())]
                                     : kSurfacePreshapes[random.index(kSurfacePreshapes.size())];
    const double standoff = random.index(2) == 0 ? 0.0 : scene_.options.sampling.largest_standoff;

    const hands::HandModel& hand = scene_.hand.model();
    hands::HandConfiguration start = hands::open_hand_spread_by(hand, preshape.spread_share);
    start.q = preclosed(std::move(start.q), preshape.closed_by_rad);
    const Vector3d direction = -sample.normal;
    const Vector3d axis =
        hands::turned_axis(hands::any_normal(direction), direction, roll * 2.0 * std::numbers::pi);
    start.X_OH = hands::palm_pose(hand, axis_H_, hand.palm.center_H, direction, axis,
                                  sample.point + standoff * sample.normal);
    const RetreatRule retreat{
        .step = scene_.options.fitting.small_step * scene_.object.grid.lattice.voxel_size,
        .palm_may_touch = standoff == 0.0};
    result.starts.push_back({{}, [&scene = scene_, start, retreat] {
                               return close_hand(scene, scene.options.style, scene.parts, start,
                                                 retreat, scene.options.fitting);
                             }});
    return result;
  }

  GuidanceModel model() const override { return sample_model(samples_); }

  std::vector<std::string> failures() const override { return {kNoSample}; }

  std::map<std::string, std::int64_t> counts() const override {
    return {{"samples", static_cast<std::int64_t>(samples_.size())},
            {"samples in the cone of approach", static_cast<std::int64_t>(usable_.size())}};
  }

 private:
  static constexpr const char* kNoSample = "no sample";

  bool is_approached(const Vector3d& direction_O) const {
    return hands::angle_from_approach(direction_O, scene_.options.approach_O) <=
           scene_.options.approach_angle;
  }

  Eigen::VectorXd preclosed(Eigen::VectorXd q, double angle) const {
    const hands::HandModel& hand = scene_.hand.model();
    for (std::size_t j = 0; j < hand.joints.size(); ++j) {
      const hands::Joint& joint = hand.joints[j];
      if (joint.type != hands::JointType::Revolute || joint.coupling) continue;
      double& position = q[j];
      position = std::clamp(position + joint.closing_sign * angle, joint.lower, joint.upper);
    }
    hands::apply_couplings(hand, q);
    return q;
  }

  const GuidanceScene scene_;
  const Vector3d axis_H_;
  const std::vector<geometry::SurfaceSample> samples_;
  /// Indices of the samples against whose normals the palm may face.
  std::vector<std::size_t> usable_;
};

}  // namespace

std::unique_ptr<GraspGuidance> sampling_guidance(const GuidanceScene& scene) {
  return std::make_unique<SamplingGuidance>(scene);
}

}  // namespace graspfit::grasp::internal
