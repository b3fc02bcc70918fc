#include "graspfit/geometry/shape_diameter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "feature/shape_diameter.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/base/parallel_for.hpp"
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

/// First face that a ray meets, and the ray parameter t there, in units of the direction.
struct QuickHit {
  std::int32_t face = 0;
  double t = std::numeric_limits<double>::infinity();
};

/// First hit of the ray from `origin` along `direction`, before the parameter `limit`, on any face
/// but `skipped_face`, in plain doubles: for statistics over many rays, not for decisions. Empty:
/// none.
///
/// Approximate: triangles are taken larger by 1e-9 of their size, so that no ray slips between two
/// of them unless they are seen edge-on or are a millionth of the ray's way in size; a triangle
/// seen edge-on is missed, but not its neighbors. Of equal hits the one with the lowest face is
/// returned; for such faces hits within 1e-12 of each other may depend on the tree.
std::optional<QuickHit> quick_first_hit(const internal::FaceTree& tree, const Vector3d& origin,
                                        const Vector3d& direction, std::int32_t skipped_face,
                                        double limit) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Of a triangle's barycentric coordinates, which are off by some 7e-16 |s| |ac| / det.
  constexpr double kMargin = 1e-9;
  // By so much more than the best t a box is entered, so that equally far triangles are all seen.
  constexpr double kSlack = 1.0 + 1e-12;
  const Eigen::Array3d inverse = direction.array().inverse();
  QuickHit best{-1, limit};
  // Where the ray enters a box; infinity if it misses it. A zero direction gives infinite bounds,
  // or NaN in a plane of the box, which the ray then does not leave: no bound.
  const auto entry = [&](const Eigen::AlignedBox3d& box) {
    double t_in = 0.0;
    double t_out = best.t;
    for (int axis = 0; axis < 3; ++axis) {
      const double t0 = (box.min()[axis] - origin[axis]) * inverse[axis];
      const double t1 = (box.max()[axis] - origin[axis]) * inverse[axis];
      if (std::isnan(t0) || std::isnan(t1)) continue;
      const double t_near = t0 < t1 ? t0 : t1;
      const double t_far = t0 < t1 ? t1 : t0;
      t_in = t_near > t_in ? t_near : t_in;
      t_out = t_far < t_out ? t_far : t_out;
    }
    return t_in <= t_out * kSlack ? t_in : kInfinity;
  };
  // A box that is missed is not entered, even where nothing is hit yet.
  const auto farthest = [&] {
    return std::min(best.t * kSlack, std::numeric_limits<double>::max());
  };
  tree.traverse_by_bound(entry, farthest, [&](const internal::IndexedTriangle& triangle) {
    const auto& [corners, face] = triangle;
    if (face == skipped_face) return;
    // [Möller & Trumbore 1997].
    const Vector3d ab = corners[1] - corners[0];
    const Vector3d ac = corners[2] - corners[0];
    const Vector3d h = direction.cross(ac);
    const double signed_det = ab.dot(h);
    if (signed_det == 0.0) return;
    const double sign = signed_det < 0.0 ? -1.0 : 1.0;
    const double det = sign * signed_det;
    const Vector3d s = sign * (origin - corners[0]);
    const double u = s.dot(h);
    if (!(u >= -kMargin * det && u <= (1.0 + kMargin) * det)) return;
    const Vector3d q = s.cross(ab);
    const double v = direction.dot(q);
    if (!(v >= -kMargin * det && u + v <= (1.0 + kMargin) * det)) return;
    const double t = ac.dot(q) / det;
    if (!(t >= 0.0)) return;
    if (t < best.t || (t == best.t && face < best.face)) best = {face, t};
  });
  if (best.face < 0) return std::nullopt;
  return best;
}

/// The rays from the faces of a mesh into what they bound.
class FaceRays {
 public:
  /// @throws InvalidInput for options out of range and faces that are none.
  FaceRays(const MeshQuery& mesh, std::span<const std::int32_t> faces,
           const ShapeDiameterOptions& options)
      : mesh_(mesh.mesh()), tree_(mesh.indexed().tree()), normals_(mesh_.faces.size()) {
    options.validate();
    for (const std::int32_t face : faces) {
      if (face < 0 || std::cmp_greater_equal(face, normals_.size())) {
        throw base::InvalidInput("shape_diameter: face " + std::to_string(face) + " of " +
                                 std::to_string(normals_.size()));
      }
    }
    rays_ = cone_of_rays(options);
    for (std::int32_t face = 0; face < std::ssize(normals_); ++face) {
      normals_[face] = face_normal(mesh_, face);
    }
  }

  /// Calls visit(length) for the rays of a face that meet one which faces it before `limit` [m],
  /// until it says no.
  template <class Visit>
  void visit(std::int32_t face, double limit, const Visit& visit) const {
    const Vector3d& normal = normals_[face];
    if (normal.isZero()) return;
    const auto [a, b, c] = corners(mesh_, face);
    const Vector3d centroid = (a + b + c) / 3.0;
    const Eigen::Matrix3d frame = frame_around(-normal);
    for (const Vector3d& ray : rays_) {
      const std::optional<QuickHit> hit =
          quick_first_hit(tree_, centroid, frame * ray, face, limit);
      if (!hit || normals_[hit->face].dot(normal) >= 0.0) continue;
      if (!visit(hit->t)) return;
    }
  }

 private:
  const TriangleMesh& mesh_;
  const internal::FaceTree& tree_;
  std::vector<Vector3d> normals_;
  std::vector<Vector3d> rays_;
};

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
  mesh.indexed().tree().traverse(
      [](const Eigen::AlignedBox3d&) { return true; },
      [&](const internal::IndexedTriangle& triangle) { faces.push_back(triangle.face); });
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
  const FaceRays rays(mesh, faces, options);
  ShapeDiameter result{std::vector<double>(faces.size(), std::numeric_limits<double>::infinity()),
                       std::vector<std::int32_t>(faces.size(), 0)};
  base::parallel_for(faces.size(), options.num_threads, [&](std::size_t i) {
    std::vector<double> lengths;
    lengths.reserve(options.num_rays);
    rays.visit(faces[i], std::numeric_limits<double>::infinity(), [&](double length) {
      lengths.push_back(length);
      return true;
    });
    if (lengths.empty()) return;
    result.num_hits[i] = base::as_index<std::int32_t>(lengths.size());
    result.thickness[i] = trimmed_mean(lengths, options.trim_deviations);
  });
  return result;
}

std::vector<char> internal::may_be_thinner(const MeshQuery& mesh,
                                           std::span<const std::int32_t> faces, double limit,
                                           const ShapeDiameterOptions& options) {
  // A mean of lengths above the limit may be rounded to below it.
  constexpr double kSlack = 1.0 + 1e-9;
  const FaceRays rays(mesh, faces, options);
  std::vector<char> may_be(faces.size(), 0);
  base::parallel_for(faces.size(), options.num_threads, [&](std::size_t i) {
    rays.visit(faces[i], kSlack * limit, [&](double) {
      may_be[i] = 1;
      return false;
    });
  });
  return may_be;
}

}  // namespace graspfit::geometry
