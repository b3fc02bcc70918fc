#include "mesh_io/checked_glb.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/base/json_bounds.hpp"
#include "mesh_io/gltf_buffer.hpp"
#include "mesh_io/gltf_container.hpp"
#include "mesh_io/text_scanner.hpp"

namespace graspfit::geometry::internal {
namespace {

using Json = nlohmann::json;
using gltf::fail;
using gltf::kMostBufferBytes;
using gltf::name_in_quotes;
using gltf::numbered;
using std::uint64_t;

constexpr int kMostNodeDepth = 100;
constexpr uint64_t kMostVertices = 20'000'000;

Json parsed(std::string_view text) {
  text = without_byte_order_mark(text);
  base::require_bounded_json(text, "not a glTF mesh: its JSON");
  try {
    Json json = Json::parse(text);
    if (!json.is_object()) fail("its JSON is not an object");
    return json;
  } catch (const Json::parse_error& error) {
    fail("its JSON does not parse: " + base::json_fault(error.what()));
  }
}

/// A member that is a whole number from 0; `fallback` if it is not there.
std::optional<uint64_t> whole_member(const Json& object, const char* key, const std::string& where,
                                     std::optional<uint64_t> fallback = std::nullopt) {
  const auto found = object.find(key);
  if (found == object.end()) return fallback;
  if (found->is_number_unsigned()) return found->get<uint64_t>();
  const double value =
      found->is_number() ? found->get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!(value >= 0.0 && value < 0x1p53) || value != std::floor(value)) {
    fail(where + ": " + key + " is not a whole number from 0");
  }
  return static_cast<uint64_t>(value);
}

uint64_t required_whole(const Json& object, const char* key, const std::string& where) {
  const std::optional<uint64_t> value = whole_member(object, key, where);
  if (!value) fail(where + " has no " + key);
  return *value;
}

/// An index into an array of `count`; empty if it is not there.
std::optional<uint64_t> index_member(const Json& object, const char* key, std::size_t count,
                                     const std::string& where) {
  const std::optional<uint64_t> value = whole_member(object, key, where);
  if (value && *value >= count) {
    fail(where + ": " + key + " " + std::to_string(*value) + " of " + std::to_string(count));
  }
  return value;
}

/// A member that is an array of objects; empty if it is not there.
const Json& objects(const Json& parent, const char* key) {
  static const Json kNone = Json::array();
  const auto found = parent.find(key);
  if (found == parent.end()) return kNone;
  const auto is_object = [](const Json& item) { return item.is_object(); };
  if (!found->is_array() || !std::all_of(found->begin(), found->end(), is_object)) {
    fail(std::string(key) + " is not an array of objects");
  }
  return *found;
}

const Json& member_object(const Json& parent, const char* key, const std::string& where) {
  const auto found = parent.find(key);
  if (found == parent.end() || !found->is_object()) fail(where + " has no " + key);
  return *found;
}

/// Refuses bytes that are not all within the `size` bytes of `whole`.
void require_within(uint64_t size, const char* whole, uint64_t offset, uint64_t length,
                    const std::string& where) {
  if (offset <= size && length <= size - offset) return;
  fail(where + ": " + std::to_string(length) + " bytes from " + std::to_string(offset) +
       " are not within the " + std::to_string(size) + " of its " + whole);
}

/// Bytes of a component of an accessor.
uint64_t component_size(uint64_t type, const std::string& where) {
  if (type == 5120 || type == 5121) return 1;
  if (type == 5122 || type == 5123) return 2;
  if (type == 5125 || type == 5126) return 4;
  fail(where + ": unknown componentType " + std::to_string(type));
}

bool is_unsigned_integer(uint64_t component_type) {
  return component_type == 5121 || component_type == 5123 || component_type == 5125;
}

/// Bytes of an element; columns of matrices begin at multiples of four.
uint64_t element_size(const std::string& type, uint64_t component, const std::string& where) {
  const auto matrix = [component](uint64_t n) { return n * ((n * component + 3) / 4 * 4); };
  if (type == "SCALAR") return component;
  if (type == "VEC2") return 2 * component;
  if (type == "VEC3") return 3 * component;
  if (type == "VEC4") return 4 * component;
  if (type == "MAT2") return matrix(2);
  if (type == "MAT3") return matrix(3);
  if (type == "MAT4") return matrix(4);
  fail(where + ": unknown type " + name_in_quotes(type));
}

/// The properties of an accessor that matter to its users.
struct Accessor {
  uint64_t component_type = 0;
  std::string type;
  uint64_t count = 0;
};

/// A glTF document that is checked and written as a GLB of its own.
class Document {
 public:
  Document(std::string_view content, const std::filesystem::path& folder)
      : container_(gltf::opened(content)), source_(parsed(container_.json)), folder_(folder) {}

