#include <sys/stat.h>

#include <filesystem>

#include "geometry/mesh_io/error_of.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_mesh_io {

using namespace graspfit::base;
using namespace graspfit::geometry;
using graspfit::testing::Contains;
using graspfit::testing::error_of;
using graspfit::testing::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

const char* const kTetrahedronOff =
    "OFF\n# a comment\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

}  // namespace

TEST_CASE("OFF, OBJ and PLY give back every bit that was written", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = scaled(torus(1.0, 0.3, 20, 10), 0.1234567890123456789);
  for (const char* const name : {"mesh.off", "mesh.obj", "mesh.ply", "mesh.OBJ"}) {
    write_mesh(folder.path() / name, mesh);
    const MeshFile back = read_mesh(folder.path() / name);
    CHECK(back.mesh == mesh);
    CHECK(back.report.num_file_vertices == 200);
    CHECK(back.report.num_file_polygons == 400);
    CHECK(back.report.num_vertices_welded == 0);
    CHECK(back.report.num_polygons_triangulated == 0);
  }
  CHECK(read_mesh(folder.path() / "mesh.OBJ").report.format == "obj");
}

TEST_CASE("STL gives back the closed mesh in single precision", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = torus(1.0, 0.3, 20, 10);
  write_mesh(folder.path() / "mesh.stl", mesh);
  const MeshFile back = read_mesh(folder.path() / "mesh.stl");
  CHECK(back.mesh.vertices.size() == 200);
  CHECK(back.mesh.faces.size() == 400);
  CHECK(back.report.num_file_vertices == 1200);
  CHECK(back.report.num_vertices_welded == 1000);
  CHECK(signed_volume(back.mesh) == Approx(signed_volume(mesh)).epsilon(1e-6));
}

TEST_CASE("Every format of one tetrahedron has its volume", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  std::vector<fs::path> files;
  files.push_back(folder.write("a.off", kTetrahedronOff));
  // The file has Windows line ends, counts beside the header, and colors after the corners.
  files.push_back(
      folder.write("b.off",
                   "COFF 4 4 0\r\n0 0 0 255 0 0 255\r\n1 0 0 0 0 0 0\r\n0 1 0 0 0 0 0\r\n"
                   "0 0 1 1 1 1 1\r\n3 0 2 1 255 0 0\r\n3 0 1 3\r\n3 1 2 3\r\n3 2 0 3"));
  files.push_back(folder.write("c.obj",
                               "mtllib x.mtl\no part\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0 0.5 0.5 0.5\n"
                               "v +0 0 1e0\nvt 0 0\nvn 0 0 1\nusemtl x\ns off\nf 1/1/1 3/1 2//1\n"
                               "f 1 2 4\nf -3 -2 \\\n -1\nl 1 2\nf 3 1 4\n"));
  files.push_back(
      folder.write("d.ply",
                   "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty float x\n"
                   "property float y\nproperty float z\nproperty uchar red\n"
                   "element face 4\nproperty list uchar int vertex_index\nend_header\n"
                   "0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n"
                   "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"));
  std::string stl = "solid name of it\n";
  const auto facet = [&](const char* a, const char* b, const char* c) {
    stl += std::string("facet normal nan 0 0\nouter loop\nvertex ") + a + "\nvertex " + b +
           "\nvertex " + c + "\nendloop\nendfacet\n";
  };
  facet("0 0 0", "0 1 0", "1 0 0");
  facet("0 0 0", "1 0 0", "0 0 1");
  facet("1 0 0", "0 1 0", "0 0 1");
  facet("0 1 0", "-0 0 0", "0 0 1");
  files.push_back(folder.write("e.stl", stl + "endsolid\n"));
  for (const fs::path& file : files) {
    INFO(file);
    const MeshFile read = read_mesh(file);
    CHECK(read.mesh.vertices.size() == 4);
    CHECK(read.mesh.faces.size() == 4);
    CHECK(signed_volume(read.mesh) == Approx(1.0 / 6.0));
  }
}

