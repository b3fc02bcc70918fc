#include "voxel/triangle_clip.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "exact/exact_number.hpp"

namespace graspfit::geometry::internal {
namespace {

constexpr double kEps = 0x1p-53;  // Half an ulp of 1.

// A line's values are off by at most 4 kEps of its sizes, as each product passes four roundings and
// the offset one; the sizes themselves are rounded.
constexpr double kValueBound = 8.0 * kEps;

// h / (h0 + h1 + h2) is off by at most this times sum(h_size) / (h0 + h1 + h2): with values off by
// 4 kEps, a product and a difference, h is off by 10 kEps of its size and the sum by 12; lambda,
// at most 1, is off by 22 for that and the quotient by 1. The second order is below 1.
constexpr double kLambdaBound = 32.0 * kEps;
constexpr double kLambdaTolerance = 0x1p-44;

// The bound for long double, in the same proportion to its precision. The `sum` that it is compared
// with is that of doubles: where sizes are at most 2^15 of it, it is good to 2^-34. The cast to
// double takes 2^-53, of a tolerance of 2^-44.
constexpr double kLongLambdaBound =
    16.0 * static_cast<double>(std::numeric_limits<long double>::epsilon());

// A coordinate v0 + λ1 e1 + λ2 e2 is off by 2^-43 of the extent for the λ's, by four roundings of
// numbers no larger than the extent, and by two of numbers no larger than the coordinates. The
// slack is twice that, plus a number that no underflow reaches.
constexpr double kExtentSlack = 0x1p-42;
constexpr double kSizeSlack = 0x1p-51;
constexpr double kLeastSlack = 0x1p-1000;

// Products below this may have lost bits to underflow. Over the largest value of a line: a value
// may itself have lost 3 * 2^-1075, a product that times the other line's. Both are below 2^-169
// then.
constexpr double kLeastProduct = 0x1p-900;
constexpr double kGreatestProduct = 0x1p1000;

// Beyond this a difference of coordinates may overflow.
constexpr double kGreatestCoordinate = 0x1p1000;

int sign(double value) { return (value > 0.0) - (value < 0.0); }

template <typename Number>
std::array<Number, 3> cross(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {Number(a[1] * b[2] - a[2] * b[1]), Number(a[2] * b[0] - a[0] * b[2]),
          Number(a[0] * b[1] - a[1] * b[0])};
}

double largest_of(const std::array<double, 3>& values) {
  return std::max({values[0], values[1], values[2]});
}

// |a × b| at most, entry by entry.
std::array<double, 3> cross_size(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]};
}

}  // namespace

TriangleCutter::TriangleCutter() : lines_(3), corners_(3) {
  for (int i = 0; i < 3; ++i) {
    Line& line = lines_[i];
    line.value = {0.0, 0.0, 0.0};
    line.value[i] = 1.0;
    line.size = line.value;
    line.vertex = i;
    CutCorner& corner = corners_[i];
    corner.line_a = static_cast<std::uint32_t>((i + 1) % 3);
    corner.line_b = static_cast<std::uint32_t>((i + 2) % 3);
    corner.exact_axes = 7;
    corner.lambda_1 = i == 1 ? 1.0 : 0.0;
    corner.lambda_2 = i == 2 ? 1.0 : 0.0;
  }
}

void TriangleCutter::reset(const std::array<Eigen::Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  vertices_ = corners;
  edge_1_ = b - a;
  edge_2_ = c - a;
  const Eigen::Vector3d lower = a.cwiseMin(b).cwiseMin(c);
  const Eigen::Vector3d upper = a.cwiseMax(b).cwiseMax(c);
  const Eigen::Vector3d size = lower.cwiseAbs().cwiseMax(upper.cwiseAbs());
  slack_ = (kExtentSlack * (upper - lower) + kSizeSlack * size).array() + kLeastSlack;
  is_huge_ = !(size.maxCoeff() < kGreatestCoordinate);
  lines_.resize(3);
  corners_.resize(3);
  for (int i = 0; i < 3; ++i) corners_[i].point = corners[i];
}

