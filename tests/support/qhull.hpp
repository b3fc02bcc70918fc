#pragma once

#include <Eigen/Core>
#include <vector>

namespace graspfit::testing {

/// What Qhull makes of points: the independent library that hulls are compared with.
struct QhullResult {
  bool is_full = false;       ///< Whether it found a hull of full dimension.
  std::vector<int> vertices;  ///< Ascending.
  Eigen::MatrixXd planes;     ///< One per facet, coplanar ones merged: outward normal, −offset.
  double volume = 0.0;
};

/// Hull of the columns of `points`. With `options` empty Qhull merges facets that its arithmetic
/// cannot tell apart; "Qt" triangulates them, "QJ" moves the points instead.
QhullResult qhull(const Eigen::MatrixXd& points, const char* options = "");

}  // namespace graspfit::testing
