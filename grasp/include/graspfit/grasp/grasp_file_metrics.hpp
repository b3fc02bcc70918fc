#pragma once

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/grasp_metric.hpp"

namespace graspfit::grasp {

/// All facts about the grasps of a file, for metrics in a tool's wrench convention. `object` is the
/// mesh of the file's object record. File and object must outlive this.
class GraspFileMetrics {
 public:
  GraspFileMetrics(const GraspFile& file, const geometry::MeshQuery& object,
                   contact::WrenchTool tool);

  /// The facts of a measured grasp (`RecordedScene::measure`); the grasp must outlive the result.
  GraspMetricFacts facts(const Grasp& grasp) const;

 private:
  GraspMetricFacts shared_;  ///< What is the same for all grasps.
};

}  // namespace graspfit::grasp
