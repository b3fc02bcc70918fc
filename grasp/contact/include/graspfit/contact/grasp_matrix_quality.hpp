#pragma once

#include <Eigen/Core>
#include <span>

#include "graspfit/contact/contact.hpp"
#include "graspfit/contact/wrench.hpp"

namespace graspfit::contact {

/// How evenly contact forces reach all directions of wrench, friction aside [Li & Sastry 1988].
struct GraspMatrixQuality {
  Eigen::Matrix<double, 6, 1> singular_values =
      Eigen::Matrix<double, 6, 1>::Zero();  ///< Singular values of the 6 × 3k grasp matrix of k
                                            ///< contacts, descending; for fewer than two contacts
                                            ///< some are 0.
  double smallest() const { return singular_values[5]; }
  /// Volume of the ellipsoid of wrenches of unit contact forces, up to a constant: √det(G Gᵀ).
  double product() const { return singular_values.prod(); }
  /// Smallest over largest, 1 at best; 0 without contacts.
  double ratio() const {
    return singular_values[0] > 0.0 ? singular_values[5] / singular_values[0] : 0.0;
  }
};

/// Computes the singular values of `grasp_matrix`, whose columns are the wrenches of unit forces
/// along three axes per contact, with torques over the torque scale. They are rounded: values that
/// are 0 in truth, as the sixth of two contacts, come out as 1e-16.
/// @throws InvalidInput as `grasp_matrix`.
GraspMatrixQuality grasp_matrix_quality(std::span<const Contact> contacts,
                                        const Eigen::Vector3d& reference_point_O,
                                        double torque_scale);

}  // namespace graspfit::contact
