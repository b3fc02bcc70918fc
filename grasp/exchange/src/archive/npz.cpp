#include "archive/npz.hpp"

#include <algorithm>
#include <bit>
#include <boost/crc.hpp>
#include <cassert>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "graspfit/base/errors.hpp"

namespace graspfit::exchange::internal {
namespace {

template <class Unsigned>
void append(Unsigned value, std::string& bytes) {
  static_assert(std::is_unsigned_v<Unsigned>);
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    bytes += static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
  }
}

/// Returns the code points of a UTF-8 text, with U+FFFD for a byte that is not part of any.
std::u32string code_points(const std::string& utf8) {
  std::u32string points;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto byte = static_cast<unsigned char>(utf8[i]);
    const int length = byte < 0x80 ? 1 : byte >= 0xf0 ? 4 : byte >= 0xe0 ? 3 : byte >= 0xc2 ? 2 : 0;
    char32_t point = length < 2 ? byte : byte & (0x7fU >> length);
    bool is_valid =
        length > 0 && byte < 0xf5 && i + static_cast<std::size_t>(length) <= utf8.size();
    for (int k = 1; is_valid && k < length; ++k) {
      const auto next = static_cast<unsigned char>(utf8[i + static_cast<std::size_t>(k)]);
      is_valid = (next & 0xc0U) == 0x80U;
      point = (point << 6U) | (next & 0x3fU);
    }
    points += is_valid ? point : U'\ufffd';
    i += is_valid ? static_cast<std::size_t>(length) : 1;
  }
  return points;
}

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text = "(";
  for (const std::size_t extent : shape) text += std::to_string(extent) + ", ";
  if (shape.size() > 1) text.resize(text.size() - 2);  // "(3, 7)", but "(7,)"
  if (shape.size() == 1) text.pop_back();
  return text + ')';
}

}  // namespace

void NpzWriter::add(std::string_view name, const std::vector<std::size_t>& shape,
                    std::span<const double> values) {
  std::string data;
  data.reserve(8 * values.size());
  for (const double value : values) append(std::bit_cast<std::uint64_t>(value), data);
  add_member(name, "<f8", shape, data);
}

void NpzWriter::add(std::string_view name, const std::vector<std::size_t>& shape,
                    std::span<const std::int64_t> values) {
  std::string data;
  data.reserve(8 * values.size());
  for (const std::int64_t value : values) append(static_cast<std::uint64_t>(value), data);
  add_member(name, "<i8", shape, data);
}

void NpzWriter::add(std::string_view name, const std::vector<std::size_t>& shape,
                    std::span<const std::string> texts) {
  std::size_t width = 1;
  std::vector<std::u32string> rows;
  for (const std::string& text : texts) {
    rows.push_back(code_points(text));
    width = std::max(width, rows.back().size());
  }
  std::string data;
  for (std::u32string& row : rows) {
    row.resize(width, U'\0');
    for (const char32_t point : row) append(static_cast<std::uint32_t>(point), data);
  }
  add_member(name, "<U" + std::to_string(width), shape, data);
}

void NpzWriter::add_member(std::string_view name, std::string_view type,
                           const std::vector<std::size_t>& shape, const std::string& data) {
  // The prelude is the magic text, the version and the header's length. The header is padded with
  // blanks so that it ends, with a line feed, at a multiple of 64 bytes.
  std::string header = "{'descr': '" + std::string(type) +
                       "', 'fortran_order': False, 'shape': " + shape_text(shape) + ", }";
  constexpr std::size_t kPrelude = 10;
  header.append((64 - (kPrelude + header.size() + 1) % 64) % 64, ' ');
  header += '\n';
  std::string array = "\x93NUMPY\x01";
  array += '\0';
  append(static_cast<std::uint16_t>(header.size()), array);
  array += header + data;

  boost::crc_32_type crc;
  crc.process_bytes(array.data(), array.size());
  const std::string file = std::string(name) + ".npy";
  constexpr std::uint16_t kVersion = 20;
  constexpr std::uint16_t kFirstDay = 0x21;  // 1 January 1980, where the archive's time begins
  std::string common;                        // fields that both headers share
  append(kVersion, common);
  append(std::uint16_t{0}, common);  // flags
  append(std::uint16_t{0}, common);  // stored
  append(std::uint16_t{0}, common);  // time
  append(kFirstDay, common);
  append(static_cast<std::uint32_t>(crc.checksum()), common);
  append(static_cast<std::uint32_t>(array.size()), common);
  append(static_cast<std::uint32_t>(array.size()), common);
  append(static_cast<std::uint16_t>(file.size()), common);
  append(std::uint16_t{0}, common);  // extra field

  const std::size_t offset = members_.size();
  append(std::uint32_t{0x04034b50}, members_);
  members_ += common + file + array;

  append(std::uint32_t{0x02014b50}, directory_);
  append(kVersion, directory_);
  directory_ += common;
  append(std::uint16_t{0}, directory_);  // comment
  append(std::uint16_t{0}, directory_);  // disk
  append(std::uint16_t{0}, directory_);  // internal attributes
  append(std::uint32_t{0}, directory_);  // external attributes
  append(static_cast<std::uint32_t>(offset), directory_);
  directory_ += file;
  ++count_;
}

std::string NpzWriter::bytes() const {
  if (members_.size() + directory_.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw base::InvalidInput("NPZ: " + std::to_string(members_.size()) +
                             " bytes are more than the 4 GiB of an archive");
  }
  std::string end;
  append(std::uint32_t{0x06054b50}, end);
  append(std::uint16_t{0}, end);  // this disk
  append(std::uint16_t{0}, end);  // disk of the directory
  append(static_cast<std::uint16_t>(count_), end);
  append(static_cast<std::uint16_t>(count_), end);
  append(static_cast<std::uint32_t>(directory_.size()), end);
  append(static_cast<std::uint32_t>(members_.size()), end);
  append(std::uint16_t{0}, end);  // comment
  return members_ + directory_ + end;
}

}  // namespace graspfit::exchange::internal
