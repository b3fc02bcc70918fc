#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/content_cache.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/sha256.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_content_cache {

using namespace graspfit::base;
using graspfit::testing::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

const std::string kKey = sha256_hex("some content");

}  // namespace

TEST_CASE("What is kept is read back byte for byte, under its own kind and key only",
          "[base][content_cache]") {
  const TemporaryFolder folder;
  const ContentCache cache{.folder = folder.path() / "new/folder"};
  CHECK_FALSE(cache.read("numbers", kKey));
  for (const std::string& value :
       {std::string(), std::string("1 2 3"), std::string("two\nlines\n"), std::string("\0\xff", 2),
        std::string("sha256 ") + kKey + "\n", std::string(1 << 20, 'x')}) {
    cache.write("numbers", kKey, value);
    CHECK(cache.read("numbers", kKey) == value);
  }
  CHECK_FALSE(cache.read("letters", kKey));
  CHECK_FALSE(cache.read("numbers", sha256_hex("other content")));
  // A file of another kind or key under this name counts as no entry.
  cache.write("letters", kKey, "abc");
  fs::copy_file(*cache.file_of("letters", kKey), *cache.file_of("numbers", kKey),
                fs::copy_options::overwrite_existing);
  CHECK_FALSE(cache.read("numbers", kKey));
}

TEST_CASE("A damaged entry is as good as none, whichever byte it is, and is replaced",
          "[base][content_cache]") {
  const TemporaryFolder folder;
  const ContentCache cache{.folder = folder.path()};
  cache.write("numbers", kKey, "12 34 56 ");
  const fs::path file = *cache.file_of("numbers", kKey);
  const std::string text = read_file(file);
  std::vector<std::string> damaged = {"", "nonsense", text + "x", text.substr(1)};
  for (std::size_t i = 0; i < text.size(); ++i) {
    damaged.push_back(text.substr(0, i));
    damaged.push_back(text);
    damaged.back()[i] ^= 1;
  }
  for (const std::string& content : damaged) {
    write_file_atomically(file, content);
    CHECK_FALSE(cache.read("numbers", kKey));
  }
  int num_found = 0;
  const auto value = [&] {
    return cache.value(
        "numbers", kKey, [&] { return ++num_found; },
        [](std::string_view kept) {
          NumberReader in(kept);
          const auto number = static_cast<int>(in.integer(0, 9));
          return in.is_finished() ? std::optional<int>(number) : std::nullopt;
        },
        [](int number) { return std::to_string(number); });
  };
  CHECK(value() == 1);
  CHECK(value() == 1);                // This one is read.
  cache.write("numbers", kKey, "7");  // Another value shows that it is the entry that is read.
  CHECK(value() == 7);
  // The entry is sealed but holds no such value, so the value is found again and replaces it.
  cache.write("numbers", kKey, "seven");
  CHECK(value() == 2);
  CHECK(cache.read("numbers", kKey) == "2");
}

TEST_CASE("A cache that is off, or that cannot be written, keeps nothing and is no error",
          "[base][content_cache]") {
  const TemporaryFolder folder;
  const ContentCache off{.is_on = false, .folder = folder.path()};
  off.write("numbers", kKey, "1");
  CHECK_FALSE(off.file_of("numbers", kKey));
  CHECK_FALSE(off.read("numbers", kKey));
  CHECK(fs::is_empty(folder.path()));
  // Nobody can write where a file is in the place of the folder, or a folder in that of the file.
  write_file_atomically(folder.path() / "file", "");
  for (const char* place : {"file", "file/below"}) {
    const ContentCache blocked{.folder = folder.path() / place};
    blocked.write("numbers", kKey, "1");
    CHECK_FALSE(blocked.read("numbers", kKey));
  }
  const ContentCache taken{.folder = folder.path()};
  fs::create_directories(*taken.file_of("numbers", kKey));
  taken.write("numbers", kKey, "1");
  CHECK_FALSE(taken.read("numbers", kKey));
  // No temporary file stays behind.
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 2);
  CHECK(std::distance(fs::directory_iterator(folder.path() / "numbers"), {}) == 1);
}

