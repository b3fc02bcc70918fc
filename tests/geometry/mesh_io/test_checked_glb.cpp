#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/mesh_io/error_of.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "mesh_io/checked_glb.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_checked_glb {

using namespace graspfit::base;
using namespace graspfit::geometry;
using graspfit::testing::Contains;
using graspfit::testing::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

// The file has a triangle: 36 bytes of positions (0 0 0), (1 0 0), (0 1 0), then indices 0 1 2 as
// bytes, in a buffer of 40 bytes; a sparse accessor puts its point 1 to (0 0 0).
const char* const kTriangle = R"({"asset":{"version":"2.0"},
"scene":0,
"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1]},{"mesh":0,"translation":[0,0,5]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":4}]}],
"accessors":[
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"},
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,
"indices":{"bufferView":1,"byteOffset":1,"componentType":5121},
"values":{"bufferView":0,"byteOffset":0}}}],
"bufferViews":[
{"buffer":0,"byteOffset":0,"byteLength":36},
{"buffer":0,"byteOffset":36,"byteLength":3}],
"buffers":[{"byteLength":40,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAECAA=="}]})";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  INFO(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string u32(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFF);
  return bytes;
}

std::string chunk(const char* type, const std::string& body) {
  return u32(static_cast<std::uint32_t>(body.size())) + type + body;
}

std::string glb(const std::string& chunks) {
  return "glTF" + u32(2) + u32(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

const std::string kJson = "JSON";
const std::string kBinary = std::string("BIN\0", 4);

std::string nested(const std::string& open, const std::string& close, int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += open;
  for (int i = 0; i < depth; ++i) text += close;
  return text;
}

std::string chain_of_nodes(int length) {
  std::string nodes = "\"nodes\":[";
  for (int i = 0; i + 1 < length; ++i) nodes += "{\"children\":[" + std::to_string(i + 1) + "]},";
  return nodes + "{\"mesh\":0}],";
}

std::string error_of(const fs::path& file) {
  return graspfit::testing::error_of(file, "not a glTF mesh: ");
}

}  // namespace

TEST_CASE("A glTF file and the GLB of the same bytes are the same mesh", "[geometry][gltf]") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = read_mesh(folder.write("a.gltf", kTriangle)).mesh;
  CHECK(mesh.vertices == std::vector<Eigen::Vector3d>{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}});
  CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});

  std::string bytes(40, '\0');
  bytes[14] = bytes[30] = static_cast<char>(0x80);
  bytes[15] = bytes[31] = 0x3F;
  bytes[37] = 1;
  bytes[38] = 2;
  const std::string uri = R"("uri":"data:application/octet-stream;base64,)";
  std::string json = kTriangle;
  const std::size_t at = json.find("," + uri);
  json.erase(at, json.find("\"}]}", at) + 1 - at);
  const std::string binary = glb(chunk("JSON", json) + chunk(kBinary.c_str(), bytes).substr(0, 7) +
                                 std::string(1, '\0') + bytes);
  CHECK(read_mesh(folder.write("a.glb", binary)).mesh == mesh);

  // The buffer may be in a file beside the mesh, its name in percent signs, and below it.
  folder.write("my bytes.bin", bytes + "more");
  const auto with_uri = [&](const std::string& name) {
    return replaced(json, "\"byteLength\":40", "\"byteLength\":40,\"uri\":\"" + name + "\"");
  };
  CHECK(read_mesh(folder.write("b.gltf", with_uri("my%20bytes.bin"))).mesh == mesh);
  fs::create_directory(folder.path() / "sub");
  folder.write("sub/c.bin", bytes);
  CHECK(read_mesh(folder.write("c.gltf", with_uri("sub/c.bin"))).mesh == mesh);
  CHECK(read_mesh(folder.write("d.gltf", with_uri("./sub/c.bin"))).mesh == mesh);

  // A sparse accessor puts its second point onto the first.
  const std::string sparse = replaced(kTriangle, "\"POSITION\":0", "\"POSITION\":2");
  CHECK(read_mesh(folder.write("e.gltf", sparse)).mesh.vertices ==
        std::vector<Eigen::Vector3d>{{0, 0, 5}, {0, 1, 5}});

  // Nothing of this is a shape.
  const std::string more = replaced(
      kTriangle, "\"scene\":0,",
      R"("scene":0,"cameras":[{"type":"none"}],"materials":[7],"animations":[{"channels":{}}],)"
      R"("images":[{"uri":"/etc/passwd"}],"skins":3,)");
  CHECK(read_mesh(folder.write("f.gltf", more)).mesh == mesh);
}

