#include "decomposition/cut_choice.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/bounded_integer.hpp"
#include "graspfit/base/random.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kNumSamples = 500;       // points of the part's surface
constexpr std::size_t kNumSegments = 3000;     // segments between these points
constexpr int kNumSteps = 5;                   // depths along each segment
constexpr int kNumDirections = 32;             // spread evenly, beside the axes
constexpr std::size_t kNumFacePlanes = 24;     // planes of faces
constexpr double kFacePlanePreference = 0.97;  // share of the best score that is good enough

constexpr double kNumBoundarySamples = 600.0;  // samples on a hull's boundary, about
constexpr int kMostPerSide = 24;               // most samples along a side of a face, however long

struct Sample {
  Vector3d point;
  std::int32_t face = -1;
};

/// Something a cut should separate: its points span an interval along any direction.
struct Obstacle {
  std::vector<std::int32_t> ends;  ///< Indices into `Evidence::points`.
  double weight = 0.0;
};

struct Evidence {
  std::vector<Vector3d> points;
  std::vector<Obstacle> obstacles;
  std::vector<std::int32_t> faces;  ///< Faces of the mesh at the ends of the heaviest segments.
};

std::vector<Sample> samples_of(const SolidPart& part, base::Random& random) {
  std::vector<double> areas;
  std::vector<std::array<std::int32_t, 4>> triangles;  // corners and face
  double total = 0.0;
  for (std::size_t k = 0; k < part.num_polygons(); ++k) {
    for (std::int32_t c = part.starts[k] + 1; c + 1 < part.starts[k + 1]; ++c) {
      const std::array<std::int32_t, 4> t = {part.corners[part.starts[k]], part.corners[c],
                                             part.corners[c + 1], part.faces[k]};
      const Vector3d& a = part.points[t[0]];
      total += 0.5 * (part.points[t[1]] - a).cross(part.points[t[2]] - a).norm();
      areas.push_back(total);
      triangles.push_back(t);
    }
  }
  std::vector<Sample> samples;
  if (!(total > 0.0)) return samples;
  for (std::size_t i = 0; i < kNumSamples; ++i) {
    const double area_drawn =
        (static_cast<double>(i) + random.uniform()) / static_cast<double>(kNumSamples) * total;
    const auto at =
        std::min(std::upper_bound(areas.begin(), areas.end(), area_drawn) - areas.begin(),
                 std::ssize(areas) - 1);
    const auto& t = triangles[at];
    double u = random.uniform();
    double v = random.uniform();
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const Vector3d& a = part.points[t[0]];
    samples.push_back({a + u * (part.points[t[1]] - a) + v * (part.points[t[2]] - a), t[3]});
  }
  return samples;
}

double excess(double depth, double allowed) {
  const double over = std::max(0.0, depth - allowed);
  return over * over;
}

void scale_weights(std::vector<Obstacle>& obstacles, std::size_t first) {
  double sum = 0.0;
  for (std::size_t i = first; i < obstacles.size(); ++i) sum += obstacles[i].weight;
  if (!(sum > 0.0)) return;
  for (std::size_t i = first; i < obstacles.size(); ++i) obstacles[i].weight /= sum;
}

/// Spacing at which the boundary of a hull gets about `kNumBoundarySamples` [m].
double sample_spacing(const PieceHull& hull) {
  return std::sqrt(2.0 * surface_area(hull.mesh) / kNumBoundarySamples);
}

double deepest_on(const std::array<Vector3d, 3>& p, double spacing, const OutsideDepth& depth) {
  const double longest =
      std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
  const int n = base::bounded_integer(std::ceil(longest / spacing), 1, kMostPerSide);
  double deepest = 0.0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      const double u = (i + 1.0 / 3.0) / n;
      const double v = (j + 1.0 / 3.0) / n;
      deepest = std::max(deepest, depth(p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0])));
    }
  }
  return deepest;
}

