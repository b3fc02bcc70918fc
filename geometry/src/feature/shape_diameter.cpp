#include "graspfit/geometry/shape_diameter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/base/parallel_for.hpp"
#include "query/box_tree.hpp"
#include "query/indexed_mesh.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;

// Directions around +z, evenly spread over the cap of the cone: a spiral of equal steps in z with
// the golden angle between neighbors [Vogel 1979, on a sphere].
std::vector<Vector3d> cone_of_rays(const ShapeDiameterOptions& options) {
  const double lowest = std::cos(0.5 * options.cone_angle_deg * std::numbers::pi / 180.0);
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Vector3d> rays;
  for (int i = 0; i < options.num_rays; ++i) {
    const double z = 1.0 - (1.0 - lowest) * (i + 0.5) / options.num_rays;
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    rays.emplace_back(r * std::cos(golden_angle * i), r * std::sin(golden_angle * i), z);
  }
  return rays;
}

// Two unit vectors that complete the unit vector z to a right-handed frame [Duff et al. 2017].
Eigen::Matrix3d frame_around(const Vector3d& z) {
  const double sign = std::copysign(1.0, z[2]);
  const double a = -1.0 / (sign + z[2]);
  const double b = z[0] * z[1] * a;
  Eigen::Matrix3d frame;
  frame.col(0) = Vector3d(1.0 + sign * z[0] * z[0] * a, sign * b, -sign * z[0]);
  frame.col(1) = Vector3d(b, sign + z[1] * z[1] * a, -z[1]);
  frame.col(2) = z;
  return frame;
}

// Mean of the lengths within some standard deviations of their median; sorts them.
double trimmed_mean(std::vector<double>& lengths, double deviations) {
  std::sort(lengths.begin(), lengths.end());
  const std::size_t n = lengths.size();
  const double median = 0.5 * (lengths[(n - 1) / 2] + lengths[n / 2]);
  double mean = 0.0;
  for (const double length : lengths) mean += length / static_cast<double>(n);
  double variance = 0.0;
  for (const double length : lengths) variance += (length - mean) * (length - mean);
  const double reach = deviations * std::sqrt(variance / static_cast<double>(n));
  double sum = 0.0;
  int count = 0;
  for (const double length : lengths) {
    if (std::abs(length - median) > reach) continue;
    sum += length;
    ++count;
  }
  // Between two clusters there may be no length near the median.
  return count > 0 ? sum / count : median;
}

}  // namespace

void ShapeDiameterOptions::validate() const {
  const char* const where = "ShapeDiameterOptions";
  base::require_between(1, 10000, where, "num_rays", num_rays);
  base::require(cone_angle_deg >= 0.0 && cone_angle_deg <= 179.0, where, "cone_angle_deg",
                cone_angle_deg, "in [0, 179] degrees");
  base::require(trim_deviations > 0.0, where, "trim_deviations", trim_deviations, "> 0");
  base::require(num_threads >= 0, where, "num_threads", num_threads, ">= 0");
}

ShapeDiameter shape_diameter(const MeshQuery& mesh, const ShapeDiameterOptions& options) {
  // In the order of the tree's leaves: rays of neighbors run through the same memory.
  std::vector<std::int32_t> faces;
  for (const auto& triangle : mesh.indexed().tree.triangles) faces.push_back(triangle.face);
  const ShapeDiameter in_order = shape_diameter(mesh, faces, options);
  ShapeDiameter result{std::vector<double>(faces.size()), std::vector<std::int32_t>(faces.size())};
  for (std::size_t i = 0; i < faces.size(); ++i) {
    result.thickness[faces[i]] = in_order.thickness[i];
    result.num_hits[faces[i]] = in_order.num_hits[i];
  }
  return result;
}

ShapeDiameter shape_diameter(const MeshQuery& mesh, std::span<const std::int32_t> faces,
                             const ShapeDiameterOptions& options) {
  options.validate();
  const std::size_t num_faces = mesh.mesh().faces.size();
  for (const std::int32_t face : faces) {
    if (face < 0 || static_cast<std::size_t>(face) >= num_faces) {
      throw base::InvalidInput("shape_diameter: face " + std::to_string(face) + " of " +
                               std::to_string(num_faces));
    }
  }
  const internal::BoxTree& tree = mesh.indexed().tree;
  const std::vector<Vector3d> rays = cone_of_rays(options);
  std::vector<Vector3d> normals(num_faces);
  for (std::size_t face = 0; face < num_faces; ++face) {
    normals[face] = face_normal(mesh.mesh(), face);
  }
  ShapeDiameter result{std::vector<double>(faces.size(), std::numeric_limits<double>::infinity()),
                       std::vector<std::int32_t>(faces.size(), 0)};
  base::parallel_for(faces.size(), options.num_threads, [&](std::size_t i) {
    const std::int32_t face = faces[i];
    const Vector3d& normal = normals[face];
    if (normal.isZero()) return;
    const auto [a, b, c] = corners(mesh.mesh(), face);
    const Vector3d centroid = (a + b + c) / 3.0;
    const Eigen::Matrix3d frame = frame_around(-normal);
    std::vector<double> lengths;
    lengths.reserve(rays.size());
    for (const Vector3d& ray : rays) {
      const internal::QuickHit hit = internal::quick_first_hit(tree, centroid, frame * ray, face);
      if (hit.triangle < 0) continue;
      if (normals[tree.triangles[hit.triangle].face].dot(normal) >= 0.0) continue;
      lengths.push_back(hit.t);
    }
    if (lengths.empty()) return;
    result.num_hits[i] = static_cast<std::int32_t>(lengths.size());
    result.thickness[i] = trimmed_mean(lengths, options.trim_deviations);
  });
  return result;
}

}  // namespace graspfit::geometry