TEST_CASE("Buffers of glTF come from the file's own folder and nowhere else", "[geometry][gltf]") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "inner");
  folder.write("outer.bin", std::string(40, '\0'));
  folder.write("inner/short.bin", std::string(39, '\0'));
  fs::create_directory(folder.path() / "inner/folder.bin");
  fs::create_symlink("../outer.bin", folder.path() / "inner/link.bin");
  REQUIRE(mkfifo((folder.path() / "inner/pipe.bin").c_str(), 0600) == 0);
  std::string json = kTriangle;
  const std::size_t begin = json.find("data:");
  const std::string uri = json.substr(begin, json.find('"', begin) - begin);
  const std::string outside = "is not in the file's own folder";
  const std::vector<std::vector<std::string>> cases = {
      {"../outer.bin", outside},
      {"%2e%2e/outer.bin", outside},
      {"sub/../../outer.bin", outside},
      {"..\\\\outer.bin", outside},
      {"/etc/passwd", outside},
      {"file:///etc/passwd", outside},
      {"http://example.org/x.bin", outside},
      {"link.bin", "leads out of the file's own folder"},
      {"none.bin", "no such file"},
      {"folder.bin", "is not a regular file"},
      {"pipe.bin", "is not a regular file"},
      {"short.bin", "buffer 0 states 40 bytes, there are 39"},
      {"a%zz.bin", "is not a file's name"},
      {"a%00.bin", "is not a file's name"},
      {"", "is not a file's name"},
      {"data:text/plain,hello", "its data URI is not in base64"},
      {"data:;base64,AA*A", "its data URI has a character that is not one of base64's"},
      {"data:;base64,AAAA", "buffer 0 states 40 bytes, there are 3"},
  };
  for (const auto& row : cases) {
    INFO(row[0]);
    const fs::path file = folder.write("inner/x.gltf", replaced(json, uri, row[0]));
    CHECK_THAT(error_of(file), Contains(row[1]));
  }
}

