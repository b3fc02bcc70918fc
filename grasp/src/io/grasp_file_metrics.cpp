#include "graspfit/grasp/grasp_file_metrics.hpp"

#include "graspfit/geometry/mass_properties.hpp"

namespace graspfit::grasp {

GraspFileMetrics::GraspFileMetrics(const GraspFile& file, const geometry::MeshQuery& object,
                                   contact::WrenchTool tool) {
  const geometry::TriangleMesh& mesh = object.mesh();
  const contact::QualityContext context{
      .center_of_mass_O = geometry::mass_properties(mesh).center_of_mass,
      .normalizing_radius = contact::normalizing_radius(geometry::bounding_box(mesh)),
      .hand = &file.hand};
  shared_.object = contact::wrench_object(mesh, context.center_of_mass_O);
  shared_.friction = file.options.friction;
  shared_.bearing_gap = bearing_gap(file);
  shared_.tool = tool;
  shared_.surface = &object;
  shared_.quality_context = context;
  shared_.quality_options = file.options.quality;
  shared_.quality_options.merge_distance = file.merge_distance;
}

GraspMetricFacts GraspFileMetrics::facts(const Grasp& grasp) const {
  GraspMetricFacts facts = shared_;
  facts.contacts = grasp.contacts;
  facts.grasp = &grasp;
  return facts;
}

}  // namespace graspfit::grasp