  std::string as_glb() {
    check_extensions();
    add_buffers();
    add_views();
    add_accessors();
    add_meshes();
    add_nodes();
    add_scenes();
    target_["asset"] = {{"version", "2.0"}};
    return gltf::packed(target_.dump(), binary_);
  }

 private:
  void check_extensions() const {
    const Json& asset = member_object(source_, "asset", "it");
    const auto version = asset.find("version");
    if (version == asset.end() || !version->is_string()) fail("its asset has no version");
    const std::string text = version->get<std::string>();
    if (!text.starts_with("2.")) fail("glTF version " + name_in_quotes(text) + ", only 2 is read");
    for (const char* key : {"extensionsRequired", "extensionsUsed"}) {
      const auto names = source_.find(key);
      if (names == source_.end() || !names->is_array()) continue;
      for (const Json& name : *names) {
        for (const char* compressed :
             {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"}) {
          if (name != compressed) continue;
          fail(std::string("its meshes are compressed (") + compressed +
               "), which is not supported; write it without compression");
        }
      }
    }
  }

  void add_buffers() {
    const Json& buffers = objects(source_, "buffers");
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      const std::string where = numbered("buffer", i);
      const uint64_t length = required_whole(buffers[i], "byteLength", where);
      const auto uri = buffers[i].find("uri");
      if (uri != buffers[i].end() && !uri->is_string()) fail(where + ": uri is not a text");
      std::string loaded;
      std::string_view bytes;
      if (uri != buffers[i].end()) {
        loaded = gltf::buffer_bytes(uri->get_ref<const std::string&>(), folder_, where);
        bytes = loaded;
      } else if (i == 0 && container_.binary) {
        bytes = *container_.binary;
      } else {
        fail(where + " has no uri" + (i == 0 ? " and the file no chunk of bytes" : ""));
      }
      if (bytes.size() < length) {
        fail(where + " states " + std::to_string(length) + " bytes, there are " +
             std::to_string(bytes.size()));
      }
      if (length > kMostBufferBytes - binary_.size()) {
        fail("its buffers have more than " + std::to_string(kMostBufferBytes) + " bytes");
      }
      buffers_.push_back({binary_.size(), length});
      binary_ += bytes.substr(0, length);
      binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    }
    target_["buffers"] = Json::array();
    if (!binary_.empty()) target_["buffers"].push_back({{"byteLength", binary_.size()}});
  }

  void add_views() {
    const Json& views = objects(source_, "bufferViews");
    target_["bufferViews"] = Json::array();
    for (std::size_t i = 0; i < views.size(); ++i) {
      const std::string where = numbered("bufferView", i);
      const auto buffer = index_member(views[i], "buffer", buffers_.size(), where);
      if (!buffer) fail(where + " has no buffer");
      const uint64_t offset = *whole_member(views[i], "byteOffset", where, 0);
      const uint64_t length = required_whole(views[i], "byteLength", where);
      const auto [begin, size] = buffers_[*buffer];
      require_within(size, "buffer", offset, length, where);
      const uint64_t stride = *whole_member(views[i], "byteStride", where, 0);
      if (stride != 0 && (stride < 4 || stride > 252)) {
        fail(where + ": byteStride " + std::to_string(stride) + ", must be in [4, 252]");
      }
      views_.push_back({length, stride});
      Json& view = target_["bufferViews"].emplace_back();
      view = {{"buffer", 0}, {"byteOffset", begin + offset}, {"byteLength", length}};
      if (stride != 0) view["byteStride"] = stride;
    }
  }

