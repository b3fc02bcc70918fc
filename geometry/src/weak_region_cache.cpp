#include <charconv>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string_view>
#include <system_error>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/weak_regions.hpp"

namespace graspfit::geometry {
namespace {

namespace fs = std::filesystem;

// Raised whenever the same input may give another result.
constexpr std::string_view kAlgorithm = "weak regions 1";
constexpr std::string_view kHead = "graspfit weak regions 1\n";
constexpr std::string_view kSeal = "sha256 ";

std::optional<fs::path> environment_folder(const char* name) {
  const char* const value = std::getenv(name);
  // The XDG base directory specification: paths that are not absolute are ignored.
  if (value == nullptr || !fs::path(value).is_absolute()) return std::nullopt;
  return fs::path(value);
}

std::optional<fs::path> cache_folder(const WeakRegionCache& cache) {
  if (!cache.is_on) return std::nullopt;
  if (cache.folder) return cache.folder;
  if (const auto folder = environment_folder("GRASPFIT_CACHE")) return *folder / "weak_regions";
  if (const auto folder = environment_folder("XDG_CACHE_HOME")) {
    return *folder / "graspfit/weak_regions";
  }
  if (const auto home = environment_folder("HOME")) return *home / ".cache/graspfit/weak_regions";
  return std::nullopt;
}

template <typename T>
void append_bytes(std::string& text, const T* data, std::size_t count) {
  const std::size_t size = text.size();
  text.resize(size + count * sizeof(T));
  if (count > 0) std::memcpy(text.data() + size, data, count * sizeof(T));
}

// Numbers separated by blanks, lists with their length in front; read back by Reader.
class Writer {
 public:
  void number(std::int64_t value) { text_ += std::to_string(value) + ' '; }
  void number(double value) { text_ += shortest_decimal(value) + ' '; }
  void faces(const std::vector<std::int32_t>& faces) {
    number(static_cast<std::int64_t>(faces.size()));
    for (const std::int32_t face : faces) number(std::int64_t{face});
    text_ += '\n';
  }
  void end_line() { text_ += '\n'; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  template <typename T>
  T number(T least, T most) {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n')) {
      text_.remove_prefix(1);
    }
    T value{};
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc() || !(value >= least && value <= most)) {
      is_good_ = false;
      text_ = {};
      return least;
    }
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }
  std::vector<std::int32_t> faces(std::int64_t num_faces) {
    const auto count = number<std::int64_t>(0, num_faces);
    std::vector<std::int32_t> faces;
    for (std::int64_t i = 0; i < count && is_good_; ++i) {
      faces.push_back(static_cast<std::int32_t>(number<std::int64_t>(0, num_faces - 1)));
    }
    return faces;
  }
  bool is_good() const { return is_good_; }
  bool is_finished() const {
    return is_good_ && text_.find_first_not_of(" \n") == std::string_view::npos;
  }

