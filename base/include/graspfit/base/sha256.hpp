#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace graspfit::base {

/// SHA-256 of `bytes` as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

/// SHA-256 of a file's bytes, as `sha256_hex(read_file(file))`, in memory that does not depend on
/// its size. @throws IoError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace graspfit::base
