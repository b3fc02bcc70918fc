#include "graspfit/motion/pick_and_place.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "graspfit/grasp/planner_result.hpp"

namespace graspfit::motion {

using Eigen::Vector3d;
using geometry::RigidTransform;
using hands::HandConfiguration;

namespace {

RigidTransform raised(RigidTransform X, double height) {
  X.translation().z() += height;
  return X;
}

/// The table below z = 0 of W as a body, for who sees it from another frame: as much of it as a
/// hand reaches at `goal_W`. By whole meters, so that it is the same body for all goals near each
/// other.
geometry::TriangleMesh table_body(const Vector3d& goal_W) {
  constexpr double kEdge = 4.0;
  constexpr double kThickness = 0.5;
  RigidTransform X_WB = RigidTransform::Identity();
  X_WB.translation() << std::round(goal_W.x()), std::round(goal_W.y()), -0.5 * kThickness;
  return geometry::transformed(geometry::box({kEdge, kEdge, kThickness}), X_WB);
}

/// The search for one move.
class MoveSearch {
 public:
  MoveSearch(const TableScene& scene, std::span<const RigidTransform> X_WO, int object,
             const RigidTransform& X_WO_goal, const PickAndPlaceOptions& options)
      : scene_(scene),
        X_WO_(X_WO),
        object_(object),
        X_WO_start_(X_WO[object]),
        X_WO_goal_(X_WO_goal),
        options_(options) {}

  MoveAttempt operator()() {
    if (!is_goal_free() || !is_size_possible()) return attempt_;
    const geometry::TriangleMesh mesh_W =
        geometry::transformed(scene_.object(object_).surface_O.mesh(), X_WO_start_);
    const grasp::ObjectModel model =
        grasp::prepare_object(mesh_W, options_.planner, options_.cache);
    const grasp::Surroundings surroundings = surroundings_at_both_ends();
    for (const Vector3d& approach_W : approaches()) {
      grasp::PlannerOptions planner = options_.planner;
      planner.approach_O = approach_W;
      // Fingers that open just enough still stand around the object when the palm withdraws.
      planner.pre_grasp.opening_steps = 1;
      const grasp::PlannerResult planned =
          grasp::plan_grasps(model, scene_.hand(), planner, surroundings, {.num_threads = 1});
      attempt_.planner_attempts += planned.statistics.attempts;
      if (planned.grasps.empty()) note_no_grasp(planned.statistics);
      for (const grasp::Grasp& grasp : planned.grasps) {
        ++attempt_.grasps_tried;
        if (auto segments = whole_way(grasp)) {
          attempt_.move = PlannedMove{object_,
                                      X_WO_start_,
                                      X_WO_goal_,
                                      grasp,
                                      approach_W,
                                      std::move(*segments),
                                      attempt_.planner_attempts,
                                      attempt_.grasps_tried,
                                      attempt_.segments_tried,
                                      attempt_.reason()};
          return attempt_;
        }
      }
    }
    return attempt_;
  }

 private:
  using Way = std::vector<MotionSegment>;

  bool is_goal_free() {
    const SceneObject& moved = scene_.object(object_);
    for (int other = 0; other < std::ssize(scene_.objects()); ++other) {
      if (other == object_) continue;
      const SceneObject& standing = scene_.object(other);
      const RigidTransform X_SO = geometry::relative_pose(X_WO_[other], X_WO_goal_);
      if (geometry::do_intersect(standing.surface_O, moved.surface_O, X_SO)) {
        ++attempt_.failures["the goal is taken by " + standing.name];
      }
    }
    return attempt_.failures.empty();
  }

  /// By the object's own frame, not by how it stands; what is too large is a reason, not an error.
  bool is_size_possible() {
    const auto refusal = grasp::size_refusal(scene_.object(object_).surface_O.mesh(), scene_.hand(),
                                             options_.planner);
    if (refusal) ++attempt_.failures[*refusal];
    return !refusal;
  }

