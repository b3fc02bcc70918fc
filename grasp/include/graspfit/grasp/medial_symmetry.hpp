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
  Alone,  ///< No other ball near: nothing is known.
  Axis,   ///< Centers near it lie on a line: a local axis of symmetry.
  Rim,  ///< Centers near it spread over a plane, much farther along the plane's border than across
        ///< it.
  Interior,  ///< Centers near it spread evenly: the inside of a plane, or a blob.
  Point,  ///< Centers near it coincide, as in a sphere: directions between them would be rounding
          ///< errors.
};

/// Parameters of the baseline MA [Przybylski, Asfour & Dillmann 2011]; values from its first
/// author's published implementation unless marked [R].
struct MedialSymmetryOptions {
  int samples = 1000;  ///< Surface points that get a ball, in [1, 10⁶] [R]; the published
                       ///< implementation takes all vertices.
  /// Balls with a smaller object angle are dropped, in [0, 180].
  double min_object_angle_deg = 120.0;
  double axis_ratio = 0.01;     ///< Largest ratio of second to first eigenvalue that makes an axis.
  double rim_ratio = 0.4;       ///< Largest such ratio that makes a rim, ≥ axis_ratio, ≤ 1.
  double search_radius = 0.01;  ///< Distance within which balls are neighbors [m], > 0.
  /// The search radius is at least this share of the longest extent, ≥ 0 [R].
  double search_radius_rel = 0.05;
  /// Least spread of the centers (root mean square along their first axis) over the longest extent,
  /// ≥ 0 [R]. With less spread, or with less than 3 % of the ball's radius (the accuracy of
  /// centers), the kind is `Point`.
  double least_spread_rel = 1e-3;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// One ball and the symmetry of its neighborhood.
struct MedialSymmetry {
  geometry::MedialBall ball;
  SymmetryKind kind = SymmetryKind::Alone;
  int neighbors = 0;  ///< Balls with centers within the search radius, itself not counted.
  /// Second over first eigenvalue of the centers' scatter; 0 for kinds Alone and Point.
  double ratio = 0.0;
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

/// A candidate placement of a hand around a ball of the medial axis.
struct MedialCandidate {
  /// Center of the ball, where the hand's grasp center goes [m].
  Eigen::Vector3d center_O = Eigen::Vector3d::Zero();
  Eigen::Vector3d outward_O = Eigen::Vector3d::UnitZ();  ///< Unit; the palm faces against it.
  /// Unit, normal to `outward_O`: the direction of the axis about which the fingers close.
  Eigen::Vector3d axis_O = Eigen::Vector3d::UnitX();
  std::int32_t symmetry = -1;  ///< Index of the ball.
};

/// Candidates of all balls, in the order of the balls. A ball on an axis gives 8: four directions
/// across the axis, each with both orientations along it. A ball on a rim gives 2, away from the
/// neighborhood's center of gravity. A ball of an interior and a lone ball give none. A point gives
/// 8 random ones [R], drawn by (seed, index).
std::vector<MedialCandidate> medial_candidates(std::span<const MedialSymmetry> symmetries,
                                               std::uint64_t seed);

}  // namespace graspfit::grasp
