#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_distance.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "support/catch.hpp"

namespace test_link_surfaces {

namespace {

namespace fs = std::filesystem;
using namespace graspfit;
using hands::TriangleMesh;

/// Reads a gripper of two boxes and a base whose collision geometry is `parts`, with its findings.
class Gripper {
 public:
  explicit Gripper(const std::vector<TriangleMesh>& parts) {
    static int count = 0;
    folder_ = fs::temp_directory_path() / ("graspfit_link_surfaces_" + std::to_string(::getpid()) +
                                           "_" + std::to_string(count++));
    fs::create_directories(folder_);
    std::string base;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::string name = "part_" + std::to_string(i) + ".obj";
      geometry::write_mesh(folder_ / name, parts[i]);
      base += "<collision><geometry><mesh filename=\"" + name + "\"/></geometry></collision>";
    }
    std::string text = "<robot name=\"gripper\"><link name=\"base\">" + base + "</link>";
    for (const std::string side : {"1", "-1"}) {
      text += "<link name=\"jaw" + side + "\"><collision><origin xyz=\"0 0 0.05\"/><geometry>" +
              "<box size=\"0.01 0.02 0.06\"/></geometry></collision></link>" +
              "<joint name=\"slide" + side + "\" type=\"prismatic\"><parent link=\"base\"/>" +
              "<child link=\"jaw" + side + "\"/><axis xyz=\"" + side + " 0 0\"/>" +
              "<limit lower=\"0.01\" upper=\"0.05\" effort=\"1\" velocity=\"1\"/></joint>";
    }
    std::ofstream(folder_ / "gripper.urdf") << text << "</robot>";
    reading_ = hands::read_hand(folder_ / "gripper.urdf");
  }
  ~Gripper() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  Gripper(const Gripper&) = delete;
  Gripper& operator=(const Gripper&) = delete;

  const TriangleMesh& base() const { return reading_.model.links[0].mesh_L; }
  std::vector<std::string> notes_on_base() const {
    std::vector<std::string> notes;
    for (const hands::HandFinding& finding : reading_.findings) {
      if (finding.item == "link base" && finding.what.find("mended") != std::string::npos) {
        notes.push_back(finding.what);
      }
    }
    return notes;
  }

 private:
  fs::path folder_;
  hands::HandReading reading_;
};

TriangleMesh without_faces(TriangleMesh mesh, std::size_t first, std::size_t count) {
  mesh.faces.erase(mesh.faces.begin() + static_cast<std::ptrdiff_t>(first),
                   mesh.faces.begin() + static_cast<std::ptrdiff_t>(first + count));
  return mesh;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (geometry::Face& face : mesh.faces) std::swap(face[1], face[2]);
  return mesh;
}

const Eigen::Vector3d kSize(0.1, 0.06, 0.02);

TEST_CASE("Broken link meshes become closed outward solids, and a note says what was done",
          "[hands][link_surfaces]") {
  const TriangleMesh box = geometry::box(kSize);
  const double volume = kSize.prod();
  struct Case {
    std::string what;
    std::vector<TriangleMesh> parts;
    double volume;  ///< [m³]
    std::size_t num_notes;
    std::string says;
  };
  const std::vector<Case> cases = {
      {"sound", {box}, volume, 0, ""},
      {"one triangle missing", {without_faces(box, 0, 1)}, volume, 1, "3 boundary edges"},
      {"inside out", {inside_out(box)}, volume, 1, "1 parts inside out"},
      {"the same twice", {box, box}, volume, 0, ""},
      {"the same twice and broken",
       {without_faces(box, 3, 1), without_faces(box, 3, 1)},
       volume,
       1,
       "6 boundary edges"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.what);
    const Gripper gripper(c.parts);
    const geometry::MeshAnalysis analysis = geometry::analyze(gripper.base());
    CHECK(analysis.is_closed);
    CHECK(analysis.is_outward);
    CHECK(geometry::mass_properties(gripper.base()).volume == Approx(c.volume).epsilon(1e-12));
    const auto notes = gripper.notes_on_base();
    REQUIRE(notes.size() == c.num_notes);
    if (c.num_notes > 0) CHECK(notes[0].find(c.says) != std::string::npos);
  }
}

TEST_CASE("A link that is a flat sheet is wrapped, and a sound part beside it stays as it is",
          "[hands][link_surfaces]") {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0.1, 0.1}, {0, 0.1, 0.1}};
  sheet.faces = {{0, 1, 2}, {0, 2, 3}};
  const TriangleMesh box = geometry::box(kSize);
  const Gripper alone({sheet});
  CHECK(geometry::analyze(alone.base()).is_closed);
  REQUIRE(alone.notes_on_base().size() == 1);
  // As the note says, the distance is 0.005 of 100 mm.
  CHECK(alone.notes_on_base()[0].find("wrapped at a distance of 0.5 mm") != std::string::npos);
  const auto away =
      geometry::hausdorff_distance(geometry::MeshQuery(alone.base()), geometry::MeshQuery(sheet));
  CHECK(away.upper >= 0.0005);
  CHECK(away.lower <= 0.0025);  // Corners stand a few offsets away.

  const Gripper beside({geometry::concatenated({sheet, box})});
  const TriangleMesh& mesh = beside.base();
  for (const Eigen::Vector3d& corner : box.vertices) {
    CHECK(std::find(mesh.vertices.begin(), mesh.vertices.end(), corner) != mesh.vertices.end());
  }
  CHECK(geometry::analyze(mesh).is_closed);
}

}  // namespace

}  // namespace test_link_surfaces
