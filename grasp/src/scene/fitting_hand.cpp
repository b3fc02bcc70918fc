#include "graspfit/grasp/fitting_hand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <unordered_set>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hands/pad_surface.hpp"
#include "scene/link_pieces.hpp"

namespace graspfit::grasp {
namespace {

using base::InvalidInput;
using base::shortest_decimal;
using Eigen::Vector3d;
using geometry::RigidTransform;

constexpr std::size_t kLeafSize =
    8;  // points: larger leaves ask the map oftener, smaller make more balls
constexpr double kPieceSize = 0.012;  // [m]; about a fingertip: its sides and end are pieces apart

/// Into how many parts of `spacing` the longest edge of a face is cut.
double parts_of_edge(const geometry::TriangleMesh& mesh, std::int32_t face, double spacing) {
  const auto [a, b, c] = geometry::corners(mesh, face);
  return std::ceil(std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()}) / spacing);
}

/// Refuses a hand that is many times the object's size: its points would fill the memory.
void require_few_points(const hands::HandModel& hand, const hands::Link& link, double spacing) {
  constexpr double kMostPoints = 1e8;  // 2.4 GB
  double num_points = 0.0;
  for (std::size_t face = 0; face < link.mesh_L.faces.size(); ++face) {
    const double n = parts_of_edge(link.mesh_L, face, spacing);
    num_points += 0.5 * n * n;
  }
  if (num_points <= kMostPoints) return;
  throw InvalidInput("hand " + hand.name + ": link " + link.name + " is " +
                     shortest_decimal(geometry::longest_extent(link.mesh_L)) +
                     " m long, too much for points " + shortest_decimal(spacing) +
                     " m apart: its lengths are in another unit, or the object is far too small "
                     "for it");
}

/// Whole numbers, of any size.
using Cell = std::array<double, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::size_t hash = 0;
    for (const double x : cell) hash = 31 * hash + std::hash<double>{}(x);
    return hash;
  }
};

/// Points on the surface of a mesh: vertices, and a barycentric lattice in faces longer than
/// `spacing`; of these, only the first one in each cell of half that size is kept.
std::vector<Vector3d> surface_points(const geometry::TriangleMesh& mesh, double spacing) {
  std::vector<Vector3d> points = mesh.vertices;
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    const auto [a, b, c] = geometry::corners(mesh, face);
    const int n = static_cast<int>(parts_of_edge(mesh, face, spacing));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const bool is_corner = (i == 0 && j == 0) || i == n || j == n;
        if (!is_corner) points.push_back(a + (b - a) * (double(i) / n) + (c - a) * (double(j) / n));
      }
    }
  }
  std::unordered_set<Cell, CellHash> taken;
  taken.reserve(points.size());
  std::erase_if(points, [&](const Vector3d& point) {
    const Vector3d cell = (point / (0.5 * spacing)).array().floor();
    return !taken.insert(Cell{cell[0], cell[1], cell[2]}).second;
  });
  return points;
}

/// Adds the ball of points [first, last) and those of its two halves, split at the median of the
/// longest extent.
void add_ball(FittingHand::LinkSamples& samples, std::size_t first, std::size_t last) {
  const std::span<Vector3d> points(samples.points_L.data() + first, last - first);
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) box.extend(point);
  FittingHand::Ball ball;
  ball.center_L = box.center();
  for (const Vector3d& point : points) {
    ball.radius = std::max(ball.radius, (point - ball.center_L).norm());
  }
  const std::size_t index = samples.balls.size();
  samples.balls.push_back(ball);
  if (points.size() <= kLeafSize) {
    samples.balls[index].first = base::as_index<std::int32_t>(first);
    samples.balls[index].count = base::as_index<std::int32_t>(points.size());
    return;
  }
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t half = points.size() / 2;
  std::nth_element(points.begin(), points.begin() + half, points.end(),
                   [axis](const Vector3d& a, const Vector3d& b) { return a[axis] < b[axis]; });
  add_ball(samples, first, first + half);
  samples.balls[index].first = base::as_index<std::int32_t>(samples.balls.size());
  add_ball(samples, first + half, last);
}

}  // namespace

FittingHand::FittingHand(const hands::HandModel& hand, double sample_spacing)
    : model_(hand), collision_(hand) {
  if (!(sample_spacing > 0.0) || !std::isfinite(sample_spacing)) {
    throw InvalidInput("FittingHand: sample_spacing = " + shortest_decimal(sample_spacing) +
                       ", must be a positive length in meters");
  }
  for (const hands::Link& link : hand.links) {
    LinkSamples& samples = samples_.emplace_back();
    require_few_points(hand, link, sample_spacing);
    samples.points_L = surface_points(link.mesh_L, sample_spacing);
    for (const Vector3d& point : samples.points_L) {
      samples.reach = std::max(samples.reach, point.norm());
    }
    if (!samples.points_L.empty()) add_ball(samples, 0, samples.points_L.size());
    pieces_.push_back(internal::pieces_of(link.mesh_L, kPieceSize));
  }
  for (int pad = 0; pad < std::ssize(hand.pads); ++pad) {
    pad_surfaces_.emplace_back(hands::pad_surface_L(hand, pad));
  }
}

float smallest_distance(const FittingHand& hand, int link, const RigidTransform& X_OL,
                        const geometry::SignedDistanceMap& map, float enough) {
  const FittingHand::LinkSamples& samples = hand.samples(link);
  // Anything above `enough` is as good as this.
  float smallest = enough + 0.5F;
  if (samples.balls.empty()) return smallest;
  const double voxels_per_meter = 1.0 / map.lattice.voxel_size;
  // Values change by at most √2 per voxel between voxel centers (voxels that meet in an edge may be
  // +1 and −1; beyond the lattice as well), and a point is within √3/2 of its own center.
  const auto bound = [&](const FittingHand::Ball& ball) {
    return map.at(Vector3d(X_OL * ball.center_L)) -
           std::numbers::sqrt2 * (ball.radius * voxels_per_meter + std::numbers::sqrt3);
  };
  struct Open {
    std::int32_t ball;
    double bound;
  };
  std::array<Open, 128> open;  // the tree is balanced: its depth is the logarithm of the points
  std::size_t size = 0;
  open[size++] = {0, bound(samples.balls[0])};
  while (size > 0) {
    const Open next = open[--size];
    // The next value below 0 is −1: once the smallest value is 0, only full voxels are searched
    // for.
    if (next.bound >= smallest || (smallest == 0.0F && next.bound > -1.0)) continue;
    const FittingHand::Ball& ball = samples.balls[next.ball];
    if (ball.count > 0) {
      for (std::int32_t i = 0; i < ball.count; ++i) {
        smallest = std::min(smallest, map.at(Vector3d(X_OL * samples.points_L[ball.first + i])));
      }
      continue;
    }
    const Open left = {next.ball + 1, bound(samples.balls[next.ball + 1])};
    const Open right = {ball.first, bound(samples.balls[ball.first])};
    const bool is_left_nearer = left.bound < right.bound;
    open[size++] = is_left_nearer ? right : left;
    open[size++] = is_left_nearer ? left : right;
  }
  return smallest;
}

}  // namespace graspfit::grasp
