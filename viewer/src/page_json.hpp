#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::viewer::internal {

using Json = nlohmann::ordered_json;

// Base64 of little-endian numbers, whatever the machine's order is.
std::string base64_of(std::span<const std::uint16_t> numbers);
std::string base64_of(std::span<const std::uint32_t> numbers);
std::string base64_of(std::span<const float> numbers);

Json to_json(const Eigen::Vector3d& v);
// A transform as a column-major 4×4 matrix, as WebGL takes it.
Json to_json(const geometry::RigidTransform& X);
// Vertices (float) and faces as base64.
Json to_json(const geometry::TriangleMesh& mesh);

// The text of `data` without any "<", so that it can stand in a script element; it is JSON all the
// same.
std::string script_text(const Json& data);

}  // namespace graspfit::viewer::internal
