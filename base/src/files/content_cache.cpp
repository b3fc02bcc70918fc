#include "graspfit/base/content_cache.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <system_error>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/sha256.hpp"

namespace graspfit::base {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSeal = "sha256 ";
constexpr std::size_t kHashDigits = 64;

std::optional<fs::path> environment_folder(const char* name) {
  const char* const value = std::getenv(name);
  // The XDG base directory specification: paths that are not absolute are ignored.
  if (value == nullptr || !fs::path(value).is_absolute()) return std::nullopt;
  return fs::path(value);
}

std::optional<fs::path> default_folder() {
  if (const auto folder = environment_folder("GRASPFIT_CACHE")) return folder;
  if (const auto folder = environment_folder("XDG_CACHE_HOME")) return *folder / "graspfit";
  if (const auto home = environment_folder("HOME")) return *home / ".cache/graspfit";
  return std::nullopt;
}

std::string head(std::string_view kind, std::string_view key) {
  return "graspfit " + std::string(kind) + "\n" + std::string(key) + "\n";
}

bool consists_of(std::string_view text, std::string_view characters) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

}  // namespace

std::optional<fs::path> ContentCache::file_of(std::string_view kind, std::string_view key) const {
  if (!consists_of(kind, "abcdefghijklmnopqrstuvwxyz0123456789_")) {
    throw InvalidInput("ContentCache: kind '" + std::string(kind) +
                       "', must be of a-z, 0-9 and _ (it names a folder)");
  }
  if (key.size() != kHashDigits || !consists_of(key, "0123456789abcdef")) {
    throw InvalidInput("ContentCache: key '" + std::string(key) +
                       "', must be 64 lower-case hexadecimal digits, a SHA-256");
  }
  if (!is_on) return std::nullopt;
  const std::optional<fs::path> root = folder ? folder : default_folder();
  if (!root) return std::nullopt;
  return *root / kind / (std::string(key) + ".txt");
}

std::optional<std::string> ContentCache::read(std::string_view kind, std::string_view key) const {
  const std::optional<fs::path> file = file_of(kind, key);
  std::error_code error;
  if (!file || !fs::is_regular_file(*file, error)) return std::nullopt;
  std::string text;
  try {
    text = read_file(*file);
  } catch (const IoError&) {
    return std::nullopt;  // A cache that cannot be read is as good as none.
  }
  const std::string start = head(kind, key);
  const std::size_t end = kSeal.size() + kHashDigits + 1;
  if (!text.starts_with(start) || text.size() < start.size() + end) return std::nullopt;
  const std::string_view content = std::string_view(text).substr(0, text.size() - end);
  if (text.substr(content.size()) != std::string(kSeal) + sha256_hex(content) + '\n') {
    return std::nullopt;
  }
  return std::string(content.substr(start.size()));
}

void ContentCache::write(std::string_view kind, std::string_view key,
                         std::string_view value) const {
  const std::optional<fs::path> file = file_of(kind, key);
  if (!file) return;
  const std::string content = head(kind, key) + std::string(value);
  std::error_code error;
  fs::create_directories(file->parent_path(), error);
  try {
    if (!error) {
      write_file_atomically(*file, content + std::string(kSeal) + sha256_hex(content) + '\n');
    }
  } catch (const IoError&) {
    // The value is right all the same; only the next run must find it again.
  }
}

void ContentKey::append(const void* data, std::size_t size) {
  if (size > 0) content_.append(static_cast<const char*>(data), size);
}

std::string ContentKey::sha256() const { return sha256_hex(content_); }

void NumberWriter::number(std::int64_t value) { text_ += std::to_string(value) + ' '; }

void NumberWriter::number(double value) { text_ += shortest_decimal(value) + ' '; }

void NumberWriter::indices(const std::vector<std::int32_t>& values) {
  number(static_cast<std::int64_t>(values.size()));
  for (const std::int32_t value : values) number(std::int64_t{value});
  end_line();
}

template <class T>
T NumberReader::number(T least, T most) {
  text_.remove_prefix(std::min(text_.find_first_not_of(" \n"), text_.size()));
  T value{};
  const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
  if (error != std::errc() || !(value >= least && value <= most)) {
    is_good_ = false;
    text_ = {};
    return least;
  }
  text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
  return value;
}

std::int64_t NumberReader::integer(std::int64_t least, std::int64_t most) {
  return number(least, most);
}

double NumberReader::real(double least, double most) { return number(least, most); }

std::vector<std::int32_t> NumberReader::indices(std::int64_t size) {
  const std::int64_t count = integer(0, size);
  std::vector<std::int32_t> values;
  for (std::int64_t i = 0; i < count && is_good_; ++i) {
    values.push_back(static_cast<std::int32_t>(integer(0, size - 1)));
  }
  return values;
}

bool NumberReader::is_finished() const {
  return is_good_ && text_.find_first_not_of(" \n") == std::string_view::npos;
}

}  // namespace graspfit::base