  /// Refuses `count` elements that do not lie within a view.
  void check_elements(const Json& elements, uint64_t count, uint64_t size, const std::string& where,
                      bool uses_stride) const {
    const uint64_t view = required_index(elements, "bufferView", views_.size(), where);
    const uint64_t offset = *whole_member(elements, "byteOffset", where, 0);
    const auto [length, stride] = views_[view];
    const uint64_t step = uses_stride && stride != 0 ? stride : size;
    if (step < size) {
      fail(where + ": elements of " + std::to_string(size) + " bytes at steps of " +
           std::to_string(step));
    }
    // The count is at most kMostVertices here, so that the product does not overflow.
    const uint64_t bytes = count == 0 ? 0 : (count - 1) * step + size;
    require_within(length, "bufferView", offset, bytes, where);
  }

  static uint64_t required_index(const Json& object, const char* key, std::size_t count,
                                 const std::string& where) {
    const auto value = index_member(object, key, count, where);
    if (!value) fail(where + " has no " + key);
    return *value;
  }

  void add_accessors() {
    const Json& accessors = objects(source_, "accessors");
    target_["accessors"] = Json::array();
    for (std::size_t i = 0; i < accessors.size(); ++i) {
      const Json& accessor = accessors[i];
      const std::string where = numbered("accessor", i);
      Accessor known;
      known.component_type = required_whole(accessor, "componentType", where);
      const auto type = accessor.find("type");
      if (type == accessor.end() || !type->is_string()) fail(where + " has no type");
      known.type = type->get<std::string>();
      known.count = required_whole(accessor, "count", where);
      const uint64_t size =
          element_size(known.type, component_size(known.component_type, where), where);
      if (known.count > kMostVertices) {
        fail(where + " has " + std::to_string(known.count) + " elements, at most " +
             std::to_string(kMostVertices) + " are read");
      }
      if (accessor.contains("bufferView")) {
        check_elements(accessor, known.count, size, where, true);
      }
      const auto sparse = accessor.find("sparse");
      if (sparse != accessor.end()) check_sparse(*sparse, known, size, where + ": sparse");
      if (sparse == accessor.end() && !accessor.contains("bufferView")) {
        fail(where + " has neither a bufferView nor sparse values");
      }
      accessors_.push_back(std::move(known));
      Json& copy = target_["accessors"].emplace_back(Json::object());
      for (const char* key :
           {"bufferView", "byteOffset", "componentType", "count", "type", "sparse"}) {
        if (accessor.contains(key)) copy[key] = accessor[key];
      }
    }
  }

  void check_sparse(const Json& sparse, const Accessor& accessor, uint64_t size,
                    const std::string& where) const {
    if (!sparse.is_object()) fail(where + " is not an object");
    const uint64_t count = required_whole(sparse, "count", where);
    if (count > accessor.count) {
      fail(where + " has " + std::to_string(count) + " of " + std::to_string(accessor.count) +
           " elements");
    }
    const Json& indices = member_object(sparse, "indices", where);
    const Json& values = member_object(sparse, "values", where);
    const uint64_t type = required_whole(indices, "componentType", where + " indices");
    if (!is_unsigned_integer(type)) {
      fail(where + " indices: componentType " + std::to_string(type) + " is no unsigned integer");
    }
    const uint64_t index_size = component_size(type, where);
    check_elements(indices, count, index_size, where + " indices", false);
    check_elements(values, count, size, where + " values", false);
    const Json& view = target_["bufferViews"][indices["bufferView"].get<std::size_t>()];
    const uint64_t begin =
        view["byteOffset"].get<uint64_t>() + *whole_member(indices, "byteOffset", where, 0);
    for (uint64_t i = 0; i < count; ++i) {
      uint64_t value = 0;
      for (uint64_t k = 0; k < index_size; ++k) {
        const auto byte = static_cast<unsigned char>(binary_[begin + i * index_size + k]);
        value |= uint64_t{byte} << (8 * k);
      }
      if (value >= accessor.count) {
        fail(where + " indices: element " + std::to_string(value) + " of " +
             std::to_string(accessor.count));
      }
    }
  }

