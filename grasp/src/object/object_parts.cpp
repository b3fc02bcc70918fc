#include "object/object_parts.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

namespace graspfit::grasp::internal {
namespace {

// Raised whenever the same input may give other parts.
constexpr std::string_view kAlgorithm = "object parts 3";

/// A patch without its faces, as the cache stores it.
struct PatchRecord {
  std::int64_t voxel;
  std::int64_t num_faces;
  std::int64_t has_normal;
  double area;
  std::array<std::array<double, 3>, 5> vectors;
};
static_assert(sizeof(PatchRecord) == 19 * 8, "without padding");

std::array<double, 3> numbers(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }
Eigen::Vector3d vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

class ByteWriter {
 public:
  template <typename T>
  void list(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto size = static_cast<std::int64_t>(values.size());
    append(&size, sizeof size);
    append(values.data(), values.size() * sizeof(T));
  }
  std::string take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) {
    if (size > 0) bytes_.append(static_cast<const char*>(data), size);
  }
  std::string bytes_;
};

/// Reads lists from bytes. After a list that is incomplete the reader stays bad, and all further
/// lists are empty.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  std::vector<T> list() {
    std::int64_t size = 0;
    if (bytes_.size() < sizeof size) return bad<T>();
    std::memcpy(&size, bytes_.data(), sizeof size);
    bytes_.remove_prefix(sizeof size);
    if (size < 0 || static_cast<std::uint64_t>(size) > bytes_.size() / sizeof(T)) return bad<T>();
    std::vector<T> values(size);
    if (size > 0) std::memcpy(values.data(), bytes_.data(), values.size() * sizeof(T));
    bytes_.remove_prefix(values.size() * sizeof(T));
    return values;
  }
  bool is_finished() const { return is_good_ && bytes_.empty(); }

 private:
  template <typename T>
  std::vector<T> bad() {
    is_good_ = false;
    bytes_ = {};
    return {};
  }

  std::string_view bytes_;
  bool is_good_ = true;
};

bool is_in(std::int64_t index, std::int64_t size) { return index >= 0 && index < size; }

}  // namespace

std::string object_parts_key(const geometry::TriangleMesh& mesh,
                             const ObjectModelOptions& options) {
  const ScoreOptions& score = options.score;
  base::ContentKey key(kAlgorithm);
  for (const double value : {options.margin.value_or(-1.0), score.gamma_deg, score.length_voxels,
                             score.floor, score.median_factor}) {
    key.number(value);
  }
  for (const int value :
       {options.resolution, static_cast<int>(options.averaging), score.neighborhood,
        static_cast<int>(score.normalization), static_cast<int>(score.plane_distance),
        score.mean_filter_radius, score.mean_filter_passes}) {
    key.number(std::int64_t{value});
  }
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) &&
                sizeof(geometry::Face) == 3 * sizeof(std::int32_t));
  key.list(mesh.vertices);
  key.list(mesh.faces);
  return key.sha256();
}

std::string to_bytes(const ObjectParts& parts) {
  std::vector<PatchRecord> records;
  std::vector<std::int32_t> faces;
  for (const geometry::SurfacePatch& patch : parts.patches) {
    records.push_back(
        {patch.voxel,
         static_cast<std::int64_t>(patch.faces.size()),
         patch.has_normal,
         patch.area,
         {numbers(patch.centroid), numbers(patch.outward_normal), numbers(patch.area_centroid),
          numbers(patch.area_weighted_normal), numbers(patch.plain_normal)}});
    faces.insert(faces.end(), patch.faces.begin(), patch.faces.end());
  }
  const auto& first = parts.distance.first_partial;
  const auto& last = parts.distance.last_partial;
  ByteWriter out;
  out.list(records);
  out.list(faces);
  out.list(parts.grid.classes);
  out.list(parts.distance.values);
  out.list(std::vector<std::int32_t>{first[0], first[1], first[2], last[0], last[1], last[2]});
  out.list(parts.scores.scores);
  out.list(parts.scores.mean_plane_distance);
  out.list(parts.scores.mean_normal_angle_deg);
  return out.take();
}

std::optional<ObjectParts> from_bytes(std::string_view bytes, const geometry::VoxelLattice& lattice,
                                      std::size_t num_faces) {
  ByteReader in(bytes);
  const auto records = in.list<PatchRecord>();
  const auto faces = in.list<std::int32_t>();
  ObjectParts parts;
  parts.grid.lattice = lattice;
  parts.grid.classes = in.list<geometry::VoxelClass>();
  parts.distance.lattice = lattice;
  parts.distance.values = in.list<float>();
  const auto partial = in.list<std::int32_t>();
  parts.scores.scores = in.list<double>();
  parts.scores.mean_plane_distance = in.list<double>();
  parts.scores.mean_normal_angle_deg = in.list<double>();
  const auto num_voxels = static_cast<std::size_t>(lattice.num_voxels());
  if (!in.is_finished() || parts.grid.classes.size() != num_voxels ||
      parts.distance.values.size() != num_voxels || partial.size() != 6 ||
      parts.scores.scores.size() != records.size() ||
      parts.scores.mean_plane_distance.size() != records.size() ||
      parts.scores.mean_normal_angle_deg.size() != records.size() ||
      !std::all_of(faces.begin(), faces.end(), [&](std::int32_t face) {
        return is_in(face, static_cast<std::int64_t>(num_faces));
      })) {
    return std::nullopt;
  }
  parts.distance.first_partial = {partial[0], partial[1], partial[2]};
  parts.distance.last_partial = {partial[3], partial[4], partial[5]};
  std::size_t first_face = 0;
  parts.patches.reserve(records.size());
  for (const PatchRecord& record : records) {
    if (!is_in(record.voxel, lattice.num_voxels()) ||
        !is_in(record.num_faces, static_cast<std::int64_t>(faces.size() - first_face) + 1)) {
      return std::nullopt;
    }
    geometry::SurfacePatch& patch = parts.patches.emplace_back();
    patch.voxel = record.voxel;
    patch.area = record.area;
    patch.centroid = vector(record.vectors[0]);
    patch.outward_normal = vector(record.vectors[1]);
    patch.has_normal = record.has_normal != 0;
    patch.area_centroid = vector(record.vectors[2]);
    patch.area_weighted_normal = vector(record.vectors[3]);
    patch.plain_normal = vector(record.vectors[4]);
    const auto begin = faces.begin() + first_face;
    patch.faces.assign(begin, begin + record.num_faces);
    first_face += static_cast<std::size_t>(record.num_faces);
  }
  if (first_face != faces.size()) return std::nullopt;
  return parts;
}

}  // namespace graspfit::grasp::internal
