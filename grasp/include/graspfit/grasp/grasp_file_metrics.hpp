#pragma once

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/grasp_metric.hpp"

namespace graspfit::grasp {

/// The facts about grasps of a file, for metrics in a tool's wrench convention: everything there
/// is. `object` is the record's own mesh. Both must outlive this.
class GraspFileMetrics {
 public:
  GraspFileMetrics(const GraspFile& file, const geometry::MeshQuery& object,
                   contact::WrenchTool tool);

  /// Of a grasp as measured (`RecordedScene::measure`); it must outlive the result.
  GraspMetricFacts facts(const Grasp& grasp) const;

 private:
  GraspMetricFacts shared_;  ///< What is the same for all grasps.
};

}  // namespace graspfit::grasp
