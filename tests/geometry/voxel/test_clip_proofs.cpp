// These tests prove the shipped fast path: its cutter knows the origin of every corner, and what
// follows from the origins is checked in rational numbers.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "exact/predicates.hpp"
#include "geometry/changed_meshes.hpp"
#include "geometry/exact_clip.hpp"
#include "geometry/rational_clip.hpp"
#include "geometry/traced_clip.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"

namespace test_clip_proofs {

using namespace graspfit::base;
using namespace graspfit::geometry;
using namespace graspfit::testing;

namespace {

RationalPoint rational(const ExactVector3& exact) {
  return {Rational(exact[0].to_string()), Rational(exact[1].to_string()),
          Rational(exact[2].to_string())};
}

void add(RationalPoint& sum, const RationalPoint& part) {
  for (int axis = 0; axis < 3; ++axis) sum[axis] += part[axis];
}

double length(const RationalPoint& v) { return std::sqrt(CGAL::to_double(dot(v, v))); }

// Checks corners, area and centroid of a piece against its exact corners, by the bounds of `clip`.
void check_bounds(const ClippedPiece& piece, const Triangle& triangle,
                  const std::vector<RationalPoint>& places, const RationalPoint& exact_centroid) {
  REQUIRE(piece.polygon.size() == places.size());
  const double bound = corner_bound(triangle);
  bool are_near = true;
  for (std::size_t i = 0; i < places.size(); ++i) {
    are_near = are_near && distance(piece.polygon[i], places[i]) <= bound;
  }
  REQUIRE(are_near);
  const RationalPoint own =
      doubled_vector_area({exactly(triangle[0]), exactly(triangle[1]), exactly(triangle[2])});
  const double whole = 0.5 * length(own);
  const double exact = 0.5 * length(doubled_vector_area(places));
  REQUIRE(piece.area > 0.0);
  REQUIRE(std::abs(piece.area - exact) <= 1e-12 * whole);
  double edge = 0.0;
  for (int i = 0; i < 3; ++i) edge = std::max(edge, (triangle[(i + 1) % 3] - triangle[i]).norm());
  REQUIRE(distance(piece.centroid, exact_centroid) * exact <=
          4e-12 * whole * edge + corner_bound(triangle) * exact);
}

// The pieces of a mesh, each with the same polygon traced.
struct TracedPieces {
  std::vector<VoxelPiece> pieces;
  std::vector<TracedPolygon> traced;
  internal::ClipStatistics statistics;
};

// Requires that the traced polygons are those of the pieces, bit for bit.
TracedPieces traced_pieces(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  ClipTracer tracer;
  std::map<std::pair<std::int64_t, std::int32_t>, TracedPolygon> traced;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (auto& [voxel, polygon] : tracer.clip_by_voxels(corners(mesh, face), lattice)) {
      traced[{voxel, static_cast<std::int32_t>(face)}] = polygon;
    }
  }
  TracedPieces result;
  result.pieces = clip_by_voxels(mesh, lattice);
  result.statistics = tracer.statistics();
  REQUIRE(result.pieces.size() == traced.size());
  auto next = traced.begin();
  for (const auto& [voxel, piece] : result.pieces) {
    const auto& [name, polygon] = *next++;
    REQUIRE(name == std::pair(voxel, piece.face));
    REQUIRE(polygon.corners == piece.polygon);
    result.traced.push_back(polygon);
  }
  return result;
}

// Proves the pieces of every face in every voxel. Returns how often the fast path needed help.
internal::ClipStatistics prove_pieces(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  const TracedPieces traced = traced_pieces(mesh, lattice);
  std::vector<std::vector<std::size_t>> of_face(mesh.faces.size());
  for (std::size_t i = 0; i < traced.pieces.size(); ++i) {
    of_face[traced.pieces[i].piece.face].push_back(i);
  }
  const PlaneOf plane_of = planes_of(lattice);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    CAPTURE(face);
    const Triangle triangle = corners(mesh, face);
    const std::vector<ExactVoxelPiece> exact = exact_clip_by_voxels(triangle, lattice);
    REQUIRE(of_face[face].size() == exact.size());
    RationalPoint sum = {0, 0, 0};
    for (std::size_t k = 0; k < exact.size(); ++k) {
      const auto& [index, piece] = traced.pieces[of_face[face][k]];
      const std::vector<CornerOrigin>& origins = traced.traced[of_face[face][k]].origins;
      REQUIRE(index == exact[k].voxel);
      const std::vector<RationalPoint> places = exact_places(origins, triangle, plane_of);
      const Eigen::Vector3i voxel = lattice.voxel(index);
      bool is_inside = true;
      bool is_on_planes = true;
      for (std::size_t i = 0; i < places.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          is_inside = is_inside && places[i][axis] >= Rational(lattice.plane(axis, voxel[axis])) &&
                      places[i][axis] <= Rational(lattice.plane(axis, voxel[axis] + 1));
        }
        for (const CuttingPlane& plane : origins[i].planes) {
          if (plane.axis < 0) continue;
          is_on_planes = is_on_planes &&
                         piece.polygon[i][plane.axis] == lattice.plane(plane.axis, plane.index);
        }
      }
      REQUIRE(is_inside);
      REQUIRE(is_on_planes);
      const RationalPoint doubled = doubled_vector_area(places);
      RationalPoint of_exact_form = rational(exact[k].piece.vector_area);
      for (Rational& x : of_exact_form) x *= 2;
      REQUIRE(doubled == of_exact_form);
      check_bounds(piece, triangle, places, rational(exact[k].piece.centroid));
      add(sum, doubled);
    }
    const RationalPoint own =
        doubled_vector_area({exactly(triangle[0]), exactly(triangle[1]), exactly(triangle[2])});
    REQUIRE(sum == own);
  }
  return traced.statistics;
}

