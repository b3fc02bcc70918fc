#include <limits>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/viewer/hand_page.hpp"
#include "sample_scene.hpp"
#include "support/catch.hpp"

namespace graspfit::test_hand_page {
namespace {

using testing::Contains;
using testing::sample_hand_scene;
using viewer::hand_page_html;

TEST_CASE("A hand's page names no other file and no network address", "[viewer][hand_page]") {
  const std::string html = hand_page_html(sample_hand_scene());
  CHECK(html.find("://") == std::string::npos);
  CHECK(html.find(" src=") == std::string::npos);
  CHECK(html.find("href=") == std::string::npos);
  CHECK_THAT(html, Contains("default-src 'none'"));
  CHECK(html.find("{{") == std::string::npos);
  CHECK(hand_page_html(sample_hand_scene()) == html);
}

TEST_CASE("A hand's names cannot break out of its page", "[viewer][hand_page]") {
  viewer::HandScene scene = sample_hand_scene();
  scene.hand.name = "</script><!-- {{data}}";
  scene.description = "</script>";
  const std::string html = hand_page_html(scene);
  CHECK_THAT(html, Contains("&lt;/script&gt;&lt;!-- {{data}}"));
  CHECK(html.find("</script><!--") == std::string::npos);
  CHECK_THAT(html, Contains("\\u003c/script>"));
}

TEST_CASE("A hand's page refuses scenes that do not fit", "[viewer][hand_page]") {
  viewer::HandScene scene = sample_hand_scene();
  scene.poses.clear();
  CHECK_THROWS_WITH(hand_page_html(scene), Contains("no pose"));
  scene = sample_hand_scene();
  scene.poses[1].q.resize(2);
  CHECK_THROWS_WITH(hand_page_html(scene), Contains("closed") && Contains("2 joint positions"));
  for (const double thickness : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    scene = sample_hand_scene();
    scene.clip_thickness = thickness;
    CHECK_THROWS_AS(hand_page_html(scene), base::InvalidInput);
  }
}

}  // namespace
}  // namespace graspfit::test_hand_page
