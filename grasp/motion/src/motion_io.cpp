#include "graspfit/motion/motion_io.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/base/json_value.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/base/path_text.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/named_shapes.hpp"
#include "graspfit/grasp/object_file.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "io/json_text.hpp"
#include "io/record_json.hpp"

namespace graspfit::motion {

namespace fs = std::filesystem;
using base::JsonValue;
using geometry::RigidTransform;
using grasp::internal::Json;
using grasp::internal::pose;

namespace {

constexpr const char* kFormat = "graspfit_motion";
constexpr std::int64_t kVersion = 1;
constexpr std::string_view kShapePrefix = "shape ";

Json joints_json(const Eigen::VectorXd& q) { return std::vector<double>(q.begin(), q.end()); }

/// A keyframe: the state in which a segment begins or ends.
Json keyframe_json(const hands::HandConfiguration& hand, const RigidTransform& X_WO) {
  return {{"X_WH", grasp::internal::to_json(hand.X_OH)},
          {"q", joints_json(hand.q)},
          {"X_WO", grasp::internal::to_json(X_WO)}};
}

Json move_json(const MotionFile& file, const RecordedMove& move) {
  Json segments = Json::array();
  for (const MotionSegment& segment : move.segments) {
    Json entry = {{"phase", phase_name(segment.phase)}};
    entry.update(keyframe_json(segment.to, segment.X_WO_to));
    segments.push_back(std::move(entry));
  }
  const MotionSegment& first = move.segments.front();
  return {{"object", file.objects.at(move.object).name},
          {"grasp_m", move.grasp_m},
          {"num_contacts", move.num_contacts},
          {"from", keyframe_json(first.from, first.X_WO_from)},
          {"to", segments}};
}

int object_index(const JsonValue& node, const std::vector<MotionObject>& objects) {
  const std::string name = node.text();
  for (int i = 0; i < std::ssize(objects); ++i) {
    if (objects[i].name == name) return i;
  }
  node.fail("is \"" + name + "\", which is none of the objects");
}

hands::HandConfiguration hand_at(const JsonValue& node, std::size_t num_joints) {
  const std::vector<JsonValue> positions = node.at("q").items();
  if (positions.size() != num_joints) {
    node.at("q").fail("has " + std::to_string(positions.size()) + " positions for " +
                      std::to_string(num_joints) + " joints");
  }
  hands::HandConfiguration hand{pose(node.at("X_WH")),
                                Eigen::VectorXd(static_cast<Eigen::Index>(num_joints))};
  for (std::size_t j = 0; j < num_joints; ++j) {
    hand.q[j] = positions[j].number();
  }
  return hand;
}

/// Poses and positions that differ by no more than this are the same but for rounding [m, rad].
constexpr double kSame = 1e-9;

bool are_same(const RigidTransform& a, const RigidTransform& b) {
  return (a.matrix() - b.matrix()).norm() <= kSame;
}

bool are_same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() <= kSame;
}

/// Refuses a segment whose motion its phase does not allow: an object that moves while the hand is
/// free, or a hand that moves relative to the object that it carries.
void require_possible(const JsonValue& end, const MotionSegment& segment) {
  const std::string phase = phase_name(segment.phase);
  if (!is_carrying(segment.phase)) {
    if (are_same(segment.X_WO_from, segment.X_WO_to)) return;
    end.at("X_WO").fail("is not where the object stood, which no hand carries in phase " + phase);
  }
  if (!are_same(segment.from.q, segment.to.q)) {
    end.at("q").fail("is not as before, and joints do not move in phase " + phase);
  }
  if (!are_same(geometry::relative_pose(segment.X_WO_from, segment.from.X_OH),
                geometry::relative_pose(segment.X_WO_to, segment.to.X_OH))) {
    end.at("X_WH").fail("is not the hand's place against the object, which it keeps in phase " +
                        phase);
  }
}

/// Where the moves before have left hand and objects.
struct Whereabouts {
  std::optional<hands::HandConfiguration> hand;
  std::vector<RigidTransform> X_WO;
};

/// Refuses a move that does not begin where the moves before it have left object and hand.
void require_there(const JsonValue& from, const MotionSegment& first, const Whereabouts& now) {
  if (!are_same(first.X_WO_from, now.X_WO[first.object])) {
    from.at("X_WO").fail("is not where the object stands then");
  }
  if (!now.hand) return;
  if (!are_same(first.from.X_OH, now.hand->X_OH)) {
    from.at("X_WH").fail("is not where the move before has left the hand");
  }
  if (!are_same(first.from.q, now.hand->q)) {
    from.at("q").fail("is not as the move before has left the joints");
  }
}

RecordedMove read_move(const JsonValue& node, const MotionFile& file, Whereabouts& now) {
  RecordedMove move{object_index(node.at("object"), file.objects),
                    node.at("grasp_m").number(),
                    node.at("num_contacts").small_integer(),
                    {}};
  JsonValue before = node.at("from");
  for (const JsonValue& after : node.at("to").items()) {
    const JsonValue phase = after.at("phase");
    const auto value = phase_named(phase.text());
    if (!value) phase.fail("is \"" + phase.text() + "\", which is no phase of a motion");
    move.segments.push_back({*value, move.object, hand_at(before, file.joints.size()),
                             hand_at(after, file.joints.size()), pose(before.at("X_WO")),
                             pose(after.at("X_WO"))});
    if (move.segments.size() == 1) require_there(before, move.segments.front(), now);
    require_possible(after, move.segments.back());
    before = after;
  }
  if (move.segments.empty()) node.at("to").fail("is empty");
  now.hand = move.segments.back().to;
  now.X_WO[move.object] = move.segments.back().X_WO_to;
  return move;
}

void require_hash(const std::string& what, const std::string& found, const std::string& recorded) {
  if (found == recorded) return;
  throw base::IoError(what + " is not the one recorded: its SHA-256 is " + found + ", not " +
                      recorded);
}

/// Requires that the joints are those of the hand, and that the hand can take their positions in
/// every keyframe.
void require_joints(const MotionFile& file, const hands::HandModel& hand) {
  std::vector<std::string> names;
  for (const hands::Joint& joint : hand.joints) names.push_back(joint.name);
  const auto differs =
      std::mismatch(names.begin(), names.end(), file.joints.begin(), file.joints.end());
  if (differs.first != names.end() || differs.second != file.joints.end()) {
    const auto name = [](const auto& at, const auto& end) { return at == end ? "none" : *at; };
    throw base::IoError("/hand/joints/" + std::to_string(differs.first - names.begin()) + ": is " +
                        name(differs.second, file.joints.end()) + ", of hand " + hand.name +
                        " it is " + name(differs.first, names.end()));
  }
  for (std::size_t m = 0; m < file.moves.size(); ++m) {
    const std::string move = "/moves/" + std::to_string(m);
    const std::vector<MotionSegment>& segments = file.moves[m].segments;
    const auto check = [&](const hands::HandConfiguration& configuration, const std::string& at) {
      try {
        hands::validate(hand, configuration);
      } catch (const base::InvalidInput& error) {
        throw base::IoError(move + at + "/q: " + error.what());
      }
    };
    if (!segments.empty()) check(segments.front().from, "/from");
    for (std::size_t s = 0; s < segments.size(); ++s) {
      check(segments[s].to, "/to/" + std::to_string(s));
    }
  }
}

geometry::TriangleMesh mesh_of(const MotionObject& object, const fs::path& mesh_folder) {
  if (object.file.starts_with(kShapePrefix)) {
    const geometry::TriangleMesh mesh =
        geometry::named_shape(object.file.substr(kShapePrefix.size()));
    // The shape is scaled as it was when it was made: a factor of one leaves its bits alone.
    return object.meters_per_file_unit == 1.0 ? mesh
                                              : geometry::scaled(mesh, object.meters_per_file_unit);
  }
  grasp::ObjectReadOptions options;
  options.meters_per_file_unit = object.meters_per_file_unit;
  const grasp::ObjectFile read = grasp::read_object_file(mesh_folder / object.file, options);
  require_hash("object " + object.file, read.record.sha256, object.sha256);
  return read.mesh;
}

}  // namespace

