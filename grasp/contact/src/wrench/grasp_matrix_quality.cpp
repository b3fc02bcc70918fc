#include "graspfit/contact/grasp_matrix_quality.hpp"

#include <Eigen/SVD>

namespace graspfit::contact {

GraspMatrixQuality grasp_matrix_quality(std::span<const Contact> contacts,
                                        const Eigen::Vector3d& reference_point_O,
                                        double torque_scale) {
  const Eigen::MatrixXd matrix = grasp_matrix(contacts, reference_point_O, torque_scale);
  GraspMatrixQuality quality;
  if (matrix.cols() == 0) return quality;
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  quality.singular_values.head(values.size()) = values;
  return quality;
}

}  // namespace graspfit::contact
