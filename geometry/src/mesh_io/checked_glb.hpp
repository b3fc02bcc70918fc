#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace graspfit::geometry::internal {

/// A glTF or GLB file, checked, as a GLB that holds all its buffers and of its scenes what a shape
/// needs: nodes with their transforms, meshes and their positions and indices. What reads it meets
/// no other file, no number out of range and nothing that is not needed.
///
/// Checked are: the container (magic, version, lengths of chunks); the nesting of the JSON, at most
/// 100; every range of bytes of buffers, views and accessors, sparse ones too; every index; that
/// nodes form trees at most 100 deep; that buffers in other files lie in `folder` or below, with
/// links followed, and are regular files that hold the stated bytes. Compressed meshes (Draco,
/// meshopt) are refused, and positions that are not three floats.
///
/// What is allocated is bounded by the file: buffers take at most 1 GiB together and are not
/// believed before they are there, and the scene has at most 20 million vertices and as many
/// corners, those of meshes that several nodes show counted for each. Reading takes some 200 bytes
/// for each of them.
/// @throws IoError with a text that lacks only the file's name.
std::string checked_glb(std::string_view content, const std::filesystem::path& folder);

}  // namespace graspfit::geometry::internal
