#include "geometry/broken_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

namespace graspfit::testing {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Face;
using geometry::TriangleMesh;
using Index = std::int32_t;

// These are the faces of `block`, two a side, outward.
//      6-----7        z
//     /|    /|        | y
//    4-----5 |        |/
//    | 2---|-3        o--x
//    0-----1
enum Side { kBottom = 0, kTop = 2, kFront = 4, kBack = 6, kLeft = 8, kRight = 10 };
constexpr std::array<Face, 12> kBlockFaces{{{0, 2, 3},
                                            {0, 3, 1},
                                            {4, 5, 7},
                                            {4, 7, 6},
                                            {0, 1, 5},
                                            {0, 5, 4},
                                            {2, 6, 7},
                                            {2, 7, 3},
                                            {0, 4, 6},
                                            {0, 6, 2},
                                            {1, 3, 7},
                                            {1, 7, 5}}};

TriangleMesh block(const Vector3d& low, const Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1],
                               i & 4 ? high[2] : low[2]);
  }
  mesh.faces.assign(kBlockFaces.begin(), kBlockFaces.end());
  return mesh;
}

TriangleMesh cube(double low = 0.0, double high = 1.0) {
  return block(Vector3d::Constant(low), Vector3d::Constant(high));
}

TriangleMesh tall(double size = 1.0) { return block({0, 0, 0}, {size, size, 4 * size}); }

Face reversed(const Face& face) { return {face[0], face[2], face[1]}; }

TriangleMesh inside_out(TriangleMesh mesh) {
  for (Face& face : mesh.faces) face = reversed(face);
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Vector3d& by) {
  for (Vector3d& vertex : mesh.vertices) vertex += by;
  return mesh;
}

TriangleMesh without_side(TriangleMesh mesh, Side side) {
  mesh.faces.erase(mesh.faces.begin() + side, mesh.faces.begin() + side + 2);
  return mesh;
}

TriangleMesh with_faces(TriangleMesh mesh, const std::vector<Face>& more) {
  mesh.faces.insert(mesh.faces.end(), more.begin(), more.end());
  return mesh;
}

TriangleMesh with_vertices(TriangleMesh mesh, const std::vector<Vector3d>& more) {
  mesh.vertices.insert(mesh.vertices.end(), more.begin(), more.end());
  return mesh;
}

// Returns the mesh with a side replaced by other faces.
TriangleMesh with_side(const TriangleMesh& mesh, Side side, const std::vector<Face>& faces) {
  return with_faces(without_side(mesh, side), faces);
}

