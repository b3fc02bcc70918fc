#include "mesh_io/gltf_container.hpp"

#include <cstdint>
#include <limits>

#include "graspfit/base/errors.hpp"
#include "mesh_io/byte_order.hpp"
#include "mesh_io/text_scanner.hpp"

namespace graspfit::geometry::internal::gltf {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

std::uint32_t decoded_u32(std::string_view bytes, std::size_t at) {
  return decoded<std::uint32_t>(bytes.data() + at, true);
}

}  // namespace

void fail(const std::string& what) { throw base::IoError("not a glTF mesh: " + what); }

std::string numbered(const char* what, std::size_t index) {
  return std::string(what) + " " + std::to_string(index);
}

std::string name_in_quotes(std::string_view name) { return in_quotes(name, 60); }

Container opened(std::string_view content) {
  if (!content.starts_with("glTF")) return {content, std::nullopt};
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  if (content.size() < kHeader) fail("the file ends inside its header of 12 bytes");
  const std::uint32_t version = decoded_u32(content, 4);
  if (version != 2) fail("GLB version " + std::to_string(version) + ", only 2 is read");
  const std::uint32_t length = decoded_u32(content, 8);
  if (length < kHeader || length > content.size()) {
    fail("it states " + std::to_string(length) + " bytes, the file has " +
         std::to_string(content.size()));
  }
  Container container;
  std::string_view rest = content.substr(kHeader, length - kHeader);
  if (rest.empty()) fail("it has no chunk of JSON");
  for (std::size_t chunk = 0; !rest.empty(); ++chunk) {
    if (rest.size() < kChunkHeader)
      fail("it ends inside the header of " + numbered("chunk", chunk));
    const std::uint32_t size = decoded_u32(rest, 0);
    const std::uint32_t type = decoded_u32(rest, 4);
    rest.remove_prefix(kChunkHeader);
    if (size > rest.size()) {
      fail(numbered("chunk", chunk) + " states " + std::to_string(size) + " bytes, " +
           std::to_string(rest.size()) + " are left");
    }
    const std::string_view body = rest.substr(0, size);
    rest.remove_prefix(size);
    if (chunk == 0 && type != kJsonChunk) fail("its first chunk is not JSON");
    if (chunk == 0) {
      container.json = body;
    } else if (chunk == 1 && type == kBinaryChunk) {
      container.binary = body;
    }
  }
  return container;
}

std::string packed(std::string json, const std::string& binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string glb = "glTF";
  const std::size_t size = 12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size());
  if (size > std::numeric_limits<std::uint32_t>::max()) fail("it is too large");
  glb.reserve(size);
  append_little_endian(glb, std::uint32_t{2});
  append_little_endian(glb, static_cast<std::uint32_t>(size));
  append_little_endian(glb, static_cast<std::uint32_t>(json.size()));
  append_little_endian(glb, kJsonChunk);
  glb += json;
  if (binary.empty()) return glb;
  append_little_endian(glb, static_cast<std::uint32_t>(binary.size()));
  append_little_endian(glb, kBinaryChunk);
  return glb + binary;
}

}  // namespace graspfit::geometry::internal::gltf