void add_segments(const std::vector<Sample>& samples, const OutsideDepth& depth, double allowed,
                  base::Random& random, Evidence& evidence) {
  const std::size_t first = evidence.obstacles.size();
  std::vector<std::pair<double, std::int32_t>> heavy;
  for (std::size_t i = 0; i < kNumSegments; ++i) {
    const auto a = base::as_index<std::int32_t>(random.index(samples.size()));
    const auto b = base::as_index<std::int32_t>(random.index(samples.size()));
    double deepest = 0.0;
    for (int step = 1; step <= kNumSteps; ++step) {
      const double s = static_cast<double>(step) / (kNumSteps + 1);
      deepest = std::max(deepest, depth((1.0 - s) * samples[a].point + s * samples[b].point));
    }
    const double weight = excess(deepest, allowed);
    if (!(weight > 0.0)) continue;
    evidence.obstacles.push_back({{a, b}, weight});
    heavy.emplace_back(-weight, a);
    heavy.emplace_back(-weight, b);
  }
  scale_weights(evidence.obstacles, first);
  std::sort(heavy.begin(), heavy.end());
  for (const auto& [weight, sample] : heavy) {
    if (evidence.faces.size() >= kNumFacePlanes) break;
    evidence.faces.push_back(samples[sample].face);
  }
}

void add_hull_faces(const PieceHull& hull, const OutsideDepth& depth, double allowed,
                    Evidence& evidence) {
  const std::size_t first = evidence.obstacles.size();
  const auto first_point = base::as_index<std::int32_t>(evidence.points.size());
  const double spacing = sample_spacing(hull);
  evidence.points.insert(evidence.points.end(), hull.mesh.vertices.begin(),
                         hull.mesh.vertices.end());
  for (std::int32_t f = 0; f < std::ssize(hull.mesh.faces); ++f) {
    const std::array<Vector3d, 3> p = corners(hull.mesh, f);
    const Face& face = hull.mesh.faces[f];
    const double deepest = deepest_on(p, spacing, depth);
    const double weight = excess(deepest, allowed) * vector_area(hull.mesh, f).norm();
    if (!(weight > 0.0)) continue;
    evidence.obstacles.push_back(
        {{first_point + face[0], first_point + face[1], first_point + face[2]}, weight});
  }
  scale_weights(evidence.obstacles, first);
}