// Returns the first `num_sides` sides of a box [0, size]³ as tiles of one by one, each a fan around
// its middle, which is raised. An edge has a vertex in its middle on the first of its two tiles
// only, so that tiles share no edges but only their corners: every edge is a hole of three sides,
// without area.
TriangleMesh tiled_box(int size, double raised, int num_sides) {
  TriangleMesh mesh;
  using Place = std::array<int, 3>;
  std::map<Place, Index> index_of;
  const auto corner = [&](const Place& at) {
    const auto [entry, is_new] = index_of.try_emplace(at, static_cast<Index>(mesh.vertices.size()));
    if (is_new) mesh.vertices.emplace_back(at[0], at[1], at[2]);
    return entry->second;
  };
  std::map<std::array<Index, 2>, int> tiles_at_edge;
  for (int side = 0; side < num_sides; ++side) {
    const int axis = side / 2;
    const bool is_high = side % 2 == 1;
    for (int tile = 0; tile < size * size; ++tile) {
      const int i = tile % size;
      const int j = tile / size;
      const std::array<std::array<int, 2>, 4> around{
          {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
      std::vector<Index> rim;
      for (int k = 0; k < 4; ++k) {
        Place at{};
        at[axis] = is_high ? size : 0;
        at[(axis + 1) % 3] = around[is_high ? k : 3 - k][0];
        at[(axis + 2) % 3] = around[is_high ? k : 3 - k][1];
        rim.push_back(corner(at));
      }
      Vector3d middle = Vector3d::Zero();
      for (const Index vertex : rim) middle += mesh.vertices[vertex] / 4.0;
      middle[axis] += is_high ? raised : -raised;
      const auto apex = static_cast<Index>(mesh.vertices.size());
      mesh.vertices.push_back(middle);
      for (int k = 0; k < 4; ++k) {
        const Index a = rim[k];
        const Index b = rim[(k + 1) % 4];
        if (tiles_at_edge[{std::min(a, b), std::max(a, b)}]++ > 0) {
          mesh.faces.push_back({a, b, apex});
          continue;
        }
        const auto half = static_cast<Index>(mesh.vertices.size());
        mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2.0);
        mesh.faces.push_back({a, half, apex});
        mesh.faces.push_back({half, b, apex});
      }
    }
  }
  return mesh;
}

// Returns n³ unit cubes side by side that share vertices, and so have their inner walls twice.
TriangleMesh cube_grid(int n) {
  TriangleMesh mesh;
  const auto vertex = [n](int i, int j, int k) {
    return static_cast<Index>((i * (n + 1) + j) * (n + 1) + k);
  };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      for (int k = 0; k <= n; ++k) mesh.vertices.emplace_back(i, j, k);
    }
  }
  for (int cell = 0; cell < n * n * n; ++cell) {
    const int i = cell / (n * n);
    const int j = cell / n % n;
    const int k = cell % n;
    for (const Face& face : kBlockFaces) {
      Face& corners = mesh.faces.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const Index b = face[c];
        corners[c] = vertex(i + (b & 1), j + (b >> 1 & 1), k + (b >> 2));
      }
    }
  }
  return mesh;
}

// Returns the eight octants of a unit ball, each of n² triangles with vertices of its own, moved
// apart by `gap` along each axis.
TriangleMesh ball_octants(int n, double gap) {
  TriangleMesh mesh;
  for (int octant = 0; octant < 8; ++octant) {
    const Vector3d sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
    const bool is_turned = sign.prod() < 0;
    std::map<std::array<int, 2>, Index> index_of;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        index_of[{i, j}] = static_cast<Index>(mesh.vertices.size());
        const Vector3d direction = Vector3d(i, j, n - i - j).normalized();
        mesh.vertices.push_back(sign.cwiseProduct(direction + Vector3d::Constant(gap / 2.0)));
      }
    }
    const auto add = [&](const Face& face) {
      mesh.faces.push_back(is_turned ? reversed(face) : face);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        add({index_of[{i, j}], index_of[{i + 1, j}], index_of[{i, j + 1}]});
        if (i + j + 2 > n) continue;
        add({index_of[{i + 1, j}], index_of[{i + 1, j + 1}], index_of[{i, j + 1}]});
      }
    }
  }
  return mesh;
}

// Returns every face with three vertices of its own; `place` may move the copy.
TriangleMesh soup(const TriangleMesh& mesh,
                  const std::function<Vector3d(const Vector3d&, int)>& place) {
  TriangleMesh apart;
  for (const Face& face : mesh.faces) {
    const auto first = static_cast<Index>(apart.vertices.size());
    for (const Index i : face) {
      apart.vertices.push_back(place(mesh.vertices[i], static_cast<int>(apart.vertices.size())));
    }
    apart.faces.push_back({first, first + 1, first + 2});
  }
  return apart;
}

TriangleMesh soup(const TriangleMesh& mesh) {
  return soup(mesh, [](const Vector3d& p, int) { return p; });
}

// Returns one mesh whose faces share vertices: those of `b` are named by indices of the result.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b,
                    const std::map<Index, Index>& vertex_of_a) {
  TriangleMesh mesh = a;
  std::vector<Index> index(b.vertices.size());
  for (Index i = 0; i < static_cast<Index>(index.size()); ++i) {
    if (const auto it = vertex_of_a.find(i); it != vertex_of_a.end()) {
      index[i] = it->second;
    } else {
      index[i] = static_cast<Index>(mesh.vertices.size());
      mesh.vertices.push_back(b.vertices[i]);
    }
  }
  for (const Face& f : b.faces) mesh.faces.push_back({index[f[0]], index[f[1]], index[f[2]]});
  return mesh;
}