TEST_CASE("The cache is where the environment says, and nowhere without a home",
          "[base][content_cache]") {
  const TemporaryFolder folder;
  const std::vector<const char*> variables = {"GRASPFIT_CACHE", "XDG_CACHE_HOME", "HOME"};
  std::vector<std::optional<std::string>> before;
  for (const char* variable : variables) {
    const char* value = std::getenv(variable);
    before.push_back(value ? std::optional<std::string>(value) : std::nullopt);
    ::unsetenv(variable);
  }
  const ContentCache cache;
  CHECK_FALSE(cache.file_of("numbers", kKey));
  cache.write("numbers", kKey, "1");  // There is no folder to write to.
  const std::vector<std::pair<const char*, const char*>> places = {
      {"HOME", "home/.cache/graspfit"},
      {"XDG_CACHE_HOME", "xdg/graspfit"},
      {"GRASPFIT_CACHE", "own"}};
  const auto file = [&](const char* place) {
    return folder.path() / place / "numbers" / (kKey + ".txt");
  };
  for (const auto& [variable, place] : places) {
    const fs::path value = folder.path() / *fs::path(place).begin();
    ::setenv(variable, value.c_str(), 1);  // Each variable takes precedence over those set so far.
    CHECK(cache.file_of("numbers", kKey) == file(place));
    cache.write("numbers", kKey, "1");
    CHECK(fs::is_regular_file(file(place)));
  }
  // A relative path is ignored, because it would follow the working folder.
  ::setenv("GRASPFIT_CACHE", "relative/path", 1);
  CHECK(cache.file_of("numbers", kKey) == file(places[1].second));
  for (std::size_t i = 0; i < variables.size(); ++i) {
    ::unsetenv(variables[i]);
    if (before[i]) ::setenv(variables[i], before[i]->c_str(), 1);
  }
}

TEST_CASE("Kinds that are no folder's name and keys that are no hash are refused",
          "[base][content_cache]") {
  const ContentCache cache;
  for (const char* kind : {"", "..", "a/b", "Numbers", "a b"}) {
    CHECK_THROWS_WITH(cache.read(kind, kKey), "ContentCache: kind '" + std::string(kind) +
                                                  "', must be of a-z, 0-9 and _ (it names a "
                                                  "folder)");
  }
  for (const std::string& key : {std::string(), kKey.substr(1), "G" + kKey.substr(1)}) {
    CHECK_THROWS_AS(cache.write("numbers", key, ""), InvalidInput);
  }
}

TEST_CASE("Keys differ with every bit and every border between what they are made of",
          "[base][content_cache]") {
  std::set<std::string> keys;
  int num_keys = 0;
  const auto add = [&](const auto& fill) {
    ContentKey key("test 1");
    fill(key);
    keys.insert(key.sha256());
    ++num_keys;
  };
  add([](ContentKey&) {});
  add([](ContentKey& key) { key.number(1.0); });
  add([](ContentKey& key) { key.number(std::nextafter(1.0, 2.0)); });
  add([](ContentKey& key) { key.number(std::int64_t{1}); });
  add([](ContentKey& key) { key.text("ab"), key.text("c"); });
  add([](ContentKey& key) { key.text("a"), key.text("bc"); });
  add([](ContentKey& key) { key.list(std::vector<int>{1, 2}), key.list(std::vector<int>{3}); });
  add([](ContentKey& key) { key.list(std::vector<int>{1}), key.list(std::vector<int>{2, 3}); });
  add([](ContentKey& key) { key.list(std::vector<int>{}); });
  CHECK(static_cast<int>(keys.size()) == num_keys);
  CHECK(ContentKey("test 1").sha256() != ContentKey("test 2").sha256());
  CHECK(ContentKey("test 1").sha256() == ContentKey("test 1").sha256());
}

TEST_CASE("Numbers are read back to the bit, and nothing else is", "[base][content_cache]") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<double> reals = {0.0,     0.1,  -1e300,    5e-324,
                                     1.0 / 3, 1e22, kInfinity, -kInfinity};
  NumberWriter out;
  for (const double real : reals) out.number(real);
  out.end_line();
  out.number(std::numeric_limits<std::int64_t>::min());
  out.indices({4, 0, 2});
  out.indices({});
  NumberReader in(out.text());
  for (const double real : reals) CHECK(in.real() == real);
  CHECK(in.integer(std::numeric_limits<std::int64_t>::min(), 0) ==
        std::numeric_limits<std::int64_t>::min());
  CHECK(in.indices(5) == std::vector<std::int32_t>{4, 0, 2});
  CHECK_FALSE(in.is_finished());
  CHECK(in.indices(0).empty());
  CHECK(in.is_finished());

  // The reader is bad for good once something is missing, out of range or no number.
  for (const char* text : {"", "x", "7", "-1", "nan", "2 5"}) {
    CAPTURE(text);
    NumberReader bad(text);
    const std::vector<double> read = {bad.real(0.0, 6.0), bad.real(0.0, 4.0)};
    CHECK_FALSE(bad.is_good());
    CHECK_FALSE(bad.is_finished());
    CHECK(read.back() == 0.0);
  }
  for (const char* text : {"6 0 1 2 3 4 5", "1 5", "2 1", "-1"}) {
    CAPTURE(text);
    NumberReader bad(text);
    bad.indices(5);
    CHECK_FALSE(bad.is_good());
  }
}

}  // namespace test_content_cache
