#include "graspfit/contact/grasp_balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/contact_check.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/nonnegative_least_squares.hpp"

namespace graspfit::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Returns the weights ≥ 0 with the given sum that bring Σ weight_i wrench_i nearest to `load`.
/// With v_i = wrench_i − load / sum, Σ weight_i wrench_i − load is `sum` times a point in the hull
/// of the v_i, at best the point nearest to the origin. The weights of this point are, up to their
/// own sum, those that minimize ‖Σ a_i v_i‖² + s² (Σ a_i − 1)² over a ≥ 0: for weights in a fixed
/// ratio whose point has the squared length q, the best sum leaves s² q / (s² + q), which grows
/// with q.
VectorXd weights_of_sum(const MatrixXd& wrenches, const VectorXd& load, double sum) {
  const Index rows = wrenches.rows();
  MatrixXd system(rows + 1, wrenches.cols());
  system.topRows(rows) = wrenches.colwise() - load / sum;
  // The scale is not zero either where all wrenches are the load itself.
  const double scale = std::max(system.topRows(rows).colwise().norm().maxCoeff(),
                                wrenches.colwise().norm().maxCoeff());
  system.row(rows).setConstant(scale);
  VectorXd target = VectorXd::Zero(rows + 1);
  target[rows] = scale;
  const VectorXd weights = geometry::nonnegative_least_squares(system, target);
  return weights * (sum / weights.sum());
}

}  // namespace

void BalanceOptions::validate() const {
  base::require(num_cone_edges >= 3, "BalanceOptions", "num_cone_edges", num_cone_edges,
                "at least 3");
  base::require(friction >= 0.0 && std::isfinite(friction), "BalanceOptions", "friction", friction,
                "finite and at least 0");
  base::require(least_normal_sum >= 0.0 && std::isfinite(least_normal_sum), "BalanceOptions",
                "least_normal_sum", least_normal_sum, "finite and at least 0");
  const double scale = torque_scale.value_or(std::numeric_limits<double>::quiet_NaN());
  base::require(scale > 0.0 && std::isfinite(scale), "BalanceOptions", "torque_scale", scale,
                "set, finite and positive");
  base::require(evenness >= 0.0 && std::isfinite(evenness), "BalanceOptions", "evenness", evenness,
                "finite and at least 0");
}

BalanceForces balance_forces(std::span<const Contact> contacts,
                             const Eigen::Vector3d& reference_point_O, const Wrench& load,
                             const BalanceOptions& options) {
  options.validate();
  internal::require_finite("balance_forces", contacts, reference_point_O);
  if (!load.allFinite()) throw base::InvalidInput("balance_forces: the load is not finite");
  base::require(!contacts.empty() || options.least_normal_sum == 0.0, "balance_forces",
                "least_normal_sum", options.least_normal_sum, "0 without contacts");
  const auto num_contacts = std::ssize(contacts);
  const Index num_edges = options.num_cone_edges;
  Eigen::Matrix3Xd edges(3, num_contacts * num_edges);
  Wrenches wrenches(6, edges.cols());
  for (Index i = 0; i < num_contacts; ++i) {
    const Contact& contact = contacts[i];
    edges.middleCols(i * num_edges, num_edges) = cone_edges(
        friction_cone(contact.inward_normal_O, options.friction), options.num_cone_edges);
    for (Index k = i * num_edges; k < (i + 1) * num_edges; ++k) {
      wrenches.col(k) =
          wrench(edges.col(k), contact.point_O, reference_point_O, *options.torque_scale);
    }
  }
  // The force along an edge counts as one more component of its wrench, in a dimension of its own.
  const Index num_own = options.evenness > 0.0 ? edges.cols() : 0;
  MatrixXd terms = MatrixXd::Zero(6 + num_own, edges.cols());
  terms.topRows(6) = wrenches;
  terms.bottomRows(num_own).diagonal().setConstant(options.evenness);
  VectorXd target = VectorXd::Zero(6 + num_own);
  target.head(6) = load;
  BalanceForces result;
  result.edge_forces = geometry::nonnegative_least_squares(terms, target);
  // Where the optimum without the bound violates it, the bound is met exactly: the residual grows
  // with the distance from that optimum.
  if (result.edge_forces.sum() < options.least_normal_sum) {
    result.edge_forces = weights_of_sum(terms, target, options.least_normal_sum);
  }
  result.forces_O.resize(3, num_contacts);
  for (Index i = 0; i < num_contacts; ++i) {
    result.forces_O.col(i) = edges.middleCols(i * num_edges, num_edges) *
                             result.edge_forces.segment(i * num_edges, num_edges);
  }
  result.residual = wrenches * result.edge_forces - load;
  result.residual_norm = result.residual.norm();
  result.normal_sum = result.edge_forces.sum();
  return result;
}

}  // namespace graspfit::contact
