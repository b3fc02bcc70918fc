#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/viewer/motion_page.hpp"
#include "sample_motion.hpp"
#include "support/catch.hpp"

namespace graspfit::test_motion_page {
namespace {

using testing::Contains;
using testing::sample_motion;

TEST_CASE("A motion's page names no other file and no network address", "[viewer][motion_page]") {
  const std::string html = viewer::motion_page_html(sample_motion());
  CHECK(html.find("://") == std::string::npos);
  CHECK(html.find(" src=") == std::string::npos);
  CHECK(html.find("href=") == std::string::npos);
  CHECK_THAT(html, Contains("default-src 'none'"));
  CHECK_THAT(html, Contains("Two moves &amp; a &lt;flat&gt; box"));
  CHECK(viewer::motion_page_html(sample_motion()) == html);
}

TEST_CASE("A motion's frames are as near as asked for and belong to one phase each",
          "[viewer][motion_page]") {
  viewer::MotionInput input = sample_motion();
  input.frame_step = 0.02;
  const auto data = nlohmann::json::parse(viewer::motion_scene_json(input));
  int frames = 1;
  for (const auto& move : input.file.moves) {
    for (const auto& segment : move.segments) {
      frames += static_cast<int>(
          std::max(4.0, std::ceil(motion::largest_travel(input.scene, segment) / 0.02)));
    }
  }
  CHECK(data["num_frames"] == frames);
  // A body has 7 floats of 4 bytes per frame, in base64.
  const auto length = [&](std::size_t bodies) { return (28 * bodies * frames + 2) / 3 * 4; };
  CHECK(data["object_poses"].get<std::string>().size() == length(3));
  CHECK(data["link_poses"].get<std::string>().size() == length(input.scene.hand().links.size()));
  CHECK(data["frame_time"].get<double>() == Approx(0.08));
  int last = 0;
  for (const auto& move : data["moves"]) {
    CHECK(move["first"] == last);
    CHECK(move["phases"].size() == 7);
    for (const auto& phase : move["phases"]) {
      CHECK(phase["last"] > last);
      last = phase["last"];
    }
    CHECK(move["last"] == last);
  }
  CHECK(last == frames - 1);
  CHECK(data["unmoved"][0]["reason"] == "it is too flat");
}

TEST_CASE("A motion's page claims no more than was found", "[viewer][motion_page]") {
  viewer::MotionInput input = sample_motion();
  const auto check_of = [&] {
    return nlohmann::json::parse(viewer::motion_scene_json(input))["check"].get<std::string>();
  };
  CHECK(check_of() == "not_checked");
  input.check = viewer::MotionCheck::Free;
  CHECK(check_of() == "free");
  input.check = viewer::MotionCheck::NotFree;
  CHECK(check_of() == "not_free");
  for (const char* const finding : {"free", "not_free", "not_checked"}) {
    CHECK_THAT(viewer::motion_page_html(input), Contains(std::string("  ") + finding + ": '"));
  }
}

TEST_CASE("A motion's page refuses what does not fit together", "[viewer][motion_page]") {
  const auto refused = [](auto change) {
    viewer::MotionInput input = sample_motion();
    change(input);
    std::string message;
    try {
      viewer::motion_scene_json(input);
    } catch (const base::InvalidInput& error) {
      message = error.what();
    }
    return message;
  };
  CHECK_THAT(refused([](auto& input) { input.file.moves.clear(); }), Contains("no move"));
  CHECK_THAT(refused([](auto& input) { input.file.objects.pop_back(); }),
             Contains("3 objects, the file 2"));
  CHECK_THAT(refused([](auto& input) { input.file.joints.pop_back(); }), Contains("joints"));
  CHECK_THAT(refused([](auto& input) { input.frame_step = 0.0; }), Contains("frame_step"));
  CHECK_THAT(refused([](auto& input) { input.frame_step = 1e-300; }),
             Contains("more than 100000 frames"));
  CHECK_THAT(refused([](auto& input) { input.largest_speed = std::nan(""); }),
             Contains("largest_speed"));
}

}  // namespace
}  // namespace graspfit::test_motion_page
