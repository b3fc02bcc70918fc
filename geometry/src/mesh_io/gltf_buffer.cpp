#include "mesh_io/gltf_buffer.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>

#include "graspfit/base/atomic_file.hpp"
#include "mesh_io/gltf_container.hpp"

namespace graspfit::geometry::internal::gltf {
namespace {

std::optional<std::string> base64_bytes(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int num_bits = 0;
  for (const char c : text) {
    int value = -1;
    if (c >= 'A' && c <= 'Z') value = c - 'A';
    if (c >= 'a' && c <= 'z') value = c - 'a' + 26;
    if (c >= '0' && c <= '9') value = c - '0' + 52;
    if (c == '+' || c == '-') value = 62;
    if (c == '/' || c == '_') value = 63;
    if (value < 0) return std::nullopt;
    bits = ((bits << 6) | static_cast<std::uint32_t>(value)) & 0xFFFFFF;
    num_bits += 6;
    if (num_bits >= 8) {
      num_bits -= 8;
      bytes += static_cast<char>((bits >> num_bits) & 0xFF);
    }
  }
  return bytes;
}

/// `%20` and the like as the bytes they stand for; empty if one is cut or stands for a zero byte.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    auto byte = static_cast<unsigned char>(text[i]);
    if (byte == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const char* const end = text.data() + i + 3;
      if (std::from_chars(end - 2, end, byte, 16).ptr != end) return std::nullopt;
      i += 2;
    }
    if (byte == 0) return std::nullopt;
    bytes += static_cast<char>(byte);
  }
  return bytes;
}

}  // namespace

std::string buffer_bytes(std::string_view uri, const std::filesystem::path& folder,
                         const std::string& where) {
  namespace fs = std::filesystem;
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
      fail(where + ": its data URI is not in base64");
    }
    const auto bytes = base64_bytes(uri.substr(comma + 1));
    if (!bytes) fail(where + ": its data URI has a character that is not one of base64's");
    return *bytes;
  }
  const auto refuse = [&](const std::string& why) {
    fail(where + ": " + name_in_quotes(uri) + why);
  };
  const auto name = percent_decoded(uri);
  if (!name || name->empty()) refuse(" is not a file's name");
  const fs::path relative = *name;
  const bool goes_up = std::find(relative.begin(), relative.end(), "..") != relative.end();
  const bool has_scheme = uri.substr(0, uri.find('/')).find(':') != std::string_view::npos;
  if (relative.is_absolute() || goes_up || has_scheme || name->find('\\') != std::string::npos) {
    refuse(" is not in the file's own folder");
  }
  const fs::path base = folder.empty() ? fs::path(".") : folder;
  std::error_code error;
  const fs::path file = fs::canonical(base / relative, error);
  if (error) refuse(": no such file");
  const fs::path root = fs::canonical(base, error);
  if (error ||
      std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first != root.end()) {
    refuse(" leads out of the file's own folder");
  }
  if (!fs::is_regular_file(file, error)) refuse(" is not a regular file");
  if (fs::file_size(file, error) > kMostBufferBytes || error) {
    refuse(" has more than " + std::to_string(kMostBufferBytes) + " bytes");
  }
  return base::read_file(file);
}

}  // namespace graspfit::geometry::internal::gltf
