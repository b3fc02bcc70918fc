#include "shapes/implicit_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/disjoint_sets.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "voxel/block.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr int kBlock = 8;                        // lattice points a side that are skipped together
constexpr std::int64_t kMostPoints = 1LL << 28;  // of a lattice: 2 GB of values
constexpr int kQuadRounds = 14;                  // relaxation rounds; more change nothing visible
constexpr int kTriangleRounds = 6;               // the same, each followed by flips
constexpr double kRelaxation = 0.6;              // share of the distance to the neighbors' mean
constexpr double kVertexTolerance = 1e-12;       // over the longest extent

[[noreturn]] void refuse_coarse(const ImplicitSolid& solid, double edge_length) {
  throw base::InvalidInput(solid.name + ": edges of " + base::shortest_decimal(edge_length) +
                           " m are too long for its finest features; raise segments");
}

// Values of the field at the points of a cubic lattice, x fastest.
class Lattice {
 public:
  Lattice(const ImplicitSolid& solid, double spacing) : spacing_(spacing) {
    const Vector3d size = solid.box.sizes();
    std::int64_t total = 1;
    for (int axis = 0; axis < 3; ++axis) {
      // Two cells of air on each side: relaxation and fillets never reach the end.
      const double cells = std::ceil(size[axis] / spacing) + 4;
      if (!(cells * static_cast<double>(total) < static_cast<double>(kMostPoints))) {
        throw base::InvalidInput(solid.name + ": edges of " + base::shortest_decimal(spacing) +
                                 " m need more than 2^28 lattice points; lower segments");
      }
      count_[axis] = static_cast<int>(cells) + 1;
      total *= count_[axis];
      origin_[axis] = solid.box.center()[axis] - 0.5 * cells * spacing;
    }
    values_.resize(total);
    for (int z = 0; z < count_[2]; z += kBlock) {
      for (int y = 0; y < count_[1]; y += kBlock) {
        for (int x = 0; x < count_[0]; x += kBlock) fill_block(solid, {x, y, z});
      }
    }
    remove_ambiguities(solid);
  }

  /// The point with the highest coordinates.
  Vector3i last() const { return count_ - Vector3i::Ones(); }
  std::int64_t index(const Vector3i& p) const {
    return p[0] + count_[0] * (p[1] + static_cast<std::int64_t>(count_[1]) * p[2]);
  }
  Vector3d position(const Vector3i& p) const { return origin_ + spacing_ * p.cast<double>(); }
  double value(const Vector3i& p) const { return values_[index(p)]; }
  bool is_inside(const Vector3i& p) const { return value(p) < 0.0; }

  // Bit c is set where corner c (x in bit 0, y in 1, z in 2) of the cell at `p` is inside.
  int signs(const Vector3i& p) const {
    const std::int64_t first = index(p);
    const std::int64_t row = count_[0];
    const std::int64_t layer = row * count_[1];
    int mask = 0;
    for (int c = 0; c < 8; ++c) {
      if (values_[first + (c & 1) + (c >> 1 & 1) * row + (c >> 2) * layer] < 0.0) mask |= 1 << c;
    }
    return mask;
  }

 private:
  // Far from the surface one value decides a block: the ball around its middle that also holds the
  // neighbors of its points is then all inside or all outside.
  void fill_block(const ImplicitSolid& solid, const Vector3i& low) {
    const Vector3i high = (low + Vector3i::Constant(kBlock - 1)).cwiseMin(last());
    const double middle =
        solid.field(position(low) + Vector3d::Constant(0.5 * (kBlock - 1) * spacing_));
    const double reach = 0.5 * std::sqrt(3.0) * (kBlock + 1) * spacing_;
    const bool is_far = std::abs(middle) > solid.slope_bound * reach;
    for_each_in_block(low, high, [&](const Vector3i& p) {
      values_[index(p)] = is_far ? middle : solid.field(position(p));
    });
  }