 private:
  std::string_view text_;
  bool is_good_ = true;
};

std::string to_text(const WeakRegions& result, const std::string& key) {
  Writer out;
  out.number(static_cast<std::int64_t>(result.outcome));
  out.number(result.voxel_size);
  out.end_line();
  for (const double thickness : result.thickness) out.number(thickness);
  out.end_line();
  std::vector<std::int32_t> weak;
  for (std::size_t face = 0; face < result.is_weak.size(); ++face) {
    if (result.is_weak[face]) weak.push_back(static_cast<std::int32_t>(face));
  }
  out.faces(weak);
  out.number(static_cast<std::int64_t>(result.regions.size()));
  out.end_line();
  for (const WeakRegion& region : result.regions) {
    out.number(static_cast<std::int64_t>(region.verdict));
    out.number(std::int64_t{region.num_necks});
    out.number(region.thickness);
    out.number(region.length);
    out.faces(region.faces);
  }
  const std::string content = std::string(kHead) + key + '\n' + out.text();
  return content + std::string(kSeal) + sha256_hex(content) + '\n';
}

/// Empty unless the text is exactly one that was written for this key.
std::optional<WeakRegions> from_text(std::string_view text, const std::string& key,
                                     std::size_t num_faces) {
  const std::string head = std::string(kHead) + key + '\n';
  const std::size_t seal = kSeal.size() + 64 + 1;
  if (!text.starts_with(head) || text.size() < head.size() + seal) return std::nullopt;
  const std::string_view content = text.substr(0, text.size() - seal);
  if (text.substr(content.size()) != std::string(kSeal) + sha256_hex(content) + '\n') {
    return std::nullopt;
  }
  constexpr double kMost = std::numeric_limits<double>::infinity();
  const auto most_faces = static_cast<std::int64_t>(num_faces);
  Reader in(content.substr(head.size()));
  WeakRegions result;
  result.outcome = static_cast<WeakOutcome>(in.number<int>(0, 2));
  result.voxel_size = in.number<double>(0.0, kMost);
  for (std::size_t face = 0; face < num_faces; ++face) {
    result.thickness.push_back(in.number<double>(0.0, kMost));
  }
  result.is_weak.assign(num_faces, false);
  for (const std::int32_t face : in.faces(most_faces)) result.is_weak[face] = true;
  const auto num_regions = in.number<std::int64_t>(0, most_faces);
  for (std::int64_t i = 0; i < num_regions && in.is_good(); ++i) {
    WeakRegion region;
    region.verdict = static_cast<WeakVerdict>(in.number<int>(0, 4));
    region.num_necks = in.number<int>(0, std::numeric_limits<int>::max());
    region.thickness = in.number<double>(0.0, kMost);
    region.length = in.number<double>(0.0, kMost);
    region.faces = in.faces(most_faces);
    result.regions.push_back(std::move(region));
  }
  if (!in.is_finished()) return std::nullopt;
  return result;
}

std::optional<WeakRegions> read_cached(const fs::path& file, const std::string& key,
                                       std::size_t num_faces) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  try {
    return from_text(read_file(file), key, num_faces);
  } catch (const IoError&) {
    return std::nullopt;  // A cache that cannot be read is as good as none.
  }
}

}  // namespace

std::string weak_region_key(const TriangleMesh& mesh, const WeakRegionOptions& options) {
  const ShapeDiameterOptions& rays = options.shape_diameter;
  std::string text(kAlgorithm);
  for (const double value :
       {options.weak_thickness, options.min_length_ratio, options.voxels_per_thickness,
        rays.cone_angle_deg, rays.trim_deviations}) {
    text += ' ' + shortest_decimal(value);
  }
  text += ' ' + std::to_string(options.max_resolution) + ' ' + std::to_string(rays.num_rays) + ' ' +
          std::to_string(mesh.vertices.size()) + ' ' + std::to_string(mesh.faces.size()) + '\n';
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && sizeof(Face) == 12);
  append_bytes(text, mesh.vertices.data(), mesh.vertices.size());
  append_bytes(text, mesh.faces.data(), mesh.faces.size());
  return sha256_hex(text);
}

WeakRegions cached_weak_regions(const MeshQuery& object, const WeakRegionOptions& options,
                                const WeakRegionCache& cache) {
  options.validate();
  const std::optional<fs::path> folder = cache_folder(cache);
  if (!folder) return find_weak_regions(object, options);
  const std::string key = weak_region_key(object.mesh(), options);
  const fs::path file = *folder / (key + ".txt");
  if (auto found = read_cached(file, key, object.mesh().faces.size())) return *std::move(found);
  WeakRegions result = find_weak_regions(object, options);
  std::error_code error;
  fs::create_directories(*folder, error);
  try {
    if (!error) write_file_atomically(file, to_text(result, key));
  } catch (const IoError&) {
    // The result is right all the same; only the next run pays for it again.
  }
  return result;
}

}  // namespace graspfit::geometry
