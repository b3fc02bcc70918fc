#include "graspfit/grasp/contact_refinement.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "graspfit/base/option_check.hpp"
#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "refinement/constrained_least_squares.hpp"
#include "rows/range_check.hpp"
#include "scene/clearance.hpp"
#include "scene/hand_motion.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Index;
using Eigen::RowVectorXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using hands::HandConfiguration;
using internal::HandMotion;
using internal::LinkPoses;
using internal::NearPoints;

// Weights of the least squares, relative to 1 for a length that the palm moves: gaps come first,
// then clearance, then the positions of the targets and the tilt of the pads there. A joint weighs
// less than the palm, whose motion moves every pad. A larger weight of the targets brings contacts
// nearer to them, and leaves more gaps open.
constexpr double kPalmWeight = 1.0;
constexpr double kJointWeight = 0.5;
constexpr double kGapWeight = 30.0;
constexpr double kClearanceWeight = 3.0;
constexpr double kTargetWeight = 0.1;
constexpr double kTiltWeight = 0.5;
constexpr double kTiltLever = 0.01;  // [m/rad]; half a fingertip

// Sliding: gaps still come first, but the targets weigh as much as a length moved.
constexpr double kSlideWeight = 1.0;
constexpr double kShortestSlide = 1e-4;  // [m]; below it the rest is not worth the work

// Long steps need fewer iterations, but distances are linear over short ones only, so that long
// steps are shortened again, at the cost of a query of all distances each time. What closes small
// gaps begins with shorter ones.
constexpr double kLongestStep = 4e-3;   // of every entry of a motion [m]
constexpr double kFirstPerGap = 3.0;    // the longest first step, of the largest gap
constexpr double kLeastLongest = 1e-3;  // [m]; of first steps, and after those that were taken
// Bodies within so many times the step length are rows of the problem: a larger value makes the
// problem larger, with a smaller one bodies without a row are met and shorten the step.
constexpr double kNearPerStep = 0.8;
constexpr double kShortestStep = 2e-6;  // [m]; below it nothing is gained
// Clearance from everything while gaps are large: more lets fingers pass obstacles in longer steps,
// less ends nearer to the surface.
constexpr double kClearancePerGap = 0.1;  // per largest gap that is left
constexpr double kMostClearance = 3e-4;   // [m]
// Share of a step by which bodies that are too near may be required to separate: a larger share
// separates them sooner, at the cost of the step's other aims.
constexpr double kPartingShare = 0.3;
constexpr int kMostHalvings = 5;          // more save steps of blocked hands, a query each
constexpr double kTrustGrowth = 2.0;      // the next longest step, of one taken whole, or allowed
constexpr double kLeastTrust = 0.1;       // of the longest step, after one that was not taken
constexpr double kLeastSlideTrust = 0.3;  // the same while sliding
constexpr double kTurnRounding = 1e-7;    // [rad]; angles of matrices near 1 are rounded so far
// The gaps must shrink to this share within so many steps: less patience saves the steps of hands
// that are blocked, and loses those that get there slowly.
constexpr int kPatience = 8;
constexpr int kNearPadPatience = 2;  // of further pads, most of which the others hold off
constexpr double kLeastProgress = 0.85;

// A start that penetrates something is opened in steps that grow, 3 cm in all. A smaller first step
// stays nearer to the configuration found by fitting, a longer opening saves deeper starts.
constexpr int kMostOpenings = 14;
constexpr double kFirstOpening = 5e-4;  // [m]
constexpr double kOpeningGrowth = 1.2;
constexpr int kOpeningsOfFingersAlone = 8;  // 8 mm; then the palm withdraws, too

/// A pad that must touch.
struct PadRequest {
  int pad = 0;
  int link = 0;
  const TargetContact* target = nullptr;
  double gap = 0.0;
  Vector3d point_O = Vector3d::Zero();   ///< On the pad, nearest to the object.
  Vector3d normal_O = Vector3d::Zero();  ///< Unit, from the object to it.
  std::optional<geometry::ProximitySeed> seed;
};

/// One refinement.
class Refinement {
 public:
  Refinement(const GraspScene& scene, const std::vector<int>& requested_pads,
             const TargetContacts* targets, const RefinementOptions& options)
      : hand_(scene.hand),
        model_(scene.hand.model()),
        object_(scene.object),
        contact_options_(scene.contact_options),
        options_(options),
        least_(0.5 * options.least_distance),
        clearance_(scene.hand, scene.object, scene.surroundings),
        entries_(scene.hand.model(), options.largest_shift > 0.0, options.largest_turn > 0.0) {
    for (const int pad : requested_pads) requests_.push_back(request_of(pad, targets));
  }

