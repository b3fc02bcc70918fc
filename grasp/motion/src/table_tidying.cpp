#include "graspfit/motion/table_tidying.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/rest_pose.hpp"

namespace graspfit::motion {

using geometry::RigidTransform;

namespace {

bool is_same(const RigidTransform& a, const RigidTransform& b) { return a.matrix() == b.matrix(); }

/// Depth-first search over moves.
class TidyingSearch {
 public:
  TidyingSearch(const TableScene& scene, const std::vector<RigidTransform>& X_WO_start,
                const std::vector<RigidTransform>& X_WO_goal, const TidyingOptions& options)
      : scene_(scene), goal_(X_WO_goal), options_(options), at_(X_WO_start) {
    result_.X_WO_start = X_WO_start;
    result_.X_WO_end = X_WO_start;
    was_put_down_.resize(X_WO_start.size(), false);
  }

  TidyingResult operator()() {
    search();
    return std::move(result_);
  }

 private:
  int num_objects() const { return base::as_index<int>(at_.size()); }
  bool is_home(int object) const { return is_same(at_[object], goal_[object]); }

  /// True once all objects are at their goals.
  bool search() {
    std::vector<UnmovedObject> refused;
    for (int object = 0; object < num_objects(); ++object) {
      if (is_home(object)) continue;
      std::string reason;
      if (std::optional<PlannedMove> move = planned(object, goal_[object], reason)) {
        if (descend(std::move(*move))) return true;
        refused.push_back({object, "its goal leaves another object without a free move"});
      } else {
        refused.push_back({object, reason});
      }
    }
    note(refused);
    return refused.empty() || put_one_down();
  }

  bool put_one_down() {
    for (int object = 0; object < num_objects(); ++object) {
      if (is_home(object) || was_put_down_[object]) continue;
      was_put_down_[object] = true;
      for (const RigidTransform& X_WO : stopovers(object)) {
        std::string reason;
        std::optional<PlannedMove> move = planned(object, X_WO, reason);
        if (move && descend(std::move(*move))) return true;
      }
      was_put_down_[object] = false;
    }
    return false;
  }

  bool descend(PlannedMove move) {
    const int object = move.object;
    const RigidTransform before = std::exchange(at_[object], move.X_WO_to);
    moves_.push_back(std::move(move));
    if (search()) return true;
    moves_.pop_back();
    at_[object] = before;
    return false;
  }

  /// Keeps the current arrangement if it has more objects at their goals than all before.
  void note(const std::vector<UnmovedObject>& refused) {
    int num_home = 0;
    for (int object = 0; object < num_objects(); ++object) num_home += is_home(object) ? 1 : 0;
    if (best_num_home_ && num_home <= *best_num_home_) return;
    best_num_home_ = num_home;
    result_.moves = moves_;
    result_.X_WO_end = at_;
    result_.unmoved = refused;
  }

  std::optional<PlannedMove> planned(int object, const RigidTransform& X_WO_to,
                                     std::string& reason) {
    if (result_.moves_tried >= options_.max_moves_tried) {
      reason = "not tried: the limit of " + std::to_string(options_.max_moves_tried) +
               " planned moves was reached";
      return std::nullopt;
    }
    ++result_.moves_tried;
    // Moves of two objects in either order lead to one arrangement, in which a refused move comes
    // up again.
    const auto known = std::find_if(refused_.begin(), refused_.end(), [&](const Refused& refused) {
      return refused.object == object && is_same(refused.X_WO_to, X_WO_to) &&
             std::equal(at_.begin(), at_.end(), refused.at.begin(), is_same);
    });
    const bool is_known = known != refused_.end();
    MoveAttempt attempt =
        is_known ? known->attempt : plan_move(scene_, at_, object, X_WO_to, options_.move);
    if (!is_known && !attempt.move) refused_.push_back({at_, object, X_WO_to, attempt});
    result_.segments_tried += attempt.segments_tried;
    result_.planner_attempts += attempt.planner_attempts;
    result_.grasps_tried += attempt.grasps_tried;
    reason = attempt.reason();
    return std::move(attempt.move);
  }

