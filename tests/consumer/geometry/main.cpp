// This program links every layer below the public headers: mesh building, file formats (assimp) and
// the exact kernel's containment, from nothing but an installed graspfit.
#include <cstdio>
#include <filesystem>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"

int main() {
  namespace geometry = graspfit::geometry;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "consumer_torus.off";
  geometry::write_mesh(file, geometry::torus(0.05, 0.02));
  const geometry::TriangleMesh mesh = geometry::read_mesh(file).mesh;
  std::filesystem::remove(file);

  // The volume is 2 pi^2 R r^2 = 3.948e-4 m^3; the inscribed polyhedron has a little less.
  const double volume = geometry::mass_properties(mesh).volume;
  std::printf("torus: %zu faces, %.6f liters\n", mesh.faces.size(), 1000 * volume);
  if (volume < 3.9e-4 || volume > 3.95e-4) return 1;

  try {
    geometry::read_mesh("there is no such file.off");
  } catch (const graspfit::base::IoError&) {
    return 0;
  }
  return 1;
}