  RefinementResult run(const HandConfiguration& start) {
    start_ = start;
    go_to(start);
    RefinementResult result;
    result.stop = make_clear();
    if (result.stop == RefinementStop::Contact) {
      const HandConfiguration clear = configuration_;
      result.stop = approach(result.iterations, options_.max_iterations, kPatience);
      if (result.stop == RefinementStop::Contact && options_.slide_steps > 0) {
        const HandConfiguration touching = configuration_;
        slide(result.iterations);
        if (!is_clear()) go_to(touching);
      }
      // Nearest points are accurate to rounding only; the exact test decides.
      if (!is_clear()) {
        go_to(clear);
        result.stop = RefinementStop::GapLeft;
      }
      if (result.stop == RefinementStop::Contact) bring_near_pads(result.iterations);
    }
    result.configuration = configuration_;
    measure_gaps();
    for (const PadRequest& request : requests_)
      result.largest_gap = std::max(result.largest_gap, request.gap);
    return result;
  }

 private:
  PadRequest request_of(int pad, const TargetContacts* targets) const {
    base::require(pad >= 0 && pad < std::ssize(model_.pads), "refine_contacts", "requested pad",
                  pad, "an index into the pads of hand " + model_.name);
    PadRequest request;
    request.pad = pad;
    request.link = model_.pads[pad].link;
    if (!targets) return request;
    for (const TargetContact& target : targets->contacts) {
      const bool is_assigned = target.finger || target.is_palm;
      if (is_assigned && pad_for(model_, target) == pad) request.target = &target;
    }
    return request;
  }

  void go_to(const HandConfiguration& configuration) {
    configuration_ = configuration;
    X_OL_ = hands::forward_kinematics(model_, configuration_);
  }

  Vector3d palm_center(const HandConfiguration& configuration) const {
    return configuration.X_OH * model_.palm.center_H;
  }
  Vector3d shift(const HandConfiguration& configuration) const {
    return palm_center(configuration) - palm_center(start_);
  }
  Vector3d turn(const HandConfiguration& configuration) const {
    const Eigen::AngleAxisd turned(
        Eigen::Matrix3d(configuration.X_OH.linear() * start_.X_OH.linear().transpose()));
    return turned.angle() * turned.axis();
  }
  bool is_within_limits(const HandConfiguration& configuration) const {
    constexpr double kRounding = 1e-12;  // a palm that stays is turned by rounding only
    return shift(configuration).norm() <= options_.largest_shift + kRounding &&
           turn(configuration).norm() <= options_.largest_turn + kTurnRounding;
  }

  /// Opens and withdraws the hand until it is clear; returns `Contact` if it is.
  RefinementStop make_clear() {
    double step = kFirstOpening;
    for (int round = 0;; ++round, step *= kOpeningGrowth) {
      const internal::Clearance::Blocked blocked = clearance_.blocked(X_OL_, least_);
      if (blocked.is_empty()) {
        if (!clearance_.is_clear_of_world(X_OL_)) return RefinementStop::Intersecting;
        return clearance_.is_clear_of_itself(X_OL_) ? RefinementStop::Contact
                                                    : RefinementStop::SelfCollision;
      }
      const HandConfiguration opened = opened_by(blocked, round, step);
      if (round == kMostOpenings || !is_within_limits(opened)) {
        return blocked.links.empty() ? RefinementStop::SelfCollision : RefinementStop::Intersecting;
      }
      go_to(opened);
    }
  }

  HandConfiguration opened_by(const internal::Clearance::Blocked& blocked, int round, double step) {
    const HandMotion from(entries_, configuration_, X_OL_, palm_center(configuration_));
    VectorXd motion = VectorXd::Zero(from.size());
    bool withdraws = false;
    const auto open = [&](int link) {
      const VectorXd opening = from.opening(link, step);
      for (Index i = 0; i < motion.size(); ++i) {
        if (opening[i] != 0.0) motion[i] = opening[i];
      }
      return !opening.isZero(0.0);
    };
    for (const int link : blocked.by_own_hand) {
      open(link);
      const VectorXd straightening = from.straightening(link, step);
      for (Index i = 0; i < motion.size(); ++i) {
        if (straightening[i] != 0.0) motion[i] = straightening[i];
      }
    }
    for (const int link : blocked.links) {
      withdraws = !open(link) || round >= kOpeningsOfFingersAlone || withdraws;
    }
    HandConfiguration opened = from.moved(motion);
    if (withdraws && options_.largest_shift > 0.0) {
      opened.X_OH.pretranslate(-step * (opened.X_OH.linear() * model_.palm.direction_H));
    }
    return opened;
  }

