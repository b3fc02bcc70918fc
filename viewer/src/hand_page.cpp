#include "graspfit/viewer/hand_page.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "hand_data.hpp"
#include "page_template.hpp"

namespace graspfit::viewer {
namespace {

using internal::Json;
using internal::to_json;

void validate(const HandScene& scene) {
  const auto refuse = [](const std::string& what) {
    throw base::InvalidInput("hand_scene_json: " + what);
  };
  if (scene.poses.empty()) refuse("no pose of hand " + scene.hand.name);
  if (scene.clip_thickness &&
      !(*scene.clip_thickness > 0.0 && std::isfinite(*scene.clip_thickness))) {
    refuse("clip_thickness is " + std::to_string(*scene.clip_thickness) +
           ", must be finite and above 0");
  }
  for (const HandPose& pose : scene.poses) {
    if (pose.q.size() == std::ssize(scene.hand.joints)) continue;
    refuse("pose " + pose.name + " has " + std::to_string(pose.q.size()) + " joint positions, " +
           scene.hand.name + " has " + std::to_string(scene.hand.joints.size()) + " joints");
  }
}

Json poses(const HandScene& scene) {
  Json list = Json::array();
  for (const HandPose& pose : scene.poses) {
    Json X_HL = Json::array();
    for (const hands::RigidTransform& X :
         hands::forward_kinematics(scene.hand, {hands::RigidTransform::Identity(), pose.q})) {
      X_HL.push_back(to_json(X));
    }
    list.push_back({{"name", pose.name},
                    {"q", std::vector<double>(pose.q.data(), pose.q.data() + pose.q.size())},
                    {"X_HL", std::move(X_HL)}});
  }
  return list;
}

/// Views of a hand that show fingers and palm, in H. They are chosen by the shape of the open hand.
Json views(const hands::HandModel& hand) {
  const auto X_HL = hands::forward_kinematics(hand, hands::open_configuration(hand));
  const Eigen::Vector3d palm = hand.palm.direction_H;
  Eigen::Vector3d thumb = Eigen::Vector3d::Zero();   // its tip, from the palm center
  Eigen::Vector3d others = Eigen::Vector3d::Zero();  // mean of the other fingers' tips
  double num_others = 0.0;
  for (int f = 0; f < std::ssize(hand.fingers); ++f) {
    if (!hand.fingers[f].tip_pad) continue;
    const Eigen::Vector3d tip =
        hands::pad_pose(hand, *hand.fingers[f].tip_pad, X_HL).translation() - hand.palm.center_H;
    if (f == hand.thumb()) {
      thumb = tip;
    } else {
      others += tip;
      num_others += 1.0;
    }
  }
  if (num_others > 0.0) others /= num_others;
  const Eigen::Vector3d spread = thumb - others;
  constexpr double kNothing = 1e-9;  // [m]; a shorter vector gives no direction
  const auto unit_or = [&](const Eigen::Vector3d& v, const Eigen::Vector3d& otherwise) {
    return v.norm() > kNothing ? Eigen::Vector3d(v.normalized()) : otherwise;
  };
  constexpr double kFlat = 0.7;  // cosine; below it the palm faces across the fingers
  const bool is_flat = std::abs(unit_or(thumb + others, palm).dot(palm)) < kFlat;
  const Eigen::Vector3d fingers = num_others > 0.0 ? others : thumb;
  const Eigen::Vector3d up =
      is_flat ? unit_or(fingers - fingers.dot(palm) * palm, palm.unitOrthogonal())
              : unit_or(thumb + others, palm);
  const Eigen::Vector3d beside = unit_or(spread - spread.dot(palm) * palm, palm.unitOrthogonal());
  Eigen::Vector3d across = unit_or(palm.cross(is_flat ? up : beside), palm.unitOrthogonal());
  if (across.dot(beside) < 0.0) across = -across;  // the thumb's side
  const Eigen::Vector3d oblique = is_flat
                                      ? Eigen::Vector3d(0.8 * palm + 0.5 * across + 0.15 * up)
                                      : Eigen::Vector3d(0.8 * across + 0.35 * beside + 0.4 * palm);
  const Eigen::Vector3d up_along_palm = is_flat ? up : beside;
  Json list = Json::array();
  const auto add = [&](const char* name, const Eigen::Vector3d& back,
                       const Eigen::Vector3d& its_up) {
    list.push_back({{"name", name},
                    {"back", to_json(Eigen::Vector3d(back.normalized()))},
                    {"up", to_json(its_up)}});
  };
  add("oblique", oblique, up);
  add("side", across, up);
  add("front", palm, up_along_palm);
  add("behind", -palm, up_along_palm);
  return list;
}

/// The pads as they are drawn: thin plates that lie on their links.
Json plates(const hands::HandModel& hand) {
  constexpr double kPlate = 2e-4;  // [m]; enough to be seen in front of the link's own surface
  Json list = Json::array();
  for (const hands::ContactPad& pad : hand.pads) list.push_back(internal::clip_volume(pad, kPlate));
  return list;
}

}  // namespace

std::string hand_scene_json(const HandScene& scene) {
  validate(scene);
  const Json data = {{"description", scene.description},
                     {"hand", internal::hand_data(scene.hand, scene.clip_thickness)},
                     {"plates", plates(scene.hand)},
                     {"poses", poses(scene)},
                     {"views", views(scene.hand)}};
  return internal::script_text(data);
}

std::string hand_page_html(const HandScene& scene) {
  return internal::filled_page(
      {scene.hand.name, std::string(internal::kHandJs), hand_scene_json(scene)});
}

void write_hand_page(const std::filesystem::path& file, const HandScene& scene) {
  base::write_file_atomically(file, hand_page_html(scene));
}

}  // namespace graspfit::viewer
