#include "geometry/exact_clip.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "exact/exact_number.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::geometry {

struct ExactRational::Number {
  internal::Rational value;
};

ExactRational::ExactRational() : ExactRational(0.0) {}

ExactRational::ExactRational(double value) {
  if (!std::isfinite(value)) throw base::InvalidInput("ExactRational: the value is not finite");
  number_ = std::make_shared<const Number>(Number{internal::Rational(value)});
}

double ExactRational::to_double() const { return CGAL::to_double(number_->value); }

int ExactRational::sign() const { return internal::sign_of(number_->value); }

std::string ExactRational::numerator() const {
  std::ostringstream text;
  text << number_->value.numerator();
  return text.str();
}

std::string ExactRational::denominator() const {
  std::ostringstream text;
  text << number_->value.denominator();
  return text.str();
}

std::string ExactRational::to_string() const {
  const std::string below = denominator();
  return below == "1" ? numerator() : numerator() + "/" + below;
}

ExactRational ExactRational::operator-() const {
  return ExactRational(std::make_shared<const Number>(Number{-number_->value}));
}

ExactRational& ExactRational::operator+=(const ExactRational& other) {
  number_ = std::make_shared<const Number>(Number{number_->value + other.number_->value});
  return *this;
}

ExactRational& ExactRational::operator-=(const ExactRational& other) {
  number_ = std::make_shared<const Number>(Number{number_->value - other.number_->value});
  return *this;
}

ExactRational& ExactRational::operator*=(const ExactRational& other) {
  number_ = std::make_shared<const Number>(Number{number_->value * other.number_->value});
  return *this;
}

ExactRational& ExactRational::operator/=(const ExactRational& other) {
  if (other.sign() == 0) throw base::InvalidInput("ExactRational: division by zero");
  number_ = std::make_shared<const Number>(Number{number_->value / other.number_->value});
  return *this;
}

bool operator==(const ExactRational& a, const ExactRational& b) {
  return a.number_->value == b.number_->value;
}

std::strong_ordering operator<=>(const ExactRational& a, const ExactRational& b) {
  if (a.number_->value < b.number_->value) return std::strong_ordering::less;
  return a == b ? std::strong_ordering::equal : std::strong_ordering::greater;
}

Eigen::Vector3d to_double(const ExactVector3& exact) {
  return {exact[0].to_double(), exact[1].to_double(), exact[2].to_double()};
}

