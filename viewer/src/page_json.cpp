#include "page_json.hpp"

#include <bit>
#include <type_traits>
#include <vector>

namespace graspfit::viewer::internal {
namespace {

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

template <typename Number>
std::string base64_of_numbers(std::span<const Number> numbers) {
  using Bits = std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint32_t>;
  static_assert(sizeof(Bits) == sizeof(Number));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(numbers.size_bytes());
  for (const Number number : numbers) {
    const auto bits = std::bit_cast<Bits>(number);
    for (std::size_t k = 0; k < sizeof(Bits); ++k) {
      bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * k)));
    }
  }
  return base64(bytes);
}

}  // namespace

std::string base64_of(std::span<const std::uint16_t> numbers) { return base64_of_numbers(numbers); }
std::string base64_of(std::span<const std::uint32_t> numbers) { return base64_of_numbers(numbers); }
std::string base64_of(std::span<const float> numbers) { return base64_of_numbers(numbers); }

Json to_json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json to_json(const geometry::RigidTransform& X) {
  const Eigen::Matrix4d matrix = X.matrix();
  return Json(std::vector<double>(matrix.data(), matrix.data() + 16));
}

Json to_json(const geometry::TriangleMesh& mesh) {
  std::vector<float> vertices;
  vertices.reserve(3 * mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) vertices.push_back(static_cast<float>(vertex[axis]));
  }
  std::vector<std::uint32_t> faces;
  faces.reserve(3 * mesh.faces.size());
  for (const geometry::Face& face : mesh.faces) {
    for (const std::int32_t vertex : face) faces.push_back(static_cast<std::uint32_t>(vertex));
  }
  return {{"vertices", base64_of(vertices)}, {"faces", base64_of(faces)}};
}

std::string script_text(const Json& data) {
  const std::string text = data.dump(-1, ' ', false, nlohmann::detail::error_handler_t::replace);
  // "</" would end the script element early, "<!--" would change how its end is found.
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace graspfit::viewer::internal