  /// What the hand must keep clear of, in W with the object at its start: the table and what
  /// stands there, and the same as the object sees them at its goal. Objects as their convex hulls,
  /// which have fewer faces: a hand clear of those is clear of them.
  grasp::Surroundings surroundings_at_both_ends() const {
    grasp::Surroundings around;
    around.table_z_O = 0.0;
    const RigidTransform X_from_goal = X_WO_start_ * geometry::inverted(X_WO_goal_);
    const bool turns_over = X_from_goal.linear()(2, 2) < 1.0 - 1e-12;
    constexpr double kLevel = 1e-9;  // [m] start and goal on one table, but for rounding
    if (turns_over) {
      around.obstacles.emplace_back(
          geometry::transformed(table_body(X_WO_goal_.translation()), X_from_goal));
    } else if (const double goal_table_z = X_from_goal.translation().z(); goal_table_z > kLevel) {
      around.table_z_O = goal_table_z;  // nearer to the object there, which goes down
    }
    const Eigen::AlignedBox3d object_W = box_of(object_, X_WO_start_);
    // A hand that touches the object reaches no farther, its retreat to the pre-grasp included.
    const grasp::PreGraspOptions& pre_grasp = options_.planner.pre_grasp;
    const double reach =
        2.0 * hands::largest_reach(scene_.hand()) + pre_grasp.largest_retreat + pre_grasp.clearance;
    for (int other = 0; other < std::ssize(scene_.objects()); ++other) {
      if (other == object_) continue;
      const RigidTransform& X_WS = X_WO_[other];
      for (const RigidTransform& X : {X_WS, X_from_goal * X_WS}) {
        if (object_W.exteriorDistance(box_of(other, X)) > reach) continue;
        around.obstacles.emplace_back(geometry::transformed(scene_.hull_O(other), X));
      }
    }
    return around;
  }

  Eigen::AlignedBox3d box_of(int object, const RigidTransform& X_WO) const {
    return Eigen::AlignedBox3d(scene_.object(object).surface_O.box()).transformed(X_WO);
  }

  std::vector<Vector3d> approaches() const {
    std::vector<Vector3d> directions = options_.approaches_W;
    if (directions.empty()) {
      const Vector3d palm_W = options_.home.X_OH * scene_.hand().palm.center_H;
      const Vector3d center_W = X_WO_start_ * scene_.object(object_).center_of_mass_O;
      directions = {center_W - palm_W, -Vector3d::UnitZ()};
      // From a palm at the center of mass, no direction leads there.
      if (!(directions.front().norm() > 0.0)) directions.erase(directions.begin());
    }
    for (Vector3d& direction : directions) direction.normalize();
    return directions;
  }

  void note_no_grasp(const grasp::PlannerStatistics& statistics) {
    const auto most_frequent = [](const auto& counts) {
      return std::max_element(counts.begin(), counts.end(),
                              [](const auto& a, const auto& b) { return a.second < b.second; })
          ->first;
    };
    std::string why;
    if (statistics.attempts > 0) {
      why = std::string(" (most often ") + grasp::outcome_name(most_frequent(statistics.outcomes)) +
            ")";
    } else if (!statistics.target_failures.empty()) {
      why = " (" + most_frequent(statistics.target_failures) + ")";
    }
    ++attempt_.failures["no valid grasp with room at start and goal in " +
                        std::to_string(statistics.attempts) + " attempts" + why];
  }

  /// Whether a segment is free; else the reason is counted.
  bool is_free(const MotionSegment& segment, double clearance) {
    ++attempt_.segments_tried;
    const auto met = find_collision(scene_, X_WO_, segment, clearance);
    if (met) ++attempt_.failures[std::string(phase_name(segment.phase)) + ": " + met->text()];
    return !met;
  }

  /// The grasp seen from an object that has moved to `X_WO`.
  HandConfiguration carried(const HandConfiguration& at_start, const RigidTransform& X_WO) const {
    return {X_WO * geometry::relative_pose(X_WO_start_, at_start.X_OH), at_start.q};
  }

