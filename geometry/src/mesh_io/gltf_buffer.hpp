#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace graspfit::geometry::internal::gltf {

/// Most bytes of a file, and of all buffers together.
inline constexpr std::uint64_t kMostBufferBytes = std::uint64_t{1} << 30;

/// The bytes that a buffer's URI stands for: data in base64, or a file in `folder` or below, links
/// followed. @throws IoError "not a glTF mesh: <where>: ..." if these bytes cannot be had.
std::string buffer_bytes(std::string_view uri, const std::filesystem::path& folder,
                         const std::string& where);

}  // namespace graspfit::geometry::internal::gltf
