#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace graspfit::geometry::internal {

/// Checks a glTF or GLB file and returns a GLB that holds all buffers of the file and the part of
/// its scenes that a shape needs: nodes with their transforms, meshes and their positions and
/// indices. A reader of that GLB needs no other file and meets no number out of range.
///
/// Checked are: the container (magic, version, lengths of chunks); the nesting of the JSON, at most
/// 100; every range of bytes of buffers, views and accessors, sparse ones too; every index; that
/// nodes form trees at most 100 deep; that buffers in other files lie in `folder` or below, with
/// links followed, and are regular files that hold the stated bytes. Compressed meshes (Draco,
/// meshopt) are refused, and positions that are not three floats.
///
/// The file bounds what is allocated: buffers take at most 1 GiB together, their stated lengths are
/// not trusted before the bytes are there, and the scene has at most 20 million vertices and as
/// many corners, where a mesh that several nodes show counts for each node. Reading takes some 200
/// bytes for each vertex and corner.
/// @throws IoError with a text that lacks only the file's name.
std::string checked_glb(std::string_view content, const std::filesystem::path& folder);

}  // namespace graspfit::geometry::internal
