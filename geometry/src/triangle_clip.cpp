#include "internal/triangle_clip.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "internal/exact_number.hpp"

namespace graspfit::geometry::internal {
namespace {

constexpr double kEps = 0x1p-53;  // Half an ulp of 1.

// A line's values carry at most 5 kEps of its sizes (three products, three additions; one
// subtraction for axis-aligned planes), two factors and their difference 12 kEps of h_size, a third
// factor and the sum 20 kEps of the product; the sizes themselves are rounded. 32 covers it with
// room.
constexpr double kSignBound = 32.0 * kEps;

// h / (h0 + h1 + h2) is off by at most this times sum(h_size) / (h0 + h1 + h2).
constexpr double kLambdaBound = 32.0 * kEps;
constexpr double kLambdaTolerance = 0x1p-44;

// Products of three numbers below this may have lost bits to underflow.
constexpr double kLeastProduct = 0x1p-900;

// The bound in the wider type, in the same proportion.
constexpr double kLongLambdaBound =
    16.0 * static_cast<double>(std::numeric_limits<long double>::epsilon());

template <typename Number>
std::array<Number, 3> cross(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {Number(a[1] * b[2] - a[2] * b[1]), Number(a[2] * b[0] - a[0] * b[2]),
          Number(a[0] * b[1] - a[1] * b[0])};
}

}  // namespace

void TriangleCutter::reset(const std::array<Eigen::Vector3d, 3>& corners) {
  vertices_ = corners;
  edge_1_ = corners[1] - corners[0];
  edge_2_ = corners[2] - corners[0];
  lines_.clear();
  for (int i = 0; i < 3; ++i) {
    Line line;
    line.value = {0.0, 0.0, 0.0};
    line.value[i] = 1.0;
    line.size = line.value;
    line.vertex = i;
    lines_.push_back(line);
  }
}

void TriangleCutter::whole(CutPolygon& polygon) const {
  polygon.clear();
  for (std::uint32_t i = 0; i < 3; ++i) {
    CutCorner corner;
    corner.line_a = (i + 1) % 3;
    corner.line_b = (i + 2) % 3;
    corner.edge = (i + 2) % 3;
    corner.h = {0.0, 0.0, 0.0};
    corner.h[i] = 1.0;
    corner.h_size = corner.h;
    corner.lambda_1 = corner.h[1];
    corner.lambda_2 = corner.h[2];
    corner.point = vertices_[i];
    polygon.push_back(corner);
  }
}

std::uint32_t TriangleCutter::add_plane(const Eigen::Vector3d& normal, double offset) {
  Line line;
  for (int i = 0; i < 3; ++i) {
    line.value[i] = offset - normal.dot(vertices_[i]);
    line.size[i] = std::abs(offset) + normal.cwiseAbs().dot(vertices_[i].cwiseAbs());
  }
  line.normal = normal;
  line.offset = offset;
  lines_.push_back(line);
  return static_cast<std::uint32_t>(lines_.size() - 1);
}

std::uint32_t TriangleCutter::add_axis_plane(int axis, double coordinate) {
  Line line;
  for (int i = 0; i < 3; ++i) {
    line.value[i] = coordinate - vertices_[i][axis];
    line.size[i] = std::abs(line.value[i]);
  }
  line.normal = Eigen::Vector3d::Unit(axis);
  line.offset = coordinate;
  line.axis = axis;
  lines_.push_back(line);
  return static_cast<std::uint32_t>(lines_.size() - 1);
}

template <typename Number>
std::array<Number, 3> TriangleCutter::exact_line(std::uint32_t name) const {
  const Line& line = lines_[name];
  std::array<Number, 3> result;
  for (int i = 0; i < 3; ++i) {
    if (line.vertex >= 0) {
      result[i] = Number(i == line.vertex ? 1 : 0);
    } else if (line.axis >= 0) {
      result[i] = Number(line.offset) - Number(vertices_[i][line.axis]);
    } else {
      Number value(line.offset);
      for (int k = 0; k < 3; ++k) value -= Number(line.normal[k]) * Number(vertices_[i][k]);
      result[i] = value;
    }
  }
  return result;
}

template <typename Number>
std::array<Number, 3> TriangleCutter::exact_corner(std::uint32_t a, std::uint32_t b) const {
  return cross(exact_line<Number>(a), exact_line<Number>(b));
}

[[gnu::cold, gnu::noinline]] int TriangleCutter::exact_sign_at(const CutCorner& corner,
                                                               std::uint32_t name) const {
  const auto h = exact_corner<Rational>(corner.line_a, corner.line_b);
  const auto line = exact_line<Rational>(name);
  return sign_of(h[0] * line[0] + h[1] * line[1] + h[2] * line[2]);
}

int TriangleCutter::sign_at(const CutCorner& corner, std::uint32_t name) {
  // The line's own corners are on it: duplicated planes would otherwise ask for an exact zero.
  if (corner.line_a == name || corner.line_b == name) return 0;
  const Line& line = lines_[name];
  ++counters_.signs;
  if (corner.line_b < 3 && corner.line_a < 3 && line.axis >= 0) {
    // A difference of two doubles has the right sign, however it is rounded.
    const double value = line.value[3 - corner.line_a - corner.line_b];
    return (value > 0.0) - (value < 0.0);
  }
  double value = 0.0;
  double size = 0.0;
  for (int i = 0; i < 3; ++i) {
    value += corner.h[i] * line.value[i];
    size += corner.h_size[i] * line.size[i];
  }
  if (std::abs(value) > kSignBound * size && size > kLeastProduct && size < 0x1p1000) {
    return value > 0.0 ? 1 : -1;
  }
  ++counters_.exact_signs;
  return exact_sign_at(corner, name);
}

CutCorner TriangleCutter::meet(std::uint32_t a, bool a_is_turned, std::uint32_t b,
                               bool b_is_turned) {
  // Counter-clockwise consecutive lines, each with the polygon on its positive side, have
  // h0 + h1 + h2 > 0; turning one of them changes the sign, exchanging the two changes it back.
  CutCorner corner;
  corner.line_a = a_is_turned != b_is_turned ? b : a;
  corner.line_b = a_is_turned != b_is_turned ? a : b;
  const Line& p = lines_[corner.line_a];
  const Line& q = lines_[corner.line_b];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    corner.h[i] = p.value[j] * q.value[k] - p.value[k] * q.value[j];
    corner.h_size[i] = p.size[j] * q.size[k] + p.size[k] * q.size[j];
  }
  place(corner);
  return corner;
}

