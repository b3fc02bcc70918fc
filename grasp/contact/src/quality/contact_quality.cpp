#include "graspfit/contact/contact_quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/angle.hpp"
#include "quality/contact_hull.hpp"
#include "quality/regularity.hpp"

namespace graspfit::contact {
namespace {

using base::InvalidInput;
using Eigen::Vector3d;

constexpr double kCentimetersPerMeter = 100.0;
constexpr double kCoincident = 1e-9;  // [m] Closer points have no line between them.

void check_context(const QualityContext& context) {
  base::require(context.normalizing_radius > 0.0 && std::isfinite(context.normalizing_radius),
                "QualityContext", "normalizing_radius", context.normalizing_radius,
                "finite and above 0");
  if (!context.center_of_mass_O.allFinite()) {
    throw InvalidInput("QualityContext: center_of_mass_O has a coordinate that is not finite");
  }
}

void check_contacts(std::span<const Contact> contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const std::string name = "contact " + std::to_string(i);
    if (!contact.point_O.allFinite()) {
      throw InvalidInput(name + ": point_O has a coordinate that is not finite");
    }
    // A normal of another length would do for the angles, but it says that something else was
    // meant.
    const double length = contact.inward_normal_O.norm();
    base::require(std::abs(length - 1.0) <= 1e-6, name, "the length of inward_normal_O", length,
                  "1 within 1e-6");
  }
}

const hands::ContactPad& pad_of(const std::optional<int>& pad, const hands::HandModel& hand) {
  base::require(pad && *pad >= 0 && *pad < std::ssize(hand.pads), "Contact", "pad",
                pad ? std::to_string(*pad) : "none", "an index into the pads of hand " + hand.name);
  return hand.pads[*pad];
}

/// Returns the pad that a target contact stands for: its own or, if it has none, the tip pad of its
/// finger or the pad of the palm, which precision grasps use.
const hands::ContactPad& nominal_pad(const Contact& contact, const hands::HandModel& hand) {
  if (contact.pad) return pad_of(contact.pad, hand);
  const bool has_finger =
      contact.finger && *contact.finger >= 0 && *contact.finger < std::ssize(hand.fingers);
  return pad_of(has_finger ? hand.fingers[*contact.finger].tip_pad : hand.palm.pad, hand);
}

std::string finger_text(const Contact& contact) {
  return contact.finger ? std::to_string(*contact.finger) : "none";
}

double strength(const Contact& contact) { return contact.weak.value_or(false) ? 0.0 : 1.0; }

/// Computes the measure from the terms of M1, which the two public functions obtain differently.
ContactQuality assemble(std::span<const Contact> contacts, std::vector<SustainabilityTerm> terms,
                        const QualityContext& context, const QualityOptions& options) {
  ContactQuality quality;
  quality.terms = std::move(terms);
  if (contacts.empty()) return quality;

  // M1 = Σ (d_i + α A_i) S_i / n
  for (const SustainabilityTerm& term : quality.terms) {
    quality.m1 += (term.boundary_distance + options.alpha * term.area) * term.strength;
  }
  quality.m1 /= static_cast<double>(contacts.size());

  // M2 = Σ (1 − θ_l / θ_max) over stable pairs
  for (int i = 0; i < std::ssize(contacts); ++i) {
    for (int j = i + 1; j < std::ssize(contacts); ++j) {
      if (contacts[i].finger == contacts[j].finger) continue;
      const std::optional<double> angle =
          stable_pair_angle(contacts[i].point_O, contacts[i].inward_normal_O, contacts[j].point_O,
                            contacts[j].inward_normal_O, options.theta_max);
      if (!angle) continue;
      quality.stable_pairs.push_back({i, j, *angle});
      quality.m2 += 1.0 - *angle / options.theta_max;
    }
  }

  // M3 = R − β D
  std::vector<Vector3d> points;
  for (const Contact& contact : contacts) points.push_back(contact.point_O);
  const internal::ContactHull hull =
      internal::contact_hull(points, options.merge_distance.value_or(0.0));
  Vector3d centroid = hull.hull.centroid;
  if (options.centroid == HullCentroid::Vertices) {
    centroid.setZero();
    for (const std::size_t vertex : hull.hull.vertices) centroid += hull.points[vertex];
    centroid /= static_cast<double>(hull.hull.vertices.size());
  }
  quality.regularity = internal::regularity(hull, options.regularity);
  quality.centroid_distance = (centroid - context.center_of_mass_O).norm();
  quality.scaled_centroid_distance = options.units == MeasureUnits::Normalized
                                         ? quality.centroid_distance / context.normalizing_radius
                                         : quality.centroid_distance * kCentimetersPerMeter;
  quality.m3 = quality.regularity - options.beta * quality.scaled_centroid_distance;

  // M = M1^w1 M2^w2 M3^w3. Usability is decided factor by factor, because 0^0 = 1 would let a zero
  // factor pass.
  const bool is_usable = contacts.size() >= 2 && quality.m1 > 0.0 &&
                         !quality.stable_pairs.empty() && quality.m2 > 0.0 && quality.m3 > 0.0;
  if (is_usable) {
    quality.m = std::pow(quality.m1, options.w1) * std::pow(quality.m2, options.w2) *
                std::pow(quality.m3, options.w3);
  }
  return quality;
}

}  // namespace