  /// Whether the hand is clear of object, surroundings and itself, decided exactly.
  bool is_clear() {
    return clearance_.is_clear_of_world(X_OL_) && clearance_.is_clear_of_itself(X_OL_);
  }

  /// False if a pad is farther than twice the reach.
  bool measure_gaps() {
    for (PadRequest& request : requests_) {
      const auto nearest =
          geometry::nearest_points(object_.query, hand_.pad_surface(request.pad),
                                   X_OL_[request.link], 2.0 * options_.reach, request.seed);
      request.gap = 2.0 * options_.reach;
      if (!nearest) return false;
      request.gap = nearest->distance;
      request.seed = geometry::ProximitySeed{nearest->face_a, nearest->face_b};
      request.point_O = nearest->point_on_b_A;
      request.normal_O = (nearest->point_on_b_A - nearest->point_on_a_A).normalized();
    }
    return true;
  }

  double largest_gap() const {
    double largest = 0.0;
    for (const PadRequest& request : requests_) largest = std::max(largest, request.gap);
    return largest;
  }
  double sum_of_gaps() const {
    double sum = 0.0;
    for (const PadRequest& request : requests_) sum += std::max(request.gap, options_.wanted_gap);
    return sum;
  }

  bool all_touch() const {
    return largest_gap() <= options_.largest_gap &&
           std::all_of(requests_.begin(), requests_.end(), [&](const PadRequest& request) {
             return contact::has_contact(model_, request.pad,
                                         hands::pad_pose(model_, request.pad, X_OL_), object_.query,
                                         contact_options_);
           });
  }

  /// Closes the gaps from a clear start, in at most `max_iterations` steps, of which so many in
  /// sequence as `patience` says may hardly shrink them.
  RefinementStop approach(int& iterations, int max_iterations, int patience) {
    if (!measure_gaps() || largest_gap() > options_.reach) return RefinementStop::OutOfReach;
    double trust = std::clamp(kFirstPerGap * largest_gap(), kLeastLongest, kLongestStep);
    std::vector<double> sums = {sum_of_gaps()};
    bool has_moved = true;
    while (!all_touch()) {
      if (is_stuck(sums, patience) || trust < kShortestStep) return RefinementStop::GapLeft;
      if (iterations == max_iterations) return RefinementStop::IterationLimit;
      ++iterations;
      if (has_moved) {
        near_ = clearance_.find(X_OL_, kNearPerStep * trust);
      } else {
        std::erase_if(near_,
                      [&](const NearPoints& near) { return near.distance > kNearPerStep * trust; });
      }
      const Step taken = step(trust);
      has_moved = taken.share > 0.0;
      trust = taken.share < 1.0 ? trust * std::max(taken.share, kLeastTrust)
                                : std::clamp(kTrustGrowth * taken.longest,
                                             std::min(trust, kLeastLongest), kLongestStep);
      if (has_moved) measure_gaps();
      sums.push_back(sum_of_gaps());
    }
    return RefinementStop::Contact;
  }

  /// Brings further pads that nearly touch into contact, one after the other. A pad that does not
  /// touch within its steps, or takes another's contact, is given up.
  void bring_near_pads(int& iterations) {
    if (options_.near_pad_steps == 0) return;
    const std::vector<PadRequest> requested = requests_;
    std::vector<PadRequest> near = near_pads();
    for (PadRequest& pad : near) {
      const HandConfiguration touching = configuration_;
      requests_.push_back(pad);
      int steps = 0;
      const RefinementStop stop = approach(steps, options_.near_pad_steps, kNearPadPatience);
      iterations += steps;
      if (stop == RefinementStop::Contact && is_clear()) continue;
      requests_.pop_back();
      go_to(touching);
    }
    requests_ = requested;
    measure_gaps();
  }