void TriangleCutter::whole(CutPolygon& polygon) const {
  // The edge from corner i to the next is the line of the vertex that is on neither.
  polygon = {{0, 2 * 2}, {1, 2 * 0}, {2, 2 * 1}};
}

std::uint32_t TriangleCutter::add_plane(const Eigen::Vector3d& normal, double offset) {
  Line line;
  for (int i = 0; i < 3; ++i) {
    line.value[i] = offset - normal.dot(vertices_[i]);
    line.size[i] = std::abs(offset) + normal.cwiseAbs().dot(vertices_[i].cwiseAbs());
  }
  line.normal = normal;
  line.offset = offset;
  // A corner is a mean of the vertices, so that |normal| · |point| is at most the largest size, but
  // for |normal| times the point's slack, which is twice what is needed: evaluated there, the plane
  // is off by 4 kEps of 8, and by less underflow than the last term.
  line.slack = normal.cwiseAbs().dot(slack_) + kValueBound * largest_of(line.size) + kLeastSlack;
  lines_.push_back(line);
  return static_cast<std::uint32_t>(lines_.size() - 1);
}

std::uint32_t TriangleCutter::add_axis_plane(int axis, double coordinate) {
  Line& line = lines_.emplace_back();
  for (int i = 0; i < 3; ++i) {
    line.value[i] = coordinate - vertices_[i][axis];
    line.size[i] = std::abs(line.value[i]);
  }
  line.offset = coordinate;
  line.slack = slack_[axis];
  line.axis = axis;
  return static_cast<std::uint32_t>(lines_.size() - 1);
}

