#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/broken_meshes.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "solid/mesh_holes.hpp"
#include "support/catch.hpp"
#include "support/test_data.hpp"

namespace test_broken_meshes {

// These tests compare what becomes of the broken meshes with assets/broken_mesh_outcomes.csv, whose
// rows follow the contract of `repair_mesh` and not its answers. The columns are:
//
//   name     as in broken_meshes.cpp
//   options  of repair_mesh: strict, report, resolve, wrap=alpha_rel, hole=, weld=; none: defaults
//   before   analysis of the mesh as built: parts, and every count that is not zero; "?": any;
//            "pinched": a vertex is; "overlaps", "nested": pairs of parts, parts; "crossing",
//            "no-crossing": faces do or do not cross
//   strict   outcome of RepairMode::Strict, on the first row of each mesh
//   outcome  unchanged, repaired, InvalidInput, DegenerateGeometry, or closed: unchanged or
//            repaired
//   steps    what:count; "+": any count; "*": any further steps
//   parts    after
//   volume   signed sum, relative tolerance 1e-9 unless "~tolerance", or a range "a..b"
//   union    volume of the solid that is meant, where it differs from the signed sum
//   inside, outside, on   points with their containment
//   words    that the message must hold, each "a/b" in one of its forms
//   remark   why

using namespace graspfit::base;
using namespace graspfit::geometry;
using graspfit::testing::broken_meshes;
using graspfit::testing::BrokenMesh;

namespace {

using Row = std::map<std::string, std::string>;

std::vector<std::string> split(const std::string& text, const std::string& by) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; !text.empty();) {
    const std::size_t next = text.find(by, at);
    parts.push_back(text.substr(at, next - at));
    if (next == std::string::npos) break;
    at = next + by.size();
  }
  return parts;
}

double number(const std::string& text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  INFO("'" << text << "' is a number");
  REQUIRE((error == std::errc() && end == text.data() + text.size()));
  return value;
}

std::vector<Eigen::Vector3d> points(const std::string& text) {
  std::vector<Eigen::Vector3d> result;
  for (const std::string& point : split(text, " | ")) {
    const auto x = split(point, " ");
    REQUIRE(x.size() == 3);
    result.emplace_back(number(x[0]), number(x[1]), number(x[2]));
  }
  return result;
}

std::vector<Row> read_rows() {
  const auto file =
      graspfit::testing::source_directory() / "tests/geometry/assets/broken_mesh_outcomes.csv";
  std::ifstream in(file);
  std::string line;
  REQUIRE(std::getline(in, line));
  const auto columns = split(line, ",");
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const auto cells = split(line, ",");
    INFO(line);
    REQUIRE(cells.size() == columns.size());
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < columns.size(); ++i) row[columns[i]] = cells[i];
  }
  return rows;
}

MeshRepairOptions options_of(const Row& row) {
  MeshRepairOptions options;
  for (const std::string& word : split(row.at("options"), " ")) {
    if (word == "strict") {
      options.mode = RepairMode::Strict;
    } else if (word == "report") {
      options.self_intersections = SelfIntersections::Report;
    } else if (word == "resolve") {
      options.self_intersections = SelfIntersections::Resolve;
    } else if (word.starts_with("wrap=")) {
      options.wrap = AlphaWrap{.alpha_rel = number(word.substr(5))};
    } else if (word.starts_with("hole=")) {
      options.max_hole_extent_rel = number(word.substr(5));
    } else if (word.starts_with("weld=")) {
      options.weld_distance_rel = number(word.substr(5));
    } else {
      FAIL("unknown option " << word);
    }
  }
  return options;
}

struct Outcome {
  std::string what;
  std::string message;
  RepairedMesh repaired;
};