// Returns loose triangles with corners drawn by `coordinate`.
template <typename Coordinate>
TriangleMesh loose_triangles(int count, const Coordinate& coordinate) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const double x = coordinate();
      const double y = coordinate();
      const double z = coordinate();
      mesh.vertices.emplace_back(x, y, z);
    }
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

VoxelLattice unit_lattice(const Eigen::Vector3i& counts) {
  return {Eigen::Vector3d::Zero(), 1.0, counts};
}

// Returns a number one or two ulps beside a whole number.
double beside_a_plane(Random& random, std::uint64_t planes) {
  double x = static_cast<double>(1 + random.index(planes));
  for (std::uint64_t ulps = random.index(3); ulps > 0; --ulps) {
    x = std::nextafter(x, random.index(2) == 0 ? 0.0 : 100.0);
  }
  return x;
}

TriangleMesh halves(int count) {
  Random random(2);
  return loose_triangles(count, [&] { return 0.5 * static_cast<double>(1 + random.index(6)); });
}

// Returns slivers of height 1e-12 over the longest edge.
TriangleMesh slivers(int count) {
  Random random(4);
  TriangleMesh mesh = loose_triangles(count, [&] { return random.uniform(0.5, 3.5); });
  for (const Face& f : mesh.faces) {
    const double t = random.uniform(0.2, 0.8);
    mesh.vertices[f[2]] = mesh.vertices[f[0]] + t * (mesh.vertices[f[1]] - mesh.vertices[f[0]]) +
                          Eigen::Vector3d::Constant(1e-12);
  }
  return mesh;
}