// Returns a straight prism from z = 0 to z = 1 over a polygon, which may cross itself; the caps are
// fans from its first corner. It is outward for a polygon that is counter-clockwise on balance.
TriangleMesh prism(const std::vector<Vector2d>& polygon) {
  const auto n = static_cast<Index>(polygon.size());
  TriangleMesh mesh;
  for (const double z : {0.0, 1.0}) {
    for (const Vector2d& p : polygon) mesh.vertices.emplace_back(p[0], p[1], z);
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    mesh.faces.push_back({i, j, n + j});
    mesh.faces.push_back({i, n + j, n + i});
  }
  for (Index i = 1; i + 1 < n; ++i) {
    mesh.faces.push_back({0, i + 1, i});
    mesh.faces.push_back({n, n + i, n + i + 1});
  }
  return mesh;
}

// Returns the surface of revolution of (radius, z), z ascending, outward. Where the radius is 0 it
// has a pole, elsewhere it is open.
TriangleMesh revolved(const std::vector<Vector2d>& profile, int segments) {
  TriangleMesh mesh;
  std::vector<std::vector<Index>> rings;
  for (const Vector2d& p : profile) {
    std::vector<Index>& ring = rings.emplace_back();
    for (int i = 0; i < segments; ++i) {
      if (p[0] > 0 || i == 0) {
        const double angle = 2 * std::numbers::pi * i / segments;
        mesh.vertices.emplace_back(p[0] * std::cos(angle), p[0] * std::sin(angle), p[1]);
      }
      ring.push_back(static_cast<Index>(mesh.vertices.size()) - 1);
    }
  }
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
    for (int i = 0; i < segments; ++i) {
      const int j = (i + 1) % segments;
      const std::array<Index, 4> quad{rings[k][i], rings[k][j], rings[k + 1][j], rings[k + 1][i]};
      if (quad[0] != quad[1]) mesh.faces.push_back({quad[0], quad[1], quad[2]});
      if (quad[2] != quad[3]) mesh.faces.push_back({quad[0], quad[2], quad[3]});
    }
  }
  return mesh;
}

// Returns a unit ball of 8 rows and 32 columns from the south pole to the ring of radius `radius`
// above the equator, where it is open: the hole is `radius` of the ball's extent.
TriangleMesh ball_without_cap(double radius) {
  constexpr double kPi = std::numbers::pi;
  std::vector<Vector2d> profile{{0.0, -1.0}};
  for (int k = 1; k <= 8; ++k) {
    const double latitude = -kPi / 2 + k * (std::acos(radius) + kPi / 2) / 8;
    profile.emplace_back(std::cos(latitude), std::sin(latitude));
  }
  return revolved(profile, 32);
}

// Returns a unit ball of 24 columns whose first meridian is cut from pole to pole: its eleven
// vertices are there twice, the second time 1e-6 to and fro along the equator.
TriangleMesh ball_with_zigzag_seam() {
  constexpr int kColumns = 24;
  std::vector<Vector2d> profile{{0.0, -1.0}};
  for (int k = 1; k < 12; ++k) {
    const double latitude = -std::numbers::pi / 2 + k * std::numbers::pi / 12;
    profile.emplace_back(std::cos(latitude), std::sin(latitude));
  }
  profile.emplace_back(0.0, 1.0);
  TriangleMesh mesh = revolved(profile, kColumns);
  // Vertex 0 is the south pole; ring k starts at 1 + (k - 1) columns, and its last column is next
  // to the seam from the other side.
  std::map<Index, Index> copies;
  for (Index k = 0; k < 11; ++k) {
    const Index original = 1 + k * kColumns;
    copies[original] = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back(mesh.vertices[original] + Vector3d(0, k % 2 ? 1e-6 : -1e-6, 0));
  }
  for (Face& face : mesh.faces) {
    bool is_beyond = false;
    for (const Index i : face) is_beyond |= i > 0 && i <= 11 * kColumns && i % kColumns == 0;
    for (Index& i : face) {
      if (is_beyond && copies.contains(i)) i = copies.at(i);
    }
  }
  return mesh;
}

