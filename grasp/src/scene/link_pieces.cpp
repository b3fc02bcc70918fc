#include "scene/link_pieces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "graspfit/base/as_index.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

Vector3d middle_of(const Corners& c) { return (c[0] + c[1] + c[2]) / 3.0; }

/// Appends a triangle, halved across its longest edge until none is longer than `size`.
void add_parts(const Corners& c, double size, std::vector<Corners>& parts) {
  int longest = 0;
  double length = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double edge = (c[(i + 1) % 3] - c[i]).norm();
    if (edge > length) {
      length = edge;
      longest = i;
    }
  }
  if (length <= size) {
    parts.push_back(c);
    return;
  }
  const Vector3d& a = c[longest];
  const Vector3d& b = c[(longest + 1) % 3];
  const Vector3d& apex = c[(longest + 2) % 3];
  const Vector3d middle = 0.5 * (a + b);
  add_parts({a, middle, apex}, size, parts);
  add_parts({middle, b, apex}, size, parts);
}

FittingHand::Piece piece_of(const std::vector<Corners>& parts, std::size_t begin, std::size_t end) {
  geometry::TriangleMesh mesh;
  Eigen::AlignedBox3d box;
  for (std::size_t i = begin; i < end; ++i) {
    const auto first = base::as_index<std::int32_t>(mesh.vertices.size());
    for (const Vector3d& corner : parts[i]) {
      mesh.vertices.push_back(corner);
      box.extend(corner);
    }
    mesh.faces.push_back({first, first + 1, first + 2});
  }
  const Vector3d center = box.center();
  double radius = 0.0;
  for (const Vector3d& vertex : mesh.vertices) {
    radius = std::max(radius, (vertex - center).norm());
  }
  return {geometry::MeshQuery(std::move(mesh)), center, radius};
}

void gather(std::vector<Corners>& parts, std::size_t begin, std::size_t end, double size,
            std::vector<FittingHand::Piece>& pieces) {
  Eigen::AlignedBox3d middles;
  for (std::size_t i = begin; i < end; ++i) middles.extend(middle_of(parts[i]));
  int axis = 0;
  const Vector3d extent = middles.sizes();
  extent.maxCoeff(&axis);
  if (extent[axis] <= size) {
    pieces.push_back(piece_of(parts, begin, end));
    return;
  }
  const double middle = middles.center()[axis];
  const auto at =
      std::stable_partition(parts.begin() + begin, parts.begin() + end,
                            [&](const Corners& part) { return middle_of(part)[axis] <= middle; });
  const auto half = static_cast<std::size_t>(at - parts.begin());
  gather(parts, begin, half, size, pieces);
  gather(parts, half, end, size, pieces);
}

}  // namespace

std::vector<FittingHand::Piece> pieces_of(const geometry::TriangleMesh& mesh, double size) {
  std::vector<Corners> parts;
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    add_parts(geometry::corners(mesh, face), size, parts);
  }
  std::vector<FittingHand::Piece> pieces;
  if (!parts.empty()) gather(parts, 0, parts.size(), size, pieces);
  return pieces;
}

}  // namespace graspfit::grasp::internal
