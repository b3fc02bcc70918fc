#include "archive/npz_reader.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <regex>
#include <system_error>
#include <type_traits>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::exchange::internal {
namespace {

constexpr std::size_t kMostNpzBytes = std::size_t{1} << 30;
constexpr std::size_t kEndSize = 22;          // of the archive's end record, without its comment
constexpr std::size_t kMostComment = 0xffff;  // [bytes]
constexpr std::size_t kMostDeflation = 1032;  // bytes that a byte of deflated data can stand for
constexpr std::size_t kDirectoryEntry = 46;   // [bytes], without name, extra field and comment
constexpr std::size_t kLocalHeader = 30;      // [bytes], without name and extra field
constexpr std::size_t kMostNpyHeader = 4096;  // [bytes]; plain arrays need a hundred, and
                                              // std::regex a piece of stack for each
constexpr const char* kCutOff = "is cut off: a part of the file is missing";

/// A little-endian number at a place that the caller knows to be within the bytes.
template <class Unsigned>
Unsigned number_at(std::string_view bytes, std::size_t offset) {
  static_assert(std::is_unsigned_v<Unsigned>);
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    const auto byte = static_cast<Unsigned>(static_cast<unsigned char>(bytes[offset + i]));
    value = static_cast<Unsigned>(value | static_cast<Unsigned>(byte << (8 * i)));
  }
  return value;
}

std::uint16_t short_at(std::string_view bytes, std::size_t offset) {
  return number_at<std::uint16_t>(bytes, offset);
}

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  return number_at<std::uint32_t>(bytes, offset);
}

/// Appends a code point in UTF-8; U+FFFD where there is no such code point.
void append_utf8(char32_t point, std::string& text) {
  if (point > 0x10ffff || (point >= 0xd800 && point < 0xe000)) point = U'\ufffd';
  const auto tail = [point](unsigned shift) {
    return static_cast<char>(0x80U | ((point >> shift) & 0x3fU));
  };
  if (point < 0x80) {
    text += static_cast<char>(point);
  } else if (point < 0x800) {
    text += static_cast<char>(0xc0U | (point >> 6U));
    text += tail(0);
  } else if (point < 0x10000) {
    text += static_cast<char>(0xe0U | (point >> 12U));
    text += tail(6);
    text += tail(0);
  } else {
    text += static_cast<char>(0xf0U | (point >> 18U));
    text += tail(12);
    text += tail(6);
    text += tail(0);
  }
}

/// The inflated bytes; empty if they are not exactly `size` bytes or damaged.
std::optional<std::string> inflated(std::string_view packed, std::size_t size) {
  std::string data(size, '\0');
  z_stream stream = {};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return std::nullopt;  // raw, as in archives
  // zlib does not write to its input, though its type allows it.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(data.data());
  stream.avail_out = static_cast<uInt>(size);
  const int outcome = inflate(&stream, Z_FINISH);
  const bool is_whole = outcome == Z_STREAM_END && stream.total_out == size;
  inflateEnd(&stream);
  if (!is_whole) return std::nullopt;
  return data;
}

/// The text of a field of an NPY header that `pattern` captures; empty if there is none.
std::string header_field(const std::string& header, const char* pattern) {
  std::smatch match;
  return std::regex_search(header, match, std::regex(pattern)) ? match[1].str() : std::string();
}

/// "(3, 7)" without its parentheses as numbers; empty if it is none, or some number is too large.
std::optional<std::vector<std::size_t>> shape_of(const std::string& text) {
  std::vector<std::size_t> shape;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    if (*at == ' ' || *at == ',') {
      ++at;
      continue;
    }
    std::size_t extent = 0;
    const auto [next, error] = std::from_chars(at, end, extent);
    if (error != std::errc()) return std::nullopt;
    shape.push_back(extent);
    at = next;
  }
  return shape;
}

}  // namespace

NpzReader::NpzReader(const std::filesystem::path& file) : file_(file.string()) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > kMostNpzBytes) {
    fail("has " + std::to_string(size) + " bytes, more than the 1 GiB that are read; split it");
  }
  bytes_ = base::read_file(file);
  read_members();
}

void NpzReader::fail(const std::string& what) const { throw base::IoError(file_ + ": " + what); }

void NpzReader::fail(std::string_view place, const std::string& what) const {
  fail(std::string(place) + ": " + what);
}

