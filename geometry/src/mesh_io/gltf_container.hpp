#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace graspfit::geometry::internal::gltf {

/// Throws IoError "not a glTF mesh: <what>".
[[noreturn]] void fail(const std::string& what);

/// `what` with its number, as in "chunk 3".
std::string numbered(const char* what, std::size_t index);

/// A name for a message.
std::string name_in_quotes(std::string_view name);

/// JSON text and the bytes that come with it in a GLB.
struct Container {
  std::string_view json;
  std::optional<std::string_view> binary;
};

/// What a glTF file (all of it JSON) or a GLB holds. @throws IoError if the GLB is incomplete.
Container opened(std::string_view content);

/// A GLB that holds this JSON text and these bytes.
std::string packed(std::string json, const std::string& binary);

}  // namespace graspfit::geometry::internal::gltf
