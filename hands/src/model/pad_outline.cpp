#include "model/pad_outline.hpp"

namespace graspfit::hands::internal {

std::vector<Side> sides(const std::vector<Eigen::Vector2d>& outline) {
  std::vector<Side> result;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d edge = outline[(i + 1) % outline.size()] - a;
    const double length = edge.norm();
    if (length == 0.0) continue;
    const Eigen::Vector2d inward = Eigen::Vector2d(-edge.y(), edge.x()) / length;
    result.push_back({inward, inward.dot(a)});
  }
  return result;
}

double area_of(const std::vector<Eigen::Vector2d>& outline) {
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    twice += cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
  }
  return 0.5 * twice;
}

}  // namespace graspfit::hands::internal
