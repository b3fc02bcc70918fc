// This program computes a contact metric on a Surface_mesh of CGAL: which share of a fingertip's
// pad has surface within reach. CGAL's tree finds the faces near the pad and the distance of its
// center; graspfit cuts the surface exactly by the volume before the pad.
#include <cmath>
#include <cstdio>
#include <iterator>
#include <vector>

#include "graspfit/geometry/cgal.hpp"
#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/mesh_query.hpp"

namespace adapter = graspfit::geometry::cgal;
using Kernel = adapter::Kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Returns a mesh as somebody may have it: a square plate with a step along y, as two rows of quads
// cut into triangles.
SurfaceMesh stepped_plate(double half_size, double step) {
  SurfaceMesh mesh;
  std::vector<SurfaceMesh::Vertex_index> row[4];
  const double x[4] = {-half_size, 0.0, 0.0, half_size};
  const double z[4] = {0.0, 0.0, -step, -step};
  for (int i = 0; i < 4; ++i) {
    for (const double y : {-half_size, half_size}) {
      row[i].push_back(mesh.add_vertex(Kernel::Point_3(x[i], y, z[i])));
    }
  }
  for (int i = 0; i < 3; ++i) {
    mesh.add_face(row[i][0], row[i + 1][0], row[i + 1][1]);
    mesh.add_face(row[i][0], row[i + 1][1], row[i][1]);
  }
  return mesh;
}

// Returns the share of a pad over the origin with the edge `size` that has surface within `depth`.
double supported_share(const SurfaceMesh& object, double size, double depth) {
  const graspfit::geometry::TriangleMesh mesh = adapter::triangle_mesh(object);
  const adapter::FaceTree faces(mesh);
  const double half = 0.5 * size;
  const Kernel::Iso_cuboid_3 before_pad(Kernel::Point_3(-half, -half, -depth),
                                        Kernel::Point_3(half, half, depth));
  std::vector<adapter::FaceTree::Tree::Primitive_id> near;
  faces.tree().all_intersected_primitives(before_pad, std::back_inserter(near));
  std::vector<std::int32_t> indices;
  for (const auto id : near) indices.push_back(static_cast<std::int32_t>(faces.face(id)));
  double area = 0.0;
  for (const auto& piece : graspfit::geometry::clip(mesh, indices, adapter::volume(before_pad))) {
    const auto normal = graspfit::geometry::face_normal(mesh, piece.face);
    area += piece.area * normal.z();  // This is the area as the pad sees it.
  }
  return area / (size * size);
}

int main() {
  const SurfaceMesh plate = stepped_plate(0.05, 0.003);
  const double deep = supported_share(plate, 0.02, 0.004);
  const double shallow = supported_share(plate, 0.02, 0.002);
  std::printf("pad that sees 4 mm deep: %.3f supported\n", deep);
  std::printf("pad that sees 2 mm deep: %.3f supported\n", shallow);

  // CGAL's tree and graspfit's query find the same distance.
  const graspfit::geometry::TriangleMesh mesh = adapter::triangle_mesh(plate);
  const adapter::FaceTree faces(mesh);
  const Eigen::Vector3d tip(0.01, 0.004, 0.007);
  const double by_cgal = std::sqrt(
      CGAL::squared_distance(adapter::point(tip), faces.tree().closest_point(adapter::point(tip))));
  const double by_graspfit =
      std::sqrt(graspfit::geometry::MeshQuery(mesh).closest_point(tip).squared_distance);
  std::printf("distance of a fingertip: %.4f mm, %.4f mm\n", 1e3 * by_cgal, 1e3 * by_graspfit);

  // In closed form the shares are all of the pad, and the half before the step; the distance is 10
  // mm above the lower half.
  return std::abs(deep - 1.0) < 1e-12 && std::abs(shallow - 0.5) < 1e-12 &&
                 std::abs(by_cgal - 0.01) < 1e-15 && std::abs(by_graspfit - 0.01) < 1e-15
             ? 0
             : 1;
}