// Returns slivers with corners at whole coordinates, a hair off the line from (1, 1, 1) to (3, 3,
// 3) through voxel corners.
TriangleMesh slivers_through_voxel_corners(int count) {
  Random random(5);
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d third = Eigen::Vector3d::Constant(2.0);
    third[static_cast<int>(random.index(3))] += 1e-12 * static_cast<double>(1 + random.index(3));
    mesh.vertices.insert(mesh.vertices.end(),
                         {Eigen::Vector3d::Constant(1.0), Eigen::Vector3d::Constant(3.0), third});
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// Returns every face three times, once the other way around.
TriangleMesh tripled(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  for (const Face& f : mesh.faces) {
    result.faces.push_back(f);
    result.faces.push_back({f[0], f[2], f[1]});
  }
  return result;
}

struct Adversarial {
  const char* name;
  TriangleMesh mesh;
  VoxelLattice lattice;
};

std::vector<Adversarial> adversarial_meshes() {
  Random random(3);
  std::vector<Adversarial> meshes;
  meshes.push_back({"faces in voxel planes, their diagonals through voxel corners",
                    moved(box({3.0, 2.0, 4.0}), {2.5, 2.0, 3.0}), unit_lattice({6, 5, 7})});
  meshes.push_back({"vertices on voxel corners",
                    loose_triangles(150, [&] { return static_cast<double>(1 + random.index(4)); }),
                    unit_lattice({5, 6, 7})});
  meshes.push_back({"vertices in voxel planes and between", halves(150), unit_lattice({4, 5, 4})});
  meshes.push_back({"an ulp or two beside voxel planes",
                    loose_triangles(100, [&] { return beside_a_plane(random, 3); }),
                    unit_lattice({4, 4, 5})});
  meshes.push_back({"slivers of height 1e-12, some through voxel corners",
                    concatenated({slivers(60), slivers_through_voxel_corners(20)}),
                    unit_lattice({4, 4, 4})});
  const Eigen::Vector3d far(1e6, -1e6, 1e6);
  const auto between = [&] { return random.uniform(0.05, 0.35); };
  const auto in_planes = [&] { return 0.1 * static_cast<double>(random.index(4)); };
  meshes.push_back(
      {"coordinates near 1e6, half of them in planes",
       moved(concatenated({loose_triangles(60, between), loose_triangles(60, in_planes)}), far),
       {far, 0.1, {4, 5, 4}}});
  meshes.push_back(
      {"voxels of an ulp near 1e6",
       moved(loose_triangles(60, [&] { return 0x1p-33 * static_cast<double>(random.index(9)); }),
             far),
       {far, 0.75 * 0x1p-33, {14, 14, 14}}});
  meshes.push_back({"duplicated faces", tripled(halves(50)), unit_lattice({4, 4, 4})});
  return meshes;
}

// Proves every `step`-th face of a real mesh, on the lattice of the whole one.
internal::ClipStatistics prove_packaged_mesh(const std::string& file, std::size_t step) {
  TriangleMesh mesh = read_mesh(*packaged_mesh(file)).mesh;
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 30});
  std::vector<Face> sampled;
  for (std::size_t i = 0; i < mesh.faces.size(); i += step) sampled.push_back(mesh.faces[i]);
  mesh.faces = sampled;
  return prove_pieces(mesh, lattice);
}

constexpr const char* kPackaged[] = {"bunny00.off", "armadillo.off", "dino.off"};

template <typename Coordinate>
Eigen::Vector3d drawn(const Coordinate& coordinate) {
  const double x = coordinate();
  const double y = coordinate();
  const double z = coordinate();
  return {x, y, z};
}

Eigen::Vector3d mirrored(const Eigen::Vector3d& p) { return {-p[0], p[1], p[2]}; }

using Corners = std::vector<std::array<double, 3>>;

