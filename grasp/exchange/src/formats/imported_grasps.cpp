#include "graspfit/exchange/imported_grasps.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

#include "approach/checked_pre_grasp.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/voxel_grid.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/hand_io.hpp"

namespace graspfit::exchange {
namespace {

using grasp::Grasp;
using grasp::GraspFile;
using grasp::PlannerOptions;

void require_solid(const grasp::ObjectRecord& object) {
  if (object.analysis.is_closed && object.analysis.is_outward) return;
  throw base::InvalidInput("import_grasps: " + object.file + " is not a closed outward solid");
}

/// Everything of the file but its grasps.
GraspFile empty_file(const grasp::ObjectFile& object, const hands::HandModel& hand,
                     const grasp::ImportRecord& source, const PlannerOptions& options) {
  GraspFile file;
  file.object = object.record;
  file.hand = hand;
  file.link_mesh_sha256 = hands::link_mesh_hashes(hand);
  file.options = options;
  const grasp::RequestedParts requested = grasp::requested_parts(hand, options);
  if (requested.palm && !hand.palm.pad) {
    throw base::InvalidInput("import_grasps: hand " + hand.name +
                             " has no pad on its palm to touch with");
  }
  for (const int finger : requested.fingers) file.fingers.push_back(hand.fingers[finger].name);
  file.palm = requested.palm;
  file.voxel_size =
      geometry::lattice_around(object.record.analysis.box, {.resolution = options.resolution})
          .voxel_size;
  file.clip_thickness = grasp::clip_thickness(options, file.voxel_size);
  file.merge_distance = grasp::merge_distance(options, file.voxel_size);
  file.stop = grasp::PlannerStop::Count;
  for (int i = 0; i <= static_cast<int>(grasp::AttemptOutcome::PoorShape); ++i) {
    file.statistics.outcomes[static_cast<grasp::AttemptOutcome>(i)] = 0;
  }
  file.imported = source;
  return file;
}

/// Adds pre-grasps and squeezes to the grasps of a file.
class Completion {
 public:
  Completion(const GraspFile& file, const geometry::TriangleMesh& mesh)
      : hand_(file.hand),
        options_(file.options),
        object_(mesh),
        collision_(file.hand),
        surroundings_(file.hand, grasp::Surroundings{}),
        center_of_mass_(geometry::mass_properties(mesh).center_of_mass),
        torque_scale_(contact::wrench_object(mesh, center_of_mass_).largest_radius) {}

  void add_to(Grasp& grasp, const ImportedGrasp& imported, std::vector<std::string>& notes) const {
    if (options_.pre_grasps) add_pre_grasp(grasp, imported, notes);
    if (grasp.contacts.empty()) return;
    grasp.squeeze = contact::squeeze_configuration(hand_, grasp.configuration, grasp.contacts,
                                                   {.center_of_mass_O = center_of_mass_,
                                                    .torque_scale = torque_scale_,
                                                    .friction = options_.squeeze_friction},
                                                   options_.squeeze);
  }

 private:
  void add_pre_grasp(Grasp& grasp, const ImportedGrasp& imported,
                     std::vector<std::string>& notes) const {
    if (grasp.penetration.is_any()) {
      notes.push_back(imported.name + ": no pre-grasp, as the grasp itself cuts something");
      return;
    }
    const grasp::PreGraspScene scene{hand_, collision_, object_, surroundings_};
    if (imported.pre_grasp_q) {
      grasp.pre_grasp = grasp::internal::checked_pre_grasp(
          scene, {grasp.configuration.X_OH, *imported.pre_grasp_q}, grasp.configuration,
          options_.pre_grasp);
      if (grasp.pre_grasp) return;
    }
    grasp.pre_grasp = grasp::find_pre_grasp(scene, grasp.configuration, options_.pre_grasp);
    const std::string instead = grasp.pre_grasp ? "another one was found" : "none was found";
    notes.push_back(imported.name +
                    (imported.pre_grasp_q ? ": its pre-grasp is not clear of the object or has no "
                                            "free way to the grasp, "
                                          : ": the file has no pre-grasp at its palm's pose, ") +
                    instead);
  }

  const hands::HandModel& hand_;
  const PlannerOptions& options_;
  geometry::MeshQuery object_;
  hands::HandCollision collision_;
  grasp::SurroundingsCollision surroundings_;
  Eigen::Vector3d center_of_mass_;
  double torque_scale_;
};

}  // namespace

void ImportTolerances::validate() const {
  const auto require = [](std::string_view field, double value) {
    base::require(value >= 0.0 && std::isfinite(value), "ImportTolerances", field, value,
                  "finite and >= 0");
  };
  require("largest_norm_error", largest_norm_error);
  require("largest_limit_excess", largest_limit_excess);
  require("largest_coupling_error", largest_coupling_error);
}

ImportResult import_grasps(const grasp::ObjectFile& object, const hands::HandModel& hand,
                           std::span<const ImportedGrasp> grasps, const grasp::ImportRecord& source,
                           const PlannerOptions& options) {
  PlannerOptions used = options;
  used.count = std::max(1, base::as_index<int>(grasps.size()));
  used.validate();
  require_solid(object.record);
  GraspFile file = empty_file(object, hand, source, used);
  const grasp::RecordedScene scene(file, object.mesh, {});
  const Completion completion(file, object.mesh);
  std::vector<Grasp> measured;
  std::vector<std::string> notes;
  for (const ImportedGrasp& imported : grasps) {
    measured.push_back(scene.measure(imported.configuration));
    measured.back().attempt = static_cast<std::int64_t>(measured.size()) - 1;
    completion.add_to(measured.back(), imported, notes);
  }
  std::vector<std::size_t> order(measured.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return measured[a].quality.m > measured[b].quality.m;
  });
  for (const std::size_t index : order) file.grasps.push_back(measured[index]);
  return {std::move(file), std::move(order), std::move(notes)};
}

}  // namespace graspfit::exchange