// Returns a square tube, 0.5 wide, around a closed path in the xy plane of axis-parallel legs,
// mitered at the corners (straight joints allowed). From the corner `open_at` to the next there is
// no tube.
TriangleMesh tube(const std::vector<Vector2d>& path, int open_at = -1) {
  const auto n = static_cast<int>(path.size());
  TriangleMesh mesh;
  const auto left = [&](int i) -> Vector2d {
    const Vector2d along = (path[(i + 1) % n] - path[i]).normalized();
    return {-along[1], along[0]};
  };
  for (int i = 0; i < n; ++i) {
    const Vector2d a = left((i + n - 1) % n);
    const Vector2d b = left(i);
    const Vector2d miter = 0.25 * (a == b ? a : Vector2d(a + b));
    // The order around the path's direction is right low, left low, left high, right high.
    for (const auto& [side, z] : {std::pair{-1, -0.25}, {1, -0.25}, {1, 0.25}, {-1, 0.25}}) {
      mesh.vertices.emplace_back(path[i][0] + side * miter[0], path[i][1] + side * miter[1], z);
    }
  }
  for (int i = 0; i < n; ++i) {
    if (i == open_at) continue;
    for (int k = 0; k < 4; ++k) {
      const Index a = 4 * i + k;
      const Index b = 4 * i + (k + 1) % 4;
      const Index c = 4 * ((i + 1) % n) + (k + 1) % 4;
      const Index d = 4 * ((i + 1) % n) + k;
      // Seen along the path the ring runs clockwise (for a path along +x left is +y and up is +z).
      mesh.faces.push_back({a, b, c});
      mesh.faces.push_back({a, c, d});
    }
  }
  return mesh;
}

TriangleMesh moebius_strip(int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n;
    for (const double side : {-0.25, 0.25}) {
      const double r = 1 + side * std::cos(u / 2);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), side * std::sin(u / 2));
    }
  }
  for (int i = 0; i < n; ++i) {
    const Index a = 2 * i;
    const Index b = 2 * i + 1;
    const bool is_last = i + 1 == n;
    const Index c = is_last ? 0 : 2 * i + 3;
    const Index d = is_last ? 1 : 2 * i + 2;
    mesh.faces.push_back({a, d, c});
    mesh.faces.push_back({a, c, b});
  }
  return mesh;
}

// Returns a Klein bottle, immersed as a figure eight turned by half a turn on its way around.
TriangleMesh klein_bottle(int n, int m) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n;
    for (int j = 0; j < m; ++j) {
      const double v = 2 * std::numbers::pi * j / m;
      const double r = 3 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u),
                                 std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v));
    }
  }
  const auto at = [&](int i, int j) -> Index {
    return i < n ? i * m + j % m : (m - j % m) % m;  // After a turn it is mirrored.
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

// Returns the cube with n × n squares a side and shared vertices, without the squares that
// `is_hole` names by their center.
TriangleMesh grid_cube(int n, const std::function<bool(const Vector3d&)>& is_hole) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, Index> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [it, is_new] = known.try_emplace(at, static_cast<Index>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(Vector3d(at[0], at[1], at[2]) / n);
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const int side : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          std::array<std::array<int, 3>, 4> at{};
          for (int k = 0; k < 4; ++k) {
            at[k][axis] = side;
            at[k][u] = i + (k == 1 || k == 2);
            at[k][v] = j + (k >= 2);
          }
          const Vector3d center =
              0.5 / n * Vector3d(at[0][0] + at[2][0], at[0][1] + at[2][1], at[0][2] + at[2][2]);
          if (is_hole(center)) continue;
          std::array<Index, 4> quad{vertex(at[0]), vertex(at[1]), vertex(at[2]), vertex(at[3])};
          if (side == 0) std::swap(quad[1], quad[3]);
          mesh.faces.push_back({quad[0], quad[1], quad[2]});
          mesh.faces.push_back({quad[0], quad[2], quad[3]});
        }
      }
    }
  }
  return mesh;
}