TEST_CASE("Big-endian PLY with unknown elements is read", "[geometry][mesh_io]") {
  std::string ply =
      "ply\nformat binary_big_endian 1.0\nelement camera 1\nproperty list uchar short data\n"
      "element vertex 3\nproperty double x\nproperty float y\nproperty short z\n"
      "element face 1\nproperty uchar flag\nproperty list uint uint vertex_indices\nend_header\n";
  ply += std::string("\x02\x00\x07\x00\x08", 5);
  const auto vertex = [&](const char* x8, const char* y4, const char* z2) {
    ply.append(x8, 8).append(y4, 4).append(z2, 2);
  };
  vertex("\0\0\0\0\0\0\0\0", "\0\0\0\0", "\0\0");
  vertex("\x3f\xf0\0\0\0\0\0\0", "\0\0\0\0", "\0\0");    // Here x = 1.
  vertex("\0\0\0\0\0\0\0\0", "\x40\0\0\0", "\xff\xfe");  // Here y = 2 and z = −2.
  ply += std::string("\x01\0\0\0\x03\0\0\0\0\0\0\0\x01\0\0\0\x02", 17);
  const TemporaryFolder folder;
  const TriangleMesh mesh = read_mesh(folder.write("x.ply", ply)).mesh;
  CHECK(mesh.vertices == std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 2, -2}});
  CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});
}

TEST_CASE("A byte order mark before the text of a mesh is skipped", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = read_mesh(folder.write("a.off", kTetrahedronOff)).mesh;
  const std::string mark = "\xEF\xBB\xBF";
  CHECK(read_mesh(folder.write("b.off", mark + kTetrahedronOff)).mesh == mesh);
  CHECK(read_mesh(folder.write("b.obj", mark + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))
            .mesh.faces.size() == 1);
  CHECK(read_mesh(
            folder.write("b.ply", mark + "ply\nformat ascii 1.0\nelement vertex 3\n"
                                         "property float x\nproperty float y\nproperty float z\n"
                                         "element face 1\nproperty list uchar int vertex_indices\n"
                                         "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"))
            .mesh.faces.size() == 1);
  CHECK(read_mesh(
            folder.write("b.stl", mark + "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                                         "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
                                         "endsolid x\n"))
            .mesh.faces.size() == 1);
}

TEST_CASE("Triangle strips of PLY run alternately and end with -1", "[geometry][mesh_io]") {
  // The four faces of a tetrahedron are one strip 0 2 1 3 0 2: (0 2 1), (1 2 3), (1 3 0), (0 3 2);
  // then comes one strip of a single triangle that only leads on, as its corners repeat.
  const std::string header =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const TemporaryFolder folder;
  const TriangleMesh mesh =
      read_mesh(folder.write("a.ply", "ply\nformat ascii 1.0\n" + header + points +
                                          "11 0 2 1 3 0 2 -1 1 1 2 -1\n"))
          .mesh;
  CHECK(mesh.faces == std::vector<Face>{{0, 2, 1}, {1, 2, 3}, {1, 3, 0}, {0, 3, 2}});
  CHECK(signed_volume(mesh) == Approx(1.0 / 6.0));

  std::string binary = "ply\nformat binary_little_endian 1.0\n" + header;
  const auto append = [&binary](auto value) {
    binary.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const float x : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) append(x);
  for (const std::int32_t i : {12, 0, 2, 1, -1, 1, 2, 3, -1, 0, 1, 3, -1}) append(i);
  CHECK(read_mesh(folder.write("b.ply", binary)).mesh.faces ==
        std::vector<Face>{{0, 2, 1}, {1, 2, 3}, {0, 1, 3}});

  CHECK(error_of(folder.write("c.ply", "ply\nformat ascii 1.0\n" + header + points +
                                           "3 0 1 9\n")) == "face 0 uses vertex 9 of 4");
  CHECK(error_of(folder.write("d.ply", "ply\nformat ascii 1.0\n" + header + points +
                                           "3 0 1 -2\n")) == "strip list 0 has a bad vertex index");
  CHECK(error_of(folder.write("e.ply", "ply\nformat ascii 1.0\n" + header + points +
                                           "9 0 1 2\n")) == "the file ends at tristrips 0 of 1");
}

