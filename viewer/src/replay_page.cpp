#include "graspfit/viewer/replay_page.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "frame_data.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hold_test/hold_batch.hpp"
#include "graspfit/hold_test/hold_parameters.hpp"
#include "graspfit/hold_test/hold_report.hpp"
#include "hand_data.hpp"
#include "page_template.hpp"

namespace graspfit::viewer {
namespace {

using geometry::RigidTransform;
using geometry::TriangleMesh;
using hold_test::HoldFrame;
using internal::append_pose;
using internal::base64_of;
using internal::Json;
using internal::to_json;

void validate(const ReplayInput& input) {
  const auto refuse = [](const std::string& what) {
    throw base::InvalidInput("replay_scene_json: " + what);
  };
  if (input.object_O.faces.empty()) refuse("the object has no faces");
  if (input.verdict.directions.empty()) refuse("the verdict has no direction");
  if (input.replays.size() != input.verdict.directions.size()) {
    refuse(std::to_string(input.replays.size()) + " replays of " +
           std::to_string(input.verdict.directions.size()) + " directions");
  }
  const std::size_t num_joints = input.hand.model.joints.size();
  for (std::size_t d = 0; d < input.replays.size(); ++d) {
    if (input.replays[d].empty()) refuse("replay " + std::to_string(d) + " has no frame");
    for (const HoldFrame& frame : input.replays[d]) {
      if (std::cmp_equal(frame.hand.q.size(), num_joints)) continue;
      refuse("a frame of replay " + std::to_string(d) + " has " +
             std::to_string(frame.hand.q.size()) + " joint positions, " + input.hand.model.name +
             " has " + std::to_string(num_joints) + " joints");
    }
  }
}

/// Convex pieces as one mesh, which is drawn instead of their body.
Json pieces_json(const geometry::ConvexDecomposition& shape) {
  TriangleMesh all;
  for (const TriangleMesh& piece : shape.pieces) {
    const auto first = base::as_index<std::int32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), piece.vertices.begin(), piece.vertices.end());
    for (const geometry::Face& face : piece.faces) {
      all.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    }
  }
  return to_json(all);
}

/// Shift of the object's center of mass [m] and turn [rad] between two frames, as the palm sees it.
struct Motion {
  double shift = 0.0;
  double turn = 0.0;
};

Motion motion_since(const HoldFrame& from, const HoldFrame& to, const Eigen::Vector3d& center_O) {
  const RigidTransform before = from.hand.X_OH.inverse() * from.X_OB;
  const RigidTransform after = to.hand.X_OH.inverse() * to.X_OB;
  const Eigen::Matrix3d turned = before.linear().transpose() * after.linear();
  return {(after * center_O - before * center_O).norm(), Eigen::AngleAxisd(turned).angle()};
}

double load_start(const hold_test::HoldProtocol& protocol) {
  return protocol.approach_time + protocol.squeeze_time;
}

/// Rounding error [s] by which times, which are sums of steps, may miss an exact time.
constexpr double kTimeRounding = 1e-9;

Json direction_json(const ReplayInput& input, std::size_t d) {
  const hold_test::DirectionVerdict& verdict = input.verdict.directions[d];
  const std::vector<HoldFrame>& frames = input.replays[d];
  const double start = load_start(input.protocol);
  // Before the load, shift and turn are measured from the planned pose, in which the object is at
  // the identity, as seen by the palm.
  const HoldFrame* squeezed = &frames.front();
  for (const HoldFrame& frame : frames) {
    if (frame.time <= start + kTimeRounding) squeezed = &frame;
  }
  const double diagonal = geometry::bounding_box(input.object_O).diagonal().norm();
  Json times = Json::array();
  Json shifts = Json::array();
  Json turns = Json::array();
  std::vector<float> object_poses;
  std::vector<float> link_poses;
  for (const HoldFrame& frame : frames) {
    const bool is_loaded = frame.time > start + kTimeRounding;
    HoldFrame planned = frame;
    planned.X_OB = RigidTransform::Identity();
    const Motion motion =
        motion_since(is_loaded ? *squeezed : planned, frame, input.object.center_of_mass_O);
    times.push_back(frame.time);
    shifts.push_back(motion.shift);
    turns.push_back(motion.turn);
    append_pose(frame.X_OB, object_poses);
    for (const RigidTransform& X_OL : hands::forward_kinematics(input.hand.model, frame.hand)) {
      append_pose(X_OL, link_poses);
    }
    constexpr double kFarAway = 2.0;  // diagonals of the object
    if (motion.shift > kFarAway * diagonal) break;
  }
  const bool is_lift = input.protocol.load == hold_test::HoldLoad::Lift;
  return {{"name", hold_test::load_names(input.protocol).at(d)},
          {"direction",
           to_json(is_lift ? Eigen::Vector3d(-Eigen::Vector3d::UnitZ()) : verdict.direction_O)},
          {"stage", hold_test::name_of(verdict.stage)},
          {"failed_at", verdict.failed_at ? Json(*verdict.failed_at) : Json(nullptr)},
          {"largest_shift", verdict.largest_shift},
          {"largest_turn", verdict.largest_turn},
          {"times", times},
          {"shifts", shifts},
          {"turns", turns},
          {"object_poses", base64_of(object_poses)},
          {"link_poses", base64_of(link_poses)}};
}