Corners sorted_corners(const std::vector<Eigen::Vector3d>& polygon) {
  Corners result;
  for (const Eigen::Vector3d& p : polygon) result.push_back({p[0], p[1], p[2]});
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

TEST_CASE("Pieces of adversarial triangles are exact by their origins",
          "[geometry][surface_patch][clip_proofs]") {
  std::int64_t num_in_rationals = 0;
  for (const Adversarial& adversarial : adversarial_meshes()) {
    CAPTURE(adversarial.name);
    const internal::ClipStatistics statistics = prove_pieces(adversarial.mesh, adversarial.lattice);
    // The rounded corners alone would not be enough.
    CHECK(statistics.signs_by_determinant + statistics.corners_in_rationals +
              statistics.areas_in_rationals >
          0);
    num_in_rationals += statistics.signs_in_rationals + statistics.corners_in_rationals +
                        statistics.areas_in_rationals;
  }
  // Nor would intervals.
  CHECK(num_in_rationals > 0);
}

TEST_CASE("Pieces of sampled faces of real meshes are exact by their origins",
          "[geometry][surface_patch][clip_proofs]") {
  for (const char* const file : kPackaged) {
    if (!packaged_mesh(file)) {
      GRASPFIT_SKIP_TEST(std::string(file) + " of libcgal-demo is not unpacked");
    }
    CAPTURE(file);
    prove_packaged_mesh(file, 12);
  }
}

TEST_CASE("Pieces of whole real meshes are exact by their origins",
          "[full][geometry][surface_patch][clip_proofs]") {
  for (const char* const file : kPackaged) {
    if (!packaged_mesh(file)) {
      GRASPFIT_SKIP_TEST(std::string(file) + " of libcgal-demo is not unpacked");
    }
    CAPTURE(file);
    prove_packaged_mesh(file, 1);
  }
}

TEST_CASE("Duplicated faces have the same pieces, bit for bit",
          "[geometry][surface_patch][clip_proofs]") {
  const TriangleMesh mesh = halves(50);
  const VoxelLattice lattice = unit_lattice({4, 4, 4});
  const auto single = clip_by_voxels(mesh, lattice);
  const auto triple = clip_by_voxels(tripled(mesh), lattice);
  REQUIRE(triple.size() == 3 * single.size());
  const auto num_faces = static_cast<std::int32_t>(mesh.faces.size());
  std::size_t i = 0;
  for (const auto& [voxel, piece] : triple) {
    // This is the face that is the other way around.
    if (piece.face >= num_faces && (piece.face - num_faces) % 2 == 1) continue;
    const std::int32_t face = piece.face < num_faces ? piece.face : (piece.face - num_faces) / 2;
    const auto same =
        std::find_if(single.begin(), single.end(), [face, &place = voxel](const VoxelPiece& p) {
          return p.voxel == place && p.piece.face == face;
        });
    REQUIRE(same != single.end());
    REQUIRE(piece.polygon == same->piece.polygon);
    REQUIRE(piece.area == same->piece.area);
    ++i;
  }
  CHECK(i == 2 * single.size());
}

TEST_CASE("Traced polygons are the pieces of clip and clip_by_voxels, bit for bit",
          "[geometry][convex_clip][surface_patch][clip_proofs]") {
  const TriangleMesh mesh = torus(1.0, 0.4, 24, 12);
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 12});
  // This compares the polygons.
  const TracedPieces voxels = traced_pieces(mesh, lattice);
  int num_cut = 0;
  for (std::size_t i = 0; i < voxels.pieces.size(); ++i) {
    const ClippedPiece& piece = voxels.pieces[i].piece;
    const TracedPolygon& traced = voxels.traced[i];
    const auto& [a, b, c] = corners(mesh, static_cast<std::size_t>(piece.face));
    if (piece.polygon == std::vector<Eigen::Vector3d>{a, b, c}) continue;  // It met no plane.
    ++num_cut;
    const double whole = internal::accurate_vector_area(a, b, c).norm();
    REQUIRE(piece.area == traced.measure.fraction * whole);
    REQUIRE(piece.centroid == traced.measure.centroid);
  }
  CHECK(num_cut > 1000);
  const ConvexVolume volume = {{{1, 2, 3}, 0.5}, {{-1, 0, 1}, 0.25}};
  ClipTracer tracer;
  int num_clipped = 0;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto& [a, b, c] = corners(mesh, face);
    const auto piece = clip({a, b, c}, volume);
    const TracedPolygon traced = tracer.clip({a, b, c}, volume);
    REQUIRE(piece.has_value() == !traced.corners.empty());
    if (!piece) continue;
    ++num_clipped;
    REQUIRE(piece->polygon == traced.corners);
    const double whole = internal::accurate_vector_area(a, b, c).stableNorm();
    REQUIRE(piece->area == traced.measure.fraction * whole);
    REQUIRE(piece->centroid == traced.measure.centroid);
  }
  CHECK(num_clipped > 100);
}

