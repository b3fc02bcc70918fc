#include "import/link_surfaces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "description/description_package.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/lies_in.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/shapes.hpp"

namespace graspfit::hands::internal {

namespace {

namespace fs = std::filesystem;
using base::InvalidInput;
using base::IoError;

template <typename... Alternatives>
struct Overloaded : Alternatives... {
  using Alternatives::operator()...;
};
template <typename... Alternatives>
Overloaded(Alternatives...) -> Overloaded<Alternatives...>;

/// The file that `name` of a <mesh> means. `package://NAME/rest` is searched for in the folders
/// named NAME above the description, then in the package's folder, in the description's own folder,
/// and beside this folder.
fs::path mesh_path(const fs::path& description_file, const std::string& name,
                   const std::string& item) {
  const std::string scheme = "package://";
  const fs::path package = package_folder(description_file);
  const fs::path folder = fs::weakly_canonical(description_file).parent_path();
  const std::vector<fs::path> readable = readable_folders(description_file);
  struct Candidate {
    std::vector<fs::path> folders;  ///< The file must lie in one of these.
    fs::path path;
  };
  std::vector<Candidate> candidates;
  if (name.rfind(scheme, 0) == 0) {
    const fs::path in_scheme = name.substr(scheme.size());
    const fs::path package_name = *in_scheme.begin();
    const fs::path rest = in_scheme.lexically_relative(package_name);
    for (fs::path at = folder; at.has_relative_path(); at = at.parent_path()) {
      if (at.filename() == package_name) candidates.push_back({{at}, at / rest});
    }
    candidates.push_back({readable, package / rest});
    candidates.push_back({{folder}, folder / rest});
    const fs::path beside = (folder.parent_path() / rest).lexically_normal();
    if (base::lies_in(beside, readable)) candidates.push_back({readable, beside});
  } else if (name.find("://") != std::string::npos && name.rfind("file://", 0) != 0) {
    throw InvalidInput(item + ": mesh " + name + ": only files and package:// are read");
  } else {
    const fs::path plain = name.rfind("file://", 0) == 0 ? name.substr(7) : name;
    candidates.push_back({readable, plain.is_absolute() ? plain : folder / plain});
  }
  std::error_code error;
  for (const Candidate& candidate : candidates) {
    const fs::path file = fs::weakly_canonical(candidate.path, error);
    if (error) throw IoError(item + ": mesh " + name + ": " + error.message());
    if (!base::lies_in(file, candidate.folders)) {
      throw InvalidInput(item + ": mesh " + name + " " + outside_text(description_file, file));
    }
    if (fs::is_regular_file(file, error)) return file;
  }
  throw IoError(item + ": mesh " + name + " is not there");
}

/// Reads a link's mesh; errors name the description and the link.
TriangleMesh read_link_mesh(const fs::path& file, const std::string& item) {
  try {
    return geometry::read_mesh(file).mesh;
  } catch (const IoError& error) {
    throw IoError(item + ": " + error.what());
  } catch (const base::Error& error) {
    throw InvalidInput(item + ": " + error.what());
  }
}

TriangleMesh scaled_by(TriangleMesh mesh, const Eigen::Vector3d& scale) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
  if (scale.prod() < 0.0) {  // a mirror turns the surface inside out
    for (geometry::Face& face : mesh.faces) std::swap(face[1], face[2]);
  }
  return mesh;
}

/// One <visual> or <collision> in the link's frame.
struct PartSurface {
  TriangleMesh mesh_L;
  std::optional<std::string> mesh_file;  ///< Of a <mesh>.
};

/// Primitives are inscribed: their vertices lie on the round surface.
PartSurface surface(const DescribedGeometry& part, const fs::path& description_file,
                    const std::string& item) {
  std::optional<std::string> mesh_file;
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
                   if (!loaded.filename.empty()) mesh_file = loaded.filename;
                   return loaded.mesh;
                 },
                 [&](const MeshFileShape& mesh) {
                   const fs::path file = mesh_path(description_file, mesh.filename, item);
                   const fs::path folder = fs::weakly_canonical(description_file).parent_path();
                   mesh_file = file.lexically_relative(folder).generic_string();
                   return scaled_by(read_link_mesh(file, item), mesh.scale);
                 }},
      part.shape);
  return {transformed(mesh_G, part.X_LG), mesh_file};
}

