#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "graspfit/base/errors.hpp"

namespace graspfit::base::internal {

[[noreturn]] inline void fail_to_read(const std::filesystem::path& file, const std::string& why) {
  throw IoError("cannot read " + file.string() + ": " + why);
}

/// Opens a file for reading its bytes. Pipes and devices are refused: they may never end, and
/// reading them twice, as for a hash, gives other bytes.
/// @throws IoError if the file does not exist or is not a regular file.
inline std::ifstream open_input_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) fail_to_read(file, "no such file");
  if (std::filesystem::is_directory(status)) fail_to_read(file, "it is a folder");
  if (!std::filesystem::is_regular_file(status)) {
    fail_to_read(file, "it is not a regular file; write to a file what comes through a pipe");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail_to_read(file, std::strerror(errno));
  return stream;
}

}  // namespace graspfit::base::internal