  /// Meshes keep those primitives that have a surface.
  void add_meshes() {
    const Json& meshes = objects(source_, "meshes");
    target_["meshes"] = Json::array();
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      Json kept = Json::array();
      Size size;
      const Json& primitives = objects(meshes[i], "primitives");
      for (std::size_t k = 0; k < primitives.size(); ++k) {
        const std::string where = numbered("mesh", i) + ", " + numbered("primitive", k);
        const Json& attributes = member_object(primitives[k], "attributes", where);
        const auto position = index_member(attributes, "POSITION", accessors_.size(), where);
        const auto indices = index_member(primitives[k], "indices", accessors_.size(), where);
        const uint64_t mode = *whole_member(primitives[k], "mode", where, 4);
        if (mode > 6) fail(where + ": unknown mode " + std::to_string(mode));
        if (!position || mode < 4) continue;  // Points, lines, and primitives without positions.
        const Accessor& points = accessors_[*position];
        if (points.component_type != 5126 || points.type != "VEC3") {
          fail(where +
               ": positions that are not three floats are not supported; write it without "
               "quantization");
        }
        Json primitive = {{"attributes", {{"POSITION", *position}}}, {"mode", mode}};
        uint64_t num_corners = points.count;
        if (indices) {
          const Accessor& corners = accessors_[*indices];
          if (corners.type != "SCALAR" || !is_unsigned_integer(corners.component_type)) {
            fail(where + ": its indices are no unsigned integers");
          }
          num_corners = corners.count;
          primitive["indices"] = *indices;
        }
        if (points.count == 0 || num_corners < 3) continue;
        // A strip or fan has three corners for each of its steps.
        size.corners += mode == 4 ? num_corners : 3 * num_corners;
        size.vertices += points.count;
        kept.push_back(std::move(primitive));
      }
      sizes_.push_back(size);
      target_["meshes"].push_back({{"primitives", std::move(kept)}});
    }
  }

  static void copy_numbers(const Json& from, const char* key, std::size_t count, Json& to,
                           const std::string& where) {
    const auto found = from.find(key);
    if (found == from.end()) return;
    const bool is_good = found->is_array() && found->size() == count &&
                         std::all_of(found->begin(), found->end(), [](const Json& item) {
                           return item.is_number() && std::isfinite(item.get<double>());
                         });
    if (!is_good) fail(where + ": " + key + " is not " + std::to_string(count) + " numbers");
    to[key] = *found;
  }

  /// Checks that an array of indices of nodes is one, and returns them.
  static std::vector<std::size_t> node_list(const Json& parent, const char* key,
                                            std::size_t num_nodes, const std::string& where) {
    std::vector<std::size_t> nodes;
    const auto found = parent.find(key);
    if (found == parent.end()) return nodes;
    if (!found->is_array()) fail(where + ": " + key + " is not an array");
    for (const Json& item : *found) {
      if (!item.is_number_unsigned() || item.get<uint64_t>() >= num_nodes) {
        fail(where + ": " + key + " has a number that is not one of the " +
             std::to_string(num_nodes) + " nodes");
      }
      nodes.push_back(item.get<std::size_t>());
    }
    return nodes;
  }

