#include "support/openvdb_field.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <vector>

// This is the only source that includes OpenVDB's headers.

namespace graspfit::testing {
namespace {

// This is OpenVDB's default.
const float kBand = static_cast<float>(openvdb::LEVEL_SET_HALF_WIDTH);

}  // namespace

struct OpenVdbField::Grid {
  openvdb::FloatGrid::Ptr field;
  double voxel_size = 0.0;
};

double OpenVdbField::at(const Eigen::Vector3i& voxel) const {
  return static_cast<double>(
             grid_->field->tree().getValue(openvdb::Coord(voxel[0], voxel[1], voxel[2]))) /
         grid_->voxel_size;
}

std::size_t OpenVdbField::num_bytes() const { return grid_->field->memUsage(); }

struct OpenVdbMesh::Data {
  openvdb::math::Transform::Ptr transform;
  double voxel_size = 0.0;
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
};

OpenVdbMesh::OpenVdbMesh(const geometry::TriangleMesh& mesh,
                         const geometry::VoxelLattice& lattice) {
  openvdb::initialize();
  const auto data = std::make_shared<Data>();
  data->voxel_size = lattice.voxel_size;
  data->transform = openvdb::math::Transform::createLinearTransform(lattice.voxel_size);
  const Eigen::Vector3d first = lattice.center(Eigen::Vector3i::Zero());
  data->transform->postTranslate({first[0], first[1], first[2]});
  for (const Eigen::Vector3d& v : mesh.vertices) {
    data->points.emplace_back(static_cast<float>(v[0]), static_cast<float>(v[1]),
                              static_cast<float>(v[2]));
  }
  for (const geometry::Face& f : mesh.faces) {
    data->triangles.emplace_back(static_cast<openvdb::Index32>(f[0]),
                                 static_cast<openvdb::Index32>(f[1]),
                                 static_cast<openvdb::Index32>(f[2]));
  }
  data_ = data;
}

OpenVdbField OpenVdbMesh::signed_distance_field() const {
  const auto grid = std::make_shared<OpenVdbField::Grid>();
  grid->field = openvdb::tools::meshToSignedDistanceField<openvdb::FloatGrid>(
      *data_->transform, data_->points, data_->triangles, {}, kBand, kBand);
  grid->voxel_size = data_->voxel_size;
  return OpenVdbField(grid);
}

OpenVdbField OpenVdbMesh::unsmoothed_distance_field() const {
  constexpr int kFlags = openvdb::tools::DISABLE_RENORMALIZATION |
                         openvdb::tools::DISABLE_INTERSECTING_VOXEL_REMOVAL |
                         openvdb::tools::DISABLE_NARROW_BAND_TRIMMING;
  std::vector<openvdb::Vec3s> points;
  for (const openvdb::Vec3s& p : data_->points) {
    points.emplace_back(data_->transform->worldToIndex(p));
  }
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> mesh(
      points, data_->triangles);
  const auto grid = std::make_shared<OpenVdbField::Grid>();
  openvdb::util::NullInterrupter never;
  grid->field = openvdb::tools::meshToVolume<openvdb::FloatGrid>(never, mesh, *data_->transform,
                                                                 kBand, kBand, kFlags);
  grid->voxel_size = data_->voxel_size;
  return OpenVdbField(grid);
}

struct OpenVdbThreads::Control {
  tbb::global_control limit;
};

OpenVdbThreads::OpenVdbThreads(int count)
    : control_(new Control{tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                               static_cast<std::size_t>(count))}) {}

OpenVdbThreads::~OpenVdbThreads() = default;

}  // namespace graspfit::testing
