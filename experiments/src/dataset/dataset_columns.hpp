#pragma once

/// \file
/// Columns of a data set's tables that its arrays and its card are made of.

namespace graspfit::experiments::internal {

inline constexpr const char* kLicenseColumn = "license";
inline constexpr const char* kGraspsColumn = "grasps";
inline constexpr const char* kGraspFileColumn = "grasp_file";
inline constexpr const char* kGraspFileName = "grasps.json";

}  // namespace graspfit::experiments::internal
