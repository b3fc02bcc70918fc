#include "graspfit/base/number_text.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/named_shapes.hpp"
#include "graspfit/grasp/object_laid_down.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/sweep/data_files.hpp"
#include "settings/last_used.hpp"

namespace graspfit::experiments {
namespace {

namespace fs = std::filesystem;

/// Factor by which lengths are multiplied so that the mesh has the size that is wanted.
double scale_of(const ObjectSettings& settings, const geometry::TriangleMesh& mesh) {
  const Eigen::Vector3d extents = geometry::bounding_box(mesh).sizes();
  double scale = settings.meters_per_unit.value_or(1.0);
  if (settings.size) {
    const double extent = settings.size_axis ? extents[*settings.size_axis] : extents.maxCoeff();
    if (!(extent > 0.0)) {
      throw base::DegenerateGeometry(settings.file + settings.packaged + settings.shape +
                                     ": has no extent along its size_axis");
    }
    scale = *settings.size / extent;
  }
  const double thickness = scale * extents.minCoeff();
  if (settings.largest_thickness && thickness > *settings.largest_thickness) {
    scale *= *settings.largest_thickness / thickness;
  }
  return scale;
}

/// A shape of our own as if it had been read from a file; nothing to repair.
grasp::ObjectFile shape_object(const ObjectSettings& settings) {
  grasp::ObjectFile object;
  const geometry::TriangleMesh mesh = geometry::named_shape(settings.shape);
  const double scale = scale_of(settings, mesh);
  object.mesh = scale == 1.0 ? mesh : geometry::scaled(mesh, scale);
  object.record.file = "shape " + settings.shape;
  object.record.meters_per_file_unit = scale;
  return object;
}

grasp::ObjectFile file_object(const ObjectSettings& settings) {
  const fs::path file = settings.packaged.empty() ? sweep::data_file(settings.file)
                                                  : sweep::packaged_mesh(settings.packaged);
  grasp::ObjectReadOptions options;
  options.meters_per_file_unit = settings.meters_per_unit.value_or(1.0);
  if (settings.size || settings.largest_thickness) {
    options.meters_per_file_unit = scale_of(settings, geometry::read_mesh(file).mesh);
  }
  return grasp::read_object_file(file, options);
}

/// Turns the object as `rotation_xyz` says; where this is zero, the mesh is untouched, to the bit.
void turn(const ObjectSettings& settings, grasp::ObjectFile& object) {
  if (settings.rotation_xyz.isZero(0.0)) return;
  const Eigen::Vector3d& angles = settings.rotation_xyz;
  geometry::RigidTransform X_TO = geometry::RigidTransform::Identity();
  X_TO.linear() = (Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  object.mesh = geometry::transformed(object.mesh, X_TO);
}

/// Lays the object down as `rest_pose` says; without it, the mesh is untouched.
void lay_down(const ObjectSettings& settings, grasp::ObjectFile& object) {
  if (!settings.rest_pose) return;
  object.record.center_of_mass_O = geometry::mass_properties(object.mesh).center_of_mass;
  object = grasp::laid_down(std::move(object), *settings.rest_pose);
}

/// The file that a cell's object comes from; none for a shape or where it is not there.
std::optional<fs::path> object_file_of(const ObjectSettings& settings) {
  if (!settings.file.empty()) return sweep::find_data_file(settings.file);
  if (!settings.packaged.empty()) return sweep::find_packaged_mesh(settings.packaged);
  return std::nullopt;
}

fs::path hand_file(const std::string& hand) {
  const bool is_in_data_folder = hand.find('/') != std::string::npos;
  return is_in_data_folder ? sweep::data_file(hand) : hands::find_hand_file(hand);
}

}  // namespace

std::string ObjectSettings::key() const {
  const auto text = [](const std::optional<double>& length) {
    return length ? base::shortest_decimal(*length) : "";
  };
  return file + '\n' + packaged + '\n' + shape + '\n' + text(size) + '\n' +
         (size_axis ? std::to_string(*size_axis) : "longest") + '\n' + text(meters_per_unit) +
         '\n' + text(largest_thickness) + '\n' + text(rotation_xyz.x()) + ' ' +
         text(rotation_xyz.y()) + ' ' + text(rotation_xyz.z()) + '\n' +
         (rest_pose ? std::to_string(*rest_pose) : "");
}

grasp::Surroundings surroundings_of(const PlanningSettings& settings) {
  grasp::Surroundings surroundings;
  surroundings.table_z_O = settings.object.rest_pose ? std::optional(0.0) : settings.table_z_O;
  if (surroundings.table_z_O) surroundings.table_clearance = grasp::kTableClearance;
  return surroundings;
}

std::shared_ptr<const grasp::ObjectFile> load_object(const ObjectSettings& settings) {
  static internal::LastUsed<grasp::ObjectFile> objects;
  return objects.value(settings.key(), [&] {
    grasp::ObjectFile object =
        settings.shape.empty() ? file_object(settings) : shape_object(settings);
    turn(settings, object);
    lay_down(settings, object);
    return object;
  });
}

std::shared_ptr<const hands::HandModel> load_hand(const std::string& hand) {
  static internal::LastUsed<hands::HandModel> models;
  return models.value(hand, [&] { return hands::read_hand_model(hand_file(hand)); });
}

std::vector<fs::path> planning_inputs(const PlanningSettings& settings) {
  std::vector<fs::path> files;
  if (const auto file = object_file_of(settings.object)) files.push_back(*file);
  try {
    const fs::path description = hand_file(settings.hand);
    files.push_back(description);
    files.push_back(hands::sidecar_file_of(description));
    for (const hands::Link& link : load_hand(settings.hand)->links) {
      for (const std::string& file : link.mesh_files) {
        files.push_back((description.parent_path() / file).lexically_normal());
      }
    }
  } catch (const base::Error&) {
    return files;  // The cell itself says what is wrong with its hand.
  }
  return files;
}

}  // namespace graspfit::experiments
