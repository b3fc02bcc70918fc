#include <list>
#include <mutex>

#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/named_shapes.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "internal/data_files.hpp"

namespace graspfit::experiments {
namespace {

namespace fs = std::filesystem;

/// The last few values made, by key. Two threads that want the same new value may both make it.
template <class Value>
class LastUsed {
 public:
  template <class Make>
  std::shared_ptr<const Value> value(const std::string& key, const Make& make) {
    if (std::shared_ptr<const Value> kept = find(key)) return kept;
    auto made = std::make_shared<const Value>(make());
    const std::lock_guard lock(mutex_);
    values_.emplace_front(key, made);
    constexpr std::size_t kMost = 4;  // A few meshes; one per thread that works is enough.
    if (values_.size() > kMost) values_.pop_back();
    return made;
  }

 private:
  std::shared_ptr<const Value> find(const std::string& key) {
    const std::lock_guard lock(mutex_);
    for (auto entry = values_.begin(); entry != values_.end(); ++entry) {
      if (entry->first != key) continue;
      values_.splice(values_.begin(), values_, entry);
      return values_.front().second;
    }
    return nullptr;
  }

  std::mutex mutex_;
  std::list<std::pair<std::string, std::shared_ptr<const Value>>> values_;
};

/// What lengths are multiplied by so that the mesh has the size that is wanted.
double scale_of(const ObjectSettings& settings, const geometry::TriangleMesh& mesh) {
  if (!settings.size) return 1.0;
  const Eigen::Vector3d extents = geometry::bounding_box(mesh).sizes();
  const double extent = settings.size_axis ? extents[*settings.size_axis] : extents.maxCoeff();
  if (!(extent > 0.0)) {
    throw geometry::DegenerateGeometry(settings.file + settings.shape +
                                       ": has no extent along its size_axis");
  }
  return *settings.size / extent;
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
  const fs::path file = internal::data_file(settings.file);
  grasp::ObjectReadOptions options;
  if (settings.size) {
    options.meters_per_file_unit = scale_of(settings, geometry::read_mesh(file).mesh);
  }
  return grasp::read_object_file(file, options);
}

fs::path hand_file(const std::string& hand) {
  const bool is_in_data_folder = hand.find('/') != std::string::npos;
  return is_in_data_folder ? internal::data_file(hand) : hands::find_hand_file(hand);
}

}  // namespace

std::shared_ptr<const grasp::ObjectFile> load_object(const ObjectSettings& settings) {
  static LastUsed<grasp::ObjectFile> objects;
  const std::string key = settings.file + '\n' + settings.shape + '\n' +
                          (settings.size ? geometry::shortest_decimal(*settings.size) : "") + '\n' +
                          (settings.size_axis ? std::to_string(*settings.size_axis) : "longest");
  return objects.value(
      key, [&] { return settings.shape.empty() ? file_object(settings) : shape_object(settings); });
}

std::shared_ptr<const hands::HandModel> load_hand(const std::string& hand) {
  static LastUsed<hands::HandModel> models;
  return models.value(hand, [&] { return hands::read_hand_model(hand_file(hand)); });
}

std::vector<fs::path> planning_inputs(const PlanningSettings& settings) {
  std::vector<fs::path> files;
  if (!settings.object.file.empty()) {
    files.push_back(internal::data_folder() / settings.object.file);
  }
  try {
    const fs::path description = hand_file(settings.hand);
    files.push_back(description);
    files.push_back(hands::sidecar_file_of(description));
    for (const hands::Link& link : load_hand(settings.hand)->links) {
      for (const std::string& file : link.mesh_files) {
        files.push_back((description.parent_path() / file).lexically_normal());
      }
    }
  } catch (const geometry::Error&) {
    return files;  // The cell itself says what is wrong with its hand.
  }
  return files;
}

}  // namespace graspfit::experiments