namespace {

using Polygon = std::vector<ExactVector3>;

ExactVector3 exactly(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

ExactVector3 plus(const ExactVector3& a, const ExactVector3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

ExactVector3 minus(const ExactVector3& a, const ExactVector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

ExactVector3 times(const ExactRational& s, const ExactVector3& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

ExactRational dot(const ExactVector3& a, const ExactVector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

ExactVector3 cross(const ExactVector3& a, const ExactVector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool is_zero(const ExactVector3& a) {
  return a[0].sign() == 0 && a[1].sign() == 0 && a[2].sign() == 0;
}

// Returns the corners with height ≤ 0, and those where edges cross height 0 [Sutherland & Hodgman
// 1974].
template <typename Height>
Polygon cut(const Polygon& polygon, const Height& height) {
  std::vector<ExactRational> heights;
  for (const ExactVector3& corner : polygon) heights.push_back(height(corner));
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    if (heights[i].sign() <= 0) kept.push_back(polygon[i]);
    if (heights[i].sign() * heights[next].sign() < 0) {
      const ExactRational t = heights[i] / (heights[i] - heights[next]);
      kept.push_back(plus(polygon[i], times(t, minus(polygon[next], polygon[i]))));
    }
  }
  return kept;
}

// Returns no value if the polygon has no area.
std::optional<ExactPiece> measured(Polygon polygon) {
  ExactVector3 doubled;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    doubled =
        plus(doubled, cross(minus(polygon[i - 1], polygon[0]), minus(polygon[i], polygon[0])));
  }
  if (is_zero(doubled)) return std::nullopt;
  // All triangles of the fan have vector areas along the same line, so that weights along it are
  // rational.
  const ExactRational whole = dot(doubled, doubled);
  ExactVector3 centroid;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const ExactVector3 p = minus(polygon[i - 1], polygon[0]);
    const ExactVector3 q = minus(polygon[i], polygon[0]);
    const ExactRational weight = dot(cross(p, q), doubled) / (3.0 * whole);
    centroid = plus(centroid, times(weight, plus(p, q)));
  }
  ExactPiece piece;
  piece.vector_area = times(0.5, doubled);
  piece.centroid = plus(polygon[0], centroid);
  piece.polygon = std::move(polygon);
  return piece;
}

Polygon polygon_of(const std::array<Eigen::Vector3d, 3>& triangle) {
  return {exactly(triangle[0]), exactly(triangle[1]), exactly(triangle[2])};
}

struct Range {
  int first = 0;
  int last = -1;
};

// Returns the voxels along an axis in whose closed slab between planes [first, last + 1] the
// polygon has points, by comparing with every plane.
Range cells(const Polygon& polygon, const VoxelLattice& lattice, int axis) {
  const auto [low, high] = std::minmax_element(
      polygon.begin(), polygon.end(),
      [axis](const ExactVector3& a, const ExactVector3& b) { return a[axis] < b[axis]; });
  Range range{lattice.counts[axis], -1};
  for (int i = 0; i < lattice.counts[axis]; ++i) {
    if (ExactRational(lattice.plane(axis, i)) > (*high)[axis] ||
        ExactRational(lattice.plane(axis, i + 1)) < (*low)[axis]) {
      continue;
    }
    range.first = std::min(range.first, i);
    range.last = i;
  }
  return range;
}

bool is_in_plane(const Polygon& polygon, int axis, const ExactRational& coordinate) {
  return std::all_of(polygon.begin(), polygon.end(),
                     [&](const ExactVector3& p) { return p[axis] == coordinate; });
}

}  // namespace

std::optional<ExactPiece> exact_clip(const std::array<Eigen::Vector3d, 3>& triangle,
                                     const ConvexVolume& volume) {
  Polygon polygon = polygon_of(triangle);
  if (!measured(polygon)) return std::nullopt;
  for (const HalfSpace& half_space : volume) {
    const ExactVector3 normal = exactly(half_space.normal);
    const ExactRational offset = half_space.offset;
    polygon = cut(polygon, [&](const ExactVector3& p) { return dot(normal, p) - offset; });
  }
  return measured(std::move(polygon));
}

std::vector<ExactVoxelPiece> exact_clip_by_voxels(const std::array<Eigen::Vector3d, 3>& triangle,
                                                  const VoxelLattice& lattice) {
  if (!(lattice.voxel_size > 0.0) || (lattice.counts.array() < 1).any()) {
    throw base::InvalidInput("exact_clip_by_voxels: the lattice is empty");
  }
  const Polygon whole = polygon_of(triangle);
  std::vector<ExactVoxelPiece> result;
  for (int axis = 0; axis < 3; ++axis) {
    const ExactRational lowest = lattice.plane(axis, 0);
    const ExactRational highest = lattice.plane(axis, lattice.counts[axis]);
    for (const ExactVector3& corner : whole) {
      if (corner[axis] < lowest || corner[axis] > highest ||
          (corner[axis] == highest && is_in_plane(whole, axis, highest))) {
        throw base::InvalidInput("exact_clip_by_voxels: the triangle leaves the lattice");
      }
    }
  }
  if (!measured(whole)) return result;
  const auto slab = [&](const Polygon& polygon, int axis, int i) {
    const ExactRational low = lattice.plane(axis, i);
    const ExactRational high = lattice.plane(axis, i + 1);
    // Of two voxels that share the plane in which it lies, the higher has it.
    if (is_in_plane(polygon, axis, high)) return Polygon();
    const Polygon above = cut(polygon, [&](const ExactVector3& p) { return low - p[axis]; });
    return cut(above, [&](const ExactVector3& p) { return p[axis] - high; });
  };
  const Range z = cells(whole, lattice, 2);
  for (int k = z.first; k <= z.last; ++k) {
    const Polygon layer = slab(whole, 2, k);
    if (layer.size() < 3) continue;
    const Range y = cells(layer, lattice, 1);
    for (int j = y.first; j <= y.last; ++j) {
      const Polygon row = slab(layer, 1, j);
      if (row.size() < 3) continue;
      const Range x = cells(row, lattice, 0);
      for (int i = x.first; i <= x.last; ++i) {
        if (auto piece = measured(slab(row, 0, i))) {
          result.push_back({lattice.index({i, j, k}), std::move(*piece)});
        }
      }
    }
  }
  return result;
}

}  // namespace graspfit::geometry