  MotionSegment free_hand(MotionPhase phase, const HandConfiguration& from,
                          const HandConfiguration& to, const RigidTransform& X_WO) const {
    return {phase, object_, from, to, X_WO, X_WO};
  }

  MotionSegment carry(MotionPhase phase, const HandConfiguration& grasp, const RigidTransform& from,
                      const RigidTransform& to) const {
    return {phase, object_, carried(grasp, from), carried(grasp, to), from, to};
  }

  std::optional<Way> whole_way(const grasp::Grasp& grasp) {
    const HandConfiguration& hold = grasp.configuration;
    const HandConfiguration& open = grasp.pre_grasp->configuration;
    const HandConfiguration hold_at_goal = carried(hold, X_WO_goal_);
    const HandConfiguration open_at_goal = carried(open, X_WO_goal_);
    const MotionSegment approach = free_hand(MotionPhase::Approach, open, hold, X_WO_start_);
    const MotionSegment release =
        free_hand(MotionPhase::Release, hold_at_goal, open_at_goal, X_WO_goal_);
    if (!is_free(approach, 0.0) || !is_free(release, 0.0)) return std::nullopt;
    auto carrying = carry_way(hold);
    if (!carrying) return std::nullopt;
    auto reach = between_home_and(open, MotionPhase::Reach, X_WO_start_);
    if (!reach) return std::nullopt;
    auto retreat = between_home_and(open_at_goal, MotionPhase::Retreat, X_WO_goal_);
    if (!retreat) return std::nullopt;
    Way way = std::move(*reach);
    way.push_back(approach);
    way.insert(way.end(), carrying->begin(), carrying->end());
    way.push_back(release);
    way.insert(way.end(), retreat->begin(), retreat->end());
    return way;
  }

  /// Up, over and down with the object in hand.
  std::optional<Way> carry_way(const HandConfiguration& hold) {
    for (const double height : options_.lifts) {
      const RigidTransform up = raised(X_WO_start_, height);
      const RigidTransform over = raised(X_WO_goal_, height);
      const MotionSegment lift = carry(MotionPhase::Lift, hold, X_WO_start_, up);
      const MotionSegment place = carry(MotionPhase::Place, hold, over, X_WO_goal_);
      if (!is_free(lift, 0.0) || !is_free(place, 0.0)) continue;
      for (const std::vector<RigidTransform>& stops : transports(up, over)) {
        Way way = {lift};
        bool is_way_free = true;
        for (std::size_t i = 0; i + 1 < stops.size() && is_way_free; ++i) {
          way.push_back(carry(MotionPhase::Transport, hold, stops[i], stops[i + 1]));
          is_way_free = is_free(way.back(), options_.clearance);
        }
        if (!is_way_free) continue;
        way.push_back(place);
        return way;
      }
    }
    return std::nullopt;
  }

  /// Straight; turning first; turning last.
  std::vector<std::vector<RigidTransform>> transports(const RigidTransform& up,
                                                      const RigidTransform& over) const {
    const Vector3d& center_O = scene_.object(object_).center_of_mass_O;
    const auto turned = [&](const RigidTransform& position, const RigidTransform& orientation) {
      RigidTransform X = orientation;
      X.translation() = position * center_O - X.linear() * center_O;
      return X;
    };
    return {{up, over}, {up, turned(up, over), over}, {up, turned(over, up), over}};
  }

