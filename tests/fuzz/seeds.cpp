#include "seeds.hpp"

#include <utility>

#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "mesh_io/mesh_formats.hpp"

namespace graspfit::testing {
namespace {

using namespace geometry;

std::string words(const Eigen::Vector3d& p) {
  return base::shortest_decimal(p[0]) + " " + base::shortest_decimal(p[1]) + " " +
         base::shortest_decimal(p[2]);
}

std::string text_ply(const TriangleMesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\ncomment a seed\nelement vertex " +
                     std::to_string(mesh.vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                     std::to_string(mesh.faces.size()) +
                     "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3d& v : mesh.vertices) text += words(v) + "\n";
  for (const Face& f : mesh.faces) {
    text += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) +
            "\n";
  }
  return text;
}

std::string text_stl(const TriangleMesh& mesh) {
  std::string text = "solid seed\n";
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    text += "facet normal " + words(face_normal(mesh, face)) + "\nouter loop\n";
    for (const Eigen::Vector3d& corner : corners(mesh, face))
      text += "vertex " + words(corner) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid seed\n";
}

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

std::vector<std::pair<std::string, TriangleMesh>> meshes() {
  std::vector<std::pair<std::string, TriangleMesh>> result = {
      {"tetrahedron", tetrahedron()},
      {"box", box({1, 2, 0.5})},
      {"ball", ball(0.25, 0)},
      {"torus", torus(0.5, 0.25, 3, 3)},
      {"overlap", concatenated({tetrahedron(), box({0.5, 0.5, 0.5})})},
  };
  TriangleMesh mesh = box({1, 1, 1});
  mesh.faces.pop_back();
  result.emplace_back("hole", mesh);
  mesh = box({1, 1, 1});
  std::swap(mesh.faces[3][0], mesh.faces[3][1]);
  result.emplace_back("turned", mesh);
  mesh = tetrahedron();
  mesh.faces.push_back(mesh.faces[0]);
  mesh.faces.push_back({1, 1, 2});
  result.emplace_back("doubled", mesh);
  mesh = tetrahedron();
  mesh.vertices.push_back({1, 1, -1});
  mesh.faces.push_back({0, 1, 4});
  result.emplace_back("fin", mesh);
  return result;
}

}  // namespace

std::vector<Seed> seeds() {
  std::vector<Seed> result;
  for (const auto& [name, mesh] : meshes()) {
    result.push_back({name + "_off", "o" + internal::format_off(mesh)});
    result.push_back({name + "_obj", "b" + internal::format_obj(mesh)});
    result.push_back({name + "_ply", "p" + internal::format_ply(mesh)});
    result.push_back({name + "_text_ply", "p" + text_ply(mesh)});
    result.push_back({name + "_stl", "s" + internal::format_stl(mesh)});
    result.push_back({name + "_text_stl", "s" + text_stl(mesh)});
  }
  // These are what our own writers never write.
  result.push_back({"polygon_off",
                    "oCOFF 6 2 0\n0 0 0 1 1 1\n2 0 0 .5 0 0\n2 2 0\n1 1 0 # dent\n0 2 0\n1 1 1\n"
                    "5 0 1 2 3 4\n3 0 1 5 255 0 0\n"});
  result.push_back({"relative_obj",
                    "b# seed\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\n"
                    "f -4/1/1 -2//1 \\\n-3\nf 1 2 4\nf 1/1 4/1 3/1\nf 2 3 4\n"});
  result.push_back({"big_endian_ply",
                    "pply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty short x\n"
                    "property char y\nproperty ushort z\nelement face 1\n"
                    "property list uint uint8 vertex_index\nproperty uchar red\nend_header\n" +
                        std::string("\0\1\2\0\3\0\0\0\3\0\0\0\7", 13)});
  return result;
}

}  // namespace graspfit::testing
