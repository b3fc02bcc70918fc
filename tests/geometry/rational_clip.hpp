#pragma once

#include <CGAL/Gmpq.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/voxel_grid.hpp"

/// \file
/// The oracles of clipping, in rational arithmetic: a polygon clipped straight from the definition,
/// and the exact position of a corner whose origin is known.

namespace graspfit::testing {

using Rational = CGAL::Gmpq;
using RationalPoint = std::array<Rational, 3>;
using Triangle = std::array<Eigen::Vector3d, 3>;

inline RationalPoint exactly(const Eigen::Vector3d& p) {
  return {Rational(p[0]), Rational(p[1]), Rational(p[2])};
}

inline Rational dot(const RationalPoint& a, const RationalPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline RationalPoint minus(const RationalPoint& a, const RationalPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline RationalPoint cross(const RationalPoint& a, const RationalPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns twice the vector area of a plane polygon.
inline RationalPoint doubled_vector_area(const std::vector<RationalPoint>& polygon) {
  RationalPoint sum = {0, 0, 0};
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const RationalPoint part =
        cross(minus(polygon[i - 1], polygon[0]), minus(polygon[i], polygon[0]));
    for (int axis = 0; axis < 3; ++axis) sum[axis] += part[axis];
  }
  return sum;
}

/// Returns the length of the difference between a rounded point and an exact one, rounded.
inline double distance(const Eigen::Vector3d& rounded, const RationalPoint& exact) {
  Eigen::Vector3d off;
  for (int axis = 0; axis < 3; ++axis) {
    off[axis] = CGAL::to_double(exact[axis] - Rational(rounded[axis]));
  }
  return off.norm();
}

/// A triangle clipped by closed half-spaces in rational arithmetic, straight from the definition.
/// It is the oracle of the filtered clipper, with which it shares no code and no idea (points in
/// space here, lines in barycentric coordinates there).
class RationalPolygon {
 public:
  explicit RationalPolygon(const Triangle& triangle) {
    for (const Eigen::Vector3d& p : triangle) corners_.push_back(exactly(p));
    whole_ = doubled_vector_area(corners_);
  }

  /// Keeps what has normal · p ≤ offset.
  void clip(const RationalPoint& normal, const Rational& offset) {
    std::vector<RationalPoint> kept;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const RationalPoint& p = corners_[i];
      const RationalPoint& q = corners_[(i + 1) % corners_.size()];
      const Rational fp = dot(normal, p) - offset;
      const Rational fq = dot(normal, q) - offset;
      if (fp <= 0) kept.push_back(p);
      if ((fp < 0 && fq > 0) || (fp > 0 && fq < 0)) {
        const Rational t = fp / (fp - fq);
        kept.push_back(
            {p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])});
      }
    }
    corners_ = kept;
  }

  void clip(const Eigen::Vector3d& normal, double offset) {
    clip(exactly(normal), Rational(offset));
  }

  /// Keeps lower ≤ p[axis] ≤ upper.
  void clip_slab(int axis, double lower, double upper) {
    RationalPoint normal = {0, 0, 0};
    normal[axis] = 1;
    clip(normal, Rational(upper));
    normal[axis] = -1;
    clip(normal, -Rational(lower));
  }

  bool has_area() const {
    const RationalPoint area = doubled_vector_area(corners_);
    return area[0] != 0 || area[1] != 0 || area[2] != 0;
  }

  /// Returns the exact part of the triangle's area; the vector areas are parallel.
  Rational fraction() const {
    const RationalPoint area = doubled_vector_area(corners_);
    for (int axis = 0; axis < 3; ++axis) {
      if (whole_[axis] != 0) return area[axis] / whole_[axis];
    }
    return 0;
  }

  /// Returns whether all of it lies in p[axis] = coordinate.
  bool is_in_plane(int axis, double coordinate) const {
    for (const RationalPoint& p : corners_) {
      if (p[axis] != Rational(coordinate)) return false;
    }
    return true;
  }

  const std::vector<RationalPoint>& corners() const { return corners_; }

 private:
  std::vector<RationalPoint> corners_;
  RationalPoint whole_;  // Twice the triangle's vector area.
};

/// Returns the exact part of each triangle in each voxel by the tie rule, from the definition:
/// every voxel by itself.
inline std::map<std::pair<std::int64_t, std::int32_t>, Rational> voxel_fractions(
    const geometry::TriangleMesh& mesh, const geometry::VoxelLattice& lattice) {
  std::map<std::pair<std::int64_t, std::int32_t>, Rational> result;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const Triangle triangle = geometry::corners(mesh, face);
    const Eigen::Vector3d low = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
    const Eigen::Vector3d high = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
    const RationalPolygon whole(triangle);
    if (!whole.has_area()) continue;
    for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
      const Eigen::Vector3i voxel = lattice.voxel(index);
      bool is_here = true;
      for (int axis = 0; axis < 3 && is_here; ++axis) {
        const double lower = lattice.plane(axis, voxel[axis]);
        const double upper = lattice.plane(axis, voxel[axis] + 1);
        is_here = low[axis] <= upper && high[axis] >= lower && !whole.is_in_plane(axis, upper);
      }
      RationalPolygon piece = whole;
      for (int axis = 0; axis < 3 && is_here; ++axis) {
        piece.clip_slab(axis, lattice.plane(axis, voxel[axis]),
                        lattice.plane(axis, voxel[axis] + 1));
        is_here = piece.has_area();
      }
      if (is_here) result[{index, static_cast<std::int32_t>(face)}] = piece.fraction();
    }
  }
  return result;
}