MotionFile make_motion_file(const TableScene& scene, std::vector<MotionObject> objects,
                            const std::vector<RigidTransform>& X_WO_goal,
                            const TidyingResult& result, const TidyingOptions& options) {
  const std::size_t num_objects = scene.objects().size();
  for (const std::size_t size : {objects.size(), X_WO_goal.size(), result.X_WO_start.size()}) {
    base::require(size == num_objects, "make_motion_file", "number of objects", size,
                  "that of the scene, " + std::to_string(num_objects));
  }
  MotionFile file;
  file.hand = scene.hand().description_file;
  file.description_sha256 = scene.hand().description_sha256;
  for (const hands::Joint& joint : scene.hand().joints) file.joints.push_back(joint.name);
  file.clearance = options.move.clearance;
  file.objects = std::move(objects);
  for (std::size_t i = 0; i < file.objects.size(); ++i) {
    file.objects[i].X_WO_start = result.X_WO_start[i];
    file.objects[i].X_WO_goal = X_WO_goal[i];
  }
  for (const PlannedMove& move : result.moves) {
    file.moves.push_back({move.object, move.grasp.quality.m,
                          base::as_index<int>(move.grasp.contacts.size()), move.segments});
  }
  file.unmoved = result.unmoved;
  return file;
}

std::string to_json(const MotionFile& file) {
  Json objects = Json::array();
  for (const MotionObject& object : file.objects) {
    objects.push_back({{"name", object.name},
                       {"file", base::path_text(object.file)},
                       {"sha256", object.sha256},
                       {"meters_per_file_unit", object.meters_per_file_unit},
                       {"X_WO_start", grasp::internal::to_json(object.X_WO_start)},
                       {"X_WO_goal", grasp::internal::to_json(object.X_WO_goal)}});
  }
  Json moves = Json::array();
  for (const RecordedMove& move : file.moves) moves.push_back(move_json(file, move));
  Json unmoved = Json::array();
  for (const UnmovedObject& object : file.unmoved) {
    unmoved.push_back({{"object", file.objects.at(object.object).name}, {"reason", object.reason}});
  }
  const Json json = {
      {"format", kFormat},
      {"version", kVersion},
      {"conventions",
       {{"units", "meters and radians; quaternions are w, x, y, z"},
        {"frames",
         "W: world, the table is z = 0 and z is up; H: the hand's base; O: an object's mesh, "
         "scaled; X_AB is the pose of frame B in frame A"},
        {"between_keyframes",
         "hand free: palm position and joints linear, palm rotation by the shortest arc; lift, "
         "transport and place: the same of the object's pose, taken at its center of mass, and "
         "the hand keeps its place against it"}}},
      {"title", file.title},
      {"hand",
       {{"description", base::path_text(file.hand)},
        {"description_sha256", file.description_sha256},
        {"joints", file.joints}}},
      {"proven_clearance_m", file.clearance},
      {"objects", objects},
      {"moves", moves},
      {"unmoved", unmoved}};
  return grasp::internal::json_text(json);
}

