#include <nlohmann/json.hpp>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_value.hpp"
#include "support/catch.hpp"

namespace test_json_value {

namespace {

using namespace graspfit::base;

JsonValue parsed(const std::string& text) {
  return JsonValue::parsed<InvalidInput>(text, "a.json");
}

/// Returns the message with which `use` of the text's root is refused; "accepted" if it is not.
template <class Use>
std::string refusal(const std::string& text, const Use& use) {
  try {
    use(parsed(text));
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("Values are what their text says", "[base][json_value]") {
  const JsonValue root = parsed(
      R"({"z": 1.5, "n": -3, "big": 18446744073709551615, "yes": true, "t": "", "none": null,
          "list": [1, 2.5], "a": {"b": ["x", "y"]}})");
  CHECK(root.at("z").number() == 1.5);
  CHECK(root.at("n").integer() == -3);
  CHECK(root.at("n").small_integer() == -3);
  CHECK(root.at("n").number() == -3.0);
  CHECK(root.at("big").unsigned_integer() == 18446744073709551615U);
  CHECK(root.at("yes").flag());
  CHECK(root.at("t").text().empty());
  CHECK(root.at("list").numbers<2>() == std::array{1.0, 2.5});
  CHECK(root.at("a").at("b").texts() == std::vector<std::string>{"x", "y"});
  CHECK(root.at("a").at("b").items()[1].location() == "/a/b/1");
  CHECK(root.members().front().first == "z");  // The order is that of the file.
  CHECK(root.has("none"));
  CHECK_FALSE(root.find("none"));
  CHECK_FALSE(root.find("missing"));
  CHECK(root.find("z"));
  CHECK_FALSE(root.at("z").has("z"));
  root.at("a").require_members({"b"}, {"c"});
}

TEST_CASE("A value outlives the document it was taken from", "[base][json_value]") {
  const JsonValue inner = parsed(R"({"a": [[7]]})").at("a").items()[0].items()[0];
  CHECK(inner.integer() == 7);
}

TEST_CASE("A fault names file, place, value and what it must be", "[base][json_value]") {
  const auto number = [](const JsonValue& root) { root.at("a").number(); };
  CHECK(refusal(R"({"a": "1"})", number) == "a.json: /a: is \"1\", must be a number");
  CHECK(refusal("{}", number) == "a.json: /a: is missing");
  CHECK(refusal("[]", number) == "a.json: /: is [], must be an object");
  CHECK(refusal(R"({"a": [1, [2]]})", [](const JsonValue& root) {
          root.at("a").items()[1].text();
        }) == "a.json: /a/1: is [2], must be a text");
  const auto refused = [](const std::string& text, const auto& use) {
    return refusal(text, use).substr(std::string("a.json: /: ").size());
  };
  CHECK(refused("0", [](const JsonValue& v) { v.positive_number(); }) == "is 0, must be > 0");
  CHECK(refused("1.0", [](const JsonValue& v) { v.integer(); }) == "is 1.0, must be an integer");
  CHECK(refused("9223372036854775808", [](const JsonValue& v) { v.integer(); }) ==
        "is 9223372036854775808, must be an integer of 64 bits");
  CHECK(refused("2147483648", [](const JsonValue& v) { v.small_integer(); }) ==
        "is 2147483648, must be an integer of 32 bits");
  CHECK(refused("-2147483649", [](const JsonValue& v) { v.small_integer(); }) ==
        "is -2147483649, must be an integer of 32 bits");
  CHECK(refused("-1", [](const JsonValue& v) { v.unsigned_integer(); }) ==
        "is -1, must be an integer from 0");
  CHECK(refused("1", [](const JsonValue& v) { v.flag(); }) == "is 1, must be true or false");
  CHECK(refused("\"\"", [](const JsonValue& v) { v.name(); }) ==
        "is \"\", must be a text that is not empty");
  CHECK(refused("[]", [](const JsonValue& v) { v.some_items(); }) ==
        "is [], must be an array with at least one value");
  CHECK(refused("[1, 2]", [](const JsonValue& v) { v.numbers<3>(); }) == "has 2 of 3 numbers");
  CHECK(refusal(R"({"colour": 1})",
                [](const JsonValue& v) { v.require_members({"name"}, {"color"}); }) ==
        "a.json: /colour: is not a member that is known here; there are name, color; did you mean "
        "\"color\"?");
  CHECK(refusal("{}", [](const JsonValue& v) { v.require_members({"name"}, {}); }) ==
        "a.json: /name: is missing");
}

TEST_CASE("Messages stay one short line, whatever the file holds", "[base][json_value]") {
  const std::string message = refusal("{\"two\\nlines\": \"" + std::string(1000, 'x') + "\"}",
                                      [](const JsonValue& v) { v.at("two\nlines").number(); });
  CHECK(message.starts_with("a.json: /two lines: is \"xxxxx"));
  CHECK(message.ends_with("xxx..., must be a number"));
  CHECK(message.size() < 120);
  // Texts are not cut within a character: here 59 bytes precede a character of two bytes.
  const std::string cut = refusal("\"" + std::string(58, 'x') + "\xc3\xa9\xc3\xa9\"",
                                  [](const JsonValue& v) { v.number(); });
  CHECK(cut == "a.json: /: is \"" + std::string(58, 'x') + "..., must be a number");
}

TEST_CASE("What is no JSON is an IoError that names the file", "[base][json_value]") {
  CHECK_THROWS_AS(parsed("{"), IoError);
  try {
    parsed("{\"a\": 1,}");
    FAIL("accepted");
  } catch (const IoError& error) {
    CHECK(std::string(error.what()).starts_with("a.json: is not JSON: parse error at line 1"));
  }
}

TEST_CASE("A document says itself what its faults are", "[base][json_value]") {
  struct Fault {
    std::string place, what;
  };
  const JsonValue value(
      JsonValue::Json::parse("[true]"),
      [](const std::string& place, const std::string& what) {
        throw Fault{place, what};
      },
      "way");
  try {
    value.items()[0].number();
    FAIL("accepted");
  } catch (const Fault& fault) {
    CHECK(fault.place == "way/0");
    CHECK(fault.what == "is true, must be a number");
  }
}

}  // namespace

}  // namespace test_json_value