TEST_CASE("The inside and the outside of a convex volume sum exactly to the triangle",
          "[geometry][convex_clip][clip_proofs]") {
  Random random(15);
  ClipTracer tracer;
  const auto smooth = [&] { return random.uniform(-1.0, 1.0); };
  // These planes go through corners and along edges of the triangles.
  const auto whole = [&] { return static_cast<double>(random.index(5)) - 2.0; };
  // These planes are nearly the same.
  const auto near = [&] {
    return static_cast<double>(random.index(3)) - 1.0 +
           0x1p-52 * static_cast<double>(random.index(3));
  };
  for (int round = 0; round < 600; ++round) {
    const auto coordinate = [&] {
      return round % 3 == 0 ? smooth() : round % 3 == 1 ? whole() : near();
    };
    const Triangle triangle = {drawn(coordinate), drawn(coordinate), drawn(coordinate)};
    const RationalPoint own =
        doubled_vector_area({exactly(triangle[0]), exactly(triangle[1]), exactly(triangle[2])});
    ConvexVolume volume;
    for (int i = 0; i < 6; ++i) {
      const HalfSpace half_space{drawn(coordinate), coordinate()};
      // A triangle in the plane is inside, and inside the half-space turned around.
      RationalPolygon in_plane(triangle);
      in_plane.clip(half_space.normal, half_space.offset);
      in_plane.clip(-half_space.normal, -half_space.offset);
      if (!in_plane.has_area()) volume.push_back(half_space);
    }
    RationalPoint sum = {0, 0, 0};
    const auto take = [&](const ConvexVolume& part) {
      const auto piece = clip(triangle, part);
      const TracedPolygon traced = tracer.clip(triangle, part);
      const auto exact = exact_clip(triangle, part);
      REQUIRE(piece.has_value() == exact.has_value());
      REQUIRE(traced.corners.empty() == !piece);
      if (!piece) return;
      REQUIRE(traced.corners == piece->polygon);
      const auto places = exact_places(traced.origins, triangle, planes_of(part));
      check_bounds(*piece, triangle, places, rational(exact->centroid));
      add(sum, doubled_vector_area(places));
    };
    take(volume);
    // The shell is what is outside: within the first planes and beyond the next, for each next.
    ConvexVolume shell;
    for (const HalfSpace& h : volume) {
      shell.push_back({-h.normal, -h.offset});
      take(shell);
      shell.back() = h;
    }
    REQUIRE(sum == own);
  }
  CHECK(tracer.statistics().signs_by_determinant > tracer.statistics().signs_in_rationals);
  CHECK(tracer.statistics().signs_in_rationals > 0);
}

TEST_CASE("The order of a triangle's corners changes no exact place",
          "[geometry][surface_patch][clip_proofs]") {
  const TriangleMesh mesh = halves(60);
  const VoxelLattice lattice = unit_lattice({4, 4, 4});
  const PlaneOf plane_of = planes_of(lattice);
  const auto places_of = [&](const Face& order) {
    TriangleMesh permuted = mesh;
    for (Face& f : permuted.faces) f = {f[order[0]], f[order[1]], f[order[2]]};
    const TracedPieces traced = traced_pieces(permuted, lattice);
    std::vector<std::pair<VoxelPiece, std::vector<RationalPoint>>> result;
    for (std::size_t i = 0; i < traced.pieces.size(); ++i) {
      const Triangle triangle =
          corners(permuted, static_cast<std::size_t>(traced.pieces[i].piece.face));
      auto places = exact_places(traced.traced[i].origins, triangle, plane_of);
      std::sort(places.begin(), places.end());
      result.emplace_back(traced.pieces[i], places);
    }
    return result;
  };
  const auto reference = places_of({0, 1, 2});
  for (const Face& order :
       {Face{1, 2, 0}, Face{2, 0, 1}, Face{0, 2, 1}, Face{2, 1, 0}, Face{1, 0, 2}}) {
    const auto permuted = places_of(order);
    REQUIRE(permuted.size() == reference.size());
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const auto& [a, a_places] = reference[i];
      const auto& [b, b_places] = permuted[i];
      REQUIRE(a.voxel == b.voxel);
      REQUIRE(a.piece.face == b.piece.face);
      REQUIRE(a_places == b_places);
      const Triangle triangle = corners(mesh, static_cast<std::size_t>(a.piece.face));
      const double whole =
          0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
      REQUIRE(std::abs(a.piece.area - b.piece.area) <= 2e-12 * whole);  // This is twice the bound.
    }
  }
}

