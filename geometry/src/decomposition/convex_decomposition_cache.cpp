#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/geometry/convex_decomposition.hpp"

namespace graspfit::geometry {
namespace {

// Raised whenever the same input may give another result.
constexpr std::string_view kAlgorithm = "convex decomposition 6";

/// Lock on an entry, held while the entry is read or computed: one thread or process does the work
/// of seconds, while the others wait for it. Where no lock can be obtained, each does the work.
class EntryLock {
 public:
  explicit EntryLock(const std::optional<std::filesystem::path>& entry) {
    if (!entry) return;
    file_ = *entry;
    file_ += ".lock";
    std::error_code error;
    std::filesystem::create_directories(file_.parent_path(), error);
    constexpr int kOwnerMayWrite = 0644;
    descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kOwnerMayWrite);
    while (descriptor_ >= 0 && flock(descriptor_, LOCK_EX) != 0) {
      if (errno == EINTR) continue;
      close(descriptor_);
      descriptor_ = -1;
    }
  }
  /// The entry exists by now: a process that waits on the removed file, or makes a new one, reads
  /// the entry.
  ~EntryLock() {
    if (descriptor_ < 0) return;
    unlink(file_.c_str());
    close(descriptor_);
  }
  EntryLock(const EntryLock&) = delete;
  EntryLock& operator=(const EntryLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

std::string to_text(const ConvexDecomposition& result) {
  base::NumberWriter out;
  out.number(result.outward_deviation);
  out.number(result.inward_deviation);
  out.number(result.volume_error);
  out.number(std::int64_t{result.is_within_deviation});
  out.number(static_cast<std::int64_t>(result.pieces.size()));
  out.end_line();
  for (const TriangleMesh& piece : result.pieces) {
    out.number(static_cast<std::int64_t>(piece.vertices.size()));
    for (const Eigen::Vector3d& vertex : piece.vertices) {
      for (const double x : vertex) out.number(x);
    }
    out.number(static_cast<std::int64_t>(piece.faces.size()));
    for (const Face& face : piece.faces) {
      for (const std::int32_t corner : face) out.number(std::int64_t{corner});
    }
    out.end_line();
  }
  return out.text();
}

std::optional<ConvexDecomposition> from_text(std::string_view text) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  base::NumberReader in(text);
  ConvexDecomposition result;
  result.outward_deviation = in.real(0.0);
  result.inward_deviation = in.real(0.0);
  result.volume_error = in.real();
  result.is_within_deviation = in.integer(0, 1) == 1;
  const std::int64_t num_pieces = in.integer(0, kMost);
  for (std::int64_t i = 0; i < num_pieces && in.is_good(); ++i) {
    TriangleMesh piece;
    const std::int64_t num_vertices = in.integer(4, kMost);
    for (std::int64_t k = 0; k < num_vertices && in.is_good(); ++k) {
      Eigen::Vector3d vertex;
      for (double& x : vertex) x = in.real();
      piece.vertices.push_back(vertex);
    }
    const std::int64_t num_faces = in.integer(4, kMost);
    for (std::int64_t k = 0; k < num_faces && in.is_good(); ++k) {
      Face face;
      for (std::int32_t& corner : face) {
        corner = static_cast<std::int32_t>(in.integer(0, num_vertices - 1));
      }
      piece.faces.push_back(face);
    }
    result.pieces.push_back(std::move(piece));
  }
  if (!in.is_finished()) return std::nullopt;
  return result;
}

}  // namespace

std::string convex_decomposition_key(const TriangleMesh& mesh,
                                     const ConvexDecompositionOptions& options) {
  base::ContentKey key(kAlgorithm);
  key.number(options.largest_deviation);
  key.number(std::int64_t{options.max_pieces});
  key.number(std::int64_t{options.max_piece_vertices});
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && sizeof(Face) == 12);
  key.list(mesh.vertices);
  key.list(mesh.faces);
  return key.sha256();
}

ConvexDecomposition cached_convex_decomposition(const TriangleMesh& mesh,
                                                const ConvexDecompositionOptions& options,
                                                const base::ContentCache& cache) {
  options.validate();
  const std::string key = convex_decomposition_key(mesh, options);
  const EntryLock lock(cache.file_of(kConvexDecompositionKind, key));
  return cache.value(
      kConvexDecompositionKind, key, [&] { return convex_decomposition(mesh, options); }, from_text,
      to_text);
}

}  // namespace graspfit::geometry