  /// Pads that are not requested, with surface in their clip volumes and a gap; the smallest gap
  /// first.
  std::vector<PadRequest> near_pads() const {
    std::vector<PadRequest> near;
    for (int pad = 0; pad < std::ssize(model_.pads); ++pad) {
      const bool is_requested =
          std::any_of(requests_.begin(), requests_.end(),
                      [&](const PadRequest& request) { return request.pad == pad; });
      if (is_requested || !contact::is_counted(model_, pad, contact_options_) ||
          !contact::has_contact(model_, pad, hands::pad_pose(model_, pad, X_OL_), object_.query,
                                contact_options_)) {
        continue;
      }
      PadRequest request = request_of(pad, nullptr);
      request.gap = contact::pad_gap(hand_.pad_surface(pad), X_OL_[request.link], object_.query,
                                     options_.reach)
                        .value_or(options_.reach);
      if (request.gap > options_.largest_gap) near.push_back(request);
    }
    std::stable_sort(near.begin(), near.end(),
                     [](const PadRequest& a, const PadRequest& b) { return a.gap < b.gap; });
    return near;
  }

  /// How far the pads are from their targets, and how far from lying flat there [m²].
  double squared_miss() const {
    double sum = 0.0;
    for (const PadRequest& request : requests_) {
      if (!request.target) continue;
      const Vector3d middle = hands::pad_contact_point(model_, request.pad, X_OL_);
      const Vector3d pad_normal = hands::pad_pose(model_, request.pad, X_OL_).linear().col(2);
      sum += (request.target->point_O - middle).squaredNorm() +
             (kTiltLever * (pad_normal + request.target->outward_normal_O)).squaredNorm();
    }
    return sum;
  }

  /// Moves touching pads over the surface toward their targets; the configuration nearest to the
  /// targets in which all touch is kept.
  void slide(int& iterations) {
    if (std::none_of(requests_.begin(), requests_.end(),
                     [](const PadRequest& c) { return c.target; })) {
      return;
    }
    target_weight_ = tilt_weight_ = kSlideWeight;
    HandConfiguration best = configuration_;
    double best_miss = squared_miss();
    double trust = kLongestStep;
    for (int i = 0; i < options_.slide_steps && trust > kShortestSlide; ++i) {
      ++iterations;
      near_ = clearance_.find(X_OL_, kNearPerStep * trust);
      const double share = step(trust).share;
      trust = share < 1.0 ? trust * std::max(share, kLeastSlideTrust)
                          : std::min(kTrustGrowth * trust, kLongestStep);
      if (share > 0.0) measure_gaps();
      const double miss = squared_miss();
      if (miss >= best_miss || !all_touch()) continue;
      best = configuration_;
      best_miss = miss;
    }
    go_to(best);
    measure_gaps();
  }

  /// Whether the last `patience` steps have hardly shrunk the gaps, given their sums after each
  /// step.
  static bool is_stuck(const std::vector<double>& sums, int patience) {
    const auto steps = static_cast<std::size_t>(patience);
    return sums.size() > steps && sums.back() > kLeastProgress * sums[sums.size() - 1 - steps];
  }

  struct Step {
    double share = 0.0;    ///< Of the wanted motion, 0 if none was taken.
    double longest = 0.0;  ///< Entry of the wanted motion [m], at most what it was allowed.
  };
  /// Takes one step, shortened until clear.
  Step step(double trust) {
    Vector3d pivot = Vector3d::Zero();
    for (const PadRequest& request : requests_)
      pivot += request.point_O / static_cast<double>(requests_.size());
    const HandMotion from(entries_, configuration_, X_OL_, pivot);
    const VectorXd motion = wanted_motion(from, trust);
    const double longest = motion.cwiseAbs().maxCoeff();
    double share = 1.0;
    for (int halving = 0; halving <= kMostHalvings; ++halving, share *= 0.5) {
      const HandConfiguration candidate = from.moved(share * motion);
      if (!is_within_limits(candidate)) continue;
      const LinkPoses X_OL = hands::forward_kinematics(model_, candidate);
      if (!clearance_.is_apart(X_OL, least_)) continue;
      configuration_ = candidate;
      X_OL_ = X_OL;
      return {share, longest};
    }
    return {0.0, longest};
  }