void NpzReader::read_members() {
  const std::string_view bytes = bytes_;
  if (!bytes.starts_with("PK")) {
    fail(
        "is no NPZ file, which is a ZIP archive; if it is a pickled dictionary (.npy), save its "
        "arrays with numpy.savez");
  }
  // The end record is the last thing in the file, but for a comment.
  const std::size_t end = bytes.rfind(std::string_view("PK\5\6", 4));
  if (end == std::string_view::npos || end + kEndSize > bytes.size() ||
      bytes.size() - end > kEndSize + kMostComment) {
    fail(kCutOff);
  }
  const std::size_t count = short_at(bytes, end + 10);
  std::size_t at = word_at(bytes, end + 16);
  if (count == 0xffff || at == 0xffffffffU) fail("is a ZIP64 archive, which is not read");
  for (std::size_t i = 0; i < count; ++i) {
    if (at + kDirectoryEntry > end || word_at(bytes, at) != 0x02014b50) fail(kCutOff);
    const std::size_t name_size = short_at(bytes, at + 28);
    const std::size_t entry_size =
        kDirectoryEntry + name_size + short_at(bytes, at + 30) + short_at(bytes, at + 32);
    if (at + entry_size > end) fail(kCutOff);
    std::string name(bytes.substr(at + kDirectoryEntry, name_size));
    constexpr std::string_view kNpy = ".npy";
    if (name.ends_with(kNpy)) name.resize(name.size() - kNpy.size());
    const bool is_new = members_
                            .emplace(name, Member{.offset = word_at(bytes, at + 42),
                                                  .packed_size = word_at(bytes, at + 20),
                                                  .size = word_at(bytes, at + 24),
                                                  .flags = short_at(bytes, at + 8),
                                                  .method = short_at(bytes, at + 10),
                                                  .crc = word_at(bytes, at + 16)})
                            .second;
    if (!is_new) fail(name, "is there twice");
    at += entry_size;
  }
}

std::string NpzReader::unpacked(std::string_view name) const {
  const auto found = members_.find(std::string(name));
  if (found == members_.end()) {
    std::string there;
    for (const auto& [other, unused] : members_) there += (there.empty() ? "" : ", ") + other;
    fail(name, "no such array; the file has " + (there.empty() ? "none" : there));
  }
  const Member& member = found->second;
  constexpr unsigned kEncrypted = 1;
  if ((member.flags & kEncrypted) != 0) fail(name, "is encrypted");
  if (member.size > kMostNpzBytes) {
    fail(name, "has " + std::to_string(member.size) + " bytes, more than the 1 GiB that are read");
  }
  const std::string_view bytes = bytes_;
  if (member.offset + kLocalHeader > bytes.size() || word_at(bytes, member.offset) != 0x04034b50) {
    fail(name, kCutOff);
  }
  const std::size_t data = member.offset + kLocalHeader + short_at(bytes, member.offset + 26) +
                           short_at(bytes, member.offset + 28);
  if (data + member.packed_size > bytes.size()) fail(name, kCutOff);
  const std::string_view packed = bytes.substr(data, member.packed_size);
  std::string content;
  constexpr unsigned kStored = 0;
  constexpr unsigned kDeflated = 8;
  if (member.method == kStored && member.size == member.packed_size) {
    content = packed;
  } else if (member.method == kDeflated && member.size / kMostDeflation <= packed.size()) {
    std::optional<std::string> data_inflated = inflated(packed, member.size);
    if (!data_inflated) fail(name, "is damaged: it cannot be inflated to its stated size");
    content = std::move(*data_inflated);
  } else if (member.method == kStored || member.method == kDeflated) {
    fail(name, "is damaged: its stated sizes cannot be");
  } else {
    fail(name, "is packed by method " + std::to_string(member.method) +
                   "; save it with numpy.savez or numpy.savez_compressed");
  }
  const unsigned long crc =
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  if (crc != member.crc) fail(name, "is damaged: its checksum is another one");
  return content;
}