TEST_CASE("Pipes and devices are no mesh files, and nobody waits for them", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  for (const char* const name : {"pipe.off", "pipe.stl", "pipe.glb"}) {
    REQUIRE(mkfifo((folder.path() / name).c_str(), 0600) == 0);
    CHECK_THROWS_WITH(read_mesh(folder.path() / name),
                      Contains("it is not a regular file; write to a file"));
  }
  fs::create_symlink("/dev/zero", folder.path() / "zero.off");
  CHECK_THROWS_WITH(read_mesh(folder.path() / "zero.off"), Contains("is not a regular file"));
  CHECK_THROWS_AS(read_file("/dev/null"), IoError);
}

TEST_CASE("glTF is read with its node's placement", "[geometry][mesh_io]") {
  // The file has three vertices (0,0,0), (1,0,0), (0,1,0) as floats and no indices, moved by (0, 0,
  // 5).
  const std::string gltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"translation":[0,0,5]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":4}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
      "min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],
    "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  const TemporaryFolder folder;
  const MeshFile read = read_mesh(folder.write("x.gltf", gltf), {.meters_per_file_unit = 0.5});
  CHECK(read.mesh.vertices ==
        std::vector<Eigen::Vector3d>{{0, 0, 2.5}, {0.5, 0, 2.5}, {0, 0.5, 2.5}});
  CHECK(read.mesh.faces == std::vector<Face>{{0, 1, 2}});
}

TEST_CASE("Lengths are multiplied by the file's unit", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a.off", kTetrahedronOff);
  const MeshFile read = read_mesh(file, {.meters_per_file_unit = 0.001});
  CHECK(longest_extent(read.mesh) == 0.001);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    CHECK_THROWS_AS(read_mesh(file, {.meters_per_file_unit = bad}), InvalidInput);
  }
}

TEST_CASE("Vertices at the same place become one, the first keeping its order",
          "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const MeshFile read = read_mesh(folder.write(
      "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\nf 4 6 5\n"));
  CHECK(read.mesh.vertices ==
        std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  CHECK(read.mesh.faces == std::vector<Face>{{0, 1, 2}, {0, 3, 1}});
  CHECK(read.report.num_vertices_welded == 2);
}

TEST_CASE("Polygons become triangles of the same vector area, without turned ones",
          "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  // The polygon is an L, concave at (1, 1), with area 3. Every triangle must face up.
  const MeshFile read = read_mesh(folder.write(
      "l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 4 5 6 1 2 3\n"));
  CHECK(read.mesh.faces.size() == 4);
  CHECK(read.report.num_polygons_triangulated == 1);
  double area = 0.0;
  for (std::size_t face = 0; face < read.mesh.faces.size(); ++face) {
    CHECK(vector_area(read.mesh, face)[2] > 0.0);
    area += vector_area(read.mesh, face)[2];
  }
  CHECK(area == Approx(3.0));
}

