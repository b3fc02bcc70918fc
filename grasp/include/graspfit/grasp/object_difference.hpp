#pragma once

#include <optional>
#include <string>

#include "graspfit/grasp/object_file.hpp"

namespace graspfit::grasp {

/// By how much the solid that is planned on may differ from the object's file before the difference
/// is reported.
struct DifferenceLimits {
  double volume_rel = 0.01;  ///< Change of the volume over that of the solid, >= 0. A hundredth is
                             ///< what voxels of the default resolution are uncertain by.
  double surface_rel = 0.005;  ///< Bound of the surface's move over the longest extent, >= 0: a
                               ///< fifth of a voxel of the default resolution.
};

/// One line on what makes the solid another one than the file's surface, as "cup.off: the solid
/// differs from the file: filled 5 holes (volume +2.1 %, surface up to 3.2 % of the extent)"; empty
/// if both changes are at most at the limits, all steps together.
///
/// Steps that keep every point of the surface, as turning faces does, count for nothing. What holes
/// change is measured as `RepairStep::volume_change` says.
std::optional<std::string> difference_from_file(const ObjectRecord& object,
                                                const DifferenceLimits& limits = {});

/// One line on why the record's wrap was not made, as "--wrap: not needed: the mesh was closed by
/// filling 3 holes"; empty if none was asked for or it was made.
std::optional<std::string> reason_against_wrap(const ObjectRecord& object);

}  // namespace graspfit::grasp
