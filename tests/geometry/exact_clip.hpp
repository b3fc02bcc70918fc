#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/voxel_grid.hpp"

/// \file
/// Clipping in rational numbers, for those who need a result without any rounding: a proof, a
/// reference, an identity that must hold exactly. Points in space are cut plane by plane, straight
/// from the definition; it shares no code with `clip`, whose results it can therefore check.
///
/// Everything here is exact, and costs about a thousand times what `clip` costs.

namespace graspfit::geometry {

/// An exact rational number, as a value. The exact kernel's own number stays hidden, so that those
/// who use this header need none of its headers or libraries.
class ExactRational {
 public:
  ExactRational();              ///< Zero.
  ExactRational(double value);  ///< Exactly `value`. @throws InvalidInput if it is not finite.
  // A number is copied where others are moved, so that none is ever left without its value.
  ExactRational(const ExactRational&) = default;
  ExactRational& operator=(const ExactRational&) = default;

  double to_double() const;         ///< A double next to it: off by at most one ulp.
  int sign() const;                 ///< −1, 0 or 1.
  std::string numerator() const;    ///< Decimal, with its sign; lowest terms.
  std::string denominator() const;  ///< Decimal, > 0.
  std::string to_string() const;    ///< "numerator/denominator", or "numerator" alone if whole.

  ExactRational operator-() const;
  ExactRational& operator+=(const ExactRational& other);
  ExactRational& operator-=(const ExactRational& other);
  ExactRational& operator*=(const ExactRational& other);
  ExactRational& operator/=(const ExactRational& other);  ///< @throws InvalidInput by zero.

  friend ExactRational operator+(ExactRational a, const ExactRational& b) { return a += b; }
  friend ExactRational operator-(ExactRational a, const ExactRational& b) { return a -= b; }
  friend ExactRational operator*(ExactRational a, const ExactRational& b) { return a *= b; }
  friend ExactRational operator/(ExactRational a, const ExactRational& b) { return a /= b; }
  friend bool operator==(const ExactRational& a, const ExactRational& b);
  friend std::strong_ordering operator<=>(const ExactRational& a, const ExactRational& b);

 private:
  struct Number;
  explicit ExactRational(std::shared_ptr<const Number> number) : number_(std::move(number)) {}
  std::shared_ptr<const Number> number_;  // It is never null and never changed.
};

/// A point or vector with exact coordinates [m], [m²] or [m³].
using ExactVector3 = std::array<ExactRational, 3>;

/// Returns the nearest doubles, or nearly (see `ExactRational::to_double`).
Eigen::Vector3d to_double(const ExactVector3& exact);

/// A piece of a triangle, without rounding.
struct ExactPiece {
  std::vector<ExactVector3> polygon;  ///< Corners in the order of the triangle, all different.
  ExactVector3 vector_area;           ///< Along the triangle's normal, as long as the area [m²].
  ExactVector3 centroid;              ///< Area centroid [m].
};

/// Returns the part of a triangle inside `volume`, with the outcomes of `clip`: none without area,
/// half-spaces closed. It is exact. @throws InvalidInput if a corner or a half-space is not finite.
std::optional<ExactPiece> exact_clip(const std::array<Eigen::Vector3d, 3>& triangle,
                                     const ConvexVolume& volume);

/// The part of a triangle inside one voxel.
struct ExactVoxelPiece {
  std::int64_t voxel = -1;
  ExactPiece piece;
};

/// Returns the pieces of a triangle in all voxels of a lattice, ascending by voxel, by the tie rule
/// of `SurfacePatch`. They are exact. @throws InvalidInput if the lattice is empty or the triangle
/// leaves it.
std::vector<ExactVoxelPiece> exact_clip_by_voxels(const std::array<Eigen::Vector3d, 3>& triangle,
                                                  const VoxelLattice& lattice);

}  // namespace graspfit::geometry
