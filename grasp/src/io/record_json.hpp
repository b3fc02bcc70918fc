#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "graspfit/grasp/grasp_io.hpp"
#include "io/pose_numbers.hpp"

namespace graspfit::grasp::internal {

using Json = nlohmann::ordered_json;

/// The version of grasp files that is written, and the oldest one that is read.
inline constexpr std::int64_t kGraspFileVersion = 6;
inline constexpr std::int64_t kOldestGraspFileVersion = 4;

inline Json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline Json to_json(const geometry::RigidTransform& X_AB) {
  return {{"translation_m", to_json(Eigen::Vector3d(X_AB.translation()))},
          {"rotation_wxyz", rotation_wxyz(X_AB)}};
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// The parts of a grasp file about the object, the hand and the surroundings.
Json object_json(const ObjectRecord& object, const std::optional<std::string>& used_mesh_file);
Json hand_json(const GraspFile& file);
Json surroundings_json(const GraspFile& file);

}  // namespace graspfit::grasp::internal
