#include "support/qhull.hpp"

#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace graspfit::testing {

QhullResult qhull(const Eigen::MatrixXd& points, const char* options) {
  QhullResult result;
  qhT state;
  qhT* qh = &state;
  qh_zero(qh, stderr);
  std::string command = "qhull ";
  command += options;
  Eigen::MatrixXd copy = points;
  std::FILE* const silent = std::fopen("/dev/null", "w");
  const int failure =
      qh_new_qhull(qh, static_cast<int>(points.rows()), static_cast<int>(points.cols()),
                   copy.data(), False, command.data(), nullptr, silent);
  if (failure == 0) {
    result.is_full = true;
    qh_getarea(qh, qh->facet_list);
    result.volume = qh->totvol;
    vertexT* vertex = nullptr;
    FORALLvertices { result.vertices.push_back(qh_pointid(qh, vertex->point)); }
    std::sort(result.vertices.begin(), result.vertices.end());
    result.planes.resize(points.rows() + 1, qh->num_facets);
    Eigen::Index column = 0;
    facetT* facet = nullptr;
    FORALLfacets {
      for (Eigen::Index j = 0; j < points.rows(); ++j) result.planes(j, column) = facet->normal[j];
      result.planes(points.rows(), column++) = facet->offset;
    }
  }
  // Qhull first frees the long blocks one by one, then all short ones at once. With qh_ALL the
  // latter would stay.
  qh_freeqhull(qh, !qh_ALL);
  int num_long = 0, long_bytes = 0;
  qh_memfreeshort(qh, &num_long, &long_bytes);
  if (silent != nullptr) std::fclose(silent);
  return result;
}

}  // namespace graspfit::testing