MotionFile read_motion(const fs::path& path) {
  const JsonValue root =
      JsonValue::parsed<base::IoError>(base::read_json_file(path), path.string());
  if (root.at("format").text() != kFormat) {
    root.at("format").fail(std::string("is not \"") + kFormat + '"');
  }
  if (root.at("version").integer() != kVersion) {
    root.at("version").fail("is not " + std::to_string(kVersion));
  }
  MotionFile file;
  file.title = root.at("title").text();
  file.hand = root.at("hand").at("description").path();
  file.description_sha256 = root.at("hand").at("description_sha256").text();
  file.joints = root.at("hand").at("joints").texts();
  file.clearance = root.at("proven_clearance_m").number();
  for (const JsonValue& object : root.at("objects").items()) {
    file.objects.push_back({object.at("name").text(), object.at("file").path(),
                            object.at("sha256").text(),
                            object.at("meters_per_file_unit").positive_number(),
                            pose(object.at("X_WO_start")), pose(object.at("X_WO_goal"))});
  }
  Whereabouts now;
  for (const MotionObject& object : file.objects) now.X_WO.push_back(object.X_WO_start);
  for (const JsonValue& move : root.at("moves").items()) {
    file.moves.push_back(read_move(move, file, now));
  }
  for (const JsonValue& object : root.at("unmoved").items()) {
    file.unmoved.push_back(
        {object_index(object.at("object"), file.objects), object.at("reason").text()});
  }
  return file;
}

TableScene read_motion_scene(const MotionFile& file, const fs::path& mesh_folder) {
  const bool is_in_folder = file.hand.find('/') != std::string::npos;
  hands::HandModel hand = hands::read_hand_model(is_in_folder ? mesh_folder / file.hand
                                                              : hands::find_hand_file(file.hand));
  require_hash("hand " + file.hand, hand.description_sha256, file.description_sha256);
  require_joints(file, hand);
  std::vector<SceneObject> objects;
  for (const MotionObject& object : file.objects) {
    geometry::TriangleMesh mesh = mesh_of(object, mesh_folder);
    const Eigen::Vector3d center = geometry::mass_properties(mesh).center_of_mass;
    objects.push_back({object.name, geometry::MeshQuery(std::move(mesh)), center});
  }
  return TableScene(std::move(hand), std::move(objects));
}

std::vector<std::vector<RigidTransform>> object_poses(const MotionFile& file) {
  std::vector<RigidTransform> X_WO;
  for (const MotionObject& object : file.objects) X_WO.push_back(object.X_WO_start);
  std::vector<std::vector<RigidTransform>> poses = {X_WO};
  for (const RecordedMove& move : file.moves) {
    X_WO.at(move.object) = move.segments.back().X_WO_to;
    poses.push_back(X_WO);
  }
  return poses;
}

}  // namespace graspfit::motion