void TriangleCutter::place(CutCorner& corner) {
  ++counters_.corners;
  const double sum = corner.h[0] + corner.h[1] + corner.h[2];
  const double size = corner.h_size[0] + corner.h_size[1] + corner.h_size[2];
  if (kLambdaBound * size <= kLambdaTolerance * sum && size > kLeastProduct && size < 0x1p1000) {
    corner.lambda_1 = corner.h[1] / sum;
    corner.lambda_2 = corner.h[2] / sum;
  } else if (kLongLambdaBound * size <= kLambdaTolerance * sum && size > kLeastProduct &&
             size < 0x1p1000) {
    const auto h = exact_corner<long double>(corner.line_a, corner.line_b);
    const long double long_sum = h[0] + h[1] + h[2];
    corner.lambda_1 = static_cast<double>(h[1] / long_sum);
    corner.lambda_2 = static_cast<double>(h[2] / long_sum);
  } else {
    ++counters_.exact_coordinates;
    place_exactly(corner);
  }
  corner.point = vertices_[0] + corner.lambda_1 * edge_1_ + corner.lambda_2 * edge_2_;
  for (const std::uint32_t name : {corner.line_a, corner.line_b}) {
    const Line& line = lines_[name];
    if (line.axis >= 0) corner.point[line.axis] = line.offset;
  }
}

[[gnu::cold, gnu::noinline]] void TriangleCutter::place_exactly(CutCorner& corner) const {
  const auto h = exact_corner<Rational>(corner.line_a, corner.line_b);
  const Rational sum = h[0] + h[1] + h[2];
  assert(sign_of(sum) > 0);
  corner.lambda_1 = CGAL::to_double(h[1] / sum);
  corner.lambda_2 = CGAL::to_double(h[2] / sum);
}

