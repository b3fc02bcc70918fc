// A grasp metric of one's own: how flat is the surface under a fingertip? The surface inside the
// fingertip's volume is cut out exactly; the metric is the root mean square distance of that patch
// from its best-fitting plane, every bit of area counting alike.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/shapes.hpp"

using namespace graspfit::geometry;

struct Planarity {
  double area = 0.0;                                 // Of the patch [m²].
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // Of the best-fitting plane.
  double rms_distance = 0.0;                         // Of the patch from that plane [m].
};

// The fingertip as a box: half-spaces with outward normals. `axes` are its directions in columns.
ConvexVolume fingertip(const Eigen::Vector3d& center, const Eigen::Matrix3d& axes,
                       const Eigen::Vector3d& half_size) {
  ConvexVolume volume;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d n = axes.col(axis);
    volume.push_back({n, n.dot(center) + half_size[axis]});
    volume.push_back({-n, -n.dot(center) + half_size[axis]});
  }
  return volume;
}

Planarity planarity(const MeshQuery& object, const ConvexVolume& volume,
                    const Eigen::AlignedBox3d& box_of_volume) {
  // The tree finds the few faces that can be concerned; clip decides exactly which are.
  const auto pieces = clip(object.mesh(), object.faces_near(box_of_volume), volume);

  // A piece is a convex polygon. Over a triangle with corners a, b, c and area A the integral of
  // x xᵀ is A/12 (aaᵀ + bbᵀ + ccᵀ + ssᵀ), s = a + b + c. Summed about the first corner of the
  // patch, so that no digits are lost far from the origin.
  Planarity result;
  if (pieces.empty()) return result;
  const Eigen::Vector3d origin = pieces.front().polygon.front();
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second_moment = Eigen::Matrix3d::Zero();
  for (const ClippedPiece& piece : pieces) {
    result.area += piece.area;
    first_moment += piece.area * (piece.centroid - origin);
    for (std::size_t i = 2; i < piece.polygon.size(); ++i) {
      const Eigen::Vector3d a = piece.polygon[0] - origin;
      const Eigen::Vector3d b = piece.polygon[i - 1] - origin;
      const Eigen::Vector3d c = piece.polygon[i] - origin;
      const Eigen::Vector3d s = a + b + c;
      const double area = 0.5 * (b - a).cross(c - a).norm();
      second_moment +=
          area / 12 *
          (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
    }
  }
  const Eigen::Vector3d mean = first_moment / result.area;
  const Eigen::Matrix3d covariance = second_moment / result.area - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);  // Smallest first.
  result.normal = axes.eigenvectors().col(0);
  result.rms_distance = std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
  return result;
}

int main() {
  // A fingertip pad of 20 mm by 20 mm that reaches 4 mm deep, from above.
  const Eigen::Vector3d half_size(0.010, 0.010, 0.004);
  const auto under_pad = [&](const TriangleMesh& mesh, double top) {
    const Eigen::Vector3d center(0, 0, top);
    return planarity(MeshQuery(mesh), fingertip(center, Eigen::Matrix3d::Identity(), half_size),
                     Eigen::AlignedBox3d(center - half_size, center + half_size));
  };
  const Planarity flat = under_pad(box({0.06, 0.06, 0.06}), 0.03);
  const Planarity round = under_pad(ball(0.012, 6), 0.012);
  std::printf("flat face: %6.1f mm2, %.4f mm from a plane\n", flat.area * 1e6,
              flat.rms_distance * 1e3);
  std::printf("ball:      %6.1f mm2, %.4f mm from a plane\n", round.area * 1e6,
              round.rms_distance * 1e3);

  // In closed form: nothing for the flat face, whose patch is the whole pad. On a ball of radius r
  // the pad sees the cap of height h = 4 mm, area 2 pi r h; heights on a sphere are distributed
  // evenly (Archimedes), so the cap is h / sqrt(12) from its plane. The ball's edges span 1.2
  // degrees, its faces lie at most 1e-4 r inside the sphere, and the result is off by less than
  // twice as much.
  const double sagitta = 0.012 * 1.0e-4;
  const bool is_right = std::abs(flat.area - 4e-4) < 1e-15 && flat.rms_distance < 1e-9 &&
                        std::abs(round.rms_distance - 0.004 / std::sqrt(12.0)) < 2 * sagitta;
  return is_right ? 0 : 1;
}
