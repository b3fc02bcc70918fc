#include "graspfit/exchange/posed_glb.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::exchange {
namespace {

using Json = nlohmann::ordered_json;

// Codes of the format.
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"

void append(std::uint32_t value, std::string& bytes) {
  for (unsigned shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>(static_cast<unsigned char>(value >> shift));
  }
}

Json material(const char* name, const std::array<double, 3>& color) {
  return {{"name", name},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", Json::array({color[0], color[1], color[2], 1.0})},
            {"metallicFactor", 0.0},
            {"roughnessFactor", 0.7}}}};
}

/// A glTF document that is being put together.
class Document {
 public:
  Document()
      : json_({{"asset", {{"version", "2.0"}, {"generator", "graspfit"}}},
               {"scene", 0},
               {"scenes", Json::array({{{"nodes", Json::array({0})}}})},
               {"nodes", Json::array({{{"name", "O"}, {"children", Json::array()}}})},
               {"meshes", Json::array()},
               {"accessors", Json::array()},
               {"bufferViews", Json::array()},
               {"materials", Json::array({material("object", {0.80, 0.72, 0.55}),
                                          material("hand", {0.45, 0.55, 0.70})})}}) {}

  /// A node below the root. Precondition: the mesh has faces.
  void add(const std::string& name, const geometry::TriangleMesh& mesh,
           const geometry::RigidTransform& X_OB, int material) {
    const auto [w, x, y, z] = geometry::rotation_wxyz(X_OB);
    const Eigen::Vector3d p = X_OB.translation();
    const int positions = add_positions(mesh);
    const int indices = add_indices(mesh);
    json_["nodes"][0]["children"].push_back(json_["nodes"].size());
    json_["nodes"].push_back({{"name", name},
                              {"mesh", json_["meshes"].size()},
                              {"translation", Json::array({p.x(), p.y(), p.z()})},
                              {"rotation", Json::array({x, y, z, w})}});
    json_["meshes"].push_back(
        {{"name", name},
         {"primitives", Json::array({{{"attributes", {{"POSITION", positions}}},
                                      {"indices", indices},
                                      {"material", material}}})}});
  }

  std::string bytes() {
    json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.append((4 - text.size() % 4) % 4, ' ');  // chunks end at multiples of 4 bytes
    const std::size_t size = 12 + 8 + text.size() + 8 + binary_.size();
    if (size > std::numeric_limits<std::uint32_t>::max()) {
      throw base::InvalidInput("posed_scene_glb: " + std::to_string(size) +
                               " bytes are more than the 4 GiB of a GLB file");
    }
    std::string glb;
    glb.reserve(size);
    append(kMagic, glb);
    append(2, glb);
    append(static_cast<std::uint32_t>(size), glb);
    append(static_cast<std::uint32_t>(text.size()), glb);
    append(kJsonChunk, glb);
    glb += text;
    append(static_cast<std::uint32_t>(binary_.size()), glb);
    append(kBinaryChunk, glb);
    return glb + binary_;
  }

 private:
  int add_positions(const geometry::TriangleMesh& mesh) {
    const std::size_t begin = binary_.size();
    Eigen::Array3f lower = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array3f upper = -lower;
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      const Eigen::Array3f v = vertex.cast<float>().array();
      lower = lower.min(v);
      upper = upper.max(v);
      for (const float coordinate : v) append(std::bit_cast<std::uint32_t>(coordinate), binary_);
    }
    Json accessor = add_view(begin, kArrayBuffer, kFloat, mesh.vertices.size(), "VEC3");
    accessor["min"] = Json::array({lower[0], lower[1], lower[2]});
    accessor["max"] = Json::array({upper[0], upper[1], upper[2]});
    json_["accessors"].push_back(accessor);
    return base::as_index<int>(json_["accessors"].size()) - 1;
  }

  int add_indices(const geometry::TriangleMesh& mesh) {
    const std::size_t begin = binary_.size();
    for (const geometry::Face& face : mesh.faces) {
      for (const std::int32_t corner : face) append(static_cast<std::uint32_t>(corner), binary_);
    }
    json_["accessors"].push_back(
        add_view(begin, kElementArrayBuffer, kUnsignedInt, 3 * mesh.faces.size(), "SCALAR"));
    return base::as_index<int>(json_["accessors"].size()) - 1;
  }

  /// Makes a buffer view of the bytes from `begin` on, and returns its accessor.
  Json add_view(std::size_t begin, int target, int component, std::size_t count, const char* type) {
    json_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", begin},
                                    {"byteLength", binary_.size() - begin},
                                    {"target", target}});
    return {{"bufferView", json_["bufferViews"].size() - 1},
            {"componentType", component},
            {"count", count},
            {"type", type}};
  }

  Json json_;
  std::string binary_;
};

}  // namespace

std::string posed_scene_glb(const geometry::TriangleMesh& object, const hands::HandModel& hand,
                            const hands::HandConfiguration& configuration) {
  hands::validate(hand, configuration);
  Document document;
  if (!object.faces.empty()) {
    document.add("object", object, geometry::RigidTransform::Identity(), 0);
  }
  const auto X_OL = hands::forward_kinematics(hand, configuration);
  for (std::size_t link = 0; link < hand.links.size(); ++link) {
    if (hand.links[link].mesh_L.faces.empty()) continue;
    document.add(hand.links[link].name, hand.links[link].mesh_L, X_OL[link], 1);
  }
  return document.bytes();
}

}  // namespace graspfit::exchange