void QualityOptions::validate() const {
  const auto require_weight = [](double value, std::string_view field) {
    base::require(value >= 0.0 && std::isfinite(value), "QualityOptions", field, value,
                  "finite and at least 0");
  };
  require_weight(alpha, "alpha");
  require_weight(beta, "beta");
  require_weight(w1, "w1");
  require_weight(w2, "w2");
  require_weight(w3, "w3");
  base::require(theta_max > 0.0 && theta_max < std::numbers::pi / 2, "QualityOptions", "theta_max",
                theta_max, "above 0 and below pi/2 rad");
  if (merge_distance) require_weight(*merge_distance, "merge_distance");
}

std::optional<double> stable_pair_angle(const Vector3d& point_a, const Vector3d& inward_normal_a,
                                        const Vector3d& point_b, const Vector3d& inward_normal_b,
                                        double theta_max) {
  const Vector3d a_to_b = point_b - point_a;
  if (!(a_to_b.norm() >= kCoincident)) return std::nullopt;
  // The angle comes from its tangent, not its cosine: acos loses half the digits near 0, where the
  // best pairs are. The lengths of the vectors do not matter, so nothing is rounded by scaling and
  // 45° comes out as the double π/4.
  const double angle_a = geometry::angle_between(inward_normal_a, a_to_b);
  const double angle_b = geometry::angle_between(inward_normal_b, -a_to_b);
  if (!(angle_a < theta_max && angle_b < theta_max)) return std::nullopt;
  return 0.5 * (angle_a + angle_b);
}

StablePairTest::StablePairTest(double theta_max)
    : theta_max_(theta_max), cos_theta_max_(std::cos(theta_max)) {}

bool StablePairTest::operator()(const Vector3d& point_a, const Vector3d& inward_normal_a,
                                const Vector3d& point_b, const Vector3d& inward_normal_b) const {
  // A cosine this far from that of theta_max decides beyond doubt: its rounding error is a
  // millionth of this.
  constexpr double kCosineDoubt = 1e-9;
  const Vector3d a_to_b = point_b - point_a;
  const double limit = cos_theta_max_ * a_to_b.norm();
  const double doubt = kCosineDoubt * a_to_b.norm();
  const double least = std::min(inward_normal_a.dot(a_to_b), -inward_normal_b.dot(a_to_b));
  if (least < limit - doubt) return false;
  // Equal points have no line; the whole function says so.
  if (least > limit + doubt && a_to_b.squaredNorm() > 1e-12) return true;
  return stable_pair_angle(point_a, inward_normal_a, point_b, inward_normal_b, theta_max_)
      .has_value();
}

ContactQuality contact_quality(std::span<const Contact> contacts, const QualityContext& context,
                               const QualityOptions& options) {
  options.validate();
  check_context(context);
  check_contacts(contacts);
  if (context.hand == nullptr) throw InvalidInput("QualityContext: hand is null");

  std::vector<SustainabilityTerm> terms;
  for (const Contact& contact : contacts) {
    base::require(contact.area >= 0.0 && std::isfinite(contact.area), "Contact", "area",
                  contact.area, "finite and at least 0");
    base::require(
        contact.pad_boundary_distance >= 0.0 && std::isfinite(contact.pad_boundary_distance),
        "Contact", "pad_boundary_distance", contact.pad_boundary_distance, "finite and at least 0");
    const hands::ContactPad& pad = pad_of(contact.pad, *context.hand);
    SustainabilityTerm term;
    term.strength = strength(contact);
    if (options.units == MeasureUnits::Normalized) {
      // Rough surface can have more area inside the clip volume than the pad has; both terms are
      // shares.
      term.boundary_distance =
          std::min(1.0, contact.pad_boundary_distance / hands::largest_boundary_distance(pad));
      term.area = std::min(1.0, contact.area / hands::pad_area(pad));
    } else {
      term.boundary_distance = contact.pad_boundary_distance * kCentimetersPerMeter;
      term.area = contact.area * kCentimetersPerMeter * kCentimetersPerMeter;
    }
    terms.push_back(term);
  }
  return assemble(contacts, std::move(terms), context, options);
}

double normalizing_radius(const Eigen::AlignedBox3d& box_O) {
  return 0.5 * box_O.diagonal().norm();
}

ContactQuality ideal_quality(std::span<const Contact> contacts, const QualityContext& context,
                             double boundary_distance_rel, double area_rel,
                             const QualityOptions& options) {
  options.validate();
  check_context(context);
  check_contacts(contacts);
  base::require(boundary_distance_rel >= 0.0 && boundary_distance_rel <= 1.0, "ideal_quality",
                "boundary_distance_rel", boundary_distance_rel, "in [0, 1]");
  base::require(area_rel >= 0.0 && area_rel <= 1.0, "ideal_quality", "area_rel", area_rel,
                "in [0, 1]");
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (contacts[i].finger != contacts[j].finger) continue;
      base::require(false, "ideal_quality", "the finger of two contacts", finger_text(contacts[i]),
                    "different for each contact");
    }
  }

  std::vector<SustainabilityTerm> terms;
  for (const Contact& contact : contacts) {
    SustainabilityTerm term{boundary_distance_rel, area_rel, strength(contact)};
    if (options.units == MeasureUnits::Centimeters) {
      if (context.hand == nullptr) throw InvalidInput("QualityContext: hand is null");
      const hands::ContactPad& pad = nominal_pad(contact, *context.hand);
      term.boundary_distance *= hands::largest_boundary_distance(pad) * kCentimetersPerMeter;
      term.area *= hands::pad_area(pad) * kCentimetersPerMeter * kCentimetersPerMeter;
    }
    terms.push_back(term);
  }
  return assemble(contacts, std::move(terms), context, options);
}

}  // namespace graspfit::contact