  // Where a cell's signs alternate around a face, or leave its inside or outside in two parts, the
  // corner nearest to the surface changes sides: a shift of the solid by less than a cell, undone
  // when vertices are projected.
  void remove_ambiguities(const ImplicitSolid& solid) {
    constexpr int kMostRounds = 8;
    for (int round = 0; round < kMostRounds; ++round) {
      bool is_clean = true;
      for_each_in_block(Vector3i::Zero(), last() - Vector3i::Ones(), [&](const Vector3i& cell) {
        const int mask = signs(cell);
        if (mask == 0 || mask == 255 || is_one_sheet(mask)) return;
        is_clean = false;
        std::int64_t nearest = index(cell);
        for (int c = 0; c < 8; ++c) {
          const std::int64_t i = index(cell + Vector3i(c & 1, c >> 1 & 1, c >> 2));
          if (std::abs(values_[i]) < std::abs(values_[nearest])) nearest = i;
        }
        values_[nearest] = values_[nearest] < 0.0 ? 0.0 : -0x1p-1000;
      });
      if (is_clean) return;
    }
    refuse_coarse(solid, spacing_);
  }

  static bool is_one_sheet(int mask) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const int u = 1 << (axis + 1) % 3;
        const int v = 1 << (axis + 2) % 3;
        const int base = side << axis;
        const auto at = [&](int c) { return mask >> (base + c) & 1; };
        if (at(0) == at(u + v) && at(u) == at(v) && at(0) != at(u)) return false;
      }
    }
    return is_connected(mask) && is_connected(~mask & 255);
  }

  // Whether the corners of a set are connected over edges of the cube.
  static bool is_connected(int set) {
    int reached = set & -set;
    for (int step = 0; step < 8; ++step) {
      int grown = reached;
      for (int c = 0; c < 8; ++c) {
        if (reached >> c & 1) grown |= 1 << (c ^ 1) | 1 << (c ^ 2) | 1 << (c ^ 4);
      }
      reached = grown & set;
    }
    return reached == set;
  }

  double spacing_;
  Vector3d origin_;
  Vector3i count_;
  std::vector<double> values_;
};

struct QuadMesh {
  std::vector<Vector3d> vertices;
  std::vector<std::array<std::int32_t, 4>> quads;  // counter-clockwise seen from outside
};

QuadMesh surface_net(const Lattice& lattice) {
  QuadMesh net;
  std::vector<std::int32_t> vertex_of(lattice.index(lattice.last()) + 1,
                                      -1);  // by the cell's low corner
  const Vector3i last_cell = lattice.last() - Vector3i::Ones();
  for_each_in_block(Vector3i::Zero(), last_cell, [&](const Vector3i& cell) {
    const int mask = lattice.signs(cell);
    if (mask == 0 || mask == 255) return;
    Vector3d sum = Vector3d::Zero();
    int crossings = 0;
    for (int c = 0; c < 8; ++c) {
      for (int axis = 0; axis < 3; ++axis) {
        const int d = c | 1 << axis;
        if (d == c || (mask >> c & 1) == (mask >> d & 1)) continue;
        const Vector3i p = cell + Vector3i(c & 1, c >> 1 & 1, c >> 2);
        const Vector3i q = cell + Vector3i(d & 1, d >> 1 & 1, d >> 2);
        const double fp = lattice.value(p);
        const double t = std::clamp(fp / (fp - lattice.value(q)), 0.0, 1.0);
        sum += (1.0 - t) * lattice.position(p) + t * lattice.position(q);
        ++crossings;
      }
    }
    vertex_of[lattice.index(cell)] = base::as_index<std::int32_t>(net.vertices.size());
    net.vertices.push_back(sum / crossings);
  });
  // The four cells around a crossed edge, counter-clockwise seen from the edge's high end.
  for_each_in_block(Vector3i::Ones(), last_cell, [&](const Vector3i& p) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3i q = p + Vector3i::Unit(axis);
      if (lattice.is_inside(p) == lattice.is_inside(q)) continue;
      const Vector3i u = Vector3i::Unit((axis + 1) % 3);
      const Vector3i v = Vector3i::Unit((axis + 2) % 3);
      std::array<std::int32_t, 4> quad = {
          vertex_of[lattice.index(p - u - v)], vertex_of[lattice.index(p - v)],
          vertex_of[lattice.index(p)], vertex_of[lattice.index(p - u)]};
      if (!lattice.is_inside(p)) std::swap(quad[1], quad[3]);
      net.quads.push_back(quad);
    }
  });
  return net;
}