TriangleMesh bipyramid(int n) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n;
    mesh.vertices.emplace_back(std::cos(u), std::sin(u), 0.0);
  }
  mesh.vertices.emplace_back(0, 0, 1);
  mesh.vertices.emplace_back(0, 0, -1);
  for (int i = 0; i < n; ++i) {
    mesh.faces.push_back({i, (i + 1) % n, n});
    mesh.faces.push_back({(i + 1) % n, i, n + 1});
  }
  return mesh;
}

TriangleMesh square_sheet() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

TriangleMesh tetrahedron(const std::array<Vector3d, 4>& p) {
  return {{p.begin(), p.end()}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

// Returns a cube whose top is a dent down to `depth`.
TriangleMesh dented_cube(double depth) {
  return with_side(with_vertices(cube(), {{0.5, 0.5, depth}}), kTop,
                   {{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
}

TriangleMesh many_cubes() {
  std::vector<TriangleMesh> cubes;
  for (int i = 0; i < 512; ++i) {
    cubes.push_back(moved(cube(0, 0x1p-10), Vector3d(i % 8, i / 8 % 8, i / 64) * 0x1p-8));
  }
  return geometry::concatenated(cubes);
}

// Returns a tall box with a ring of vertices at z = 2 and a wall there.
TriangleMesh box_with_wall() {
  const TriangleMesh low = without_side(block({0, 0, 0}, {1, 1, 2}), kTop);
  const TriangleMesh high = without_side(block({0, 0, 2}, {1, 1, 4}), kBottom);
  return with_faces(joined(low, high, {{0, 4}, {1, 5}, {2, 6}, {3, 7}}), {{4, 5, 7}, {4, 7, 6}});
}

// Returns what a bad scan brings at once: a soup, an open end, a face turned, a face twice, a stray
// vertex.
TriangleMesh everything() {
  TriangleMesh mesh = without_side(tall(), kTop);
  mesh.faces[3] = reversed(mesh.faces[3]);
  mesh.faces.push_back(mesh.faces[0]);
  return with_vertices(soup(mesh), {{0.5, 0.5, 0.5}});
}

}  // namespace

std::vector<BrokenMesh> broken_meshes() {
  const double gap = 0x1p-10;
  const TriangleMesh tall_box = tall();
  TriangleMesh one_turned = cube();
  one_turned.faces[2] = reversed(one_turned.faces[2]);
  TriangleMesh mostly_inside_out = cube();
  for (std::size_t i = 5; i < 12; ++i) {
    mostly_inside_out.faces[i] = reversed(mostly_inside_out.faces[i]);
  }
  TriangleMesh denormal_corner = cube();
  denormal_corner.vertices[0][0] = 5e-324;
  TriangleMesh split_corner = with_vertices(cube(), {{1, 1, 1}});
  for (const std::size_t i : {3, 6, 7}) {
    for (Index& v : split_corner.faces[i]) v = v == 7 ? 8 : v;
  }
  split_corner = with_faces(split_corner, {{4, 7, 8}, {3, 8, 7}});
  const auto top_middle = [](double z) { return std::vector<Vector3d>{{0.5, 0, z}}; };
  const std::vector<Face> top_with_middle{{4, 8, 7}, {8, 5, 7}, {4, 7, 6}};
  std::vector<Vector2d> star;
  for (int i = 0; i < 5; ++i) {
    const double u = 4 * std::numbers::pi * i / 5;
    star.emplace_back(std::cos(u), std::sin(u));
  }
  TriangleMesh upper_half = ball_without_cap(1.0);
  for (Vector3d& p : upper_half.vertices) p[2] = -p[2];
  upper_half = moved(inside_out(upper_half), {0, 0, 0.05});
  const TriangleMesh lower_half = moved(ball_without_cap(1.0), {0, 0, -0.05});
  const auto both = [](const TriangleMesh& a, const TriangleMesh& b) {
    return geometry::concatenated({a, b});
  };
  const std::array<Vector3d, 4> point{Vector3d(2, 2, 2), Vector3d(2, 2, 2), Vector3d(2, 2, 2),
                                      Vector3d(2, 2, 2)};
  const std::array<Vector3d, 4> flat{Vector3d(2, 0, 0), Vector3d(3, 0, 0), Vector3d(3, 1, 0),
                                     Vector3d(2, 1, 0)};

  return {
      // These hold no face, or sheets only.
      {"empty", "no vertices, no faces", {}},
      {"vertices_only", "three vertices, no faces", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}}},
      {"one_triangle", "a single face", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}},
      {"flat_sheet", "a square of two faces", square_sheet()},
      {"doubled_sheet", "a square drawn on both sides",
       with_faces(square_sheet(), {{0, 2, 1}, {0, 3, 2}})},
      {"moebius_strip", "one-sided and open", moebius_strip(40)},
      {"klein_bottle", "one-sided and closed", klein_bottle(40, 15)},
      // These have holes.
      {"tall_without_top", "a hole of a quarter of the extent", without_side(tall_box, kTop)},
      {"cube_without_top", "a hole of the whole extent", without_side(cube(), kTop)},
      {"box_without_half", "a hole of exactly half the extent",
       without_side(block({0, 0, 0}, {1, 1, 2}), kTop)},
      {"tall_tube", "two holes", without_side(without_side(tall_box, kTop), kBottom)},
      {"half_ball", "half is missing", ball_without_cap(1.0)},
      {"two_half_balls", "two halves with a gap", both(lower_half, upper_half)},
      {"ball_without_10", "a cap of 10 % is missing", ball_without_cap(0.1)},
      {"ball_without_40", "a cap of 40 % is missing", ball_without_cap(0.4)},
      {"ball_without_60", "a cap of 60 % is missing", ball_without_cap(0.6)},
      {"cube_without_corner", "a hole with a boundary that is not planar",
       grid_cube(4, [](const Vector3d& c) { return c.maxCoeff() < 0.25; })},
      {"tall_with_stray_triangle", "a small face far from the solid",
       both(tall_box, {{{3, 0, 0}, {3.5, 0, 0}, {3, 0.5, 0}}, {{0, 1, 2}}})},
      {"tall_with_stray_two_sided", "a small face drawn on both sides, far from the solid",
       both(tall_box, {{{3, 0, 0}, {3.5, 0, 0}, {3, 0.5, 0}}, {{0, 1, 2}, {0, 2, 1}}})},
      // These are about which side is out.
      {"one_face_turned", "one face against its neighbors", one_turned},
      {"mostly_inside_out", "seven of twelve faces turned", mostly_inside_out},
      {"inside_out", "all faces turned", inside_out(cube())},
      {"one_part_inside_out", "a part inside-out beside a good one",
       both(cube(), moved(inside_out(cube()), {2, 0, 0}))},
      {"inside_out_overlapping", "a part inside-out that overlaps a good one",
       both(cube(0, 2), inside_out(cube(1, 3)))},
      {"nested_outward", "an outward part inside an outward one", both(cube(0, 3), cube(1, 2))},
      {"cavity", "an inward part inside an outward one (good)",
       both(cube(0, 3), inside_out(cube(1, 2)))},
      {"cavity_all_turned", "the same with all faces turned",
       inside_out(both(cube(0, 3), inside_out(cube(1, 2))))},
      {"cavity_outer_turned", "an inward part inside an inward one",
       inside_out(both(cube(0, 3), cube(1, 2)))},
      {"cavity_with_island", "a solid in a cavity (good)",
       geometry::concatenated({cube(0, 5), inside_out(cube(1, 4)), cube(2, 3)})},
      // These are solids that touch or overlap.
      {"overlapping", "two boxes overlap", both(cube(0, 2), cube(1, 3))},
      {"touching_edge", "two boxes share an edge",
       joined(cube(), moved(cube(), {1, 1, 0}), {{0, 3}, {4, 7}})},
      {"touching_edge_apart", "two boxes touch along an edge, each with its own vertices (good)",
       both(cube(), moved(cube(), {1, 1, 0}))},
      {"touching_vertex", "two boxes share a vertex",
       joined(cube(), moved(cube(), {1, 1, 1}), {{0, 7}})},
      {"touching_face", "two boxes share a face, which is there twice",
       joined(cube(), moved(cube(), {1, 0, 0}), {{0, 1}, {4, 5}, {6, 7}, {2, 3}})},
      {"touching_face_other_diagonal", "the same with the other diagonal on one side",
       joined(cube(), with_side(moved(cube(), {1, 0, 0}), kLeft, {{0, 4, 2}, {4, 6, 2}}),
              {{0, 1}, {4, 5}, {6, 7}, {2, 3}})},
      {"touching_face_apart", "two boxes touch in a face, each with its own vertices (good)",
       both(cube(), moved(cube(), {1, 0, 0}))},
      {"inner_wall", "a wall through the inside", box_with_wall()},
      {"small_fin", "a third face on an edge",
       with_faces(with_vertices(tall_box, {{1.5, 0.5, 4}}), {{5, 8, 7}})},
      {"large_fin", "a third face on an edge, two thirds of the extent",
       with_faces(with_vertices(cube(), {{1.5, 0.5, 1}}), {{5, 8, 7}})},
      // These are about vertices.
      {"short_t_junction", "an edge of one face meets two edges of the next, a quarter long",
       with_side(with_vertices(tall_box, top_middle(4)), kTop, top_with_middle)},
      {"long_t_junction", "an edge of one face meets two edges of the next, as long as the mesh",
       with_side(with_vertices(cube(), top_middle(1)), kTop, top_with_middle)},
      {"soup", "three vertices a face", soup(cube())},
      {"soup_with_gaps", "three vertices a face, up to 1e-9 apart",
       soup(
           cube(),
           [](const Vector3d& p, int i) -> Vector3d { return p + Vector3d(1e-9 * i / 36, 0, 0); })},
      {"soup_with_denormal_gaps", "three vertices a face, zeros replaced by denormals",
       soup(cube(),
            [](const Vector3d& p, int i) -> Vector3d {
              return p.unaryExpr([i](double x) { return x == 0 ? 5e-324 * (i + 1) : x; });
            })},
      {"soup_with_minus_zero", "three vertices a face, every second zero negative",
       soup(cube(),
            [](const Vector3d& p, int i) -> Vector3d {
              return p.unaryExpr([i](double x) { return x == 0 && i % 2 ? -0.0 : x; });
            })},
      {"zigzag_seam", "open along a meridian, the sides up to 1e-6 apart", ball_with_zigzag_seam()},
      {"ring_with_gap", "a ring cut by a gap of 2^-10, open on both sides of it",
       tube({{2 - gap, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}}, 0)},
      {"unused_vertices", "two vertices of no face",
       with_vertices(cube(), {{9, 9, 9}, {0.5, 0.5, 0.5}})},
      {"denormal_corner", "a coordinate of 5e-324 (good)", denormal_corner},
      {"high_valence", "two vertices with 3000 faces each (good)", bipyramid(3000)},
      // These are patches that hang together by vertices.
      {"six_tiles", "a cube whose sides meet in corners: each edge is halved on one of its sides",
       tiled_box(1, 0.0, 6)},
      {"tiles", "a box of 24 such tiles with raised middles", tiled_box(2, 0.125, 6)},
      {"tiles_without_side", "the same without one side of the box", tiled_box(2, 0.125, 5)},
      {"cube_grid", "27 cubes side by side, whose 54 inner walls are there twice", cube_grid(3)},
      {"wide_sheet", "a cube and a sheet of 2 by 2 above it, drawn on both sides",
       with_faces(with_vertices(cube(), {{0, 0, 3}, {2, 0, 3}, {2, 2, 3}, {0, 2, 3}}),
                  {{8, 9, 10}, {8, 10, 11}, {8, 10, 9}, {8, 11, 10}})},
      {"octants", "a ball's eight octants, 2^-9 apart, that share no vertex",
       ball_octants(6, 0x1p-9)},
      // These are about faces.
      {"face_twice", "a face is there twice", with_faces(cube(), {kBlockFaces[0]})},
      {"face_on_both_sides", "a face is there a second time, reversed",
       with_faces(tall_box, {reversed(kBlockFaces[2])})},
      {"face_three_times", "a face is there twice and once reversed",
       with_faces(cube(), {kBlockFaces[0], reversed(kBlockFaces[0])})},
      {"two_sided_box", "every face is there a second time, reversed",
       with_faces(cube(), inside_out(cube()).faces)},
      {"repeated_index", "a face with a repeated vertex", with_faces(cube(), {{0, 0, 1}})},
      {"split_corner", "a corner is two vertices at one place, with faces without area between",
       split_corner},
      {"collinear_face", "a face without area that closes a T-junction",
       with_faces(with_side(with_vertices(cube(), top_middle(1)), kTop, top_with_middle),
                  {{4, 5, 8}})},
      {"needle", "a face 1e-12 high (good)",
       with_side(with_vertices(cube(), {{0.5, 1e-12, 1}}), kTop,
                 {{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}})},
      {"point_part", "a tetrahedron in one point beside a good part",
       both(cube(), tetrahedron(point))},
      {"point_alone", "a tetrahedron in one point", tetrahedron(point)},
      {"flat_part", "a tetrahedron without height beside a good part",
       both(cube(), tetrahedron(flat))},
      {"flat_alone", "a tetrahedron without height", tetrahedron(flat)},
      // These are surfaces that cross themselves.
      {"self_crossing_tube", "a closed tube that crosses itself once",
       tube({{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, -2}, {0, -2}})},
      {"bow_tie", "a prism over a bow tie of equal halves",
       prism({{0, 0}, {1, 1}, {1, 0}, {0, 1}})},
      {"uneven_bow_tie", "a prism over a bow tie of unequal halves",
       prism({{0, 0}, {0, 1}, {3, 0}, {3, 3}})},
      {"star_prism", "a prism over a pentagram", prism(star)},
      {"spike_through_wall", "a dent that comes out of the opposite side", dented_cube(-1)},
      {"long_spike", "the same, more of it outside than the box holds", dented_cube(-4)},
      // These are about size and position.
      {"far_off", "1e6 m away from the origin (good)", cube(1e6, 1e6 + 1)},
      {"small_with_hole", "micrometers, with a hole", without_side(tall(1e-6), kTop)},
      {"huge_with_hole", "thousands of kilometers, with a hole", without_side(tall(1e6), kTop)},
      {"size_1e-70", "products of four coordinates below 1e-270 (good)", cube(0, 1e-70)},
      {"size_1e+70", "products of four coordinates above 1e270 (good)", cube(0, 1e70)},
      {"denormal_size", "all coordinates denormal", cube(0, 1e-310)},
      {"many_parts", "512 parts (good)", many_cubes()},
      // This one has all at once.
      {"everything", "soup, open, a face turned, one twice, a stray vertex", everything()},
  };
}

}  // namespace graspfit::testing
