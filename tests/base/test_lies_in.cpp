#include <filesystem>
#include <vector>

#include "graspfit/base/lies_in.hpp"
#include "support/catch.hpp"

namespace test_lies_in {

using graspfit::base::lies_in;
using Folders = std::vector<std::filesystem::path>;

TEST_CASE("A folder lies in itself, and a neighbor whose name begins alike does not",
          "[base][lies_in]") {
  CHECK(lies_in("/a/b", "/a/b"));
  CHECK(lies_in("/a/b", "/a/b/"));
  CHECK(lies_in("/a/b/c/d", "/a/b"));
  CHECK(lies_in("/a/b", "/"));
  CHECK_FALSE(lies_in("/a/bc", "/a/b"));
  CHECK_FALSE(lies_in("/a", "/a/b"));
}

TEST_CASE("A step up leads out, a name that begins with two dots does not", "[base][lies_in]") {
  CHECK_FALSE(lies_in("/a/b/../c", "/a/b"));
  CHECK(lies_in("/a/b/..c", "/a/b"));
}

TEST_CASE("An absolute path lies in no relative folder, nor the other way round",
          "[base][lies_in]") {
  CHECK(lies_in("a/b", "a"));
  CHECK_FALSE(lies_in("/a/b", "a"));
  CHECK_FALSE(lies_in("a/b", "/a"));
  CHECK_FALSE(lies_in("", "/a"));
}

TEST_CASE("Of several folders one is enough, and none hold nothing", "[base][lies_in]") {
  CHECK(lies_in("/a/b", Folders{"/c", "/a"}));
  CHECK_FALSE(lies_in("/a/b", Folders{"/c", "/d"}));
  CHECK_FALSE(lies_in("/a/b", Folders{}));
}

}  // namespace test_lies_in