  VectorXd wanted_motion(const HandMotion& from, double trust) const {
    const double clearance =
        std::clamp(kClearancePerGap * largest_gap(), options_.least_distance, kMostClearance);
    internal::ConstrainedRows rows;
    for (Index i = 0; i < from.size(); ++i) {
      rows.want(RowVectorXd::Unit(from.size(), i), 0.0, i < 6 ? kPalmWeight : kJointWeight);
    }
    for (const PadRequest& request : requests_) {
      const double wanted = std::max(options_.wanted_gap, clearance) - request.gap;
      rows.want(from.row(request.link, request.point_O, request.normal_O), wanted, kGapWeight);
      if (request.target) draw_to_target(request, from, trust, rows);
    }
    for (const NearPoints& near : near_) {
      RowVectorXd row = from.row(near.link, near.point_O, near.normal_O);
      if (near.other_link) {
        row -= from.row(*near.other_link, near.point_on_other_O, near.normal_O);
      }
      // What even the longest step leaves clear needs no row.
      if (near.distance - trust * row.cwiseAbs().sum() > clearance) continue;
      // Bodies that nearly touch are separated first: moving along a curved surface they would meet
      // at once.
      rows.require(row, std::min(clearance - near.distance, kPartingShare * trust));
      if (near.distance < clearance) rows.want(row, clearance - near.distance, kClearanceWeight);
    }
    add_limits(from, trust, rows);
    return rows.solve(kShortestStep);
  }

  /// Adds weak rows that draw the pad's contact point to the target and its normal against the
  /// surface's normal.
  void draw_to_target(const PadRequest& request, const HandMotion& from, double trust,
                      internal::ConstrainedRows& rows) const {
    const Vector3d middle = hands::pad_contact_point(model_, request.pad, X_OL_);
    Vector3d way = request.target->point_O - middle;
    if (way.norm() > trust) way *= trust / way.norm();
    const Vector3d outward = request.target->outward_normal_O;
    const Vector3d pad_normal = hands::pad_pose(model_, request.pad, X_OL_).linear().col(2);
    const Vector3d turn = pad_normal.cross(-outward);
    for (int axis = 0; axis < 3; ++axis) {
      rows.want(from.row(request.link, middle, Vector3d::Unit(axis)), way[axis], target_weight_);
      rows.want(kTiltLever * from.turn_row(request.link, Vector3d::Unit(axis)),
                std::clamp(kTiltLever * turn[axis], -trust, trust), tilt_weight_);
    }
  }

  void add_limits(const HandMotion& from, double trust, internal::ConstrainedRows& rows) const {
    const auto [lower, upper] = from.bounds(trust);
    for (Index i = 0; i < from.size(); ++i) {
      rows.require(RowVectorXd::Unit(from.size(), i), lower[i]);
      rows.require(-RowVectorXd::Unit(from.size(), i), -upper[i]);
    }
    for (const auto& [row, least] : from.breakaway_rows()) rows.require(row, least);
    const Vector3d shifted = shift(configuration_);
    if (shifted.norm() > 0.5 * options_.largest_shift && shifted.norm() > 0.0) {
      rows.require(-from.row(model_.palm.link, palm_center(configuration_), shifted.normalized()),
                   shifted.norm() - options_.largest_shift);
    }
    const Vector3d turned = turn(configuration_);
    if (turned.norm() > 0.5 * options_.largest_turn && turned.norm() > 0.0) {
      rows.require(-from.turn_row(model_.palm.link, turned.normalized()),
                   turned.norm() - options_.largest_turn);
    }
  }

  const FittingHand& hand_;
  const hands::HandModel& model_;
  const ObjectModel& object_;
  const contact::ContactEstimationOptions& contact_options_;
  const RefinementOptions& options_;
  const double least_;  ///< Distance that a step must keep: half of the one that it aims at [m].
  internal::Clearance clearance_;
  const internal::MotionEntries entries_;
  std::vector<PadRequest> requests_;
  HandConfiguration start_;
  HandConfiguration configuration_;
  LinkPoses X_OL_;
  std::vector<NearPoints> near_;
  double target_weight_ = kTargetWeight;
  double tilt_weight_ = kTiltWeight;
};

}  // namespace

void RefinementOptions::validate() const {
  internal::require_ranges("RefinementOptions", *this, internal::refinement_rows);
  base::require(wanted_gap < largest_gap, "RefinementOptions", "wanted_gap_m", wanted_gap,
                "below largest_gap_m");
  base::require(least_distance <= wanted_gap, "RefinementOptions", "least_distance_m",
                least_distance, "at most wanted_gap_m");
}

RefinementResult refine_contacts(const GraspScene& scene, const std::vector<int>& requested_pads,
                                 const TargetContacts* targets, const HandConfiguration& start,
                                 const RefinementOptions& options) {
  options.validate();
  scene.contact_options.validate();
  hands::validate(scene.hand.model(), start);
  return Refinement(scene, requested_pads, targets, options).run(start);
}

}  // namespace graspfit::grasp
