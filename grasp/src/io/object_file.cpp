#include "graspfit/grasp/object_file.hpp"

#include <cmath>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/grasp/object_laid_down.hpp"

namespace graspfit::grasp {
namespace {

using base::shortest_decimal;

/// Runs `work`; if it refuses the mesh, the message gets the file's name in front.
template <class Work>
auto naming_file(const std::filesystem::path& file, const Work& work) {
  const std::string name = file.string();
  const auto message = [&name](const std::exception& error) {
    const std::string what = error.what();
    return what.find(name) == std::string::npos ? name + ": " + what : what;
  };
  try {
    return work();
  } catch (const base::InvalidInput& error) {
    throw base::InvalidInput(message(error));
  } catch (const base::DegenerateGeometry& error) {
    throw base::DegenerateGeometry(message(error));
  }
}

}  // namespace

void ObjectReadOptions::validate() const {
  const auto check = [](const char* field, double value) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      throw base::InvalidInput(std::string(field) + " must be positive and finite, not " +
                               shortest_decimal(value));
    }
  };
  check("meters_per_file_unit", meters_per_file_unit);
  if (longest_extent) check("longest_extent", *longest_extent);
  repair.validate();
}

ObjectFile read_object_file(const std::filesystem::path& file, const ObjectReadOptions& options) {
  options.validate();
  geometry::MeshFile read = geometry::read_mesh(file);
  return naming_file(file, [&] {
    ObjectFile object;
    object.report = std::move(read.report);
    ObjectRecord& record = object.record;
    record.file = file.string();
    record.sha256 = base::sha256_hex(base::read_file(file));
    record.repair = options.repair;
    record.meters_per_file_unit = options.meters_per_file_unit;
    if (options.longest_extent) {
      const double extent = geometry::longest_extent(read.mesh);
      if (!(extent > 0.0)) throw base::DegenerateGeometry("the mesh has no extent");
      record.meters_per_file_unit = *options.longest_extent / extent;
    }
    const geometry::TriangleMesh in_meters =
        record.meters_per_file_unit == 1.0
            ? std::move(read.mesh)
            : geometry::scaled(read.mesh, record.meters_per_file_unit);

    geometry::RepairedMesh repaired = geometry::repair_mesh(in_meters, options.repair);
    object.mesh = std::move(repaired.mesh);
    object.before = repaired.before;
    record.analysis = repaired.after;
    record.repairs = std::move(repaired.steps);
    record.normalizing_radius = contact::normalizing_radius(record.analysis.box);
    // Only `AsIs` lets a mesh through that is not closed; its mass is left at zero.
    if (record.analysis.is_closed && record.analysis.is_outward) {
      const geometry::MassProperties mass = geometry::mass_properties(object.mesh);
      record.center_of_mass_O = mass.center_of_mass;
      record.volume = mass.volume;
    }
    return object;
  });
}

geometry::RigidTransform LaidPose::X_OF() const {
  return geometry::rigid_transform(translation, rotation_wxyz);
}

geometry::RigidTransform ObjectRecord::in_file_frame(const geometry::RigidTransform& X_OB) const {
  return laid ? geometry::relative_pose(laid->X_OF(), X_OB) : X_OB;
}

ObjectFile laid_down(ObjectFile object, const geometry::LikelyRestPose& pose, int rank) {
  ObjectRecord& record = object.record;
  if (record.laid) throw base::InvalidInput(record.file + ": is laid down already");
  LaidPose& laid = record.laid.emplace();
  laid.rank = rank;
  laid.probability = pose.probability;
  const Eigen::Vector3d center_F = record.center_of_mass_O;
  laid.rotation_wxyz = geometry::rotation_wxyz(
      geometry::standing_pose(object.mesh, pose.pose.up_O, 0.0, center_F, Eigen::Vector2d::Zero()));
  const geometry::TriangleMesh turned = geometry::transformed(object.mesh, laid.X_OF());
  const Eigen::Vector3d center = laid.X_OF() * center_F;
  laid.translation << -center.x(), -center.y(), -geometry::bounding_box(turned).min().z();
  object.mesh = geometry::transformed(object.mesh, laid.X_OF());
  record.center_of_mass_O = laid.X_OF() * center_F;
  record.analysis.box = geometry::bounding_box(object.mesh);
  record.normalizing_radius = contact::normalizing_radius(record.analysis.box);
  return object;
}

ObjectFile laid_down(ObjectFile object, int rank) {
  const std::vector<geometry::LikelyRestPose> poses =
      geometry::likely_rest_poses(object.mesh, object.record.center_of_mass_O);
  if (rank < 1 || rank > std::ssize(poses)) {
    throw base::InvalidInput(object.record.file + ": there is no rest pose " +
                             std::to_string(rank) + " among its " + std::to_string(poses.size()) +
                             " (graspfit inspect lists them)");
  }
  return laid_down(std::move(object), poses[rank - 1], rank);
}

geometry::TriangleMesh read_object(const ObjectRecord& record, const std::filesystem::path& file) {
  const std::filesystem::path found = file.empty() ? std::filesystem::path(record.file) : file;
  const std::string sha256 = base::sha256_hex(base::read_file(found));
  if (sha256 != record.sha256) {
    throw base::IoError(found.string() + ": is not the file that was planned on: its SHA-256 is " +
                        sha256 + ", not " + record.sha256);
  }
  ObjectReadOptions options;
  options.meters_per_file_unit = record.meters_per_file_unit;
  options.repair = record.repair;
  geometry::TriangleMesh mesh = read_object_file(found, options).mesh;
  return record.laid ? geometry::transformed(mesh, record.laid->X_OF()) : mesh;
}

}  // namespace graspfit::grasp
