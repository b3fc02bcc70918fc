#pragma once

#include <filesystem>
#include <string>

namespace graspfit::geometry {

/// SHA-256 of a file's bytes as 64 lower-case hexadecimal digits, as `sha256_hex(read_file(file))`,
/// in memory that does not depend on its size. @throws IoError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace graspfit::geometry