// Neighbors of each vertex over edges, ascending: those of vertex i at [first[i], first[i + 1]).
struct Neighbors {
  std::vector<std::int32_t> first;
  std::vector<std::int32_t> list;
};

template <class Polygons>
Neighbors neighbors(const Polygons& polygons, std::size_t num_vertices) {
  // Each edge is run through once in each direction, so every neighbor comes up exactly once.
  Neighbors result;
  result.first.assign(num_vertices + 1, 0);
  for (const auto& polygon : polygons) {
    for (std::int32_t v : polygon) ++result.first[v + 1];
  }
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.list.resize(result.first.back());
  std::vector<std::int32_t> next(result.first.begin(), result.first.end() - 1);
  for (const auto& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      result.list[next[polygon[i]]++] = polygon[(i + 1) % polygon.size()];
    }
  }
  return result;
}

bool is_one_part(const QuadMesh& net) {
  base::DisjointSets parts(net.vertices.size());
  for (const auto& quad : net.quads) {
    for (std::size_t i = 1; i < quad.size(); ++i) parts.unite(quad[0], quad[i]);
  }
  const std::vector<std::int32_t> part_of = parts.numbered();
  return std::all_of(part_of.begin(), part_of.end(), [](std::int32_t part) { return part == 0; });
}

class Surface {
 public:
  Surface(const ImplicitSolid& solid, double edge_length)
      : solid_(solid), edge_length_(edge_length), step_(1e-4 * edge_length) {}

  // Gradient by forward differences, which are good enough for a direction.
  Vector3d gradient(const Vector3d& p, double value) const {
    Vector3d g;
    for (int axis = 0; axis < 3; ++axis) {
      g[axis] = (solid_.field(p + step_ * Vector3d::Unit(axis)) - value) / step_;
    }
    return g;
  }

  // One round: every vertex that is not fixed moves in its tangent plane towards the mean of its
  // neighbors, all from the positions before, then by one Newton step back to the surface.
  void relax(std::vector<Vector3d>& vertices, const Neighbors& neighbors,
             const std::vector<char>& is_fixed) const {
    const std::vector<Vector3d> before = vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (is_fixed[i]) continue;
      const auto degree = neighbors.first[i + 1] - neighbors.first[i];
      Vector3d mean = Vector3d::Zero();
      for (auto k = neighbors.first[i]; k < neighbors.first[i + 1]; ++k) {
        mean += before[neighbors.list[k]];
      }
      const Vector3d& p = before[i];
      const Vector3d g = gradient(p, solid_.field(p));
      const double squared = g.squaredNorm();
      if (squared == 0.0) continue;
      Vector3d shift = kRelaxation * (mean / degree - p);
      shift -= g * (g.dot(shift) / squared);
      const Vector3d q = p + shift;
      // The step is no longer than half an edge, since on a fold the field is no distance.
      const double back = std::clamp(-solid_.field(q) / std::sqrt(squared), -0.5 * edge_length_,
                                     0.5 * edge_length_);
      vertices[i] = q + g * (back / std::sqrt(squared));
    }
  }

  // The zero of the field on the line through `p` along its gradient, by bisection.
  Vector3d projected(const Vector3d& p) const {
    const double value = solid_.field(p);
    if (value == 0.0) return p;
    const Vector3d direction = gradient(p, value).normalized();
    const auto has_side_of_p = [&](double t) {
      return (solid_.field(p + t * direction) < 0.0) == (value < 0.0);
    };
    double near = 0.0;
    double far = -1.5 * value;
    while (has_side_of_p(far)) {
      near = far;
      far *= 2.0;
      if (!(std::abs(far) < 4.0 * edge_length_)) refuse();
    }
    const double tolerance = kVertexTolerance * solid_.box.sizes().maxCoeff();
    while (std::abs(far - near) > tolerance) {
      const double middle = 0.5 * (near + far);
      (has_side_of_p(middle) ? near : far) = middle;
    }
    return p + 0.5 * (near + far) * direction;
  }

  [[noreturn]] void refuse() const { refuse_coarse(solid_, edge_length_); }

 private:
  const ImplicitSolid& solid_;
  double edge_length_;
  double step_;
};

