#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/viewer/replay_page.hpp"
#include "sample_replay.hpp"
#include "support/catch.hpp"

namespace graspfit::test_replay_page {
namespace {

using hold_test::HoldStage;
using testing::Contains;
using testing::sample_replay;
using viewer::replay_page_html;

TEST_CASE("A replay's page names no other file and no network address", "[viewer][replay_page]") {
  const std::string html = replay_page_html(sample_replay());
  CHECK(html.find("://") == std::string::npos);
  CHECK(html.find(" src=") == std::string::npos);
  CHECK(html.find("href=") == std::string::npos);
  CHECK_THAT(html, Contains("default-src 'none'"));
  CHECK_THAT(html, Contains("Ball &lt;40 mm&gt;, grasp 1"));
  CHECK(replay_page_html(sample_replay()) == html);
}

TEST_CASE("A replay's shifts and turns are the object's as the palm sees it",
          "[viewer][replay_page]") {
  viewer::ReplayInput input = sample_replay();
  // The whole scene is moved while under load, as by a lift, so that nothing slips.
  auto& lifted = input.replays[1];
  for (hold_test::HoldFrame& frame : lifted) {
    if (frame.time <= 0.4 + 1e-9) continue;
    geometry::RigidTransform X = geometry::RigidTransform::Identity();
    X.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
    X.translation().z() = 0.1;
    frame.X_OB = X;
    frame.hand.X_OH = X * frame.hand.X_OH;
  }
  const auto data = nlohmann::json::parse(viewer::replay_scene_json(input));
  for (const double shift : data["directions"][1]["shifts"]) CHECK(shift < 1e-12);
  for (const double turn : data["directions"][1]["turns"]) CHECK(turn < 1e-7);

  const auto& slides = data["directions"][2];
  for (std::size_t i = 0; i < slides["times"].size(); ++i) {
    const double t = std::max(0.0, slides["times"][i].get<double>() - 0.4);
    CHECK(slides["shifts"][i].get<double>() == Approx(2.5 * t * t).margin(1e-12));
    CHECK(slides["turns"][i].get<double>() == Approx(t).margin(1e-7));
  }
  // The ball's diagonal is 80 mm · sqrt(3), and frames end with the first beyond two of them.
  const auto& shifts = slides["shifts"];
  const double far = 2.0 * 0.08 * std::sqrt(3.0);
  CHECK(shifts.back().get<double>() > far);
  CHECK(shifts[shifts.size() - 2].get<double>() <= far);
  CHECK(data["directions"][0]["times"].size() == 51);
}

TEST_CASE("A replay of a lift has the table on which the object stands", "[viewer][replay_page]") {
  viewer::ReplayInput input = sample_replay();
  CHECK(nlohmann::json::parse(viewer::replay_scene_json(input))["table_z"].is_null());
  input.protocol.load = hold_test::HoldLoad::Lift;
  input.verdict.directions.resize(1);
  input.replays.resize(1);
  // The pieces are a cube of 80 mm.
  CHECK(nlohmann::json::parse(viewer::replay_scene_json(input))["table_z"] == -0.04);
  input.object.foot_O = {{0.0, 0.0, -0.0405}, {0.0, 0.0, -0.0395}};
  CHECK(nlohmann::json::parse(viewer::replay_scene_json(input))["table_z"] == -0.0405);
}

TEST_CASE("A note is in the replay's data, and without one there is none",
          "[viewer][replay_page]") {
  viewer::ReplayInput input = sample_replay();
  CHECK_FALSE(nlohmann::json::parse(viewer::replay_scene_json(input)).contains("note"));
  input.note = "cup.off: the solid differs from the file: filled 5 holes";
  CHECK(nlohmann::json::parse(viewer::replay_scene_json(input))["note"] == input.note);
}

TEST_CASE("The direction that a replay starts with failed first or came nearest to a limit",
          "[viewer][replay_page]") {
  const viewer::ReplayInput input = sample_replay();
  hold_test::HoldVerdict verdict = input.verdict;
  CHECK(viewer::telling_direction(verdict, input.protocol) == 2);
  verdict.directions[1] = verdict.directions[2];
  verdict.directions[1].failed_at = 0.3;
  CHECK(viewer::telling_direction(verdict, input.protocol) == 2);
  verdict.directions[0].stage = HoldStage::Approach;
  CHECK(viewer::telling_direction(verdict, input.protocol) == 0);
  // The share 0.1 of the largest shift is less than 0.2 of the largest turn.
  verdict.directions = {{Eigen::Vector3d::UnitX(), HoldStage::Held, std::nullopt,
                         0.1 * input.protocol.largest_shift, 0.0},
                        {Eigen::Vector3d::UnitY(), HoldStage::Held, std::nullopt, 0.0,
                         0.2 * input.protocol.largest_turn}};
  CHECK(viewer::telling_direction(verdict, input.protocol) == 1);
}

TEST_CASE("A replay refuses what does not fit together", "[viewer][replay_page]") {
  const auto refused = [](auto change) {
    viewer::ReplayInput input = sample_replay();
    change(input);
    std::string message;
    try {
      replay_page_html(input);
    } catch (const base::InvalidInput& error) {
      message = error.what();
    }
    return message;
  };
  CHECK_THAT(refused([](auto& input) { input.object_O.faces.clear(); }), Contains("no faces"));
  CHECK_THAT(refused([](auto& input) { input.replays.pop_back(); }),
             Contains("2 replays of 3 directions"));
  CHECK_THAT(refused([](auto& input) { input.replays[1].clear(); }),
             Contains("replay 1 has no frame"));
  CHECK_THAT(refused([](auto& input) { input.replays[2][3].hand.q.resize(2); }),
             Contains("replay 2 has 2 joint positions") && Contains("3 joints"));
  CHECK_THAT(refused([](auto& input) {
               input.verdict.directions.clear();
               input.replays.clear();
             }),
             Contains("no direction"));
}

}  // namespace
}  // namespace graspfit::test_replay_page
