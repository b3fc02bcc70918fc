#include <string>

#include "graspfit/base/path_text.hpp"
#include "support/catch.hpp"

namespace test_path_text {

using namespace graspfit::base;

TEST_CASE("Only what Unicode calls UTF-8 is UTF-8", "[base][path_text]") {
  for (const char* text : {"", "plain", "caf\xC3\xA9", "\xE2\x82\xAC", "\xF0\x9F\xA4\x96",
                           "\xEF\xBF\xBF", "\xF4\x8F\xBF\xBF", "\xED\x9F\xBF", "\x01\x7F"}) {
    CAPTURE(text);
    CHECK(is_utf8(text));
  }
  for (const char* text : {"caf\xE9", "\x80", "\xC3", "\xC3(", "\xC0\xAF", "\xE0\x80\xAF",
                           "\xED\xA0\x80", "\xF0\x80\x80\xAF", "\xF4\x90\x80\x80",
                           "\xF5\x80\x80\x80", "\xE2\x82", "\xFF", "a\xE2\x82z"}) {
    CAPTURE(text);
    CHECK_FALSE(is_utf8(text));
  }
}

TEST_CASE("Paths in UTF-8 are their own texts, others have their bytes in digits",
          "[base][path_text]") {
  CHECK(path_text("meshes/caf\xC3\xA9 100%.off") == "meshes/caf\xC3\xA9 100%.off");
  CHECK(path_text("") == "");
  CHECK(path_text("a/caf\xE9 1.off") == "file:a/caf%E9%201.off");
  CHECK(path_text("\xC3\xA9\xE9") == "file:%C3%A9%E9");
  CHECK(path_text("file:a") == "file:file%3Aa");
  CHECK(path_of_text("a%E9.off") == "a%E9.off");  // It has no prefix and stays as it is.
  CHECK(path_of_text("file:50%/%zz%4") == "50%/%zz%4");
  CHECK(path_of_text("file:%e9%41") ==
        "\xE9"
        "A");
}

TEST_CASE("Every path comes back from its text, which is UTF-8", "[base][path_text]") {
  std::string all;
  for (int byte = 1; byte < 256; ++byte) {
    const std::string one(1, static_cast<char>(byte));
    for (const std::string& path : {one, "file:" + one, "a/" + one + "%41\xE9", one + "\xA9"}) {
      CAPTURE(path_text(path));
      CHECK(path_of_text(path_text(path)) == path);
      CHECK(is_utf8(path_text(path)));
    }
    all += one;
  }
  CHECK(path_of_text(path_text(all)) == all);
}

}  // namespace test_path_text