Outcome outcome_of(const TriangleMesh& mesh, const MeshRepairOptions& options) {
  try {
    Outcome outcome{"repaired", {}, repair_mesh(mesh, options)};
    if (outcome.repaired.steps.empty()) {
      outcome.what = "unchanged";
      CHECK(outcome.repaired.mesh == mesh);
    }
    return outcome;
  } catch (const InvalidInput& error) {
    return {"InvalidInput", error.what(), {}};
  } catch (const DegenerateGeometry& error) {
    return {"DegenerateGeometry", error.what(), {}};
  }
}

void check_message(const std::string& message, const std::string& words) {
  INFO(message);
  CHECK(message.find('\n') == std::string::npos);
  CHECK(message.size() < 300);
  for (const std::string& word : split(words, "|")) {
    bool is_there = false;
    for (const std::string& form : split(word, "/")) {
      is_there = is_there || message.find(form) != std::string::npos;
    }
    INFO("words: " << word);
    CHECK(is_there);
  }
}

// Returns whether "a:1 | *" fits the steps from `i` on.
bool fits(const std::vector<std::string>& expected, std::size_t k,
          const std::vector<RepairStep>& steps, std::size_t i) {
  if (k == expected.size()) return i == steps.size();
  if (expected[k] == "*") {
    return fits(expected, k + 1, steps, i) || (i < steps.size() && fits(expected, k, steps, i + 1));
  }
  const auto what_count = split(expected[k], ":");
  return i < steps.size() && steps[i].what == what_count[0] && steps[i].count > 0 &&
         (what_count[1] == "+" || std::to_string(steps[i].count) == what_count[1]) &&
         fits(expected, k + 1, steps, i + 1);
}

std::string text_of(const std::vector<RepairStep>& steps) {
  std::string text;
  for (const RepairStep& step : steps) {
    text += (text.empty() ? "" : " | ") + step.what + ":" + std::to_string(step.count);
  }
  return text;
}

void check_before(const TriangleMesh& mesh, const std::string& expected) {
  const MeshAnalysis found =
      analyze(mesh, {.count_self_intersections = true, .count_part_overlaps = true});
  std::map<std::string, std::string> counts;
  for (const std::string& word : split(expected, " ")) {
    const auto key_value = split(word, ":");
    counts[key_value[0]] = key_value.size() > 1 ? key_value[1] : "";
  }
  bool is_sure = true;
  const auto check = [&](const std::string& name, std::size_t value) {
    const auto it = counts.find(name);
    const std::string count = it == counts.end() ? "0" : it->second;
    INFO("before: " << name);
    is_sure = is_sure && count != "?";
    if (count != "?") CHECK(std::to_string(value) == count);
  };
  check("parts", found.num_parts);
  check("unused", found.num_unused_vertices);
  check("degenerate", found.num_degenerate_faces);
  check("doubled", found.num_doubled_faces);
  check("boundary", found.num_boundary_edges);
  check("nonmanifold", found.num_nonmanifold_edges);
  check("inconsistent", found.num_inconsistent_edges);
  check("inward", found.num_inward_parts);
  check("overlaps", found.num_overlapping_part_pairs.value());
  check("nested", found.num_nested_parts.value());
  CHECK(found.num_vertices == mesh.vertices.size());
  CHECK(found.num_faces == mesh.faces.size());
  if (counts.contains("crossing")) CHECK(found.num_self_intersections.value() > 0);
  if (counts.contains("no-crossing")) CHECK(found.num_self_intersections.value() == 0);
  if (!is_sure || mesh.faces.empty()) return;
  const auto has = [&](const char* name) { return counts.contains(name); };
  const bool is_closed = !has("boundary") && !has("nonmanifold") && !has("inconsistent");
  CHECK(found.is_closed == is_closed);
  CHECK(found.is_manifold == (!has("nonmanifold") && !has("pinched")));
  CHECK(found.is_outward == (is_closed && !has("inward")));
}