double cosine_at(const Vector3d& corner, const Vector3d& a, const Vector3d& b) {
  const Vector3d u = a - corner;
  const Vector3d v = b - corner;
  return u.dot(v) / std::sqrt(u.squaredNorm() * v.squaredNorm());
}

// The largest cosine, that of the smallest angle.
double sharpness(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return std::max({cosine_at(a, b, c), cosine_at(b, c, a), cosine_at(c, a, b)});
}

std::vector<Face> split(const QuadMesh& net) {
  std::vector<Face> faces;
  faces.reserve(2 * net.quads.size());
  for (const auto& [a, b, c, d] : net.quads) {
    const auto& v = net.vertices;
    const double ac = std::max(sharpness(v[a], v[b], v[c]), sharpness(v[a], v[c], v[d]));
    const double bd = std::max(sharpness(v[b], v[c], v[d]), sharpness(v[b], v[d], v[a]));
    if (ac <= bd) {
      faces.insert(faces.end(), {Face{a, b, c}, {a, c, d}});
    } else {
      faces.insert(faces.end(), {Face{b, c, d}, {b, d, a}});
    }
  }
  return faces;
}

// Flips every diagonal with opposite angles of more than a half turn together, where the surface
// stays a manifold and does not bend by more than 60 degrees at the new edge.
class Flipper {
 public:
  Flipper(TriangleMesh& mesh) : mesh_(mesh), twin_(3 * mesh.faces.size()) {
    std::vector<std::array<std::int32_t, 3>> edges;  // low vertex, high vertex, half-edge
    edges.reserve(twin_.size());
    valence_.assign(mesh.vertices.size(), 0);
    for (std::int32_t h = 0; h < std::ssize(twin_); ++h) {
      edges.push_back({std::min(from(h), to(h)), std::max(from(h), to(h)), h});
      ++valence_[from(h)];
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
      twin_[edges[i][2]] = edges[i + 1][2];
      twin_[edges[i + 1][2]] = edges[i][2];
    }
  }

  void run() {
    constexpr int kMostSweeps = 6;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      bool is_changed = false;
      for (std::int32_t h = 0; h < std::ssize(twin_); ++h) is_changed |= flip(h);
      if (!is_changed) return;
    }
  }

 private:
  std::int32_t from(std::int32_t h) const { return mesh_.faces[h / 3][h % 3]; }
  std::int32_t to(std::int32_t h) const { return mesh_.faces[h / 3][(h + 1) % 3]; }
  static std::int32_t next(std::int32_t h) { return h - h % 3 + (h + 1) % 3; }
  static std::int32_t previous(std::int32_t h) { return h - h % 3 + (h + 2) % 3; }

  bool has_edge(std::int32_t leaving, std::int32_t target) const {
    std::int32_t h = leaving;
    do {
      if (to(h) == target) return true;
      h = twin_[previous(h)];
    } while (h != leaving);
    return false;
  }

  //      c              c
  //    / | \          /   \        faces (a b c), (b a d) become (a d c), (d b c)
  //   a--+--b   to   a  |  b
  //    \   /          \ | /
  //      d              d
  bool flip(std::int32_t h) {
    const std::int32_t g = twin_[h];
    if (h > g) return false;
    const std::int32_t a = from(h);
    const std::int32_t b = to(h);
    const std::int32_t c = from(previous(h));
    const std::int32_t d = from(previous(g));
    const auto& v = mesh_.vertices;
    constexpr double kGain = 1e-9;  // cocircular corners are not flipped back and forth
    if (cosine_at(v[c], v[a], v[b]) + cosine_at(v[d], v[a], v[b]) > -kGain) {
      // cos C + cos D < 0 exactly when C + D is more than a half turn.
      return false;
    }
    if (c == d || valence_[a] < 5 || valence_[b] < 5) return false;
    const Vector3d left = (v[d] - v[a]).cross(v[c] - v[a]);
    const Vector3d right = (v[b] - v[d]).cross(v[c] - v[d]);
    if (left.dot(right) < 0.5 * left.norm() * right.norm()) return false;
    const Vector3d old_normal = (v[b] - v[a]).cross(v[c] - v[a]).normalized() +
                                (v[a] - v[b]).cross(v[d] - v[b]).normalized();
    if (left.dot(old_normal) <= 0.0 || right.dot(old_normal) <= 0.0) return false;
    if (has_edge(previous(h), d)) return false;
    const std::int32_t f = h / 3;
    const std::int32_t k = g / 3;
    const std::int32_t bc = twin_[next(h)];
    const std::int32_t ca = twin_[previous(h)];
    const std::int32_t ad = twin_[next(g)];
    const std::int32_t db = twin_[previous(g)];
    mesh_.faces[f] = {a, d, c};
    mesh_.faces[k] = {d, b, c};
    const auto join = [&](std::int32_t x, std::int32_t y) {
      twin_[x] = y;
      twin_[y] = x;
    };
    join(3 * f, ad);
    join(3 * f + 1, 3 * k + 2);
    join(3 * f + 2, ca);
    join(3 * k, db);
    join(3 * k + 1, bc);
    --valence_[a];
    --valence_[b];
    ++valence_[c];
    ++valence_[d];
    return true;
  }

  TriangleMesh& mesh_;
  std::vector<std::int32_t> twin_;
  std::vector<std::int32_t> valence_;
};

}  // namespace

