#pragma once

#include "graspfit/grasp/object_file.hpp"

namespace graspfit::grasp {

/// As `laid_down`, in the rest pose of this rank, ≥ 1, of the object's own among
/// `geometry::likely_rest_poses`, the likeliest being 1.
/// @throws InvalidInput that names the file if the object has fewer rest poses or is laid down
/// already, and as `geometry::likely_rest_poses`.
ObjectFile laid_down(ObjectFile object, int rank);

}  // namespace graspfit::grasp
