#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace graspfit::base {

/// Writes `content` to `file` as `AtomicFileWriter` does: `file` never holds half of it, even after
/// a crash or a kill; links are followed, and pipes and devices are written into.
/// @throws IoError (file and reason) if that fails; no temporary file stays behind.
void write_file_atomically(const std::filesystem::path& file, std::string_view content);

/// The bytes of a whole file.
/// @throws IoError if it cannot be read or is not a regular file (a pipe, a device, a folder).
std::string read_file(const std::filesystem::path& file);

}  // namespace graspfit::base
