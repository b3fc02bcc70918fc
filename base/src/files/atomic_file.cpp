#include "graspfit/base/atomic_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "files/input_file.hpp"
#include "graspfit/base/atomic_file_writer.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/sha256.hpp"

namespace graspfit::base {

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
  // The size of files that grow, and of those in /proc, is not reliable.
  std::array<char, 1 << 16> block;
  while (stream.read(block.data(), block.size()), stream.gcount() > 0) {
    content.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) internal::fail_to_read(file, std::strerror(errno));
  return content;
}

}  // namespace graspfit::base
