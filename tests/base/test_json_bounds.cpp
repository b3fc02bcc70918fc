#include <filesystem>
#include <fstream>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_json_bounds {

namespace {

using namespace graspfit::base;
using graspfit::testing::TemporaryFolder;

/// Returns the message with which a text is refused; "accepted" if it is not.
std::string refusal(const std::string& text) {
  try {
    require_bounded_json(text, "a.json");
  } catch (const IoError& error) {
    return error.what();
  }
  return "accepted";
}

std::string nested(int depth) {
  return std::string(static_cast<std::size_t>(depth), '[') +
         std::string(static_cast<std::size_t>(depth), ']');
}

TEST_CASE("JSON may nest to the limit and not one level deeper", "[base][json_bounds]") {
  CHECK(refusal("") == "accepted");
  CHECK(refusal("7") == "accepted");
  CHECK(refusal(nested(kDeepestJson)) == "accepted");
  const std::string one_more = "{\n \"a\": " + nested(kDeepestJson) + "}";
  CHECK(refusal(one_more) ==
        "a.json: line 2, column 70: nests deeper than 64 levels, which is as deep as JSON is read");
  CHECK(refusal(nested(kDeepestJson + 1)).starts_with("a.json: line 1, column 65: nests deeper"));
  CHECK(refusal(std::string(1000000, '[')).starts_with("a.json: line 1, column 65: nests deeper"));
  // Members beside one another are not nested.
  std::string wide = "[[]";
  for (int i = 0; i < 1000; ++i) wide += ",{\"a\": [0]}";
  CHECK(refusal(wide + "]") == "accepted");
}

TEST_CASE("Brackets in JSON strings do not nest, and escaped quotes do not end a string",
          "[base][json_bounds]") {
  const std::string brackets(100, '[');
  CHECK(refusal("{\"" + brackets + "\": \"" + brackets + "\"}") == "accepted");
  CHECK(refusal(R"(["\")" + brackets + R"("])") == "accepted");
  CHECK(refusal(R"(["\\\")" + brackets + R"("])") == "accepted");
  // A backslash that is escaped itself escapes nothing.
  CHECK(refusal(R"(["\\", )" + brackets).starts_with("a.json: line 1"));
  CHECK(refusal(R"(["\u005b"])") == "accepted");
  // Texts that end inside a string are left for the parser to refuse.
  CHECK(refusal("[\"" + brackets) == "accepted");
  CHECK(refusal("[\"\\") == "accepted");
}

TEST_CASE("An object may have so many members and not one more", "[base][json_bounds]") {
  const auto refusal_of = [](const std::string& text) -> std::string {
    try {
      require_bounded_json(text, "a.json", 2);
    } catch (const IoError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal_of(R"({"a": 1, "b": {"c:": ":", "d": [1, 2, 3]}, )") == "accepted");
  CHECK(refusal_of(R"([{"a": 1, "b": 2}, {"a": 1, "b": 2}])") == "accepted");
  CHECK(
      refusal_of("{\"a\": 1,\n \"b\": {}, \"c\": 3}") ==
      "a.json: line 2, column 14: an object has more than 2 members, which is as many as are read");
  CHECK(refusal_of(":::") == "accepted");  // This is no object, and no JSON.
}

TEST_CASE("A JSON file that is too large is refused before it is read", "[base][json_bounds]") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "large.json";
  std::ofstream(file) << "{}";
  CHECK(read_json_file(file) == "{}");
  // The file is one hole and uses no space on the disk.
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40);
  try {
    read_json_file(file);
    FAIL("accepted");
  } catch (const IoError& error) {
    CHECK(error.what() == file.string() +
                              ": has 1099511627776 bytes; JSON is read up to "
                              "268435456 bytes");
  }
}

}  // namespace

}  // namespace test_json_bounds