  void add_nodes() {
    const Json& nodes = objects(source_, "nodes");
    target_["nodes"] = Json::array();
    std::vector<bool> has_parent(nodes.size(), false);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::string where = numbered("node", i);
      Json node = Json::object();
      const auto mesh = index_member(nodes[i], "mesh", sizes_.size(), where);
      if (mesh && sizes_[*mesh].corners > 0) node["mesh"] = *mesh;
      node_mesh_.push_back(mesh);
      children_.push_back(node_list(nodes[i], "children", nodes.size(), where));
      for (const std::size_t child : children_.back()) {
        if (has_parent[child]) fail(numbered("node", child) + " has two parents");
        has_parent[child] = true;
      }
      if (!children_.back().empty()) node["children"] = children_.back();
      copy_numbers(nodes[i], "matrix", 16, node, where);
      copy_numbers(nodes[i], "translation", 3, node, where);
      copy_numbers(nodes[i], "rotation", 4, node, where);
      copy_numbers(nodes[i], "scale", 3, node, where);
      target_["nodes"].push_back(std::move(node));
    }
    // As no node has two parents, the nodes that are reached from no root form cycles.
    std::size_t num_reached = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!has_parent[i]) num_reached += below(i).num_nodes;
    }
    if (num_reached != nodes.size()) fail("its nodes are their own children");
  }

  struct Size {
    uint64_t vertices = 0;
    uint64_t corners = 0;
    std::size_t num_nodes = 0;

    /// Refuses what is too much, so that sums stay far below overflow; `shows` begins the message.
    void add(const Size& more, const std::string& shows) {
      vertices += more.vertices;
      corners += more.corners;
      if (vertices > kMostVertices || corners > kMostVertices) {
        fail(shows + " more than " + std::to_string(kMostVertices) + " vertices or corners");
      }
    }
  };

  /// Size of what is below a node, the node included.
  Size below(std::size_t root) const {
    Size sum;
    std::vector<std::pair<std::size_t, int>> rest = {{root, 1}};
    while (!rest.empty()) {
      const auto [node, depth] = rest.back();
      rest.pop_back();
      if (depth > kMostNodeDepth) {
        fail("its nodes are nested more than " + std::to_string(kMostNodeDepth) + " deep");
      }
      ++sum.num_nodes;
      if (node_mesh_[node]) sum.add(sizes_[*node_mesh_[node]], "its nodes show");
      for (const std::size_t child : children_[node]) rest.emplace_back(child, depth + 1);
    }
    return sum;
  }

  void add_scenes() {
    const Json& scenes = objects(source_, "scenes");
    const auto chosen = index_member(source_, "scene", scenes.size(), "the file");
    target_["scenes"] = Json::array();
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const std::string where = numbered("scene", i);
      const std::vector<std::size_t> roots = node_list(scenes[i], "nodes", children_.size(), where);
      Size sum;
      for (const std::size_t root : roots) sum.add(below(root), where + " shows");
      Json& scene = target_["scenes"].emplace_back(Json::object());
      if (!roots.empty()) scene["nodes"] = roots;
    }
    if (chosen) target_["scene"] = *chosen;
  }

  struct Range {
    uint64_t begin = 0;
    uint64_t size = 0;
  };
  struct View {
    uint64_t length = 0;
    uint64_t stride = 0;
  };

  gltf::Container container_;
  Json source_;
  const std::filesystem::path& folder_;
  Json target_ = Json::object();
  std::string binary_;          ///< All buffers, one after the other.
  std::vector<Range> buffers_;  ///< In `binary_`.
  std::vector<View> views_;
  std::vector<Accessor> accessors_;
  std::vector<Size> sizes_;  ///< Of meshes.
  std::vector<std::optional<uint64_t>> node_mesh_;
  std::vector<std::vector<std::size_t>> children_;
};

}  // namespace

std::string checked_glb(std::string_view content, const std::filesystem::path& folder) {
  return Document(content, folder).as_glb();
}

}  // namespace graspfit::geometry::internal