Json protocol_json(const hold_test::HoldProtocol& protocol) {
  const bool is_lift = protocol.load == hold_test::HoldLoad::Lift;
  Json parameters = Json::array();
  for (const std::string& name : hold_test::parameter_names()) {
    const Json value = std::visit([](const auto& held) { return Json(held); },
                                  hold_test::parameter_value(protocol, name));
    parameters.push_back({name, value});
  }
  return {{"name", protocol.name},
          {"source", protocol.source},
          {"is_lift", is_lift},
          {"force", is_lift ? protocol.object_mass * protocol.gravity : protocol.force},
          {"load_start", load_start(protocol)},
          {"approach_time", protocol.approach_time},
          {"largest_shift", protocol.largest_shift},
          {"largest_turn", protocol.largest_turn},
          {"parameters", parameters}};
}

}  // namespace

std::size_t telling_direction(const hold_test::HoldVerdict& verdict,
                              const hold_test::HoldProtocol& protocol) {
  // A smaller rank is more informative: first directions lost before the load, then by the time of
  // failure, then by how near they came to a limit.
  const auto rank = [&](const hold_test::DirectionVerdict& direction) {
    if (direction.stage != hold_test::HoldStage::Load &&
        direction.stage != hold_test::HoldStage::Held) {
      return std::pair(0, 0.0);
    }
    if (direction.failed_at) return std::pair(1, *direction.failed_at);
    return std::pair(2, -std::max(direction.largest_shift / protocol.largest_shift,
                                  direction.largest_turn / protocol.largest_turn));
  };
  const auto& directions = verdict.directions;
  return static_cast<std::size_t>(
      std::min_element(directions.begin(), directions.end(),
                       [&](const auto& a, const auto& b) { return rank(a) < rank(b); }) -
      directions.begin());
}

std::string replay_scene_json(const ReplayInput& input) {
  validate(input);
  Json link_pieces = Json::array();
  for (const geometry::ConvexDecomposition& link : input.hand.links) {
    link_pieces.push_back(pieces_json(link));
  }
  Json directions = Json::array();
  for (std::size_t d = 0; d < input.replays.size(); ++d) {
    directions.push_back(direction_json(input, d));
  }
  const bool is_lift = input.protocol.load == hold_test::HoldLoad::Lift;
  Json data = {{"title", input.title},
               {"object", to_json(input.object_O)},
               {"center_of_mass", to_json(input.object.center_of_mass_O)},
               {"hand", internal::hand_data(input.hand.model, std::nullopt)},
               {"pieces",
                {{"object", pieces_json(input.object.shape)},
                 {"num_object", input.object.shape.pieces.size()},
                 {"links", link_pieces}}},
               {"protocol", protocol_json(input.protocol)},
               {"table_z", is_lift ? Json(hold_test::table_z_O(input.object)) : Json(nullptr)},
               {"verdict",
                {{"stage", hold_test::name_of(input.verdict.stage)},
                 {"reason", input.verdict.reason},
                 {"squeeze_force", input.verdict.squeeze_force}}},
               {"shown", telling_direction(input.verdict, input.protocol)},
               {"directions", directions}};
  if (!input.note.empty()) data["note"] = input.note;
  return internal::script_text(data);
}

std::string replay_page_html(const ReplayInput& input) {
  return internal::filled_page(
      {input.title, internal::script_of_player(internal::kReplayJs), replay_scene_json(input)});
}

void write_replay_page(const std::filesystem::path& file, const ReplayInput& input) {
  base::write_file_atomically(file, replay_page_html(input));
}

}  // namespace graspfit::viewer