  /// From home to a pre-grasp (Reach) or from there to home (Retreat), with the object at `X_WO`.
  std::optional<Way> between_home_and(const HandConfiguration& open, MotionPhase phase,
                                      const RigidTransform& X_WO) {
    const auto segment = [&](const HandConfiguration& outer, const HandConfiguration& inner) {
      const bool is_outward = phase == MotionPhase::Retreat;
      return is_outward ? free_hand(phase, inner, outer, X_WO)
                        : free_hand(phase, outer, inner, X_WO);
    };
    for (const double withdrawal : options_.withdrawals) {
      HandConfiguration behind = open;
      behind.X_OH.translation() -=
          withdrawal * (open.X_OH.linear() * scene_.hand().palm.direction_H);
      const MotionSegment last = segment(behind, open);
      if (!is_free(last, options_.clearance)) continue;
      std::vector<double> heights = {0.0};
      heights.insert(heights.end(), options_.lifts.begin(), options_.lifts.end());
      for (const double height : heights) {
        const HandConfiguration above{raised(behind.X_OH, height), behind.q};
        Way way = {segment(options_.home, above), last};
        if (height > 0.0) way.insert(way.begin() + 1, segment(above, behind));
        const bool is_way_free = std::all_of(way.begin(), way.end() - 1, [&](const auto& part) {
          return is_free(part, options_.clearance);
        });
        if (!is_way_free) continue;
        if (phase == MotionPhase::Retreat) std::reverse(way.begin(), way.end());
        return way;
      }
    }
    return std::nullopt;
  }

  const TableScene& scene_;
  std::span<const RigidTransform> X_WO_;
  int object_;
  RigidTransform X_WO_start_;
  RigidTransform X_WO_goal_;
  const PickAndPlaceOptions& options_;
  MoveAttempt attempt_;
};

void require_heights(const char* field, const std::vector<double>& lengths) {
  base::require(!lengths.empty(), "PickAndPlaceOptions", field, lengths.size(),
                "at least one length");
  for (const double length : lengths) {
    base::require(length > 0.0 && std::isfinite(length), "PickAndPlaceOptions", field, length,
                  "finite and > 0 m");
  }
}

}  // namespace

void PickAndPlaceOptions::validate() const {
  planner.validate();
  base::require(planner.acceptance == grasp::Acceptance::Valid, "PickAndPlaceOptions",
                "planner.acceptance", grasp::name_of(planner.acceptance), "valid");
  base::require(planner.pre_grasps, "PickAndPlaceOptions", "planner.pre_grasps",
                planner.pre_grasps ? "true" : "false", "true");
  base::require(clearance >= 0.0 && clearance < planner.pre_grasp.clearance, "PickAndPlaceOptions",
                "clearance", clearance,
                ">= 0 m and below that of pre-grasps, " +
                    base::shortest_decimal(planner.pre_grasp.clearance) + " m");
  for (const Vector3d& approach : approaches_W) {
    base::require(approach.allFinite() && approach.norm() > 0.0, "PickAndPlaceOptions",
                  "approaches_W", approach.norm(), "directions with a length");
  }
  require_heights("lifts", lifts);
  require_heights("withdrawals", withdrawals);
}

std::string MoveAttempt::reason() const {
  std::vector<std::pair<int, std::string>> counts;
  for (const auto& [what, count] : failures) counts.emplace_back(-count, what);
  std::sort(counts.begin(), counts.end());
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, counts.size()); ++i) {
    text += (text.empty() ? "" : "; ") + counts[i].second;
    if (counts[i].first < -1) text += " (" + std::to_string(-counts[i].first) + ")";
  }
  return text;
}

MoveAttempt plan_move(const TableScene& scene, std::span<const RigidTransform> X_WO, int object,
                      const RigidTransform& X_WO_goal, const PickAndPlaceOptions& options) {
  options.validate();
  const std::size_t num_objects = scene.objects().size();
  base::require(X_WO.size() == num_objects, "plan_move", "number of poses", X_WO.size(),
                "that of the objects, " + std::to_string(num_objects));
  base::require(object >= 0 && object < std::ssize(X_WO), "plan_move", "object", object,
                "in [0, " + std::to_string(num_objects) + ")");
  hands::validate(scene.hand(), options.home);
  return MoveSearch(scene, X_WO, object, X_WO_goal, options)();
}

}  // namespace graspfit::motion
