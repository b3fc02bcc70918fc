#include "methods/sample_model.hpp"

namespace graspfit::grasp::internal {

GuidanceModel sample_model(const std::vector<geometry::SurfaceSample>& samples) {
  GuidanceModel model;
  model.columns = {"x_m", "y_m", "z_m", "nx", "ny", "nz"};
  for (const geometry::SurfaceSample& sample : samples) {
    model.rows.push_back({sample.point.x(), sample.point.y(), sample.point.z(), sample.normal.x(),
                          sample.normal.y(), sample.normal.z()});
  }
  return model;
}

}  // namespace graspfit::grasp::internal
