#include <string>
#include <vector>

#include "hands/bad_hand_files.hpp"

namespace test_bad_sidecars {

namespace {

using namespace graspfit;
using namespace graspfit::testing;

TEST_CASE("What is wrong in a sidecar is named by its place and value", "[hands][bad_hand_files]") {
  const std::string thumb = R"("thumb": false)";
  const std::string fingers = R"("fingers": [)";
  const std::string pads = R"("pads": [)";
  const std::string outline = R"([[-0.03, -0.01], [0.03, -0.01], [0, 0.02]])";
  const std::string coupling =
      R"({"joint": "bend", "leader": "turn", "ratio": 0.5, "offset": 0.1, "breakaway": true})";
  check_sidecar_rows({
      {R"("version": 1)", R"("version": 2)", {"version"}},
      {R"("version": 1)", R"("version": "1")", {"version"}},
      {R"("version": 1)", R"("version": 1.5)", {"version"}},
      {R"("format": {"name": "graspfit hand sidecar", "version": 1},)",
       R"("format": {"name": "graspfit hand sidecar"},)",
       {"format", "version"}},
      {R"("name": "graspfit hand sidecar")", R"("name": "hand")", {"format"}},
      {R"("closing")", R"("closings")", {"closings"}},
      {R"("swing_joint")", R"("swing")", {"fingers", "swing"}},
      {R"("clip": {"kind")", R"("clip": {"sort")", {"pads/0/clip", "sort"}},
      {R"("tip_pad": "one_pad")", R"("tip_pad": "pad")", {"one", "pad"}},
      {R"("links": ["left"])", R"("links": ["lefty"])", {"one", "lefty"}},
      {R"("links": ["left"])", R"("links": [])", {"one", "links"}},
      {R"("links": ["left"])", R"("links": "left")", {"fingers", "links"}},
      {R"("joints": ["slide"])", R"("joints": ["glide"])", {"one", "glide"}},
      {R"("joints": ["slide"])", R"("joints": [1])", {"fingers", "joints"}},
      {R"("swing_joint": null)", R"("swing_joint": "spin")", {"two", "spin"}},
      {thumb, R"("thumb": true)", {"thumb"}},
      {thumb, R"("thumb": "no")", {"thumb"}},
      {fingers, fingers + R"({"name": "two", "links": ["tip"], "joints": ["bend"]},)", {"two"}},
      {fingers, fingers + R"({"name": "palm", "links": ["tip"], "joints": ["bend"]},)", {"palm"}},
      {fingers, fingers + R"({"name": "too", "links": ["tip"], "joints": ["bend"]},)", {"tip"}},
      {R"("tip_pad": "two_pad")", R"("tip_pad": "one_pad")", {"two", "one_pad"}},
      {pads,
       pads + R"({"name": "two_pad", "link": "tip", "finger": "two",
         "frame": {"translation_m": [0, 0, 0], "rotation_wxyz": [1, 0, 0, 0]},
         "outline_m": [[0, 0], [0.01, 0], [0, 0.01]]},)",
       {"two_pad"}},
      {R"("link": "tip")", R"("link": "tipp")", {"two_pad", "tipp"}},
      {R"("link": "tip")", R"("link": "left")", {"two_pad", "left"}},
      {R"("finger": "two")", R"("finger": "three")", {"two_pad", "three"}},
      {R"([0.005, 0, 0])", R"([0.005, "NaN", 0])", {"translation_m"}},
      {R"([0.005, 0, 0])", R"([0.005, null, 0])", {"translation_m"}},
      {R"([0.005, 0, 0])", R"([0.005, 0])", {"translation_m"}},
      {R"([0.5, 0.5, 0.5, 0.5])", R"([0.5, 0.5, 0.5, 0.6])", {"rotation_wxyz"}},
      {R"([0.5, 0.5, 0.5, 0.5])", R"([0, 0, 0, 0])", {"rotation_wxyz"}},
      // The outlines are clockwise, not convex, touching themselves, without area, or with too few
      // corners.
      {outline, "[[0, 0.02], [0.03, -0.01], [-0.03, -0.01]]", {"palm_pad", "outline"}},
      {outline, "[[-0.03, -0.01], [0, 0], [0.03, -0.01], [0, 0.02]]", {"palm_pad", "outline"}},
      {outline, "[[0, 0], [1, 0], [0, 1], [1, 1]]", {"palm_pad", "outline"}},
      {outline,
       "[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0], [1, 0], [1, 1], [0, 1]]",
       {"palm_pad", "outline"}},
      {outline, "[[0, 0], [0.01, 0.01], [0.02, 0.02]]", {"palm_pad", "outline"}},
      {outline, "[[0, 0], [0.01, 0.01]]", {"outline"}},
      {R"("thickness_m": 0.001)", R"("thickness_m": 0)", {"thickness"}},
      {R"("thickness_m": 0.001)", R"("thickness_m": -0.001)", {"thickness"}},
      {R"("thickness_m": 0.001)", R"("thickness_m": "1 mm")", {"thickness"}},
      {R"("palm": {"link": "base")", R"("palm": {"link": "hand")", {"palm", "hand"}},
      {R"("direction": [0, 0, 1])", R"("direction": [0, 0, 0])", {"palm", "direction"}},
      {R"("direction": [0, 0, 1])", R"("direction": "up")", {"palm", "direction"}},
      {R"("pad": "palm_pad")", R"("pad": "flat")", {"palm", "flat"}},
      {R"({"slide": 1, "turn": 1})", R"({"slide": 2, "turn": 1})", {"closing", "slide"}},
      {R"({"slide": 1, "turn": 1})", R"({"slide": 0.5, "turn": 1})", {"closing", "slide"}},
      {R"({"slide": 1, "turn": 1})", R"({"glide": 1, "turn": 1})", {"closing", "glide"}},
      {R"({"slide": 1, "turn": 1})", R"(["slide", "turn"])", {"closing"}},
      {R"({"slide": 1, "turn": 1})", R"({"slide\nturn": 1})", {"closing"}},
      {R"("name": "two_pad")", R"("name": "two\npad")", {"pads"}},
      {coupling, R"({"joint": "bend", "leader": "tern"})", {"bend", "tern"}},
      {coupling, R"({"joint": "bent", "leader": "turn"})", {"coupling", "bent"}},
      {coupling, R"({"joint": "bend", "leader": "bend"})", {"bend"}},
      {coupling,
       R"({"joint": "bend", "leader": "turn"}, {"joint": "turn", "leader": "bend"})",
       {"cycle"}},
      {coupling, coupling + ", " + coupling, {"bend"}},
      {R"("ratio": 0.5)", R"("ratio": "NaN")", {"couplings", "ratio"}},
      {R"(["right", "tip"]])", R"(["right", "tips"]])", {"exclusions", "tips"}},
      {R"(["right", "tip"]])", R"(["right"]])", {"exclusions"}},
      {R"("hand": "pincer")", "\"hands\\nhands\": \"pincer\"", {"hands"}},
      // These are no JSON any more.
      {R"("version": 1)", R"("version": NaN)", {"not JSON"}, Refusal::Io},
      {R"("version": 1)", R"("version": 0x1)", {"not JSON"}, Refusal::Io},
      {R"([0.005, 0, 0])", R"([0.005, 1e999, 0])", {"1e999"}, Refusal::Io},
      {R"([0.005, 0, 0])", R"([0,005, 0, 0])", {"not JSON"}, Refusal::Io},
      {R"("hand": "pincer")", "\"hand\": \"\xff\"", {"not JSON"}, Refusal::Io},
      {R"("hand": "pincer")", "\"hand\": \"pin\ncer\"", {"not JSON"}, Refusal::Io},
      {R"("hand": "pincer",)", R"("hand": "pincer")", {"not JSON"}, Refusal::Io},
  });
}

