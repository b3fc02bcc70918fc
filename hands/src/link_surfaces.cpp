#include "internal/link_surfaces.hpp"

#include <Eigen/Geometry>
#include <filesystem>
#include <utility>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"

namespace graspfit::hands::internal {

namespace {

namespace fs = std::filesystem;
using geometry::InvalidInput;
using geometry::IoError;

template <typename... Alternatives>
struct Overloaded : Alternatives... {
  using Alternatives::operator()...;
};
template <typename... Alternatives>
Overloaded(Alternatives...) -> Overloaded<Alternatives...>;

/// The folder that a description may refer to: that of the nearest package.xml above the file, or
/// else the file's own folder.
fs::path package_folder(const fs::path& description_file) {
  const fs::path folder = fs::weakly_canonical(description_file).parent_path();
  std::error_code error;
  for (fs::path at = folder; at.has_relative_path(); at = at.parent_path()) {
    if (fs::exists(at / "package.xml", error)) return at;
  }
  return folder;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

/// The file that `name` of a <mesh> means. `package://NAME/rest` is looked for in the folders named
/// NAME above the description, then in the package's folder and the description's own.
fs::path mesh_path(const fs::path& description_file, const std::string& name,
                   const std::string& item) {
  const std::string scheme = "package://";
  const fs::path package = package_folder(description_file);
  const fs::path folder = fs::weakly_canonical(description_file).parent_path();
  struct Candidate {
    fs::path root;  ///< What the file must lie in.
    fs::path path;
  };
  std::vector<Candidate> candidates;
  if (name.rfind(scheme, 0) == 0) {
    const fs::path in_scheme = name.substr(scheme.size());
    const fs::path package_name = *in_scheme.begin();
    const fs::path rest = in_scheme.lexically_relative(package_name);
    for (fs::path at = folder; at.has_relative_path(); at = at.parent_path()) {
      if (at.filename() == package_name) candidates.push_back({at, at / rest});
    }
    candidates.push_back({package, package / rest});
    candidates.push_back({folder, folder / rest});
  } else if (name.find("://") != std::string::npos && name.rfind("file://", 0) != 0) {
    throw InvalidInput(item + ": mesh " + name + ": only files and package:// are read");
  } else {
    const fs::path plain = name.rfind("file://", 0) == 0 ? name.substr(7) : name;
    candidates.push_back({package, plain.is_absolute() ? plain : folder / plain});
  }
  std::error_code error;
  for (const Candidate& candidate : candidates) {
    const fs::path file = fs::weakly_canonical(candidate.path);
    if (!lies_in(file, candidate.root)) {
      throw InvalidInput(item + ": mesh " + name + " lies outside the description's package " +
                         candidate.root.string());
    }
    if (fs::is_regular_file(file, error)) return file;
  }
  throw IoError(item + ": mesh " + name + " is not there");
}

TriangleMesh scaled_by(TriangleMesh mesh, const Eigen::Vector3d& scale) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
  if (scale.prod() < 0.0) {  // a mirror turns the surface inside out
    for (geometry::Face& face : mesh.faces) std::swap(face[1], face[2]);
  }
  return mesh;
}

/// The surface of one <visual> or <collision> in the link's frame. Primitives are inscribed: their
/// vertices lie on the round surface. The file of a <mesh> is added to `mesh_files`.
TriangleMesh surface(const DescribedGeometry& part, const fs::path& description_file,
                     const std::string& item, std::vector<std::string>& mesh_files) {
  const TriangleMesh mesh_G = std::visit(
      Overloaded{[](const BoxShape& box) { return geometry::box(box.size); },
                 [](const CylinderShape& cylinder) {
                   return geometry::cylinder(cylinder.radius, cylinder.length, 48);
                 },
                 [](const CapsuleShape& capsule) {
                   return geometry::capsule(capsule.radius, capsule.length);
                 },
                 [](const EllipsoidShape& ellipsoid) {
                   return scaled_by(geometry::ball(1.0, 3), ellipsoid.radii);
                 },
                 [](const SphereShape& sphere) { return geometry::ball(sphere.radius, 3); },
                 [&](const LoadedMeshShape& loaded) {
                   if (!loaded.filename.empty()) mesh_files.push_back(loaded.filename);
                   return loaded.mesh;
                 },
                 [&](const MeshFileShape& mesh) {
                   const fs::path file = mesh_path(description_file, mesh.filename, item);
                   const fs::path folder = fs::weakly_canonical(description_file).parent_path();
                   mesh_files.push_back(file.lexically_relative(folder).generic_string());
                   return scaled_by(geometry::read_mesh(file).mesh, mesh.scale);
                 }},
      part.shape);
  return transformed(mesh_G, part.X_LG);
}

}  // namespace

void read_link_surface(const DescribedLink& source, const fs::path& description_file, Link& link,
                       Findings& findings) {
  const std::vector<DescribedGeometry>& parts =
      source.collision.empty() ? source.visual : source.collision;
  const std::string item = description_file.string() + ": link " + source.name;
  std::vector<TriangleMesh> meshes;
  for (const DescribedGeometry& part : parts) {
    TriangleMesh mesh = surface(part, description_file, item, link.mesh_files);
    const geometry::MeshAnalysis analysis = geometry::analyze(mesh);
    if (!analysis.is_closed || !analysis.is_manifold || !analysis.is_outward) {
      try {
        mesh = geometry::repair_mesh(mesh).mesh;
      } catch (const geometry::Error& error) {
        throw InvalidInput(item + ": its surface is not closed: " + error.what());
      }
      findings.note("link " + source.name, "its surface was repaired for collision");
    }
    meshes.push_back(std::move(mesh));
  }
  link.mesh_L = geometry::concatenated(meshes);
}

}  // namespace graspfit::hands::internal