TriangleMesh polygonize(const ImplicitSolid& solid, double edge_length) {
  QuadMesh net = surface_net(Lattice(solid, edge_length));
  const Surface surface(solid, edge_length);
  if (net.vertices.empty()) surface.refuse();
  const Neighbors over_quads = neighbors(net.quads, net.vertices.size());
  // Twice as many edges as quadrilaterals: V − E + F = V − F.
  const auto euler =
      static_cast<std::int64_t>(net.vertices.size()) - static_cast<std::int64_t>(net.quads.size());
  if (euler != 2 - 2 * solid.genus || !is_one_part(net)) surface.refuse();

  std::vector<char> is_fixed(net.vertices.size(), 0);
  for (const Vector3d& extreme : solid.extreme_points) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < net.vertices.size(); ++i) {
      const double squared = (net.vertices[i] - extreme).squaredNorm();
      if (squared < least && !is_fixed[i]) {
        least = squared;
        nearest = i;
      }
    }
    net.vertices[nearest] = extreme;
    is_fixed[nearest] = 1;
  }
  for (int i = 0; i < kQuadRounds; ++i) surface.relax(net.vertices, over_quads, is_fixed);

  TriangleMesh mesh{.vertices = net.vertices, .faces = split(net)};
  for (int i = 0; i < kTriangleRounds; ++i) {
    Flipper(mesh).run();
    surface.relax(mesh.vertices, neighbors(mesh.faces, mesh.vertices.size()), is_fixed);
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (is_fixed[i]) continue;
    // Flat sides of the box are met exactly; that moves no vertex by more than the tolerance.
    mesh.vertices[i] =
        surface.projected(mesh.vertices[i]).cwiseMax(solid.box.min()).cwiseMin(solid.box.max());
  }
  Flipper(mesh).run();
  for (std::int32_t f = 0; f < std::ssize(mesh.faces); ++f) {
    const auto [a, b, c] = corners(mesh, f);
    const Vector3d normal = (b - a).cross(c - a);
    for (const Vector3d& p : {a, b, c}) {
      if (!(normal.dot(surface.gradient(p, solid.field(p))) > 0.0)) surface.refuse();
    }
  }
  return mesh;
}

double rounded_intersection(double a, double b, double rounding) {
  const double u = std::max(rounding + a, 0.0);
  const double v = std::max(rounding + b, 0.0);
  return std::min(-rounding, std::max(a, b)) + std::sqrt(u * u + v * v);
}

}  // namespace graspfit::geometry::internal
