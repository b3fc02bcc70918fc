#include "graspfit/geometry/nonnegative_least_squares.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <string>
#include <vector>

#include "graspfit/base/errors.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A column that would lower ‖A x − b‖ at less than this rate, relative to its length and to that
/// of b, does so by rounding only.
constexpr double kGradientRel = 1e-13;

}  // namespace

VectorXd nonnegative_least_squares(const MatrixXd& a, const VectorXd& b) {
  if (a.rows() != b.size()) {
    throw base::InvalidInput("nonnegative_least_squares: the matrix has " +
                             std::to_string(a.rows()) + " rows, the target " +
                             std::to_string(b.size()));
  }
  if (!a.allFinite() || !b.allFinite()) {
    throw base::InvalidInput("nonnegative_least_squares: a number is not finite");
  }
  VectorXd x = VectorXd::Zero(a.cols());
  std::vector<Index> passive;  // columns that may be positive, ascending
  const VectorXd lengths = a.colwise().norm();
  const double target_length = b.norm();
  // Each round lowers the residual, so that no set of columns recurs in real arithmetic; the limit
  // guards against cycles by rounding.
  const Index most_rounds = 10 * (a.rows() + a.cols());
  std::vector<bool> is_refused(a.cols(), false);
  for (Index round = 0; round < most_rounds; ++round) {
    const VectorXd gradient = a.transpose() * (b - a * x);
    Index entering = -1;
    double steepest = 0.0;
    for (Index j = 0; j < a.cols(); ++j) {
      if (is_refused[j] || !(lengths[j] > 0.0) ||
          std::binary_search(passive.begin(), passive.end(), j)) {
        continue;
      }
      const double rate = gradient[j] / lengths[j];
      if (rate > kGradientRel * target_length && rate > steepest) {
        steepest = rate;
        entering = j;
      }
    }
    if (entering < 0) break;
    passive.insert(std::lower_bound(passive.begin(), passive.end(), entering), entering);
    bool is_new = true;
    while (!passive.empty()) {
      MatrixXd columns(a.rows(), passive.size());
      for (Index k = 0; k < std::ssize(passive); ++k) {
        columns.col(k) = a.col(passive[k]);
      }
      const VectorXd best = columns.colPivHouseholderQr().solve(b);
      double share = 1.0;
      for (Index k = 0; k < std::ssize(passive); ++k) {
        const double old_value = x[passive[k]];
        const double new_value = best[k];
        if (new_value <= 0.0) share = std::min(share, old_value / (old_value - new_value));
      }
      const auto position = std::lower_bound(passive.begin(), passive.end(), entering);
      if (is_new && best[position - passive.begin()] <= 0.0) {
        // Only rounding made this column lower the residual: it is nearly in the span of the
        // others.
        is_refused[entering] = true;
        passive.erase(position);
        break;
      }
      is_new = false;
      std::vector<Index> kept;
      for (Index k = 0; k < std::ssize(passive); ++k) {
        double& value = x[passive[k]];
        const double new_value = best[k];
        const bool is_blocking = new_value <= 0.0 && value / (value - new_value) <= share;
        value = is_blocking ? 0.0 : value + share * (new_value - value);
        if (value > 0.0) {
          kept.push_back(passive[k]);
        } else {
          value = 0.0;
        }
      }
      const bool is_done = kept.size() == passive.size();
      passive = std::move(kept);
      if (is_done) {
        std::fill(is_refused.begin(), is_refused.end(), false);
        break;
      }
    }
  }
  return x;
}

}  // namespace graspfit::geometry