TEST_CASE("A palm below which nothing moves is refused", "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  HandFiles files;
  files.sidecar = with(files.sidecar, R"("palm": {"link": "base")", R"("palm": {"link": "tip")");
  check_refused(write(folder, files), Refusal::Invalid, {"pincer", "palm", "tip"});
}

TEST_CASE("A sidecar that is no JSON object is refused by what it is", "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, Refusal expected) {
    CAPTURE(text.substr(0, 80));
    check_refused(write(folder, {.sidecar = text}), expected, {"pincer.graspfit.json"});
  };
  refused("", Refusal::Io);
  refused("fingers: [one, two]", Refusal::Io);
  refused(std::string(50, '\0'), Refusal::Io);
  refused(kSmallHandSidecar + "{}", Refusal::Io);
  refused(std::string(200000, '['), Refusal::Io);
  refused(std::string(200000, '[') + std::string(200000, ']'), Refusal::Io);
  refused("null", Refusal::Invalid);
  refused("[]", Refusal::Invalid);
  refused("3", Refusal::Invalid);
  const fs::path urdf = write(folder, {});
  fs::remove(folder.path() / "package/pincer.graspfit.json");
  fs::create_directory(folder.path() / "package/pincer.graspfit.json");
  check_refused(urdf, Refusal::Io, {"pincer.graspfit.json"});
}