TEST_CASE("Every bad number of a glTF file is refused by its place", "[geometry][gltf]") {
  struct Case {
    std::string from;
    std::string to;
    std::string says;
  };
  const std::string view0 = R"({"buffer":0,"byteOffset":0,"byteLength":36})";
  const std::string points = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)";
  const std::vector<Case> cases = {
      // These have wrong ranges of bytes.
      {view0, R"({"buffer":0,"byteOffset":18446744073709551615,"byteLength":36})",
       "bufferView 0: 36 bytes from 18446744073709551615 are not within the 40 of its buffer"},
      {view0, R"({"buffer":0,"byteOffset":5,"byteLength":36})", "bufferView 0: 36 bytes from 5"},
      {view0, R"({"buffer":0,"byteOffset":-1,"byteLength":36})",
       "bufferView 0: byteOffset is not a whole number from 0"},
      {view0, R"({"buffer":0,"byteOffset":0.5,"byteLength":36})",
       "bufferView 0: byteOffset is not a whole number from 0"},
      {view0, R"({"buffer":0,"byteOffset":1e300,"byteLength":36})",
       "bufferView 0: byteOffset is not a whole number from 0"},
      {view0, R"({"buffer":0,"byteLength":18446744073709551615})",
       "bufferView 0: 18446744073709551615 bytes from 0"},
      {view0, R"({"buffer":1,"byteLength":36})", "bufferView 0: buffer 1 of 1"},
      {view0, R"({"byteLength":36})", "bufferView 0 has no buffer"},
      {view0, R"({"buffer":0})", "bufferView 0 has no byteLength"},
      {view0, R"({"buffer":0,"byteLength":36,"byteStride":2})", "bufferView 0: byteStride 2"},
      {view0, R"({"buffer":0,"byteLength":36,"byteStride":8})",
       "accessor 0: elements of 12 bytes at steps of 8"},
      {view0, R"({"buffer":0,"byteLength":36,"byteStride":16})",
       "accessor 0: 44 bytes from 0 are not within the 36 of its bufferView"},
      {"\"byteLength\":40", "\"byteLength\":4000000000", "buffer 0 states 4000000000 bytes"},
      {"\"byteLength\":40", "\"byteLength\":\"40\"", "byteLength is not a whole number from 0"},
      // These have wrong accessors.
      {points, replaced(points, "\"count\":3", "\"count\":4"),
       "accessor 0: 48 bytes from 0 are not within the 36 of its bufferView"},
      {points, replaced(points, "\"count\":3", "\"count\":1537228672809129302"),
       "accessor 0 has 1537228672809129302 elements, at most 20000000 are read"},
      {points, replaced(points, "\"count\":3", "\"byteOffset\":18446744073709551604,\"count\":3"),
       "accessor 0: 36 bytes from 18446744073709551604"},
      {points, replaced(points, "5126", "5127"), "accessor 0: unknown componentType 5127"},
      {points, replaced(points, "VEC3", "VEC9"), "accessor 0: unknown type 'VEC9'"},
      {points, replaced(points, "\"bufferView\":0", "\"bufferView\":2"),
       "accessor 0: bufferView 2 of 2"},
      {points, replaced(points, "\"bufferView\":0,", ""),
       "accessor 0 has neither a bufferView nor sparse values"},
      {"\"sparse\":{\"count\":1", "\"sparse\":{\"count\":4", "sparse has 4 of 3 elements"},
      {"\"byteOffset\":1,\"componentType\":5121}", "\"byteOffset\":3,\"componentType\":5121}",
       "sparse indices: 1 bytes from 3 are not within the 3"},
      {"\"byteOffset\":1,\"componentType\":5121}", "\"byteOffset\":1,\"componentType\":5126}",
       "sparse indices: componentType 5126 is no unsigned integer"},
      {"\"values\":{\"bufferView\":0,\"byteOffset\":0}",
       "\"values\":{\"bufferView\":0,\"byteOffset\":30}", "sparse values: 12 bytes from 30"},
      {"AAECAA==", "AAkCAA==", "sparse indices: element 9 of 3"},
      // These have wrong indices.
      {"\"POSITION\":0", "\"POSITION\":3", "mesh 0, primitive 0: POSITION 3 of 3"},
      {"\"indices\":1", "\"indices\":9", "mesh 0, primitive 0: indices 9 of 3"},
      {"\"indices\":1", "\"indices\":0", "its indices are no unsigned integers"},
      {"\"POSITION\":0", "\"POSITION\":1", "positions that are not three floats"},
      {"\"mode\":4", "\"mode\":7", "mesh 0, primitive 0: unknown mode 7"},
      {"\"mesh\":0", "\"mesh\":1", "node 1: mesh 1 of 1"},
      {"\"scene\":0", "\"scene\":1", "scene 1 of 1"},
      {"\"nodes\":[0]", "\"nodes\":[2]", "scene 0: nodes has a number that is not one of the 2"},
      {"\"children\":[1]", "\"children\":[2]", "node 0: children has a number"},
      {"\"children\":[1]", "\"children\":[1,1]", "node 1 has two parents"},
      {"\"mesh\":0,", "\"mesh\":0,\"children\":[0],", "its nodes are their own children"},
      {"[0,0,5]", "[0,5]", "node 1: translation is not 3 numbers"},
      {"[0,0,5]", "[0,0,\"5\"]", "node 1: translation is not 3 numbers"},
      {"\"nodes\":[{\"children\":[1]},{\"mesh\":0,\"translation\":[0,0,5]}],", chain_of_nodes(101),
       "its nodes are nested more than 100 deep"},
      // These are wrong as documents.
      {"\"version\":\"2.0\"", "\"version\":\"1.0\"", "glTF version '1.0', only 2 is read"},
      {"\"asset\":{\"version\":\"2.0\"},", "", "it has no asset"},
      {"\"meshes\":[", "\"meshes\":7,\"x\":[", "meshes is not an array of objects"},
      {"\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],",
       "its meshes are compressed (KHR_draco_mesh_compression), which is not supported; write it "
       "without compression"},
      {"\"scene\":0,", "\"scene\":0,\"extensionsUsed\":[\"EXT_meshopt_compression\"],",
       "its meshes are compressed (EXT_meshopt_compression)"},
      {"\"scene\":0,", "\"scene\":0,\"extras\":" + nested("[", "]", 100'000) + ",",
       "nests deeper than 64 levels"},
      {"\"scene\":0,", "\"scene\":0,\"extras\":" + nested("{\"a\":", "}", 100'000) + ",",
       "nests deeper than 64 levels"},
      {"\"scene\":0,", "\"scene\":0,,", "its JSON does not parse: parse error at line 2"},
  };
  const TemporaryFolder folder;
  for (const Case& row : cases) {
    INFO(row.says);
    const fs::path file = folder.write("x.gltf", replaced(kTriangle, row.from, row.to));
    CHECK_THAT(error_of(file), Contains(row.says));
  }
  // This is just within the limits.
  CHECK(
      read_mesh(folder.write(
                    "deep.gltf",
                    replaced(kTriangle,
                             "\"nodes\":[{\"children\":[1]},{\"mesh\":0,\"translation\":[0,0,5]}],",
                             chain_of_nodes(100))))
          .mesh.faces.size() == 1);
}

TEST_CASE("A scene that shows few bytes many times is refused before it is built",
          "[geometry][gltf]") {
  // Seven million nodes would show 21 million vertices; 4,000 nodes with 6,000 vertices each take
  // less text. A view without data of its own does not exist, so that the points are 72,000 bytes.
  const int num_points = 6000;
  const int num_nodes = 4000;
  std::string nodes = "\"nodes\":[";
  std::string list;
  for (int i = 0; i < num_nodes; ++i) {
    nodes += i == 0 ? "{\"mesh\":0}" : ",{\"mesh\":0}";
    list += (i == 0 ? "" : ",") + std::to_string(i);
  }
  std::string json =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[)" + list + "]}]," + nodes + "]," +
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)" +
      R"("componentType":5126,"count":)" + std::to_string(num_points) +
      R"(,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":)" +
      std::to_string(12 * num_points) + R"(}],"buffers":[{"byteLength":)" +
      std::to_string(12 * num_points) + R"(,"uri":"x.bin"}]})";
  const TemporaryFolder folder;
  folder.write("x.bin", std::string(12 * num_points, '\0'));
  CHECK(error_of(folder.write("x.gltf", json)) ==
        "scene 0 shows more than 20000000 vertices or corners");
}

