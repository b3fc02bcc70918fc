#include "graspfit/geometry/mass_properties.hpp"

#include <algorithm>
#include <cmath>

#include "graspfit/base/disjoint_sets.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "mesh/input_check.hpp"
#include "query/overlapping_boxes.hpp"
#include "solid/mesh_edges.hpp"

namespace graspfit::geometry {
namespace {

// Sums over the tetrahedra (apex, a, b, c) with vectors from the apex:
//   volume       1/6 det(a, b, c)
//   ∫ x dV       volume/4 (a + b + c)
//   ∫ x xᵀ dV    volume/20 (s sᵀ + a aᵀ + b bᵀ + c cᵀ),  s = a + b + c
struct Moments {
  Eigen::Vector3d apex = Eigen::Vector3d::Zero();
  double volume = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

Moments moments(const TriangleMesh& mesh) {
  Moments m;
  if (mesh.faces.empty()) return m;
  m.apex = mesh.vertices[mesh.faces[0][0]];
  for (const Face& f : mesh.faces) {
    const Eigen::Vector3d a = mesh.vertices[f[0]] - m.apex;
    const Eigen::Vector3d b = mesh.vertices[f[1]] - m.apex;
    const Eigen::Vector3d c = mesh.vertices[f[2]] - m.apex;
    const double volume = a.cross(b).dot(c) / 6.0;
    const Eigen::Vector3d s = a + b + c;
    m.volume += volume;
    m.first += volume / 4.0 * s;
    m.second += volume / 20.0 *
                (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  return m;
}

/// Whether the boxes of any two parts meet. Exact, about the cost of the sums.
bool has_parts_that_may_overlap(const TriangleMesh& mesh) {
  base::DisjointSets vertices(mesh.vertices.size());
  for (const Face& face : mesh.faces) {
    vertices.unite(face[0], face[1]);
    vertices.unite(face[1], face[2]);
  }
  if (!mesh.faces.empty()) {
    const std::int32_t only = vertices.root(mesh.faces[0][0]);
    if (std::all_of(mesh.faces.begin(), mesh.faces.end(),
                    [&](const Face& face) { return vertices.root(face[0]) == only; })) {
      return false;
    }
  }
  const std::vector<std::int32_t> set_of_vertex = vertices.numbered();
  std::int32_t num_sets = 0;
  for (const std::int32_t set : set_of_vertex) num_sets = std::max(num_sets, set + 1);
  std::vector<std::int32_t> parts;
  parts.reserve(mesh.faces.size());
  for (const Face& face : mesh.faces) parts.push_back(set_of_vertex[face[0]]);
  return internal::do_boxes_overlap(internal::boxes_of_parts(mesh, parts, num_sets));
}

}  // namespace

double signed_volume(const TriangleMesh& mesh) {
  double volume = 0.0;
  if (mesh.faces.empty()) return volume;
  const Eigen::Vector3d apex = mesh.vertices[mesh.faces[0][0]];
  for (const Face& f : mesh.faces) {
    volume += (mesh.vertices[f[0]] - apex)
                  .cross(mesh.vertices[f[1]] - apex)
                  .dot(mesh.vertices[f[2]] - apex);
  }
  return volume / 6.0;
}

MassProperties mass_properties(const TriangleMesh& mesh) {
  internal::require_usable(mesh, "mass_properties");
  const bool may_overlap = has_parts_that_may_overlap(mesh) && internal::bounds_solid(mesh);
  const Moments m = moments(may_overlap ? solid_boundary(mesh) : mesh);
  if (!(m.volume > 0.0)) {
    throw base::DegenerateGeometry("mass_properties: the volume is " +
                                   base::shortest_decimal(m.volume) +
                                   " m^3; a closed mesh with outward faces is needed");
  }
  const Eigen::Vector3d center = m.first / m.volume;
  const Eigen::Matrix3d covariance = m.second - m.volume * center * center.transpose();
  MassProperties properties;
  properties.volume = m.volume;
  properties.center_of_mass = m.apex + center;
  properties.method = may_overlap ? MassMethod::SolidBoundary : MassMethod::SignedSum;
  properties.inertia = covariance.trace() * Eigen::Matrix3d::Identity() - covariance;
  return properties;
}

double largest_radius(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double squared = 0.0;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    squared = std::max(squared, (vertex - point).squaredNorm());
  }
  return std::sqrt(squared);
}

}  // namespace graspfit::geometry