/// The plane normal · p = offset.
struct RationalPlane {
  RationalPoint normal;
  Rational offset;
};

/// The name of a plane that cut a triangle.
struct CuttingPlane {
  int axis = -1;  ///< 0…2: the plane `VoxelLattice::plane(axis, index)`. −1: of a ConvexVolume.
  int index = -1;  ///< Of the lattice's plane, or of the half-space in its volume.
};

/// Where a corner of a piece comes from: all that is needed to compute its exact position.
struct CornerOrigin {
  enum class Kind {
    Vertex,        ///< The triangle's corner `vertex`.
    EdgeAndPlane,  ///< Edge `edge` and `planes[0]`.
    TwoPlanes,     ///< The triangle's plane and both `planes`, which are not parallel in it.
  };
  Kind kind = Kind::Vertex;
  int vertex = -1;                     ///< 0…2.
  int edge = -1;                       ///< 0…2: from corner `edge` to the next.
  std::array<CuttingPlane, 2> planes;  ///< In the order in which they cut.
};

/// A function that returns planes by the names that origins use.
using PlaneOf = std::function<RationalPlane(const CuttingPlane&)>;

inline PlaneOf planes_of(const geometry::VoxelLattice& lattice) {
  return [&lattice](const CuttingPlane& plane) {
    return RationalPlane{exactly(Eigen::Vector3d::Unit(plane.axis)),
                         Rational(lattice.plane(plane.axis, plane.index))};
  };
}

inline PlaneOf planes_of(const geometry::ConvexVolume& volume) {
  return [&volume](const CuttingPlane& plane) {
    const geometry::HalfSpace& half_space = volume.at(static_cast<std::size_t>(plane.index));
    return RationalPlane{exactly(half_space.normal), Rational(half_space.offset)};
  };
}

/// Returns the exact position of a corner: on the segment where an edge meets a plane, or by
/// Cramer's rule where the triangle's plane meets two.
inline RationalPoint exact_place(const CornerOrigin& origin, const Triangle& triangle,
                                 const PlaneOf& plane_of) {
  using Kind = CornerOrigin::Kind;
  if (origin.kind == Kind::Vertex) return exactly(triangle.at(origin.vertex));
  const RationalPlane first = plane_of(origin.planes[0]);
  if (origin.kind == Kind::EdgeAndPlane) {
    const RationalPoint p = exactly(triangle.at(origin.edge));
    const RationalPoint q = exactly(triangle.at((origin.edge + 1) % 3));
    const Rational fp = dot(first.normal, p) - first.offset;
    const Rational fq = dot(first.normal, q) - first.offset;
    const Rational t = fp / (fp - fq);
    return {p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])};
  }
  const RationalPlane second = plane_of(origin.planes[1]);
  const RationalPoint a = exactly(triangle[0]);
  const RationalPoint normal =
      cross(minus(exactly(triangle[1]), a), minus(exactly(triangle[2]), a));
  const RationalPoint direction = cross(first.normal, second.normal);
  const RationalPoint from_first = cross(second.normal, normal);
  const RationalPoint from_second = cross(normal, first.normal);
  const Rational offset = dot(normal, a);
  const Rational scale = dot(normal, direction);
  RationalPoint place;
  for (int axis = 0; axis < 3; ++axis) {
    place[axis] = (offset * direction[axis] + first.offset * from_first[axis] +
                   second.offset * from_second[axis]) /
                  scale;
  }
  return place;
}

/// Returns the exact positions of a piece's corners.
inline std::vector<RationalPoint> exact_places(const std::vector<CornerOrigin>& origins,
                                               const Triangle& triangle, const PlaneOf& plane_of) {
  std::vector<RationalPoint> places;
  for (const auto& origin : origins) places.push_back(exact_place(origin, triangle, plane_of));
  return places;
}

/// Returns the bound that `clip` states for a corner.
inline double corner_bound(const Triangle& triangle) {
  double edge = 0.0;
  double size = 0.0;
  for (int i = 0; i < 3; ++i) {
    edge = std::max(edge, (triangle[(i + 1) % 3] - triangle[i]).norm());
    size = std::max(size, triangle[i].cwiseAbs().maxCoeff());
  }
  return 0x1p-42 * edge + 2.0 * (std::nextafter(size, 2.0 * size) - size);
}

}  // namespace graspfit::testing