TEST_CASE("Bad mesh files get one clear line", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const std::string off = kTetrahedronOff;
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = off;
    return text.replace(text.find(from), from.size(), to);
  };
  CHECK(error_of(folder.path() / "no_such.off") == "no such file");
  fs::create_directory(folder.path() / "folder.off");
  CHECK(error_of(folder.path() / "folder.off") == "it is a folder");
  CHECK(error_of(folder.write("a.xyz", off)) ==
        "unknown extension '.xyz'; known are off, obj, ply, stl, gltf, glb; Blender, MeshLab or "
        "'assimp export FILE NEW.obj' convert most others");
  CHECK(error_of(folder.write("noextension", off)).starts_with("the file name has no extension"));
  for (const char* const name : {"e.off", "e.obj", "e.ply", "e.stl", "e.gltf", "e.glb"}) {
    CHECK(error_of(folder.write(name, "")) == "the file is empty");
  }
  CHECK(error_of(folder.write("b.off", "Dear sir,\nhello\n")) ==
        "line 1: not an OFF mesh: it starts with 'Dear', not 'OFF'");
  CHECK(error_of(folder.write("b.obj", "Dear sir,\nhello\n")) ==
        "not an OBJ mesh: no 'v' or 'f' lines; line 1 starts with 'Dear'");
  CHECK(error_of(folder.write("b.ply", "Dear sir,\nhello\n")) ==
        "not a PLY mesh: it does not start with 'ply'");
  CHECK(error_of(folder.write("b.stl", "Dear sir,\nhello\n")) ==
        "not an STL mesh: text that does not start with 'solid'");
  CHECK(error_of(folder.write("b.gltf", "Dear sir,\nhello\n")).starts_with("not a glTF mesh: "));
  CHECK(error_of(folder.write("b.glb", "Dear sir,\nhello\n")).starts_with("not a glTF mesh: "));
  CHECK(error_of(folder.write("c.off", "OFF\n")) == "line 1: the file ends after its header");
  CHECK(error_of(folder.write("d.off", "OFF BINARY\n")) == "binary OFF is not supported");
  CHECK(error_of(folder.write("f.off", "OFF\n-4 4 0\n")) ==
        "line 2: a number of vertices or faces is negative");
  CHECK(error_of(folder.write("g.off", "OFF\n99999999999999 4 0\n0 0 0\n")) ==
        "the file ends after 1 of 99999999999999 vertices");
  CHECK(error_of(folder.write("h.off", replaced("4 4 6", "4 5 6"))) ==
        "the file ends after 4 of 5 faces");
  CHECK(error_of(folder.write("i.off", replaced("1 0 0", "nan 0 0"))) ==
        "line 5: coordinate nan is not finite");
  CHECK(error_of(folder.write("j.off", replaced("1 0 0", "1 -inf 0"))) ==
        "line 5: coordinate -inf is not finite");
  CHECK(error_of(folder.write("k.off", replaced("1 0 0", "1 1e999 0"))) ==
        "line 5: coordinate 1e999 is not finite");
  CHECK(error_of(folder.write("l.off", replaced("1 0 0", "1 zero 0"))) ==
        "line 5: expected a number, found 'zero'");
  CHECK(error_of(folder.write("m.off", replaced("1 0 0", "1 0"))) ==
        "line 5: expected a number, found the end of the line");
  CHECK(error_of(folder.write("n.off", replaced("3 2 0 3", "3 2 0 4"))) ==
        "line 11: face 3 uses vertex 4 of 4");
  CHECK(error_of(folder.write("o.off", replaced("3 2 0 3", "3 2 0 -1"))) ==
        "line 11: face 3 uses vertex -1 of 4");
  CHECK(error_of(folder.write("p.off", replaced("3 2 0 3", "2 2 0"))) ==
        "line 11: face 3 has 2 corners");
  CHECK(error_of(folder.write("q.off", "OFF\n2 0 0\n0 0 0\n1 1 1\n")) ==
        "no faces: a point cloud of 2 points");
  CHECK(error_of(folder.write("r.off", "OFF\n0 0 0\n")) == "no vertices and no faces");
  CHECK(error_of(folder.write("q.obj", "v 0 0 0\nv 1 2 3\nv 4 5 6\n")) ==
        "no faces: a point cloud of 3 points");
  CHECK(error_of(folder.write("s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")) ==
        "line 4: face 0 uses vertex 4 of 3");
  CHECK(error_of(folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n")) ==
        "line 4: face 0 uses vertex 0 of 3");
  CHECK(error_of(folder.write("u.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n")) ==
        "line 4: expected a vertex index, found 'x'");
  CHECK(error_of(folder.write("v.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n")) ==
        "line 4: expected a vertex index, found '0'");
  CHECK(error_of(folder.write("w.obj", "v 0 0 NaN\n")) == "line 1: coordinate NaN is not finite");
  CHECK(error_of(folder.write("x.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n")) ==
        "line 3: face 0 has 2 corners");
}

