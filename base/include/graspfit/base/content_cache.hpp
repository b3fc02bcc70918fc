#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graspfit::base {

/// A cache on disk, which keeps results that are costly to find between runs.
///
/// An entry has a kind, which is the name of a folder, and a key, which is the SHA-256 of all that
/// its value depends on. An entry is therefore never out of date, and the whole folder may be
/// deleted at any time.
struct ContentCache {
  bool is_on = true;
  std::optional<std::filesystem::path> folder = {};  ///< Default: `$GRASPFIT_CACHE`, or else
                                                     ///< `graspfit` in the user's cache folder
                                                     ///< (`$XDG_CACHE_HOME` or `~/.cache`). Of
                                                     ///< these only absolute paths count.

  /// The file of an entry, `<folder>/<kind>/<key>.txt`; empty if the cache is off or no folder is
  /// known for it (see `folder`).
  /// @throws InvalidInput unless the kind is of a-z, 0-9 and _, and the key of 64 lower-case
  /// hexadecimal digits, as `sha256_hex` and `ContentKey` give them.
  std::optional<std::filesystem::path> file_of(std::string_view kind, std::string_view key) const;

  /// The value of an entry as it was written. Empty if there is none, if it cannot be read, or if
  /// it is damaged: not exactly what `write` wrote under this kind and key (the file holds both,
  /// and the SHA-256 of its content). @throws as `file_of`.
  std::optional<std::string> read(std::string_view kind, std::string_view key) const;

  /// Keeps a value, which may be any bytes. The entry is written atomically: nobody reads half of
  /// it, even after a crash or while another program writes the same entry. A folder that cannot be
  /// made or written to is no error; nothing is kept then. @throws as `file_of`.
  void write(std::string_view kind, std::string_view key, std::string_view value) const;

  /// The value of an entry, or else what `find()` returns, which is then kept.
  ///
  /// `from_text(text)` returns an optional, empty if the text is no such value: the entry then
  /// counts as missing, and is replaced. `to_text(value)` is its inverse.
  template <class Find, class FromText, class ToText>
  auto value(std::string_view kind, std::string_view key, const Find& find,
             const FromText& from_text, const ToText& to_text) const {
    if (const std::optional<std::string> text = read(kind, key)) {
      if (auto kept = from_text(std::string_view(*text))) return *std::move(kept);
    }
    auto found = find();
    if (file_of(kind, key)) write(kind, key, to_text(found));
    return found;
  }
};

/// Gathers all that a value depends on and hashes it. Two sequences of calls give the same key only
/// if they are the same calls with the same values, bit by bit.
class ContentKey {
 public:
  /// `algorithm` names the algorithm that finds the value, and its version, which is raised
  /// whenever the same input may give another value.
  explicit ContentKey(std::string_view algorithm) { text(algorithm); }

  void number(double value) { append(&value, sizeof value); }
  void number(std::int64_t value) { append(&value, sizeof value); }
  void text(std::string_view value) {
    number(static_cast<std::int64_t>(value.size()));
    append(value.data(), value.size());
  }
  /// Appends the bytes of the elements, whose type must not have padding.
  template <class T>
  void list(const std::vector<T>& values) {
    number(static_cast<std::int64_t>(values.size()));
    append(values.data(), values.size() * sizeof(T));
  }
  std::string sha256() const;

 private:
  void append(const void* data, std::size_t size);

  std::string content_;
};

/// Numbers as text, separated by blanks, for the values of a cache; `NumberReader` reads them back
/// to the bit.
class NumberWriter {
 public:
  void number(std::int64_t value);
  void number(double value);  ///< Any value but NaN; infinities read back too.
  void indices(const std::vector<std::int32_t>& values);  ///< The number of values, then these.
  void end_line() { text_ += '\n'; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Reads what `NumberWriter` wrote. The first number that is missing or out of range makes the
/// reader bad for good: from then on it returns the least allowed value.
class NumberReader {
 public:
  explicit NumberReader(std::string_view text) : text_(text) {}

  std::int64_t integer(std::int64_t least, std::int64_t most);
  double real(double least = -std::numeric_limits<double>::infinity(),
              double most = std::numeric_limits<double>::infinity());
  /// Reads indices, each in [0, size); at most `size` of them.
  std::vector<std::int32_t> indices(std::int64_t size);
  bool is_good() const { return is_good_; }
  /// Whether the reader is good and no text is left.
  bool is_finished() const;

 private:
  template <class T>
  T number(T least, T most);

  std::string_view text_;
  bool is_good_ = true;
};

}  // namespace graspfit::base