// Returns the largest distance from a corner, edge midpoint or centroid of `from` to the surface of
// `to`: a lower bound of the one-sided Hausdorff distance.
double sampled_distance(const TriangleMesh& from, const MeshQuery& to) {
  double largest = 0.0;
  for (std::size_t face = 0; face < from.faces.size(); ++face) {
    const auto c = corners(from, face);
    for (const Eigen::Vector3d& p :
         {c[0], Eigen::Vector3d((c[0] + c[1]) / 2), Eigen::Vector3d((c[0] + c[1] + c[2]) / 3)}) {
      largest = std::max(largest, to.closest_point(p).squared_distance);
    }
  }
  return std::sqrt(largest);
}

void check_steps(const TriangleMesh& mesh, const RepairedMesh& repaired) {
  const double extent = longest_extent(mesh);
  double volume_change = 0.0;
  double bound = 0.0;
  for (const RepairStep& step : repaired.steps) {
    INFO(step.what);
    CHECK(step.count > 0);
    CHECK(std::isfinite(step.volume_change));
    CHECK(step.hausdorff_bound >= 0.0);
    for (const char* same : {"removed unused vertices", "turned faces", "turned parts",
                             "split non-manifold vertices"}) {
      if (step.what == same) CHECK(step.hausdorff_bound == 0.0);
    }
    volume_change += step.volume_change;
    bound += step.hausdorff_bound;
  }
  // The distance of two surfaces in one box grown by the offset of a wrap is at most its diagonal;
  // there are at most two such steps in a row.
  CHECK(bound <= 2 * std::sqrt(3.0) * 1.1 * extent);
  const MeshQuery before(mesh);
  const MeshQuery after(repaired.mesh);
  const double sampled =
      std::max(sampled_distance(mesh, after), sampled_distance(repaired.mesh, before));
  CHECK(sampled <= bound + 1e-12 * extent);
  // Each step's change is a difference of two sums, so that all of them add up.
  const double whole =
      std::max(std::abs(internal::coned_volume(mesh)), signed_volume(repaired.mesh));
  CHECK(signed_volume(repaired.mesh) - internal::coned_volume(mesh) ==
        Approx(volume_change).margin(1e-9 * whole));
}

// Computes the winding number by solid angles [van Oosterom & Strackee 1983], another way than by
// rays.
double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& point, double scale) {
  double sum = 0.0;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    auto c = corners(mesh, face);
    for (Eigen::Vector3d& p : c) p = (p - point) / scale;
    const double a = c[0].norm();
    const double b = c[1].norm();
    const double d = c[2].norm();
    sum += 2 * std::atan2(c[0].dot(c[1].cross(c[2])),
                          a * b * d + c[0].dot(c[1]) * d + c[1].dot(c[2]) * a + c[2].dot(c[0]) * b);
  }
  return sum / (4 * std::numbers::pi);
}

// Checks what can be asked of any mesh, however broken.
void check_queries(const MeshQuery& query) {
  const TriangleMesh& mesh = query.mesh();
  const double extent = longest_extent(mesh);
  for (std::size_t face = 0; face < mesh.faces.size(); face += 1 + mesh.faces.size() / 40) {
    const auto c = corners(mesh, face);
    const Eigen::Vector3d center = (c[0] + c[1] + c[2]) / 3;
    const Eigen::Vector3d away(extent, 0.7 * extent, 0.3 * extent);
    CHECK(query.closest_point(c[0]).squared_distance == 0.0);
    CHECK(query.containment(c[0]) == Containment::OnSurface);
    CHECK(query.signed_distance(c[0]) == 0.0);
    CHECK(std::sqrt(query.closest_point(center).squared_distance) <= 1e-12 * extent);
    // A ray to the middle of a face with area meets that face or one before it.
    const auto hit = extent > 0 ? query.first_hit(center + away, -away) : std::nullopt;
    // Squares of denormal numbers are zero.
    constexpr double kUnderflow = 8 * std::numeric_limits<double>::denorm_min();
    if (hit) CHECK(hit->distance <= away.stableNorm() * (1 + 1e-9) + kUnderflow);
    if (vector_area(mesh, face).dot(away) > 1e-6 * extent * extent * extent) CHECK(hit);
    Eigen::AlignedBox3d box(c[0]);
    box.extend(c[1]).extend(c[2]);
    const auto near = query.faces_near(box);
    CHECK(std::is_sorted(near.begin(), near.end()));
    CHECK(std::binary_search(near.begin(), near.end(), static_cast<std::int32_t>(face)));
  }
}