TEST_CASE("A sidecar that nests too deep is refused with place and limit",
          "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  check_refused(write(folder, {.sidecar = "{\"deep\": " + deep + "}"}), Refusal::Io,
                {"pincer.graspfit.json: line 1, column 73", "64 levels"});
}

/// Returns `text` without what stands from `member` to the next member, or to the end.
std::string without(std::string text, const std::string& member, const std::string& next) {
  const std::size_t from = text.find(member);
  REQUIRE(from != std::string::npos);
  if (!next.empty()) return text.erase(from, text.find(next) - from);
  text.erase(from, text.rfind('}') - from);
  return text.erase(text.rfind(','), 1);
}

TEST_CASE("Every member of a sidecar may be left out, and is derived", "[hands][bad_hand_files]") {
  const TemporaryFolder folder;
  // Fingers and pads name each other; what is derived has other names.
  for (const auto& [member, next] :
       std::vector<std::pair<std::string, std::string>>{{"\"palm\": {", "\"closing\""},
                                                        {"\"closing\"", "\"couplings\""},
                                                        {"\"couplings\"", "\"exclusions\""},
                                                        {"\"exclusions\"", ""}}) {
    CAPTURE(member);
    const hands::HandReading reading =
        hands::read_hand(write(folder, {.sidecar = without(kSmallHandSidecar, member, next)}));
    CHECK_NOTHROW(hands::validate(reading.model));
    CHECK(reading.model.fingers.size() == 2);
    CHECK(reading.model.fingers[0].name == "one");
    CHECK(reading.model.pads.size() >= 3);
    if (member == "\"couplings\"") {  // These are the URDF's own.
      const auto& coupling = reading.model.joints[2].coupling;
      REQUIRE(coupling.has_value());
      CHECK(coupling->ratio == 0.5);
      CHECK_FALSE(coupling->breakaway);
    } else if (member == "\"exclusions\"") {  // Then nothing that never meets is excluded.
      CHECK_FALSE(reading.model.is_excluded(reading.model.link_index("left"),
                                            reading.model.link_index("tip")));
    } else {
      CHECK_FALSE(reading.findings.empty());
    }
  }
  // With nothing but the format all of it is derived.
  const hands::HandReading bare = hands::read_hand(
      write(folder, {.sidecar = R"({"format": {"name": "graspfit hand sidecar", "version": 1}})"}));
  CHECK(bare.model.fingers.size() == 2);
  CHECK_FALSE(bare.findings.empty());
  // Without a sidecar the hand is the same.
  const fs::path urdf = write(folder, {});
  fs::remove(folder.path() / "package/pincer.graspfit.json");
  const hands::HandReading none = hands::read_hand(urdf);
  REQUIRE(none.model.fingers.size() == bare.model.fingers.size());
  REQUIRE(none.model.pads.size() == bare.model.pads.size());
  for (std::size_t p = 0; p < none.model.pads.size(); ++p) {
    CHECK(none.model.pads[p].name == bare.model.pads[p].name);
    CHECK(none.model.pads[p].outline == bare.model.pads[p].outline);
    CHECK(none.model.pads[p].X_LC.matrix() == bare.model.pads[p].X_LC.matrix());
  }
}

}  // namespace

}  // namespace test_bad_sidecars
