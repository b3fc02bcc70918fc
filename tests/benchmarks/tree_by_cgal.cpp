#include "tree_by_cgal.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include "timing.hpp"

#if __has_include(<CGAL/AABB_traits_3.h>)  // In CGAL 6 the other name is deprecated.
#include <CGAL/AABB_traits_3.h>
template <typename Kernel, typename Primitive>
using TreeTraits = CGAL::AABB_traits_3<Kernel, Primitive>;
#else
#include <CGAL/AABB_traits.h>
template <typename Kernel, typename Primitive>
using TreeTraits = CGAL::AABB_traits<Kernel, Primitive>;
#endif

namespace graspfit::testing {

double seconds_of_cgal_tree(const geometry::TriangleMesh& mesh) {
  using Kernel = CGAL::Simple_cartesian<double>;
  using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>;
  using Tree = CGAL::AABB_tree<TreeTraits<Kernel, Primitive>>;
  SurfaceMesh surface;
  for (const Eigen::Vector3d& v : mesh.vertices) surface.add_vertex({v[0], v[1], v[2]});
  using Vertex = SurfaceMesh::Vertex_index;
  for (const auto& face : mesh.faces) {
    surface.add_face(Vertex(static_cast<std::uint32_t>(face[0])),
                     Vertex(static_cast<std::uint32_t>(face[1])),
                     Vertex(static_cast<std::uint32_t>(face[2])));
  }
  return seconds_of([&] {
    Tree tree(faces(surface).first, faces(surface).second, surface);
    tree.build();
    tree.accelerate_distance_queries();
  });
}

}  // namespace graspfit::testing