void check_pieces(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  double area = 0.0;
  for (const VoxelPiece& piece : clip_by_voxels(mesh, lattice)) {
    REQUIRE(piece.piece.area > 0.0);
    area += piece.piece.area;
  }
  // Areas below the smallest normal double have no digits left to compare.
  const double smallest =
      std::numeric_limits<double>::min() * static_cast<double>(mesh.faces.size());
  CHECK(area == Approx(surface_area(mesh)).epsilon(1e-9).margin(smallest));
}

// Checks that voxels, patches and queries of a closed mesh agree, with each other and with `solid`,
// the volume of the union where it is known.
void check_solid(const TriangleMesh& mesh, std::optional<double> solid) {
  const MeshQuery query(mesh);
  check_queries(query);
  const double extent = longest_extent(mesh);
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 20});
  check_pieces(mesh, lattice);
  const auto patches = surface_patches(mesh, lattice);
  double area = 0.0;
  for (const SurfacePatch& patch : patches) {
    REQUIRE(patch.area > 0.0);
    area += patch.area;
  }
  CHECK(area == Approx(surface_area(mesh)).epsilon(1e-9).margin(0.0));

  const VoxelGrid grid = voxelize(query, lattice, patches);
  CHECK(grid.count(VoxelClass::Partial) == static_cast<std::int64_t>(patches.size()));
  const SignedDistanceMap map = signed_distance_map(grid);
  std::size_t num_wrong = 0;
  std::size_t num_wrong_signs = 0;
  for (std::int64_t i = 0; i < lattice.num_voxels(); ++i) {
    const VoxelClass voxel_class = grid.classes[i];
    const float distance = map.values[i];
    num_wrong_signs += voxel_class == VoxelClass::Empty     ? distance <= 0
                       : voxel_class == VoxelClass::Partial ? distance != 0
                                                            : distance >= 0;
    if (voxel_class == VoxelClass::Partial) continue;
    num_wrong += query.containment(lattice.center(lattice.voxel(i))) !=
                 (voxel_class == VoxelClass::Full ? Containment::Inside : Containment::Outside);
  }
  CHECK(num_wrong == 0);
  CHECK(num_wrong_signs == 0);
  if (solid) {
    const double voxel = std::pow(lattice.voxel_size, 3);
    const auto full = static_cast<double>(grid.count(VoxelClass::Full));
    const auto partial = static_cast<double>(grid.count(VoxelClass::Partial));
    CHECK(full * voxel <= *solid * (1 + 1e-9));
    CHECK((full + partial) * voxel >= *solid * (1 - 1e-9));
  }

  Random random(53);
  const Eigen::AlignedBox3d& box = query.box();
  for (int i = 0; i < 100; ++i) {
    Eigen::Vector3d point;
    for (int k = 0; k < 3; ++k) point[k] = random.uniform(box.min()[k], box.max()[k]);
    const Containment where = query.containment(point);
    const double distance = query.signed_distance(point);
    CHECK(std::abs(distance) == std::sqrt(query.closest_point(point).squared_distance));
    CHECK((distance < 0) == (where == Containment::Inside));
    // So near the surface a solid angle says nothing.
    if (std::abs(distance) < 1e-6 * extent) continue;
    const double winding = winding_number(mesh, point, extent);
    CHECK(std::abs(winding - std::round(winding)) < 1e-6);
    CHECK((where == Containment::Inside) == (std::round(winding) != 0));
  }
}