template <typename Number>
std::array<Number, 3> TriangleCutter::values_of(std::uint32_t name) const {
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
std::array<Number, 3> TriangleCutter::corner_of(std::uint32_t a, std::uint32_t b) const {
  return cross(values_of<Number>(a), values_of<Number>(b));
}

[[gnu::noinline]] int TriangleCutter::determinant_sign(const CutCorner& corner,
                                                       std::uint32_t name) {
  // The line's own corners are on it: duplicated planes would otherwise ask for an exact zero.
  if (corner.line_a == name || corner.line_b == name) return 0;
  ++statistics_.signs_by_determinant;
  const auto determinant = [&](auto number) {
    using Number = decltype(number);
    const auto h = corner_of<Number>(corner.line_a, corner.line_b);
    const auto line = values_of<Number>(name);
    return Number(h[0] * line[0] + h[1] * line[1] + h[2] * line[2]);
  };
  if (const std::optional<int> sign = sign_by_intervals(determinant)) return *sign;
  ++statistics_.signs_in_rationals;
  return sign_of(determinant(Rational()));
}

[[gnu::always_inline]] inline int TriangleCutter::sign_at(std::uint32_t name_of_corner,
                                                          std::uint32_t name) {
  const Line& line = lines_[name];
  const CutCorner& corner = corners_[name_of_corner];
  double value = 0.0;
  double slack = line.slack;
  if (line.axis >= 0) {
    // A difference of two doubles has the right sign, however it is rounded.
    value = line.offset - corner.point[line.axis];
    if ((corner.exact_axes >> line.axis & 1) != 0) return sign(value);
  } else if (name_of_corner < 3) {
    value = line.value[name_of_corner];
    slack = kValueBound * line.size[name_of_corner] + kLeastSlack;
  } else {
    value = line.offset - line.normal.dot(corner.point);
  }
  if (std::abs(value) > slack) return value > 0.0 ? 1 : -1;
  return determinant_sign(corner, name);
}

std::uint32_t TriangleCutter::meet(std::uint32_t a, std::uint32_t b) {
  // Counter-clockwise consecutive lines, each with the polygon on its positive side, have
  // h0 + h1 + h2 > 0; turning one of them changes the sign, exchanging the two changes it back.
  CutCorner& corner = corners_.emplace_back();
  const bool is_turned = ((a ^ b) & 1) != 0;
  corner.line_a = (is_turned ? b : a) / 2;
  corner.line_b = (is_turned ? a : b) / 2;
  const Line& p = lines_[std::min(a, b) / 2];
  const Line& q = lines_[std::max(a, b) / 2];
  if (p.vertex >= 0 && q.axis >= 0 && !is_huge_) {
    place_on_edge(corner, p.vertex, q);
  } else {
    place(corner, p, q);
  }
  return static_cast<std::uint32_t>(corners_.size() - 1);
}

// An edge that crosses an axis-aligned plane: the two distances have opposite signs and are each
// rounded once, so that nothing cancels and t is off by (4 − 2 t) kEps of itself, 2 kEps at most.
void TriangleCutter::place_on_edge(CutCorner& corner, int vertex, const Line& plane) const {
  const int j = vertex == 2 ? 0 : vertex + 1;
  const int k = j == 2 ? 0 : j + 1;
  const double t = plane.value[j] / (plane.value[j] - plane.value[k]);
  corner.point = vertices_[j] + t * (vertices_[k] - vertices_[j]);
  corner.point[plane.axis] = plane.offset;
  corner.lambda_1 = k == 1 ? t : (j == 1 ? 1.0 - t : 0.0);
  corner.lambda_2 = k == 2 ? t : (j == 2 ? 1.0 - t : 0.0);
  corner.exact_axes = 1U << plane.axis;
}

void TriangleCutter::place(CutCorner& corner, const Line& p, const Line& q) {
  const auto h = cross(lines_[corner.line_a].value, lines_[corner.line_b].value);
  const auto h_size = cross_size(p.size, q.size);
  const double sum = h[0] + h[1] + h[2];
  const double size = h_size[0] + h_size[1] + h_size[2];
  const double largest = std::max({1.0, largest_of(p.size), largest_of(q.size)});
  const bool is_in_range = size > kLeastProduct * largest && size < kGreatestProduct;
  if (kLambdaBound * size <= kLambdaTolerance * sum && is_in_range) {
    corner.lambda_1 = h[1] / sum;
    corner.lambda_2 = h[2] / sum;
  } else if (kLongLambdaBound * size <= kLambdaTolerance * sum && is_in_range) {
    const auto long_h = corner_of<long double>(corner.line_a, corner.line_b);
    const long double long_sum = long_h[0] + long_h[1] + long_h[2];
    corner.lambda_1 = static_cast<double>(long_h[1] / long_sum);
    corner.lambda_2 = static_cast<double>(long_h[2] / long_sum);
  } else {
    ++statistics_.corners_in_rationals;
    place_exactly(corner);
  }
  corner.point = vertices_[0] + corner.lambda_1 * edge_1_ + corner.lambda_2 * edge_2_;
  for (const Line* const line : {&p, &q}) {
    if (line->axis < 0) continue;
    corner.point[line->axis] = line->offset;
    corner.exact_axes |= 1U << line->axis;
  }
}

[[gnu::cold, gnu::noinline]] void TriangleCutter::place_exactly(CutCorner& corner) const {
  const auto h = corner_of<Rational>(corner.line_a, corner.line_b);
  const Rational sum = h[0] + h[1] + h[2];
  assert(sign_of(sum) > 0);
  corner.lambda_1 = nearest_double(h[1] / sum);
  corner.lambda_2 = nearest_double(h[2] / sum);
}

void TriangleCutter::split(const CutPolygon& polygon, std::uint32_t line, InPlane in_plane,
                           CutPolygon& inside, CutPolygon* outside) {
  const std::size_t n = polygon.size();
  if (signs_.size() < n + 1) signs_.resize(2 * n + 16);
  int* const signs = signs_.data();
  bool any_inside = false;
  bool any_outside = false;
  for (std::size_t i = 0; i < n; ++i) {
    const int sign = sign_at(polygon[i].corner, line);
    signs[i] = sign;
    any_inside |= sign > 0;
    any_outside |= sign < 0;
  }
  if (!any_outside && (any_inside || in_plane == InPlane::Inside)) {
    inside = polygon;
    if (outside != nullptr) outside->clear();
    return;
  }
  if (!any_inside) {
    inside.clear();
    if (outside != nullptr) *outside = polygon;
    return;
  }
  signs[n] = signs[0];
  // A line cuts a convex polygon twice at most.
  inside.resize(n + 2);
  CutEdge* in = inside.data();
  if (outside != nullptr) outside->resize(n + 2);
  CutEdge* out = outside != nullptr ? outside->data() : nullptr;
  const std::uint32_t cut_inside = 2 * line;
  const std::uint32_t cut_outside = 2 * line + 1;
  for (std::size_t i = 0; i < n; ++i) {
    const CutEdge corner = polygon[i];
    const int sign = signs[i];
    const int next = signs[i + 1];
    if (sign >= 0) *in++ = {corner.corner, sign == 0 && next < 0 ? cut_inside : corner.edge};
    if (sign <= 0 && out != nullptr) {
      *out++ = {corner.corner, sign == 0 && next > 0 ? cut_outside : corner.edge};
    }
    if (sign * next >= 0) continue;
    // The edge leaves (+ to −) or enters; seen from the inside, the new line comes after the edge
    // or before it.
    const bool leaves = sign > 0;
    const std::uint32_t cut =
        leaves ? meet(corner.edge, cut_inside) : meet(cut_inside, corner.edge);
    *in++ = {cut, leaves ? cut_inside : corner.edge};
    if (out != nullptr) *out++ = {cut, leaves ? corner.edge : cut_outside};
  }
  inside.resize(in - inside.data());
  if (outside != nullptr) outside->resize(out - outside->data());
}

CutMeasure TriangleCutter::measure(const CutPolygon& polygon) {
  // The triangle has area 1/2 in the plane of (λ1, λ2), so that twice an area there is the
  // fraction.
  CutMeasure result;
  const CutCorner& first = corner(polygon.front());
  double sum_1 = 0.0;
  double sum_2 = 0.0;
  double p1 = corner(polygon[1]).lambda_1 - first.lambda_1;
  double p2 = corner(polygon[1]).lambda_2 - first.lambda_2;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const double q1 = corner(polygon[i]).lambda_1 - first.lambda_1;
    const double q2 = corner(polygon[i]).lambda_2 - first.lambda_2;
    const double doubled = p1 * q2 - p2 * q1;
    result.fraction += doubled;
    sum_1 += doubled * (p1 + q1);
    sum_2 += doubled * (p2 + q2);
    p1 = q1;
    p2 = q2;
  }
  double lambda_1 = 0.0;
  double lambda_2 = 0.0;
  // Corners moved by a tolerance τ change twice an area by 2 τ times the perimeter, in the sum norm
  // at most 4 for a convex polygon here: 8 τ, and 8 kEps a corner for the sums. Beyond 64 τ the
  // fraction is good to 1/7, and the centroid to 10 τ over it.
  if (result.fraction > 64.0 * kLambdaTolerance) {
    const double scale = 1.0 / (3.0 * result.fraction);
    lambda_1 = first.lambda_1 + sum_1 * scale;
    lambda_2 = first.lambda_2 + sum_2 * scale;
  } else {
    ++statistics_.areas_in_rationals;
    result.fraction = exact_fraction(polygon);
    for (const CutEdge& of : polygon) {
      lambda_1 += corner(of).lambda_1 / static_cast<double>(polygon.size());
      lambda_2 += corner(of).lambda_2 / static_cast<double>(polygon.size());
    }
  }
  result.centroid = vertices_[0] + lambda_1 * edge_1_ + lambda_2 * edge_2_;
  return result;
}

[[gnu::cold, gnu::noinline]] double TriangleCutter::exact_fraction(
    const CutPolygon& polygon) const {
  std::vector<std::array<Rational, 2>> coordinates;
  for (const CutEdge& of : polygon) {
    const CutCorner& corner = corners_[of.corner];
    const auto h = corner_of<Rational>(corner.line_a, corner.line_b);
    const Rational sum = h[0] + h[1] + h[2];
    coordinates.push_back({h[1] / sum, h[2] / sum});
  }
  Rational fraction(0);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const auto& p = coordinates[i];
    const auto& q = coordinates[(i + 1) % coordinates.size()];
    fraction += p[0] * q[1] - p[1] * q[0];
  }
  assert(sign_of(fraction) > 0);
  return std::max(nearest_double(fraction), std::numeric_limits<double>::min());
}

}  // namespace graspfit::geometry::internal
