#pragma once

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "support/catch.hpp"

namespace graspfit::testing {

inline void append_little_endian(std::uint64_t value, int num_bytes, std::string& bytes) {
  for (int i = 0; i < num_bytes; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xffU);
}

/// The bytes of a NPY file with that header text, "{'descr': '<f8', ...}".
inline std::string npy_file(const std::string& header, const std::string& data) {
  std::string bytes("\x93NUMPY\x01\0", 8);
  append_little_endian(header.size() + 1, 2, bytes);
  return bytes + header + '\n' + data;
}

/// The bytes of a NPY file of doubles in C order; `shape` as "(2, 9)".
inline std::string npy(const std::string& shape, const std::vector<double>& values) {
  std::string data;
  for (const double value : values) {
    append_little_endian(std::bit_cast<std::uint64_t>(value), 8, data);
  }
  return npy_file("{'descr': '<f8', 'fortran_order': False, 'shape': " + shape + ", }", data);
}

/// The same in single precision.
inline std::string npy_single(const std::string& shape, const std::vector<double>& values) {
  std::string data;
  for (const double value : values) {
    append_little_endian(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4, data);
  }
  return npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + ", }", data);
}

inline std::string deflated(const std::string& data) {
  z_stream stream = {};
  REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string packed(deflateBound(&stream, static_cast<uLong>(data.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(data.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

/// What a ZIP archive says of its members.
struct ZipForm {
  bool is_deflated = false;
  int method = -1;                ///< Stated instead of the true one, unless negative.
  std::uint32_t stated_size = 0;  ///< Stated instead of the true one, unless 0 [bytes].
  std::uint16_t flags = 0;
};

/// A ZIP archive of files by name, with a data descriptor's flags and an extra field as NumPy
/// writes them.
inline std::string zip(const std::vector<std::pair<std::string, std::string>>& files,
                       const ZipForm& form = {}) {
  std::string bytes;
  std::string directory;
  for (const auto& [name, data] : files) {
    const std::string packed = form.is_deflated ? deflated(data) : data;
    const int method = form.method >= 0 ? form.method : form.is_deflated ? 8 : 0;
    const std::uint32_t size =
        form.stated_size > 0 ? form.stated_size : static_cast<std::uint32_t>(data.size());
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
    std::string common;
    append_little_endian(20, 2, common);
    append_little_endian(form.flags, 2, common);
    append_little_endian(static_cast<std::uint64_t>(method), 2, common);
    append_little_endian(0, 4, common);  // time and day
    append_little_endian(crc, 4, common);
    append_little_endian(packed.size(), 4, common);
    append_little_endian(size, 4, common);
    append_little_endian(name.size(), 2, common);
    const std::size_t offset = bytes.size();
    bytes += "PK\3\4" + common;
    append_little_endian(20, 2, bytes);  // an extra field, in the local header only
    bytes += name + std::string(20, '\1') + packed;
    directory += std::string("PK\1\2\24\0", 6) + common;
    append_little_endian(0, 2, directory);
    directory += std::string(2 + 2 + 2 + 4, char{0});
    append_little_endian(offset, 4, directory);
    directory += name;
  }
  std::string end = "PK\5\6";
  append_little_endian(0, 4, end);
  append_little_endian(files.size(), 2, end);
  append_little_endian(files.size(), 2, end);
  append_little_endian(directory.size(), 4, end);
  append_little_endian(bytes.size(), 4, end);
  append_little_endian(0, 2, end);
  return bytes + directory + end;
}

}  // namespace graspfit::testing