TEST_CASE("Clipping the mirror image gives the mirror image, bit for bit",
          "[geometry][convex_clip][clip_proofs]") {
  Random random(16);
  const auto coordinate = [&] { return random.uniform(-1.0, 1.0); };
  int nonempty = 0;
  for (int round = 0; round < 300; ++round) {
    const Triangle triangle = {drawn(coordinate), drawn(coordinate), drawn(coordinate)};
    const Triangle mirror = {mirrored(triangle[0]), mirrored(triangle[1]), mirrored(triangle[2])};
    ConvexVolume volume;
    ConvexVolume mirrored_volume;
    for (int i = 0; i < 4; ++i) {
      volume.push_back({drawn(coordinate), coordinate()});
      mirrored_volume.push_back({mirrored(volume.back().normal), volume.back().offset});
    }
    const auto piece = clip(triangle, volume);
    const auto image = clip(mirror, mirrored_volume);
    REQUIRE(piece.has_value() == image.has_value());
    if (!piece) continue;
    ++nonempty;
    REQUIRE(piece->area == image->area);
    REQUIRE(piece->centroid == mirrored(image->centroid));
    REQUIRE(piece->polygon.size() == image->polygon.size());
    for (std::size_t i = 0; i < piece->polygon.size(); ++i) {
      REQUIRE(piece->polygon[i] == mirrored(image->polygon[i]));
    }
  }
  CHECK(nonempty > 50);
}

TEST_CASE("Voxels of the mirror image hold the mirror image of their pieces, corners bit for bit",
          "[geometry][surface_patch][clip_proofs]") {
  // Coordinates are quarters, so that every plane of the mirrored lattice is exactly the mirror
  // image of one. No triangle lies in a plane, whose voxel would be the higher one in both.
  Random random(17);
  const TriangleMesh mesh = loose_triangles(100, [&] { return random.uniform(-0.9, 0.9); });
  TriangleMesh image = mesh;
  for (Eigen::Vector3d& vertex : image.vertices) vertex = mirrored(vertex);
  const VoxelLattice lattice{{-1.0, -1.0, -1.0}, 0.25, {8, 8, 8}};
  const auto pieces = clip_by_voxels(mesh, lattice);
  const auto images = clip_by_voxels(image, lattice);
  REQUIRE(pieces.size() == images.size());
  for (const auto& [index, piece] : pieces) {
    Eigen::Vector3i voxel = lattice.voxel(index);
    voxel[0] = lattice.counts[0] - 1 - voxel[0];
    const std::int32_t face = piece.face;
    const auto found = std::find_if(images.begin(), images.end(), [&](const VoxelPiece& p) {
      return p.voxel == lattice.index(voxel) && p.piece.face == face;
    });
    REQUIRE(found != images.end());
    std::vector<Eigen::Vector3d> back;
    for (const Eigen::Vector3d& corner : found->piece.polygon) back.push_back(mirrored(corner));
    REQUIRE(sorted_corners(piece.polygon) == sorted_corners(back));
    // This is twice the bound; the triangles have areas up to 3.
    REQUIRE(std::abs(found->piece.area - piece.area) <= 6e-12);
  }
}

}  // namespace test_clip_proofs