/// The connected parts of a mesh, where corners with equal coordinates are one; the mesh itself if
/// there are more than kMostParts parts.
std::vector<TriangleMesh> connected_parts(const TriangleMesh& mesh) {
  constexpr std::size_t kMostParts = 200;  // more is a soup of triangles
  const auto less = [&](std::int32_t a, std::int32_t b) {
    const Eigen::Vector3d& p = mesh.vertices[a];
    const Eigen::Vector3d& q = mesh.vertices[b];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::map<std::int32_t, std::int32_t, decltype(less)> first_of(less);
  std::vector<std::int32_t> first_equal(mesh.vertices.size());
  for (std::int32_t v = 0; v < std::ssize(mesh.vertices); ++v) {
    first_equal[v] = first_of.emplace(v, v).first->second;
  }
  std::vector<std::int32_t> above(first_equal);  // union-find over distinct points
  const auto root = [&](std::int32_t v) {
    v = first_equal[v];
    while (above[v] != v) {
      v = above[v] = above[above[v]];
    }
    return v;
  };
  for (const geometry::Face& face : mesh.faces) {
    for (const int k : {1, 2}) {
      const std::int32_t a = root(face[0]);
      const std::int32_t b = root(face[k]);
      above[std::max(a, b)] = std::min(a, b);
    }
  }
  std::map<std::int32_t, std::size_t> number;  // by first vertex: the order of the file
  for (const geometry::Face& face : mesh.faces) number.emplace(root(face[0]), 0);
  if (number.size() > kMostParts) return {mesh};
  std::vector<TriangleMesh> parts(number.size());
  std::size_t next = 0;
  for (auto& [first, own] : number) own = next++;
  std::vector<std::int32_t> in_part(mesh.vertices.size(), -1);
  for (const geometry::Face& face : mesh.faces) {
    TriangleMesh& part = parts[number.at(root(face[0]))];
    geometry::Face own;
    for (std::size_t k = 0; k < 3; ++k) {
      std::int32_t& index = in_part[face[k]];
      if (index < 0) {
        index = base::as_index<std::int32_t>(part.vertices.size());
        part.vertices.push_back(mesh.vertices[face[k]]);
      }
      own[k] = index;
    }
    part.faces.push_back(own);
  }
  return parts;
}

/// What was done to the surface of one link, for the note about it.
struct ClosingReport {
  std::size_t num_boundary_edges = 0;
  std::size_t num_inward_parts = 0;
  std::map<std::string, std::size_t> steps;  ///< Number of repairs by name.
  double farthest = 0.0;                     ///< [m]
  double wrap_offset = 0.0;                  ///< [m]; 0: nothing was wrapped.

  void add(const geometry::RepairedMesh& repaired, double offset) {
    num_boundary_edges += repaired.before.num_boundary_edges;
    num_inward_parts += repaired.before.num_inward_parts;
    double moved = 0.0;
    for (const geometry::RepairStep& step : repaired.steps) {
      steps[step.what] += step.count;
      moved += step.hausdorff_bound;
      if (step.what == "wrapped") wrap_offset = std::max(wrap_offset, offset);
    }
    farthest = std::max(farthest, moved);
  }
};

/// Makes a mesh closed and outward. Each connected part is mended (holes of any size are filled); a
/// part that cannot be mended, or has no volume, is wrapped.
TriangleMesh closed_surface(const TriangleMesh& mesh, ClosingReport& report) {
  geometry::MeshRepairOptions options;
  options.max_hole_extent_rel = 1.0;  // the ends of a tube are as wide as the tube
  options.max_misfilled_rel = 1.0;    // a link that is filled somehow is nearer to it than a shell
  options.max_removed_rel = 1.0;
  try {
    const geometry::RepairedMesh repaired = geometry::repair_mesh(mesh, options);
    report.add(repaired, 0.0);
    return repaired.mesh;
  } catch (const base::Error&) {
    // The mesh is now mended part by part, so that only broken parts are wrapped.
  }
  std::vector<TriangleMesh> closed;
  options.wrap = geometry::AlphaWrap{.alpha_rel = 0.05, .offset_rel = 0.005};
  for (const TriangleMesh& part : connected_parts(mesh)) {
    const geometry::RepairedMesh repaired = geometry::repair_mesh(part, options);
    report.add(repaired, options.wrap->offset_rel * geometry::longest_extent(part));
    closed.push_back(repaired.mesh);
  }
  return geometry::concatenated(closed);
}

std::string in_millimeters(double meters) {
  return base::shortest_decimal(std::round(meters * 1e4) / 10.0) + " mm";
}

std::string text_of(const ClosingReport& report) {
  std::string text =
      "its surface was mended for collision: " + std::to_string(report.num_boundary_edges) +
      " boundary edges, " + std::to_string(report.num_inward_parts) + " parts inside out";
  for (const auto& [what, count] : report.steps) text += ", " + what + " " + std::to_string(count);
  if (report.wrap_offset > 0.0) {
    text += "; wrapped at a distance of " + in_millimeters(report.wrap_offset);
  }
  return text + "; no point of the new surface is farther than " + in_millimeters(report.farthest) +
         " from the old one";
}

}  // namespace

LinkSurface read_link_surface(const DescribedLink& source,
                              const std::filesystem::path& description_file, Findings& findings) {
  const std::vector<DescribedGeometry>& parts =
      source.collision.empty() ? source.visual : source.collision;
  const std::string item = description_file.string() + ": link " + source.name;
  LinkSurface result;
  std::vector<TriangleMesh> meshes;
  ClosingReport report;
  for (const DescribedGeometry& part : parts) {
    auto [mesh, mesh_file] = surface(part, description_file, item);
    if (mesh_file) result.mesh_files.push_back(*mesh_file);
    const geometry::MeshAnalysis analysis = geometry::analyze(mesh);
    if (!analysis.is_closed || !analysis.is_manifold || !analysis.is_outward) {
      try {
        mesh = closed_surface(mesh, report);
      } catch (const base::Error& error) {
        throw InvalidInput(item + ": its surface is not closed: " + error.what());
      }
    }
    const bool is_known = std::find(meshes.begin(), meshes.end(), mesh) != meshes.end();
    if (!is_known) meshes.push_back(std::move(mesh));  // equal parts are taken once
  }
  if (!report.steps.empty()) findings.note("link " + source.name, text_of(report));
  result.mesh_L = geometry::concatenated(meshes);
  return result;
}

}  // namespace graspfit::hands::internal
