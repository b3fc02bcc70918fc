#include <limits>
#include <string>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/viewer/page.hpp"
#include "sample_scene.hpp"
#include "support/catch.hpp"

namespace graspfit::test_page {
namespace {

using testing::Contains;
using viewer::page_html;

viewer::PageInput sample_input() {
  const testing::SampleScene scene = testing::sample_scene();
  viewer::PageInput input;
  input.title = "sample";
  input.object_O = scene.object_O;
  input.hand = scene.hand;
  input.grasps = scene.grasps;
  return input;
}

TEST_CASE("A page names no other file and no network address", "[viewer][page]") {
  const std::string html = page_html(sample_input());
  CHECK(html.find("://") == std::string::npos);
  CHECK(html.find(" src=") == std::string::npos);
  CHECK(html.find("href=") == std::string::npos);
  CHECK_THAT(html, Contains("default-src 'none'"));
}

TEST_CASE("The same input gives the same page, byte for byte", "[viewer][page]") {
  CHECK(page_html(sample_input()) == page_html(sample_input()));
}

TEST_CASE("Names cannot break out of the page's text or data", "[viewer][page]") {
  viewer::PageInput input = sample_input();
  input.title = "a <b> & {{data}}";
  input.hand.name = "</script><!--";
  const std::string html = page_html(input);
  CHECK_THAT(html, Contains("a &lt;b&gt; &amp; {{data}}"));
  CHECK(html.find("</script><!--") == std::string::npos);
  CHECK_THAT(html, Contains("\\u003c/script>\\u003c!--"));
}

TEST_CASE("A note is in the page's data, and without one there is none", "[viewer][page]") {
  viewer::PageInput input = sample_input();
  CHECK(page_html(input).find("\"note\":") == std::string::npos);
  input.note = "cup.off: the solid differs from the file: filled 5 holes";
  CHECK_THAT(page_html(input), Contains("\"note\":\"" + input.note + "\""));
}

TEST_CASE("Link meshes are in the page once, however many grasps there are", "[viewer][page]") {
  viewer::PageInput input = sample_input();
  input.grasps.resize(1);
  const std::size_t one = page_html(input).size();
  input.grasps.push_back(input.grasps.front());
  const std::size_t two = page_html(input).size();
  input.hand.links.front().mesh_L = input.object_O;  // It has 2562 vertices and 5120 faces.
  const std::size_t two_with_large_link = page_html(input).size();
  CHECK(two - one < 16000);
  // Base64 takes 4/3 of 12 bytes per vertex and per face.
  CHECK(two_with_large_link - two < 1.02 * 16 * (2562 + 5120));
}

TEST_CASE("A written page is what page_html returns", "[viewer][page]") {
  const auto folder = std::filesystem::temp_directory_path() / "graspfit_test_page";
  std::filesystem::create_directories(folder);
  viewer::write_page(folder / "page.html", sample_input());
  CHECK(base::read_file(folder / "page.html") == page_html(sample_input()));
  CHECK_THROWS_AS(viewer::write_page(folder / "missing" / "page.html", sample_input()),
                  base::IoError);
  std::filesystem::remove_all(folder);
}

TEST_CASE("A pad without a thickness of its own has a clip volume if one is given",
          "[viewer][page]") {
  viewer::PageInput input = sample_input();
  for (hands::ContactPad& pad : input.hand.pads) pad.clip_thickness.reset();
  const auto num_without = [&] {
    const std::string html = page_html(input);
    std::size_t count = 0;
    for (std::size_t at = 0; (at = html.find("\"clip\":null", at)) != std::string::npos; ++at) {
      ++count;
    }
    return count;
  };
  input.clip_thickness.reset();
  CHECK(num_without() == input.hand.pads.size());
  input.clip_thickness = 0.003;
  CHECK(num_without() == 0);
}

TEST_CASE("Input that makes no sense is refused in one line", "[viewer][page]") {
  viewer::PageInput input = sample_input();
  SECTION("object without faces") {
    input.object_O.faces.clear();
    CHECK_THROWS_WITH(page_html(input), "write_page: the object has no faces");
  }
  SECTION("face that leaves the mesh") {
    input.object_O.faces[7] = {0, 1, 5000};
    CHECK_THROWS_WITH(page_html(input),
                      "write_page: face 7 of the object uses vertex 5000 of 2562");
  }
  SECTION("grasp of another hand") {
    input.grasps[1].configuration.q.resize(2);
    CHECK_THROWS_WITH(page_html(input),
                      "write_page: grasp 2 has 2 joint positions, sample has 3 joints");
  }
  SECTION("pre-grasp of another hand") {
    input.grasps[0].pre_grasp->configuration.q.resize(4);
    CHECK_THROWS_WITH(
        page_html(input),
        "write_page: pre-grasp of grasp 1 has 4 joint positions, sample has 3 joints");
  }
  SECTION("contact of a link that is not there") {
    input.grasps[0].contacts[0].link = 9;
    CHECK_THROWS_AS(page_html(input), base::InvalidInput);
  }
  SECTION("thickness") {
    input.clip_thickness = GENERATE(-0.001, 0.0, std::numeric_limits<double>::quiet_NaN(),
                                    std::numeric_limits<double>::infinity());
    CHECK_THROWS_WITH(page_html(input), Contains("clip_thickness"));
  }
}

}  // namespace
}  // namespace graspfit::test_page
