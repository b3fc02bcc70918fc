#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "graspfit/geometry/medial_axis.hpp"
#include "graspfit/grasp/object_model.hpp"

namespace graspfit::grasp {

/// What the medial axis looks like around one of its balls.
enum class SymmetryKind {
  Alone,     ///< No other ball near: nothing is known.
  Axis,      ///< Centers near it lie on a line: a local axis of symmetry.
  Rim,       ///< They spread over a plane, much farther along its border than across it.
  Interior,  ///< They spread evenly: the inside of a plane, or a blob.
  Point,     ///< They coincide, as in a sphere: directions among them would be rounding.
};

/// Parameters of the baseline MA [Przybylski, Asfour & Dillmann 2011]; values from its first
/// author's published implementation unless marked [R].
struct MedialSymmetryOptions {
  int samples = 1000;  ///< Surface points that get a ball, in [1, 10⁶] [R]: there all vertices.
  double min_object_angle_deg = 120.0;  ///< Balls with smaller ones go, in [0, 180].
  double axis_ratio = 0.01;         ///< Largest ratio of the two largest eigenvalues of an axis.
  double rim_ratio = 0.4;           ///< Largest one of a rim, ≥ axis_ratio, ≤ 1.
  double search_radius = 0.01;      ///< In which balls are neighbors [m], > 0.
  double search_radius_rel = 0.05;  ///< At least this share of the longest extent, ≥ 0 [R].
  /// Root mean square of the centers along their first axis over the longest extent; below this,
  /// or below 3 % of the ball's radius (how well centers are known), `Point`. ≥ 0 [R].
  double least_spread_rel = 1e-3;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// One ball and the symmetry of its neighborhood.
struct MedialSymmetry {
  geometry::MedialBall ball;
  SymmetryKind kind = SymmetryKind::Alone;
  int neighbors = 0;   ///< Balls with centers within the search radius, itself not counted.
  double ratio = 0.0;  ///< Second over first eigenvalue of the centers' scatter; 0 if it is none.
  /// First two eigenvectors, unit and orthogonal; only of kinds Axis, Rim and Interior.
  Eigen::Vector3d first_axis_O = Eigen::Vector3d::Zero();
  Eigen::Vector3d second_axis_O = Eigen::Vector3d::Zero();
  /// Mean of the centers of the neighborhood [m].
  Eigen::Vector3d center_of_gravity_O = Eigen::Vector3d::Zero();
};

/// The search radius that the options come to for an object [m].
double search_radius(const geometry::TriangleMesh& mesh, const MedialSymmetryOptions& options);

/// Eigenvalue analysis of the centers around each ball. `longest_extent` [m] scales
/// `least_spread_rel`. Cost: quadratic in the balls. Approximate.
std::vector<MedialSymmetry> medial_symmetries(std::span<const geometry::MedialBall> balls,
                                              double radius, double longest_extent,
                                              const MedialSymmetryOptions& options);

/// Balls at area-weighted samples of the object (`geometry::medial_balls`), analyzed.
std::vector<MedialSymmetry> medial_symmetries(const ObjectModel& object,
                                              const MedialSymmetryOptions& options,
                                              std::uint64_t seed);

/// A way to put a hand around a ball.
struct MedialCandidate {
  Eigen::Vector3d center_O = Eigen::Vector3d::Zero();    ///< Of the ball; for the grasp center [m].
  Eigen::Vector3d outward_O = Eigen::Vector3d::UnitZ();  ///< Unit; the palm looks against it.
  /// Unit, normal to it: for the axis about which the fingers close.
  Eigen::Vector3d axis_O = Eigen::Vector3d::UnitX();
  std::int32_t symmetry = -1;  ///< Index of the ball.
};

/// Candidates of all balls, in their order: of an axis 8, four directions across it and both
/// orientations along it; of a rim 2, away from the neighborhood's center of gravity; of an
/// interior and of a lone ball none; of a point 8 random ones [R], drawn by (seed, index).
std::vector<MedialCandidate> medial_candidates(std::span<const MedialSymmetry> symmetries,
                                               std::uint64_t seed);

}  // namespace graspfit::grasp
