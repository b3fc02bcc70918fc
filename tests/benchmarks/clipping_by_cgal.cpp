#include "benchmarks/clipping_by_cgal.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <ctime>

#include "benchmarks/sutherland_hodgman_patches.hpp"

namespace graspfit::testing {
namespace {

using Epeck = CGAL::Exact_predicates_exact_constructions_kernel;
using Epick = CGAL::Exact_predicates_inexact_constructions_kernel;

struct EpeckArithmetic {
  using Point = Epeck::Point_3;
  struct Plane {
    int axis;
    Epeck::FT coordinate;
  };
  static constexpr bool kMeasuresWholeFaces = true;

  static Point point(const Eigen::Vector3d& p) { return {p[0], p[1], p[2]}; }
  static Eigen::Vector3d to_double(const Point& p) {
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
  }
  static Plane plane(int axis, double coordinate) { return {axis, coordinate}; }
  static bool is_below(const Point& p, const Plane& plane) {
    return p[plane.axis] < plane.coordinate;
  }
  static Point meet(const Point& p, const Point& q, const Plane& plane) {
    const Epeck::FT t = (plane.coordinate - p[plane.axis]) / (q[plane.axis] - p[plane.axis]);
    return p + t * (q - p);
  }
  static void measure(const Point* polygon, int n, double& area, Eigen::Vector3d& centroid) {
    area = 0.0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    Epeck::Vector_3 p = polygon[1] - polygon[0];
    for (int i = 2; i < n; ++i) {
      const Epeck::Vector_3 q = polygon[i] - polygon[0];
      const double part =
          0.5 * std::sqrt(CGAL::to_double(CGAL::cross_product(p, q).squared_length()));
      area += part;
      moment += part * to_double(CGAL::ORIGIN + (p + q));
      p = q;
    }
    centroid = to_double(polygon[0]) + moment / (3.0 * area);
  }
};

struct FrugalEpeckArithmetic : EpeckArithmetic {
  using Plane = Epeck::Plane_3;
  static constexpr bool kMeasuresWholeFaces = false;

  static Plane plane(int axis, double coordinate) {
    return {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0, -Epeck::FT(coordinate)};
  }
  static bool is_below(const Point& p, const Plane& plane) {
    return plane.oriented_side(p) == CGAL::ON_NEGATIVE_SIDE;
  }
  static Point meet(const Point& p, const Point& q, const Plane& plane) {
    return Epeck().construct_plane_line_intersection_point_3_object()(plane, p, q);
  }
  static void measure(const Point* polygon, int n, double& area, Eigen::Vector3d& centroid) {
    area = 0.0;
    centroid.setZero();
    for (int i = 2; i < n; ++i) {
      const double part =
          std::sqrt(CGAL::to_double(CGAL::squared_area(polygon[0], polygon[i - 1], polygon[i])));
      area += part;
      centroid += part * to_double(CGAL::centroid(polygon[0], polygon[i - 1], polygon[i]));
    }
    centroid /= area;
  }
};

}  // namespace

std::vector<geometry::SurfacePatch> surface_patches_by_epeck(
    const geometry::TriangleMesh& mesh, const geometry::VoxelLattice& lattice) {
  return SutherlandHodgmanPatches<EpeckArithmetic>(mesh, lattice).run();
}

std::vector<geometry::SurfacePatch> surface_patches_by_frugal_epeck(
    const geometry::TriangleMesh& mesh, const geometry::VoxelLattice& lattice) {
  return SutherlandHodgmanPatches<FrugalEpeckArithmetic>(mesh, lattice).run();
}

std::vector<CgalClip> clip_by_cgal(const geometry::TriangleMesh& mesh,
                                   const geometry::VoxelLattice& lattice,
                                   const std::vector<std::int64_t>& voxels) {
  using Mesh = CGAL::Surface_mesh<Epick::Point_3>;
  Mesh whole;
  for (const Eigen::Vector3d& p : mesh.vertices) whole.add_vertex({p[0], p[1], p[2]});
  for (const geometry::Face& f : mesh.faces) {
    whole.add_face(Mesh::Vertex_index(f[0]), Mesh::Vertex_index(f[1]), Mesh::Vertex_index(f[2]));
  }
  std::vector<CgalClip> results;
  for (const std::int64_t index : voxels) {
    const Eigen::Vector3i voxel = lattice.voxel(index);
    const auto corner = [&](int up) {
      return Epick::Point_3(lattice.plane(0, voxel[0] + up), lattice.plane(1, voxel[1] + up),
                            lattice.plane(2, voxel[2] + up));
    };
    Mesh piece = whole;
    const std::clock_t start = std::clock();
    CGAL::Polygon_mesh_processing::clip(piece, Epick::Iso_cuboid_3(corner(0), corner(1)),
                                        CGAL::parameters::clip_volume(false));
    CgalClip& result = results.emplace_back();
    result.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    result.area = CGAL::Polygon_mesh_processing::area(piece);
  }
  return results;
}

}  // namespace graspfit::testing
