#include "graspfit/viewer/motion_page.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "frame_data.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "hand_data.hpp"
#include "page_template.hpp"

namespace graspfit::viewer {
namespace {

using geometry::RigidTransform;
using internal::append_pose;
using internal::base64_of;
using internal::Json;
using internal::to_json;

void validate(const MotionInput& input) {
  const auto refuse = [](const std::string& what) {
    throw base::InvalidInput("motion_scene_json: " + what);
  };
  if (input.file.moves.empty()) refuse("the motion has no move");
  if (!(input.frame_step > 0.0)) refuse("frame_step is not a length above 0 m");
  if (!(input.largest_speed > 0.0)) refuse("largest_speed is not above 0 m/s");
  if (input.scene.objects().size() != input.file.objects.size()) {
    refuse("the scene has " + std::to_string(input.scene.objects().size()) + " objects, the file " +
           std::to_string(input.file.objects.size()));
  }
  if (input.scene.hand().joints.size() != input.file.joints.size()) {
    refuse("the hand has " + std::to_string(input.scene.hand().joints.size()) +
           " joints, the file " + std::to_string(input.file.joints.size()));
  }
}

std::string_view name_of(MotionCheck check) {
  switch (check) {
    case MotionCheck::NotChecked:
      return "not_checked";
    case MotionCheck::Free:
      return "free";
    case MotionCheck::NotFree:
      return "not_free";
  }
  return "";
}

/// Number of frames of a segment on which a point travels `travel` [m].
int num_frames(double travel, double frame_step) {
  constexpr double kFewest = 4.0;  // so that a short approach can be seen
  constexpr double kMost = 1e5;
  const double frames = std::max(kFewest, std::ceil(travel / frame_step));
  if (!(frames <= kMost)) {
    throw base::InvalidInput("motion_scene_json: a segment of " + base::shortest_decimal(travel) +
                             " m in frames of " + base::shortest_decimal(frame_step) +
                             " m has more than 100000 frames");
  }
  return static_cast<int>(frames);
}

/// Poses of all bodies, frame by frame.
class Frames {
 public:
  explicit Frames(const motion::TableScene& scene) : scene_(scene) {}

  void add(std::vector<RigidTransform> X_WO, int object, const motion::MotionState& state) {
    X_WO.at(object) = state.X_WO;
    for (const RigidTransform& X : X_WO) append_pose(X, objects_);
    for (const RigidTransform& X : hands::forward_kinematics(scene_.hand(), state.hand)) {
      append_pose(X, links_);
    }
    ++count_;
  }
  int count() const { return count_; }
  Json objects() const { return base64_of(objects_); }
  Json links() const { return base64_of(links_); }

 private:
  const motion::TableScene& scene_;
  int count_ = 0;
  std::vector<float> objects_;
  std::vector<float> links_;
};

/// Adds a move's frames. Returns the phases with the frames in which they end.
Json add_move(const MotionInput& input, const motion::RecordedMove& move,
              const std::vector<RigidTransform>& X_WO, Frames& frames) {
  Json phases = Json::array();
  for (const motion::MotionSegment& segment : move.segments) {
    const int parts = num_frames(motion::largest_travel(input.scene, segment), input.frame_step);
    for (int i = 1; i <= parts; ++i) {
      const double share = static_cast<double>(i) / parts;
      frames.add(X_WO, move.object, motion::state_at(input.scene, segment, share));
    }
    phases.push_back({{"name", motion::phase_name(segment.phase)}, {"last", frames.count() - 1}});
  }
  return phases;
}

}  // namespace

std::string motion_scene_json(const MotionInput& input) {
  validate(input);
  const motion::MotionFile& file = input.file;
  const auto poses = motion::object_poses(file);
  Frames frames(input.scene);
  const motion::MotionSegment& start = file.moves.front().segments.front();
  frames.add(poses.front(), file.moves.front().object, motion::state_at(input.scene, start, 0.0));
  Json moves = Json::array();
  for (std::size_t k = 0; k < file.moves.size(); ++k) {
    const motion::RecordedMove& move = file.moves[k];
    const int first = frames.count() - 1;
    const Json phases = add_move(input, move, poses[k], frames);
    moves.push_back({{"object", move.object},
                     {"m", move.grasp_m},
                     {"num_contacts", move.num_contacts},
                     {"first", first},
                     {"last", frames.count() - 1},
                     {"phases", phases}});
  }
  Json objects = Json::array();
  for (const motion::SceneObject& object : input.scene.objects()) {
    objects.push_back({{"name", object.name},
                       {"mesh", to_json(object.surface_O.mesh())},
                       {"center", to_json(object.center_of_mass_O)}});
  }
  Json unmoved = Json::array();
  for (const motion::UnmovedObject& object : file.unmoved) {
    unmoved.push_back({{"object", object.object}, {"reason", object.reason}});
  }
  const Json data = {{"title", file.title},
                     {"hand", internal::hand_data(input.scene.hand(), std::nullopt)},
                     {"objects", objects},
                     {"frame_time", input.frame_step / input.largest_speed},
                     {"num_frames", frames.count()},
                     {"object_poses", frames.objects()},
                     {"link_poses", frames.links()},
                     {"check", name_of(input.check)},
                     {"proven_clearance", file.clearance},
                     {"moves", moves},
                     {"unmoved", unmoved}};
  return internal::script_text(data);
}

std::string motion_page_html(const MotionInput& input) {
  return internal::filled_page({input.file.title, internal::script_of_player(internal::kMotionJs),
                                motion_scene_json(input)});
}

void write_motion_page(const std::filesystem::path& file, const MotionInput& input) {
  base::write_file_atomically(file, motion_page_html(input));
}

}  // namespace graspfit::viewer
