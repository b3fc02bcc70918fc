#pragma once

#include <Eigen/Core>
#include <vector>

namespace graspfit::testing {

/// The hull that Qhull, an independent library, finds of some points.
struct QhullResult {
  bool is_full = false;       ///< Whether it found a hull of full dimension.
  std::vector<int> vertices;  ///< Ascending.
  Eigen::MatrixXd planes;     ///< One per facet, coplanar ones merged: outward normal, −offset.
  double volume = 0.0;
};

/// Returns the hull of the columns of `points`. With `options` empty Qhull merges facets that its
/// arithmetic cannot tell apart; "Qt" triangulates them, "QJ" moves the points instead.
QhullResult qhull(const Eigen::MatrixXd& points, const char* options = "");

}  // namespace graspfit::testing