std::vector<Vector3d> directions_for(const std::vector<Sample>& samples) {
  std::vector<Vector3d> directions = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  Vector3d mean = Vector3d::Zero();
  for (const Sample& s : samples) mean += s.point / static_cast<double>(samples.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Sample& s : samples) spread += (s.point - mean) * (s.point - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  for (int k = 0; k < 3; ++k) directions.emplace_back(solver.eigenvectors().col(k));
  // A spiral of equal areas over the half sphere.
  for (int i = 0; i < kNumDirections; ++i) {
    const double z = (i + 0.5) / kNumDirections;
    const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

/// Weight of the obstacles that the plane of a face separates. Ends on the plane count as below it,
/// where the solid is.
double separated_weight(const Evidence& evidence, const CutPlane& plane, double on_plane) {
  double sum = 0.0;
  for (const Obstacle& o : evidence.obstacles) {
    const auto is_above = [&](std::int32_t end) {
      return plane.height(evidence.points[end]) > on_plane;
    };
    const auto num_above = std::count_if(o.ends.begin(), o.ends.end(), is_above);
    if (num_above > 0 && num_above < std::ssize(o.ends)) sum += o.weight;
  }
  return sum;
}

/// The offset along a direction that separates the largest weight of obstacles, and this weight.
std::pair<double, double> best_offset(const Evidence& evidence, const Vector3d& direction) {
  const auto n = base::as_index<std::int32_t>(evidence.points.size());
  std::vector<std::pair<double, std::int32_t>> order(n);
  for (std::int32_t i = 0; i < n; ++i) {
    order[i] = {direction.dot(evidence.points[i]), i};
  }
  std::sort(order.begin(), order.end());
  std::vector<std::int32_t> rank(n);
  for (std::int32_t i = 0; i < n; ++i) rank[order[i].second] = i;
  std::vector<double> change(n + 1, 0.0);
  for (const Obstacle& o : evidence.obstacles) {
    std::int32_t low = n;
    std::int32_t high = -1;
    for (const std::int32_t end : o.ends) {
      low = std::min(low, rank[end]);
      high = std::max(high, rank[end]);
    }
    change[low] += o.weight;
    change[high] -= o.weight;
  }
  double sum = 0.0;
  double best = -1.0;
  double offset = 0.0;
  for (std::int32_t i = 0; i + 1 < n; ++i) {
    sum += change[i];
    if (sum > best && order[i + 1].first > order[i].first) {
      best = sum;
      offset = 0.5 * (order[i].first + order[i + 1].first);
    }
  }
  return {best, offset};
}

}  // namespace

std::optional<CutPlane> choose_cut(const SolidPart& part, const PieceHull& hull,
                                   const OutsideDepth& depth, const TriangleMesh& mesh,
                                   double allowed_depth, std::uint64_t seed) {
  base::Random random(seed);
  const std::vector<Sample> samples = samples_of(part, random);
  if (samples.empty()) return std::nullopt;
  Evidence evidence;
  for (const Sample& s : samples) evidence.points.push_back(s.point);
  add_segments(samples, depth, allowed_depth, random, evidence);
  add_hull_faces(hull, depth, allowed_depth, evidence);
  if (evidence.obstacles.empty()) return std::nullopt;

  double best = 0.0;
  std::optional<CutPlane> plane;
  for (const Vector3d& direction : directions_for(samples)) {
    const auto [score, offset] = best_offset(evidence, direction);
    if (score > best) {
      best = score;
      plane = CutPlane{direction, offset};
    }
  }
  constexpr double kOnPlaneRel = 1e-9;
  const double on_plane = kOnPlaneRel * longest_extent(mesh);
  double best_of_faces = kFacePlanePreference * best;
  for (const std::int32_t face : evidence.faces) {
    CutPlane candidate{face_normal(mesh, face), 0.0};
    if (candidate.normal.isZero()) continue;
    candidate.offset = candidate.normal.dot(mesh.vertices[mesh.faces[face][0]]);
    const double score = separated_weight(evidence, candidate, on_plane);
    if (score > best_of_faces) {
      best_of_faces = score;
      plane = candidate;
    }
  }
  return plane;
}

double deepest_segment(std::span<const Vector3d> starts, std::span<const Vector3d> ends,
                       const OutsideDepth& depth, std::size_t num_segments, double limit) {
  double deepest = 0.0;
  base::Random random(starts.size() + ends.size());
  for (std::size_t k = 0; k < num_segments && deepest <= limit; ++k) {
    const Vector3d& a = starts[random.index(starts.size())];
    const Vector3d& b = ends[random.index(ends.size())];
    for (int step = 1; step <= kNumSteps; ++step) {
      const double s = static_cast<double>(step) / (kNumSteps + 1);
      deepest = std::max(deepest, depth((1.0 - s) * a + s * b));
    }
  }
  return deepest;
}

double sampled_depth(const PieceHull& hull, const OutsideDepth& depth, double limit) {
  const std::vector<Vector3d>& vertices = hull.mesh.vertices;
  double deepest = deepest_segment(vertices, vertices, depth, 4 * vertices.size(), limit);
  const double spacing = sample_spacing(hull);
  for (std::int32_t f = 0; f < std::ssize(hull.mesh.faces) && deepest <= limit; ++f) {
    deepest = std::max(deepest, deepest_on(corners(hull.mesh, f), spacing, depth));
  }
  return deepest;
}

}  // namespace graspfit::geometry::internal