TEST_CASE("Bad PLY and STL files get one clear line", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  CHECK(error_of(folder.write("a.ply", header + points + "3 0 1 3\n")) ==
        "face 0 uses vertex 3 of 3");
  CHECK(error_of(folder.write("b.ply", header + points + "3 0 1 -1\n")) ==
        "face 0 has a bad vertex index");
  CHECK(error_of(folder.write("c.ply", header + points)) == "the file ends at face 0 of 1");
  CHECK(error_of(folder.write("d.ply", header + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n")) ==
        "vertex 0 has a coordinate that is not finite");
  CHECK(error_of(folder.write("e.ply", header + points + "2 0 1\n")) == "face 0 has 2 corners");
  CHECK(error_of(folder.write("f.ply", "ply\nformat ascii 1.0\n")) ==
        "the file ends inside its header");
  CHECK(error_of(folder.write("g.ply", "ply\nelement vertex 0\nend_header\n")) ==
        "line 3: the header has no 'format'");
  CHECK(error_of(folder.write("h.ply",
                              "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                              "end_header\n1\n")) == "the vertices have no x, y and z");
  CHECK(error_of(folder.write("i.ply",
                              "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                              "property float y\nproperty float z\nend_header\n"
                              "0 0 0\n1 1 1\n")) == "no faces: a point cloud of 2 points");
  CHECK(error_of(folder.write("j.ply",
                              "ply\nformat binary_little_endian 1.0\nelement vertex 9\n"
                              "property float x\nproperty float y\nproperty float z\n"
                              "end_header\nabc")) == "the file ends at vertex 0 of 9");

  write_mesh(folder.path() / "whole.stl", box({1, 1, 1}));
  std::string stl = read_file(folder.path() / "whole.stl");
  CHECK(error_of(folder.write("cut.stl", stl.substr(0, stl.size() - 7))) ==
        "the file ends after 11 of 12 triangles");
  CHECK(error_of(folder.write("tail.stl", stl + "?")) ==
        "12 triangles take 684 bytes, the file has 685");
  CHECK(error_of(folder.write("head.stl", stl.substr(0, 82))) ==
        "the file ends inside its header of 84 bytes");
  // Some programs begin binary files like text.
  CHECK(error_of(folder.write("solid.stl", "solid" + stl.substr(5, stl.size() - 60))) ==
        "the file ends after 10 of 12 triangles");
  // The first coordinate is a NaN.
  stl.replace(84 + 12, 4, std::string("\0\0\xc0\x7f", 4));
  CHECK(error_of(folder.write("nan.stl", stl)) == "vertex 0 has a coordinate that is not finite");
  CHECK(error_of(folder.write("none.stl", std::string(84, '\0'))) == "no vertices and no faces");
  CHECK(error_of(folder.write("a.stl",
                              "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                              "vertex 1 0 0\nendloop\nendfacet\nendsolid\n")) ==
        "line 6: facet 1 has 2 vertices");
  CHECK(error_of(
            folder.write("b.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n")) ==
        "line 4: coordinate inf is not finite");
  CHECK(error_of(folder.write("loop.stl",
                              "solid x\nfacet normal 0 0 1\nouter loop\nouter loop\n"
                              "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n")) ==
        "line 4: a loop inside a loop");
  CHECK(error_of(folder.write("c.stl", "solid x\nendsolid x\n")) == "no vertices and no faces");
  CHECK(error_of(folder.write("d.stl", "solid gold\nwatch\n")) ==
        "line 2: expected a facet, found 'watch'");
}

TEST_CASE("What cannot be written leaves nothing behind", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = box({1, 1, 1});
  CHECK_THROWS_AS(write_mesh(folder.path() / "mesh.xyz", mesh), IoError);
  CHECK_THROWS_AS(write_mesh(folder.path() / "mesh.glb", mesh), IoError);
  CHECK_THROWS_AS(write_mesh(folder.path() / "no folder/mesh.off", mesh), IoError);
  CHECK(fs::is_empty(folder.path() / ""));
}

}  // namespace test_mesh_io
