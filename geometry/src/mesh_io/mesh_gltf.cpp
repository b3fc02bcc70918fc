#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <string>

#include "graspfit/base/errors.hpp"
#include "mesh_io/checked_glb.hpp"
#include "mesh_io/mesh_formats.hpp"

namespace graspfit::geometry::internal {
namespace {

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return result;
}

void add(const aiMesh& mesh, const Eigen::Matrix4d& X, PolygonSoup& soup) {
  const std::size_t first = soup.vertices.size();
  for (unsigned int i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& v = mesh.mVertices[i];
    soup.add_vertex((X * Eigen::Vector4d(v.x, v.y, v.z, 1.0)).head<3>());
  }
  // The triangles of a mirrored part have the opposite orientation.
  const bool is_mirrored = X.topLeftCorner<3, 3>().determinant() < 0.0;
  for (unsigned int i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices < 3) continue;  // Points and lines.
    soup.polygon_begin.push_back(soup.corners.size());
    for (unsigned int k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices) {
        throw base::IoError(
            out_of_range(soup.num_polygons() - 1, face.mIndices[k], mesh.mNumVertices));
      }
      soup.corners.push_back(static_cast<std::int32_t>(first + face.mIndices[k]));
    }
    if (is_mirrored) {
      std::reverse(soup.corners.begin() + soup.polygon_begin.back(), soup.corners.end());
    }
  }
}

void add(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& X_parent,
         PolygonSoup& soup) {
  const Eigen::Matrix4d X = X_parent * matrix(node.mTransformation);
  for (unsigned int i = 0; i < node.mNumMeshes; ++i) {
    if (node.mMeshes[i] < scene.mNumMeshes) {
      add(*scene.mMeshes[node.mMeshes[i]], X, soup);
    }
  }
  for (unsigned int i = 0; i < node.mNumChildren; ++i) add(scene, *node.mChildren[i], X, soup);
}

}  // namespace

PolygonSoup import_gltf(std::string_view content, const std::filesystem::path& folder) {
  const std::string glb = checked_glb(content, folder);
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFileFromMemory(glb.data(), glb.size(), 0, "glb");
  if (scene == nullptr || scene->mRootNode == nullptr) {
    std::string reason = importer.GetErrorString();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    throw base::IoError("not a glTF mesh: " + reason);
  }
  PolygonSoup soup;
  add(*scene, *scene->mRootNode, Eigen::Matrix4d::Identity(), soup);
  return soup;
}

}  // namespace graspfit::geometry::internal
