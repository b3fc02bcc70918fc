#pragma once

#include <cstdint>
#include <vector>

#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::contact::internal {

/// A triangle that only the exact clip can measure.
struct CutFace {
  std::int32_t face = -1;
  geometry::ConvexVolume cutting;  ///< The half-spaces that may cut it.
};

/// The object's triangles that may have area in a clip volume, ascending.
struct FacesInVolume {
  std::vector<std::int32_t> inside;  ///< Faces that lie inside as a whole; none is thin.
  std::vector<CutFace> cut;
  bool has_thin = false;  ///< Whether a cut face is thin, so that only the clip can say whether it
                          ///< has area at all.
};

/// @param thickness of the clip volume where the pad states none [m].
FacesInVolume faces_in_clip_volume(const hands::ContactPad& pad, double thickness,
                                   const geometry::RigidTransform& X_OC,
                                   const geometry::MeshQuery& object);

/// Returns the surface inside a clip volume, one piece per face that has area in it: first the
/// faces that lie inside as a whole.
std::vector<geometry::ClippedPiece> clipped_surface(const FacesInVolume& faces,
                                                    const geometry::TriangleMesh& mesh);

/// Groups connected pieces: returns indices into `pieces`, ascending in each group, the groups in
/// the order of their first piece. Two pieces are connected where their faces share an edge; groups
/// whose centroids (weighted by area) are within `distance` [m] of each other are merged, also by
/// way of a third group.
std::vector<std::vector<std::size_t>> groups_of(const std::vector<geometry::ClippedPiece>& pieces,
                                                const geometry::TriangleMesh& mesh,
                                                double distance);

}  // namespace graspfit::contact::internal