void check_volume(const TriangleMesh& mesh, const std::string& expected) {
  const double found = signed_volume(mesh);
  if (expected.empty()) {
    CHECK(found > 0.0);
  } else if (const auto range = split(expected, ".."); range.size() == 2) {
    CHECK(found >= number(range[0]) * (1 - 1e-12));
    CHECK(found <= number(range[1]) * (1 + 1e-12));
  } else {
    const auto parts = split(expected, "~");
    const double tolerance = parts.size() > 1 ? number(parts[1]) : 1e-9;
    CHECK(found == Approx(number(parts[0])).epsilon(tolerance).margin(0.0));
  }
}

// Returns the volume of the solid, where the row gives a number for it.
std::optional<double> solid_of(const Row& row) {
  const std::string& text = row.at("union").empty() ? row.at("volume") : row.at("union");
  if (text.empty() || text.find_first_of("~") != std::string::npos ||
      text.find("..") != std::string::npos) {
    return std::nullopt;
  }
  return number(text);
}

void check_row(const TriangleMesh& mesh, const Row& row) {
  const MeshRepairOptions options = options_of(row);
  const Outcome outcome = outcome_of(mesh, options);
  const std::string& expected = row.at("outcome");
  const RepairedMesh& repaired = outcome.repaired;
  INFO("outcome: " << outcome.what << " " << outcome.message << text_of(repaired.steps));
  if (expected == "closed") {
    CHECK((outcome.what == "unchanged" || outcome.what == "repaired"));
  } else {
    CHECK(outcome.what == expected);
  }
  if (outcome.what == "InvalidInput" || outcome.what == "DegenerateGeometry") {
    if (outcome.what == expected) check_message(outcome.message, row.at("words"));
    return;
  }
  if (expected == "InvalidInput" || expected == "DegenerateGeometry") return;

  CHECK(fits(split(row.at("steps"), " | "), 0, repaired.steps, 0));
  check_steps(mesh, repaired);
  const MeshAnalysis& after = repaired.after;
  CHECK(after.is_closed);
  CHECK(after.is_outward);
  CHECK(after.is_manifold);
  CHECK(after.num_doubled_faces == 0);
  CHECK(after.num_unused_vertices == 0);
  if (!row.at("parts").empty()) CHECK(std::to_string(after.num_parts) == row.at("parts"));
  if (options.self_intersections != SelfIntersections::Leave) {
    CHECK(after.num_self_intersections.value() <= repaired.before.num_self_intersections.value());
  }
  check_volume(repaired.mesh, row.at("volume"));
  // A repaired mesh is good, so that nothing is left to do.
  if (options.self_intersections != SelfIntersections::Resolve) {
    const RepairedMesh again = repair_mesh(repaired.mesh, options);
    CHECK(again.steps.empty());
    CHECK(again.mesh == repaired.mesh);
  }
  const MeshQuery query(repaired.mesh);
  const auto check_points = [&](const char* column, Containment where) {
    for (const Eigen::Vector3d& point : points(row.at(column))) {
      INFO(column << " " << point.transpose());
      CHECK(query.containment(point) == where);
      const double distance = query.signed_distance(point);
      CHECK((distance < 0) == (where == Containment::Inside));
      CHECK((distance == 0) == (where == Containment::OnSurface));
    }
  };
  check_points("inside", Containment::Inside);
  check_points("outside", Containment::Outside);
  check_points("on", Containment::OnSurface);
  check_solid(repaired.mesh, solid_of(row));
}

}  // namespace

TEST_CASE("Broken meshes and the table of their outcomes name each other",
          "[geometry][broken_meshes]") {
  const auto rows = read_rows();
  std::map<std::string, int> firsts;
  for (const Row& row : rows) firsts[row.at("name")] += row.at("options").empty();
  const auto meshes = broken_meshes();
  CHECK(meshes.size() >= 30);
  CHECK(firsts.size() == meshes.size());
  for (const BrokenMesh& broken : meshes) {
    INFO(broken.name);
    CHECK(!broken.wrong.empty());
    CHECK(firsts[broken.name] == 1);
  }
}

