#include "graspfit/geometry/atomic_file.hpp"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <new>

#include "graspfit/geometry/atomic_file_writer.hpp"
#include "internal/hexadecimal.hpp"
#include "internal/input_file.hpp"

namespace graspfit::geometry {

void write_file_atomically(const std::filesystem::path& file, std::string_view content) {
  AtomicFileWriter writer(file);
  writer.write(content);
  writer.commit();
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream = internal::open_input_file(file);
  std::string content;
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (!error) {
    content.resize(size);
    stream.read(content.data(), static_cast<std::streamsize>(size));
    content.resize(static_cast<std::size_t>(stream.gcount()));
    if (stream.bad()) internal::fail_to_read(file, std::strerror(errno));
    if (stream.eof()) return content;
  }
  // Files that grow and those of /proc have no size to trust.
  std::array<char, 1 << 16> block;
  while (stream.read(block.data(), block.size()), stream.gcount() > 0) {
    content.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) internal::fail_to_read(file, std::strerror(errno));
  return content;
}

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::bad_alloc();  // The only way in which hashing memory fails.
  }
  return internal::hexadecimal({digest.data(), size});
}

std::string shortest_decimal(double value) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

}  // namespace graspfit::geometry
