#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "graspfit/contact/contact.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::contact {

/// Units of d and A in M1 and of D in M3.
enum class MeasureUnits {
  Normalized,  ///< d over the pad's largest d and A over its area, both cut at 1 (rough surface can
               ///< have more area than the pad); D over the normalizing radius.
  Centimeters,  ///< d, D in cm, A in cm².
};

/// Definition of the regularity R.
enum class Regularity {
  Combined,   ///< Square root of angle and edge regularity.
  AngleOnly,  ///< 1 − Q, the shape index [Park & Starr 1992; Roa & Suárez 2015].
  EdgeOnly,   ///< Shortest over longest edge.
};

/// Which centroid D is measured from.
enum class HullCentroid {
  Measure,   ///< Centroid of the hull's area or volume.
  Vertices,  ///< Mean of the hull's vertices.
};

/// Parameters of the paper's measure M (section 4). Defaults are the paper's values [P] and,
/// where the paper is silent, the readings recommended [R]; all are weighed in docs/readings.md.
struct QualityOptions {
  double alpha = 2.0;  ///< Weight of contact area against boundary distance, ≥ 0 [P].
  double beta = 0.3;   ///< Weight of the centroid distance, ≥ 0 [P].
  double w1 = 1.0;     ///< Exponent of M1, ≥ 0 [P].
  double w2 = 1.0;     ///< Exponent of M2, ≥ 0 [P].
  double w3 = 0.5;     ///< Exponent of M3, ≥ 0 [P].
  double theta_max =
      std::numbers::pi / 4;  ///< Friction cone half-angle [rad], in (0, π/2); 45° [P].
  MeasureUnits units = MeasureUnits::Normalized;  ///< [R]
  Regularity regularity = Regularity::Combined;   ///< [R]
  HullCentroid centroid = HullCentroid::Measure;  ///< [R]
  /// Contacts linked by distances below this count as one hull point, their mean [m], ≥ 0; empty:
  /// none do, but the planner sets 0.1 voxel.
  std::optional<double> merge_distance = {};
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Properties of the object and the hand that M depends on.
struct QualityContext {
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();  ///< [m]
  double normalizing_radius = 0.0;         ///< `normalizing_radius` of the object's box [m], > 0.
  const hands::HandModel* hand = nullptr;  ///< For pad areas and largest d; not null.
};

/// The length that distances from the center of mass are divided by in normalized units: half the
/// diagonal of the object's bounding box [m]. Infinite for an empty box.
double normalizing_radius(const Eigen::AlignedBox3d& box_O);

/// A pair of contacts of different fingers whose line lies in both friction cones.
struct StablePair {
  int first = -1;  ///< Indices of contacts, first < second.
  int second = -1;
  double angle = 0.0;  ///< Mean of the two line-to-normal angles [rad] (paper: theta_l).
};

/// The terms of M1 of one contact, as they enter the sum.
struct SustainabilityTerm {
  double boundary_distance = 0.0;  ///< d in the units chosen.
  double area = 0.0;               ///< A in the units chosen.
  double strength = 1.0;           ///< S: 0 on a weak feature, else 1.
};

/// The paper's measure with every term it came from.
struct ContactQuality {
  double m1 = 0.0;
  double m2 = 0.0;
  double m3 = 0.0;                        ///< May be negative; M is then 0.
  double m = 0.0;                         ///< M of the contacts; 0 if they are unusable.
  double regularity = 0.0;                ///< R in (0, 1]; 0 if there are fewer than two contacts.
  double centroid_distance = 0.0;         ///< D [m].
  double scaled_centroid_distance = 0.0;  ///< D in the units chosen.
  std::vector<SustainabilityTerm> terms;  ///< One per contact.
  std::vector<StablePair> stable_pairs;

  bool is_usable() const { return m > 0.0; }
};

/// Computes M1, M2, M3 and M of a set of contacts (paper section 4). Pairs are formed between
/// contacts of different fingers only; the palm is a finger of its own.
///
/// M is 0 if there are fewer than two contacts, no stable pair, every contact is weak, or M3 ≤ 0,
/// whatever the exponents. Up to rounding, the result does not depend on the order of the contacts
/// and does not change with rigid motions nor, in normalized units, with scaling hand and object
/// together. All numbers are rounded.
/// @throws InvalidInput for bad options, a null hand, a pad that the hand does not have, a normal
/// that is not unit within 1e-6, and numbers that are not finite.
ContactQuality contact_quality(std::span<const Contact> contacts, const QualityContext& context,
                               const QualityOptions& options = {});

/// Computes the measure of target contacts alone, which have no pads: for every contact, d and A
/// are given as shares, in [0, 1], of the pad's largest d and of its area. It is used for the ideal
/// M of a target set.
///
/// In normalized units the hand may be null; in centimeters the shares refer to the contact's pad
/// or, if it has none, to the tip pad of its finger, without a finger to the palm's pad.
/// @throws InvalidInput as `contact_quality`, and if two contacts have the same finger.
ContactQuality ideal_quality(std::span<const Contact> contacts, const QualityContext& context,
                             double boundary_distance_rel, double area_rel,
                             const QualityOptions& options = {});

/// Tests the line between two contacts against both friction cones (paper section 4.2): returns the
/// mean of its angles to the two normals [rad] if each angle is strictly below `theta_max`, else
/// nothing. Points closer than 1e-9 m have no such line: the result is empty.
///
/// The lengths of the normals do not matter. The angles that are compared are rounded (a few
/// 1e-16): a pair at `theta_max` itself may count as stable or not, and adds next to nothing to M2
/// if both of its angles are there.
std::optional<double> stable_pair_angle(const Eigen::Vector3d& point_a,
                                        const Eigen::Vector3d& inward_normal_a,
                                        const Eigen::Vector3d& point_b,
                                        const Eigen::Vector3d& inward_normal_b, double theta_max);

/// Decides for many pairs whether they are stable. The answer is the same as whether
/// `stable_pair_angle` has a value, but cosines decide wherever they leave no doubt.
class StablePairTest {
 public:
  /// @param theta_max half-angle of the friction cones [rad], in (0, π/2).
  explicit StablePairTest(double theta_max);
  /// Normals must be unit.
  bool operator()(const Eigen::Vector3d& point_a, const Eigen::Vector3d& inward_normal_a,
                  const Eigen::Vector3d& point_b, const Eigen::Vector3d& inward_normal_b) const;

 private:
  double theta_max_;
  double cos_theta_max_;
};

/// R of the hull of `points`, in [1e-3, 1] [R]: 1 for regular polygons and polyhedra.
///
///     N < 2                                       0 (undefined)
///     N = 2                                       1
///     collinear: 2nd/1st singular value < 1e-3    1e-3, also if merging leaves fewer than three
///     planar: thickness/extent < 0.1              polygon in its best-fit plane
///     otherwise                                   polyhedron; triangles within 5° are one face
///
/// Combined is sqrt(angles · edges), where angles is 1 − Q of the polygon, or its mean over the
/// faces, and edges is the shortest over the longest edge. Points inside the hull do not matter. R
/// jumps where a case changes, most between planar and solid. Points linked by distances below
/// `merge_distance` are one, their mean. @throws InvalidInput for a negative `merge_distance` or
/// points that are not finite.
double regularity(std::span<const Eigen::Vector3d> points, Regularity definition,
                  double merge_distance = 0.0);

}  // namespace graspfit::contact