TEST_CASE("Every broken mesh comes out as its row says", "[geometry][broken_meshes]") {
  std::map<std::string, TriangleMesh> mesh_of;
  for (BrokenMesh& broken : broken_meshes()) mesh_of[broken.name] = std::move(broken.mesh);
  for (const Row& row : read_rows()) {
    INFO("row: " << row.at("name") << " " << row.at("options"));
    const TriangleMesh& mesh = mesh_of.at(row.at("name"));
    CHECK_NOTHROW(check_row(mesh, row));
    if (!row.at("options").empty()) continue;
    INFO("analysis and strict mode");
    check_before(mesh, row.at("before"));
    const Outcome strict = outcome_of(mesh, {.mode = RepairMode::Strict});
    INFO(strict.message);
    CHECK(strict.what == row.at("strict"));
    check_message(strict.message, "");
  }
}

TEST_CASE("What becomes of a broken mesh does not depend on the order of its faces and vertices",
          "[geometry][broken_meshes]") {
  for (const BrokenMesh& broken : broken_meshes()) {
    INFO(broken.name << ": " << broken.wrong);
    TriangleMesh backward = broken.mesh;
    std::reverse(backward.vertices.begin(), backward.vertices.end());
    std::reverse(backward.faces.begin(), backward.faces.end());
    const auto last = static_cast<std::int32_t>(backward.vertices.size()) - 1;
    for (Face& face : backward.faces) face = {last - face[1], last - face[2], last - face[0]};
    const Outcome one = outcome_of(broken.mesh, {});
    const Outcome other = outcome_of(backward, {});
    INFO(one.message << text_of(one.repaired.steps) << " and " << other.message
                     << text_of(other.repaired.steps));
    CHECK(one.what == other.what);
    CHECK(one.repaired.after.num_parts == other.repaired.after.num_parts);
    // Holes that are not planar may be filled otherwise.
    if (broken.name == "cube_without_corner") continue;
    const double volume = signed_volume(one.repaired.mesh);
    CHECK(signed_volume(other.repaired.mesh) == Approx(volume).epsilon(1e-9).margin(0.0));
  }
}

TEST_CASE("As-is mode leaves any mesh alone and every query survives it",
          "[geometry][broken_meshes]") {
  for (const BrokenMesh& broken : broken_meshes()) {
    INFO(broken.name << ": " << broken.wrong);
    const TriangleMesh& mesh = broken.mesh;
    if (mesh.faces.empty()) {
      CHECK_THROWS_AS(repair_mesh(mesh, {.mode = RepairMode::AsIs}), InvalidInput);
      CHECK_THROWS_AS(MeshQuery(mesh), InvalidInput);
      continue;
    }
    const RepairedMesh same = repair_mesh(mesh, {.mode = RepairMode::AsIs});
    CHECK(same.mesh == mesh);
    CHECK(same.steps.empty());
    CHECK(same.after.num_faces == same.before.num_faces);
    CHECK_NOTHROW(check_queries(MeshQuery(mesh)));
    const Eigen::AlignedBox3d box = bounding_box(mesh);
    if (box.sizes().maxCoeff() == 0) {
      CHECK_THROWS_AS(lattice_around(box, {.resolution = 20}), DegenerateGeometry);
      continue;
    }
    const VoxelLattice lattice = lattice_around(box, {.resolution = 20});
    CHECK_NOTHROW(check_pieces(mesh, lattice));
    // Open meshes have no inside, so that classes may be any; the test only asks that there are
    // some.
    const MeshQuery query(mesh);
    const auto patches = surface_patches(mesh, lattice);
    CHECK(voxelize(query, lattice, patches).classes.size() ==
          static_cast<std::size_t>(lattice.num_voxels()));
  }
}

}  // namespace test_broken_meshes