void TriangleCutter::split(const CutPolygon& polygon, std::uint32_t line, InPlane in_plane,
                           CutPolygon& inside, CutPolygon* outside) {
  inside.clear();
  if (outside != nullptr) outside->clear();
  const std::size_t n = polygon.size();
  signs_.resize(n);
  bool any_inside = false;
  bool any_outside = false;
  for (std::size_t i = 0; i < n; ++i) {
    signs_[i] = sign_at(polygon[i], line);
    any_inside |= signs_[i] > 0;
    any_outside |= signs_[i] < 0;
  }
  if (!any_outside && (any_inside || in_plane == InPlane::Inside)) {
    inside = polygon;
    return;
  }
  if (!any_inside) {
    if (outside != nullptr) *outside = polygon;
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const CutCorner& corner = polygon[i];
    const int sign = signs_[i];
    const int next = signs_[i + 1 < n ? i + 1 : 0];
    if (sign >= 0) {
      inside.push_back(corner);
      if (sign == 0 && next < 0) {
        inside.back().edge = line;
        inside.back().edge_is_turned = false;
      }
    }
    if (sign <= 0 && outside != nullptr) {
      outside->push_back(corner);
      if (sign == 0 && next > 0) {
        outside->back().edge = line;
        outside->back().edge_is_turned = true;
      }
    }
    if (sign * next >= 0) continue;
    // The edge leaves (+ to −) or enters; seen from the inside, the new line comes after the edge
    // or before it.
    const bool leaves = sign > 0;
    CutCorner cut = leaves ? meet(corner.edge, corner.edge_is_turned, line, false)
                           : meet(line, false, corner.edge, corner.edge_is_turned);
    cut.edge = leaves ? line : corner.edge;
    cut.edge_is_turned = leaves ? false : corner.edge_is_turned;
    inside.push_back(cut);
    if (outside != nullptr) {
      cut.edge = leaves ? corner.edge : line;
      cut.edge_is_turned = leaves ? corner.edge_is_turned : true;
      outside->push_back(cut);
    }
  }
}

CutMeasure TriangleCutter::measure(const CutPolygon& polygon) const {
  // The triangle has area 1/2 in the plane of (λ1, λ2), so that twice an area there is the
  // fraction.
  CutMeasure result;
  const CutCorner& first = polygon.front();
  double sum_1 = 0.0;
  double sum_2 = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const double p1 = polygon[i - 1].lambda_1 - first.lambda_1;
    const double p2 = polygon[i - 1].lambda_2 - first.lambda_2;
    const double q1 = polygon[i].lambda_1 - first.lambda_1;
    const double q2 = polygon[i].lambda_2 - first.lambda_2;
    const double doubled = p1 * q2 - p2 * q1;
    result.fraction += doubled;
    sum_1 += doubled * (p1 + q1);
    sum_2 += doubled * (p2 + q2);
  }
  double lambda_1 = 0.0;
  double lambda_2 = 0.0;
  // Rounded corners bound an area that is off by about as much as they are; far above that, the
  // weights are good.
  if (result.fraction > 64.0 * kLambdaTolerance) {
    lambda_1 = first.lambda_1 + sum_1 / (3.0 * result.fraction);
    lambda_2 = first.lambda_2 + sum_2 / (3.0 * result.fraction);
  } else {
    result.fraction = exact_fraction(polygon);
    for (const CutCorner& corner : polygon) {
      lambda_1 += corner.lambda_1 / static_cast<double>(polygon.size());
      lambda_2 += corner.lambda_2 / static_cast<double>(polygon.size());
    }
  }
  result.centroid = vertices_[0] + lambda_1 * edge_1_ + lambda_2 * edge_2_;
  return result;
}

[[gnu::cold, gnu::noinline]] double TriangleCutter::exact_fraction(
    const CutPolygon& polygon) const {
  std::vector<std::array<Rational, 2>> places;
  for (const CutCorner& corner : polygon) {
    const auto h = exact_corner<Rational>(corner.line_a, corner.line_b);
    const Rational sum = h[0] + h[1] + h[2];
    places.push_back({h[1] / sum, h[2] / sum});
  }
  Rational fraction(0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& p = places[i];
    const auto& q = places[(i + 1) % places.size()];
    fraction += p[0] * q[1] - p[1] * q[0];
  }
  assert(sign_of(fraction) > 0);
  return std::max(CGAL::to_double(fraction), std::numeric_limits<double>::min());
}

}  // namespace graspfit::geometry::internal
