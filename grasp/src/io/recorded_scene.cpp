#include <utility>

#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/grasp_measure.hpp"

namespace graspfit::grasp {

RecordedScene::RecordedScene(const GraspFile& file, geometry::TriangleMesh object,
                             Surroundings surroundings)
    : file_(file),
      object_(std::move(object)),
      collision_(file.hand),
      surroundings_(file.hand, std::move(surroundings)) {
  if (file.options.weak) weak_ = geometry::cached_weak_regions(object_, *file.options.weak);
  for (const std::string& name : file.fingers) {
    requested_.fingers.push_back(file.hand.finger_index(name));
  }
  requested_.palm = file.palm;
}

std::optional<double> bearing_gap(const GraspFile& file) {
  return file.imported ? std::nullopt : bearing_gap(file.options);
}

Grasp RecordedScene::measure(const hands::HandConfiguration& configuration) const {
  return measure(configuration, requested_);
}

Grasp RecordedScene::measure(const Grasp& recorded) const {
  return measure(recorded.configuration,
                 parts_to_touch(file_.options, requested_, recorded.targets));
}

Grasp RecordedScene::measure(const hands::HandConfiguration& configuration,
                             const RequestedParts& requested) const {
  const geometry::TriangleMesh& mesh = object_.mesh();
  const PlannerOptions& options = file_.options;
  contact::QualityContext context;
  context.center_of_mass_O = geometry::mass_properties(mesh).center_of_mass;
  context.normalizing_radius = contact::normalizing_radius(geometry::bounding_box(mesh));
  context.hand = &file_.hand;
  contact::QualityOptions quality_options = options.quality;
  quality_options.merge_distance = file_.merge_distance;
  const MeasuringScene scene{
      .hand = file_.hand,
      .collision = collision_,
      .object = object_,
      .surroundings = surroundings_,
      .weak = weak_ ? &*weak_ : nullptr,
      .wrench_object = contact::wrench_object(mesh, context.center_of_mass_O),
      .friction = options.friction,
      .quality_context = context,
      .quality_options = quality_options,
      .contact_options = contact_estimation(options, file_.clip_thickness),
      .largest_gap = bearing_gap(options),
      .bearing_gap = bearing_gap(file_)};
  return measure_grasp(scene, configuration, requested);
}

}  // namespace graspfit::grasp