  /// Returns the poses in which an object may be put down in between: for each rest pose, all
  /// resting places and quarter turns.
  std::vector<RigidTransform> stopovers(int object) const {
    const SceneObject& moved = scene_.object(object);
    const auto up_of = [](const RigidTransform& X_WO) -> Eigen::Vector3d {
      return X_WO.linear().row(2).transpose();
    };
    std::vector<Eigen::Vector3d> ups = {up_of(goal_[object]), up_of(at_[object])};
    for (const geometry::RestPose& pose :
         geometry::rest_poses(moved.surface_O.mesh(), moved.center_of_mass_O)) {
      ups.push_back(pose.up_O);
    }
    std::vector<Eigen::Vector3d> distinct;
    for (const Eigen::Vector3d& up : ups) {
      const bool is_known = std::any_of(distinct.begin(), distinct.end(), [&](const auto& other) {
        return (up - other).norm() < 0.1;
      });
      if (!is_known && std::ssize(distinct) < options_.max_rest_poses) {
        distinct.push_back(up);
      }
    }
    std::vector<RigidTransform> poses;
    for (const Eigen::Vector3d& up : distinct) {
      for (const Eigen::Vector2d& resting_place : options_.resting_places_W) {
        for (int quarter = 0; quarter < 4; ++quarter) {
          poses.push_back(geometry::standing_pose(moved.surface_O.mesh(), up,
                                                  0.5 * std::numbers::pi * quarter,
                                                  moved.center_of_mass_O, resting_place));
        }
      }
    }
    return poses;
  }

  /// A move that was found impossible in an arrangement.
  struct Refused {
    std::vector<RigidTransform> at;
    int object = -1;
    RigidTransform X_WO_to;
    MoveAttempt attempt;
  };

  const TableScene& scene_;
  const std::vector<RigidTransform>& goal_;
  const TidyingOptions& options_;
  std::vector<RigidTransform> at_;
  std::vector<bool> was_put_down_;
  std::vector<PlannedMove> moves_;
  std::vector<Refused> refused_;
  std::optional<int> best_num_home_;  // empty: no arrangement noted yet
  TidyingResult result_;
};

}  // namespace

void TidyingOptions::validate() const {
  move.validate();
  for (const Eigen::Vector2d& resting_place : resting_places_W) {
    base::require(resting_place.allFinite(), "TidyingOptions", "resting_places_W",
                  base::shortest_decimal(resting_place.x()) + ", " +
                      base::shortest_decimal(resting_place.y()),
                  "finite");
  }
  base::require(max_rest_poses >= 1, "TidyingOptions", "max_rest_poses", max_rest_poses, ">= 1");
  base::require(max_moves_tried >= 1, "TidyingOptions", "max_moves_tried", max_moves_tried, ">= 1");
}

TidyingResult tidy_table(const TableScene& scene, const std::vector<RigidTransform>& X_WO_start,
                         const std::vector<RigidTransform>& X_WO_goal,
                         const TidyingOptions& options) {
  options.validate();
  const std::size_t num_objects = scene.objects().size();
  for (const std::size_t size : {X_WO_start.size(), X_WO_goal.size()}) {
    base::require(size == num_objects, "tidy_table", "number of poses", size,
                  "that of the objects, " + std::to_string(num_objects));
  }
  for (int a = 0; a < std::ssize(scene.objects()); ++a) {
    const SceneObject& object = scene.objects()[a];
    for (const auto* poses : {&X_WO_start, &X_WO_goal}) {
      const double height = scene.height_of_object(a, (*poses)[a]);
      base::require(height >= -1e-9, "tidy_table: " + object.name, "lowest z", height,
                    ">= 0 m at start and goal");
    }
    for (int b = 0; b < a; ++b) {
      if (geometry::do_intersect(scene.objects()[b].surface_O, object.surface_O,
                                 geometry::relative_pose(X_WO_start[b], X_WO_start[a]))) {
        throw base::InvalidInput("tidy_table: " + scene.objects()[b].name + " and " + object.name +
                                 " start inside each other");
      }
    }
  }
  return TidyingSearch(scene, X_WO_start, X_WO_goal, options)();
}

}  // namespace graspfit::motion