TEST_CASE("A GLB is refused at once where its container lies", "[geometry][gltf]") {
  const std::string json = kTriangle;
  const std::string good = glb(chunk("JSON", json));
  struct Case {
    std::string bytes;
    std::string says;
  };
  const std::vector<Case> cases = {
      {"glTF", "the file ends inside its header of 12 bytes"},
      {"glTF" + u32(1) + u32(12), "GLB version 1, only 2 is read"},
      {"glTF" + u32(2) + u32(4), "it states 4 bytes, the file has 12"},
      {"glTF" + u32(2) + u32(4'000'000'000), "it states 4000000000 bytes, the file has 12"},
      {"glTF" + u32(2) + u32(12), "it has no chunk of JSON"},
      {"glTF" + u32(2) + u32(16) + "JSON", "it ends inside the header of chunk 0"},
      {"glTF" + u32(2) + u32(22) + u32(4'200'000'000) + "JSON{}",
       "chunk 0 states 4200000000 bytes, 2 are left"},
      {glb(chunk("JSON", "{}")), "it has no asset"},
      {glb(chunk("BUGS", "{}")), "its first chunk is not JSON"},
      {glb(chunk("JSON", "[]")), "its JSON is not an object"},
      {glb(chunk("JSON", json) + "123"), "it ends inside the header of chunk 1"},
      {good.substr(0, good.size() - 1), "it states " + std::to_string(good.size()) + " bytes"},
      {glb(chunk("JSON", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4}]})")),
       "buffer 0 has no uri and the file no chunk of bytes"},
  };
  const TemporaryFolder folder;
  for (const Case& row : cases) {
    INFO(row.says);
    CHECK_THAT(error_of(folder.write("x.glb", row.bytes)), Contains(row.says));
  }
  CHECK(read_mesh(folder.write("good.glb", good)).mesh.faces.size() == 1);
  // With any byte of it changed the file is read, or refused in one line.
  for (std::size_t i = 0; i < good.size(); i += 3) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << (i % 8)));
    const fs::path file = folder.write("bad.glb", bad);
    try {
      read_mesh(file);
    } catch (const IoError& error) {
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
}

}  // namespace test_checked_glb