NpzReader::RawArray NpzReader::raw_array(std::string_view name) const {
  const std::string content = unpacked(name);
  constexpr std::size_t kPrelude = 8;  // magic text and version
  if (content.size() < kPrelude + 4 || !content.starts_with("\x93NUMPY")) {
    fail(name, "is no array of NumPy");
  }
  const int version = content[6];
  if (version < 1 || version > 3) {
    fail(name, "has version " + std::to_string(version) + " of NPY; 1 to 3 are read");
  }
  const std::size_t start = kPrelude + (version == 1 ? 2 : 4);
  const std::size_t size = version == 1 ? short_at(content, kPrelude) : word_at(content, kPrelude);
  if (size > kMostNpyHeader || start + size > content.size()) fail(name, kCutOff);
  const std::string header = content.substr(start, size);
  RawArray array;
  array.type = header_field(header, R"('descr': *'([^']*)')");
  const std::string order = header_field(header, R"('fortran_order': *(True|False))");
  const std::string shape = header_field(header, R"('shape': *(\([0-9, ]*\)))");
  if (array.type.empty() && header.find("'descr'") != std::string::npos) {
    fail(name, "has elements of several fields; save each field as a plain array");
  }
  if (array.type.empty() || order.empty() || shape.empty()) {
    fail(name, "has a header that is not understood: " + header.substr(0, header.find('\n')));
  }
  if (array.type.find('O') != std::string::npos) {
    fail(name, "holds Python objects; save plain arrays");
  }
  if (array.type.starts_with('>')) {
    fail(name, "has big-endian numbers (" + array.type + "); save them little-endian");
  }
  const auto extents = shape_of(shape.substr(1, shape.size() - 2));
  if (!extents) fail(name, "has the shape " + shape + ", which cannot be");
  array.shape = *extents;
  if (order == "True" && array.shape.size() > 1) {
    fail(name, "is in Fortran order; save numpy.ascontiguousarray of it");
  }
  const char* const digits = array.type.data() + std::min<std::size_t>(2, array.type.size());
  const auto [end, error] =
      std::from_chars(digits, array.type.data() + array.type.size(), array.item_size);
  const std::size_t item_scale = array.type.size() > 1 && array.type[1] == 'U' ? 4 : 1;
  if (error != std::errc() || array.item_size > kMostNpzBytes / item_scale) {
    fail(name, "has elements of type " + array.type + ", which is not read");
  }
  array.item_size *= item_scale;
  // Bounded at every factor, so that the product does not overflow; an extent of zero empties all.
  array.count = 1;
  for (const std::size_t extent : array.shape) {
    if (extent > kMostNpzBytes || array.count * extent > kMostNpzBytes) {
      fail(name, "has the shape " + shape + ", which is larger than the file");
    }
    array.count *= extent;
  }
  array.data = content.substr(start + size);
  if (array.item_size > 0 ? array.data.size() / array.item_size != array.count ||
                                array.data.size() % array.item_size != 0
                          : !array.data.empty() || array.count > 1) {
    fail(name, "has " + std::to_string(array.data.size()) + " bytes of data, not " +
                   std::to_string(array.count) + " times the " + std::to_string(array.item_size) +
                   " of its shape " + shape + " and type " + array.type);
  }
  return array;
}

NpzArray<double> NpzReader::numbers(std::string_view name) const {
  const RawArray raw = raw_array(name);
  NpzArray<double> array{raw.shape, {}};
  array.values.reserve(raw.count);
  for (std::size_t i = 0; i < raw.count; ++i) {
    const std::size_t at = i * raw.item_size;
    if (raw.type == "<f8") {
      array.values.push_back(std::bit_cast<double>(number_at<std::uint64_t>(raw.data, at)));
    } else if (raw.type == "<f4") {
      array.values.push_back(std::bit_cast<float>(number_at<std::uint32_t>(raw.data, at)));
    } else if (raw.type == "<i8") {
      array.values.push_back(
          static_cast<double>(static_cast<std::int64_t>(number_at<std::uint64_t>(raw.data, at))));
    } else if (raw.type == "<i4") {
      array.values.push_back(static_cast<std::int32_t>(number_at<std::uint32_t>(raw.data, at)));
    } else {
      fail(name, "has elements of type " + raw.type + "; save numbers as float64 or float32");
    }
  }
  return array;
}

NpzArray<std::string> NpzReader::texts(std::string_view name) const {
  const RawArray raw = raw_array(name);
  const bool is_unicode = raw.type.starts_with("<U");
  if (!is_unicode && !raw.type.starts_with("|S")) {
    fail(name, "has elements of type " + raw.type + ", which are no texts");
  }
  NpzArray<std::string> array{raw.shape, {}};
  for (std::size_t i = 0; i < raw.count; ++i) {
    const std::string_view item =
        std::string_view(raw.data).substr(i * raw.item_size, raw.item_size);
    std::string text;
    if (is_unicode) {
      // Shorter texts are filled up with zeros.
      for (std::size_t at = 0; at < item.size(); at += 4) {
        const char32_t point = word_at(item, at);
        if (point != 0) append_utf8(point, text);
      }
    } else {
      text = item.substr(0, item.find('\0'));
    }
    array.values.push_back(text);
  }
  return array;
}

}  // namespace graspfit::exchange::internal
