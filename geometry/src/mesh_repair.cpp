#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/exceptions.h>
#include <CGAL/utility.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "internal/crossing_faces.hpp"
#include "internal/disjoint_sets.hpp"
#include "internal/mesh_edges.hpp"
#include "internal/mesh_holes.hpp"
#include "internal/one_sided_distance.hpp"
#include "internal/predicates.hpp"
#include "internal/vertex_welding.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using internal::DisjointSets;
using internal::FaceSide;
using internal::for_each_edge;
using internal::HoleRim;
using internal::sorted_sides;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Whether the three numbers run upward, up to rotation.
bool is_even(const Face& f) {
  return (f[0] < f[1] && f[1] < f[2]) || (f[1] < f[2] && f[2] < f[0]) ||
         (f[2] < f[0] && f[0] < f[1]);
}

/// Each function below changes the mesh and returns how many things it changed.

/// Returns how many vertices became another one, and the farthest way of one of them.
std::pair<std::size_t, double> weld(TriangleMesh& mesh, double distance) {
  const std::vector<Vector3d> before = mesh.vertices;
  const std::vector<std::int32_t> target = distance > 0.0
                                               ? internal::weld_near(mesh.vertices, distance)
                                               : internal::weld_equal(mesh.vertices);
  for (Face& face : mesh.faces) {
    for (std::int32_t& vertex : face) vertex = target[vertex];
  }
  double farthest = 0.0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    farthest = std::max(farthest, (before[v] - mesh.vertices[target[v]]).norm());
  }
  return {before.size() - mesh.vertices.size(), farthest * (1.0 + 0x1p-50)};
}

std::size_t remove_unused_vertices(TriangleMesh& mesh) {
  std::vector<std::int32_t> new_index(mesh.vertices.size(), -1);
  for (const Face& face : mesh.faces) {
    for (const std::int32_t vertex : face) new_index[vertex] = 0;
  }
  std::int32_t next = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (new_index[v] < 0) continue;
    mesh.vertices[next] = mesh.vertices[v];
    new_index[v] = next++;
  }
  const std::size_t removed = mesh.vertices.size() - static_cast<std::size_t>(next);
  mesh.vertices.resize(static_cast<std::size_t>(next));
  for (Face& face : mesh.faces) {
    for (std::int32_t& vertex : face) vertex = new_index[vertex];
  }
  return removed;
}

/// Faces with a repeated vertex bound nothing and go. Collinear faces with three vertices carry the
/// connection between their neighbors and stay: removing one would open the surface.
std::size_t remove_collapsed_faces(TriangleMesh& mesh) {
  return std::erase_if(mesh.faces, internal::has_repeated_vertex);
}

/// What becomes of a surface of which every face has its opposite.
enum class TwoSided {
  Halved,  ///< It was drawn on both sides throughout: one of each pair stays.
  Removed  ///< It is a sheet without thickness.
};

/// Faces on the same three vertices cancel in pairs of opposite orientation; of those left one
/// stays.
std::size_t remove_doubled_faces(TriangleMesh& mesh, TwoSided two_sided) {
  struct Tally {
    int balance = 0;
    int kept = 0;
  };
  const auto key = [](Face face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  std::map<Face, Tally> tallies;
  for (const Face& face : mesh.faces) tallies[key(face)].balance += is_even(face) ? 1 : -1;
  const bool is_two_sided = std::all_of(tallies.begin(), tallies.end(),
                                        [](const auto& t) { return t.second.balance == 0; });
  if (is_two_sided && two_sided == TwoSided::Halved) {
    return std::erase_if(mesh.faces,
                         [&](const Face& face) { return tallies[key(face)].kept++ > 0; });
  }
  return std::erase_if(mesh.faces, [&](const Face& face) {
    Tally& tally = tallies[key(face)];
    const bool is_majority = is_even(face) ? tally.balance > 0 : tally.balance < 0;
    return !is_majority || tally.kept++ > 0;
  });
}

void flip(Face& face) { std::swap(face[1], face[2]); }

/// Turns faces until neighbors over two-face edges agree, the first face of each part as it is.
/// Returns the faces turned.
std::size_t make_consistent(TriangleMesh& mesh) {
  const std::vector<FaceSide> sides = sorted_sides(mesh);
  std::vector<std::vector<std::pair<std::int32_t, bool>>> neighbors(mesh.faces.size());
  for_each_edge(sides, [&](auto first, auto last) {
    if (last - first != 2) return;
    const auto second = first + 1;
    const bool agree = first->runs_up() != second->runs_up();
    neighbors[first->face].emplace_back(second->face, agree);
    neighbors[second->face].emplace_back(first->face, agree);
  });
  std::vector<int> state(mesh.faces.size(), 0);  // 0 unseen, +1 keep, −1 turn
  for (std::size_t start = 0; start < mesh.faces.size(); ++start) {
    if (state[start] != 0) continue;
    state[start] = 1;
    std::vector<std::int32_t> component = {static_cast<std::int32_t>(start)};
    for (std::size_t next = 0; next < component.size(); ++next) {
      for (const auto& [neighbor, agree] : neighbors[component[next]]) {
        if (state[neighbor] != 0) continue;
        state[neighbor] = agree ? state[component[next]] : -state[component[next]];
        component.push_back(neighbor);
      }
    }
    // The majority was right.
    const auto turned =
        std::count_if(component.begin(), component.end(), [&](auto f) { return state[f] < 0; });
    if (2 * turned > static_cast<std::ptrdiff_t>(component.size())) {
      for (const std::int32_t face : component) state[face] = -state[face];
    }
  }
  std::size_t num_turned = 0;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (state[face] < 0) {
      flip(mesh.faces[face]);
      ++num_turned;
    }
  }
  return num_turned;
}

/// Sides of one edge in the order in which their faces stand around it, counter-clockwise seen from
/// its higher vertex; exact. Of faces in one place those that run up come first: seen along the
/// edge they end a wedge of solid, and the others begin one.
std::vector<FaceSide> sorted_around(const TriangleMesh& mesh, std::vector<FaceSide> sides) {
  const Vector3d& low = mesh.vertices[sides.front().low()];
  const Vector3d& high = mesh.vertices[sides.front().high()];
  const auto third = [&mesh](const FaceSide& side) -> const Vector3d& {
    return mesh.vertices[mesh.faces[side.face][(side.corner + 2) % 3]];
  };
  const auto has_area = [&](const FaceSide& side) {
    return !internal::are_collinear(low, high, third(side));
  };
  const auto found = std::find_if(sides.begin(), sides.end(), has_area);
  if (found == sides.end()) return sides;
  const Vector3d reference = third(*found);
  struct Item {
    FaceSide side;
    int half;  ///< From the reference: 0 there, 1 up to half a turn, 2 there, 3 beyond; −1 no area.
  };
  std::vector<Item> items;
  for (const FaceSide& side : sides) {
    int half = -1;
    if (has_area(side)) {
      const int turn = internal::orientation(low, high, reference, third(side));
      bool is_ahead = false;
      for (int u = 0; u < 3 && turn == 0; ++u) {
        const int v = (u + 1) % 3;
        const int seen = internal::orientation_2d(low, high, reference, u, v);
        is_ahead = seen != 0 && seen == internal::orientation_2d(low, high, third(side), u, v);
        if (seen != 0) break;
      }
      half = turn > 0 ? 1 : turn < 0 ? 3 : is_ahead ? 0 : 2;
    }
    items.push_back({side, half});
  }
  std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) {
    if (a.half != b.half) return a.half < b.half;
    if (a.half == 1 || a.half == 3) {
      const int turn = internal::orientation(low, high, third(a.side), third(b.side));
      if (turn != 0) return turn > 0;
    }
    return a.side.runs_up() && !b.side.runs_up();
  });
  for (std::size_t i = 0; i < items.size(); ++i) sides[i] = items[i].side;
  return sides;
}

/// Gives every fan of faces around a vertex a vertex of its own. Around an edge with more than two
/// faces the two that bound the same wedge of solid stay together, so that solids which touch along
/// an edge come apart. Returns the vertices added.
std::size_t split_nonmanifold(TriangleMesh& mesh) {
  const std::vector<FaceSide> sides = sorted_sides(mesh);
  DisjointSets fans(3 * mesh.faces.size());
  const auto join = [&](const FaceSide& a, const FaceSide& b) {
    for (const std::int32_t vertex : {a.low(), a.high()}) {
      fans.unite(a.corner_at(vertex), b.corner_at(vertex));
    }
  };
  for_each_edge(sides, [&](auto first, auto last) {
    const auto count = last - first;
    if (count == 2) join(*first, *(first + 1));
    if (count <= 2) return;
    const std::vector<FaceSide> around = sorted_around(mesh, {first, last});
    // Seen along the edge, a face that runs down it has the solid on its counter-clockwise side;
    // the next face then runs up and closes that wedge.
    for (std::size_t i = 0; i < around.size(); ++i) {
      const FaceSide& opening = around[i];
      const FaceSide& closing = around[(i + 1) % around.size()];
      if (!opening.runs_up() && closing.runs_up()) join(opening, closing);
    }
  });
  std::vector<std::int32_t> fan_of(mesh.vertices.size(), -1);
  std::map<std::int32_t, std::int32_t> vertex_of_fan;
  std::size_t added = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::int32_t k = 0; k < 3; ++k) {
      const std::int32_t fan = fans.root(static_cast<std::int32_t>(3 * f) + k);
      std::int32_t& vertex = mesh.faces[f][k];
      if (fan_of[vertex] < 0) fan_of[vertex] = fan;
      if (fan_of[vertex] == fan) continue;
      const auto [entry, is_new] =
          vertex_of_fan.try_emplace(fan, static_cast<std::int32_t>(mesh.vertices.size()));
      if (is_new) {
        mesh.vertices.push_back(Vector3d(mesh.vertices[vertex]));
        ++added;
      }
      vertex = entry->second;
    }
  }
  return added;
}

/// Triangles that close a hole, by their places in its rim. A rim without area, as where a vertex
/// of one face lies on an edge of another, gets triangles without area.
std::vector<Face> patch_of(const TriangleMesh& mesh, const HoleRim& rim) {
  const auto point = [&](std::size_t i) -> const Vector3d& { return mesh.vertices[rim[i]]; };
  std::size_t num_on_line = 2;
  while (num_on_line < rim.size() &&
         internal::are_collinear(point(0), point(1), point(num_on_line))) {
    ++num_on_line;
  }
  std::vector<Face> patch;
  if (rim.size() == 3 || num_on_line == rim.size()) {
    for (std::int32_t i = 2; i < static_cast<std::int32_t>(rim.size()); ++i) {
      patch.push_back({0, i - 1, i});
    }
    return patch;
  }
  std::vector<Kernel::Point_3> points;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    points.emplace_back(point(i).x(), point(i).y(), point(i).z());
  }
  std::vector<CGAL::Triple<int, int, int>> triangles;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(triangles));
  for (const auto& t : triangles) {
    // The patch runs along the rim where its corners are numbered upward.
    Face face = {t.first, t.second, t.third};
    if (!is_even(face)) flip(face);
    patch.push_back(face);
  }
  return patch;
}

/// Fills those holes that are up to `largest_extent` [m]. Returns how many.
std::size_t fill_holes(TriangleMesh& mesh, const std::vector<HoleRim>& rims,
                       double largest_extent) {
  std::size_t filled = 0;
  for (const HoleRim& rim : rims) {
    if (internal::rim_extent(mesh, rim) > largest_extent) continue;
    const std::vector<Face> patch = patch_of(mesh, rim);
    for (const Face& f : patch) mesh.faces.push_back({rim[f[0]], rim[f[1]], rim[f[2]]});
    if (!patch.empty()) ++filled;
  }
  return filled;
}

std::size_t turn_inside_out_parts(TriangleMesh& mesh) {
  if (mesh.faces.empty()) return 0;
  const std::vector<FaceSide> sides = sorted_sides(mesh);
  const std::vector<std::int32_t> parts = internal::parts_of_faces(mesh, sides);
  const std::int32_t last_part = *std::max_element(parts.begin(), parts.end());
  std::vector<bool> is_closed(static_cast<std::size_t>(last_part) + 1, true);
  for_each_edge(sides, [&](auto first, auto last) {
    if (last - first != 2) is_closed[parts[first->face]] = false;
  });
  const std::vector<std::int32_t> turned = internal::inside_out_parts(mesh, parts, is_closed);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (std::binary_search(turned.begin(), turned.end(), parts[face])) flip(mesh.faces[face]);
  }
  return turned.size();
}

/// Ends a wrap that does not end by itself: CGAL's refinement goes round in circles where rounding
/// puts a new point on an old one, as on a needle of 3e8 times its thickness.
class WrapLimit : public CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
 public:
  struct Exceeded {};

  explicit WrapLimit(std::int64_t most_facets) : facets_left_(most_facets) {}

  template <class Wrapper, class Gate>
  void before_facet_treatment(const Wrapper&, const Gate&) {
    if (--facets_left_ < 0) throw Exceeded();
  }

 private:
  std::int64_t facets_left_;
};

bool has_area(const TriangleMesh& mesh) {
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (!internal::is_degenerate(mesh, face)) return true;
  }
  return false;
}

/// Wraps the faces and orients the wrap outward. No faces if CGAL does not come to a good end.
TriangleMesh alpha_wrap(const TriangleMesh& given, double alpha_rel, double offset_rel,
                        double extent) {
  if (!std::isfinite(extent)) return {};
  // CGAL's exact numbers end the program where products of coordinates leave the range of doubles.
  // So a mesh is wrapped at an extent of 1/2 to 1, which rounds nothing, and what is nearer to zero
  // than kLeast there becomes zero.
  constexpr double kLeast = 1e-45;
  int exponent = 0;
  std::frexp(extent, &exponent);
  TriangleMesh mesh = given;
  for (Vector3d& vertex : mesh.vertices) {
    for (double& x : vertex) {
      x = std::ldexp(x, -exponent);
      if (std::abs(x) < kLeast) x = 0.0;
    }
  }
  // CGAL leaves degenerate faces out, and requires that others remain.
  if (!has_area(mesh)) return {};
  const double alpha = std::ldexp(alpha_rel * extent, -exponent);
  const double offset = std::ldexp(offset_rel * extent, -exponent);
  std::vector<Kernel::Point_3> points;
  for (const Vector3d& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  CGAL::Surface_mesh<Kernel::Point_3> wrap;
  // A surface has on the order of (extent / alpha)^2 facets of size alpha. Wraps of scans, cars
  // and open tubes take 20 to 80 times as many steps.
  constexpr double kMostStepsRel = 2000.0;
  const double size = 1.0 / alpha_rel;
  WrapLimit limit(static_cast<std::int64_t>(kMostStepsRel * (size * size + 10.0)));
  // CGAL 5 looks for the visitor among the parameters of the output, CGAL 6 among those of the
  // input; where it does not look, it says nothing.
  const auto visited = CGAL::parameters::visitor(std::ref(limit));
  try {
    CGAL::alpha_wrap_3(points, mesh.faces, alpha, offset, wrap, visited, visited);
  } catch (const WrapLimit::Exceeded&) {
    return {};
  } catch (const CGAL::Failure_exception&) {
    // In builds with assertions CGAL says where rounding defeated it before it starts going round.
    return {};
  }
  TriangleMesh result;
  for (const auto vertex : wrap.vertices()) {
    const Kernel::Point_3& p = wrap.point(vertex);
    result.vertices.emplace_back(std::ldexp(p.x(), exponent), std::ldexp(p.y(), exponent),
                                 std::ldexp(p.z(), exponent));
  }
  for (const auto face : wrap.faces()) {
    Face& corners = result.faces.emplace_back();
    int k = 0;
    for (const auto vertex : wrap.vertices_around_face(wrap.halfedge(face))) {
      corners[k++] = static_cast<std::int32_t>(vertex.idx());
    }
  }
  return result;
}

/// Whether all faces of `mesh` lie strictly inside the closed surface `wrap`. Exact.
bool encloses(const TriangleMesh& wrap, const TriangleMesh& mesh) {
  std::vector<std::int32_t> side(wrap.faces.size(), 0);
  side.resize(wrap.faces.size() + mesh.faces.size(), 1);
  if (!internal::crossing_faces(concatenated({wrap, mesh}), side).empty()) return false;
  const MeshQuery query(wrap);
  return std::all_of(mesh.faces.begin(), mesh.faces.end(), [&](const Face& face) {
    return std::all_of(face.begin(), face.end(), [&](std::int32_t vertex) {
      return query.containment(mesh.vertices[vertex]) == Containment::Inside;
    });
  });
}

std::string defects_of(const MeshAnalysis& analysis) {
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(analysis.num_boundary_edges, "boundary edges");
  add(analysis.num_nonmanifold_edges, "non-manifold edges");
  add(analysis.num_inconsistent_edges, "inconsistently oriented edges");
  add(analysis.num_inward_parts, "inside-out parts");
  add(analysis.num_degenerate_faces, "degenerate faces");
  add(analysis.num_doubled_faces, "doubled faces");
  add(analysis.num_unused_vertices, "unused vertices");
  return text;
}

bool is_good(const MeshAnalysis& analysis) {
  return analysis.is_outward && analysis.is_manifold && defects_of(analysis).empty();
}

/// Faces of `from` that `to` does not have on the same vertices, in whatever order.
std::vector<Face> faces_beyond(const std::vector<Face>& from, const std::vector<Face>& to) {
  const auto sorted = [](Face face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  std::vector<Face> known;
  known.reserve(to.size());
  for (const Face& face : to) known.push_back(sorted(face));
  std::sort(known.begin(), known.end());
  std::vector<Face> result;
  for (const Face& face : from) {
    if (!std::binary_search(known.begin(), known.end(), sorted(face))) result.push_back(face);
  }
  return result;
}

/// Faces with a repeated vertex that are no edge or vertex of another face of `kept`.
std::vector<Face> loose_segments(const std::vector<Face>& removed, const std::vector<Face>& kept) {
  if (removed.empty()) return {};
  std::vector<std::array<std::int32_t, 2>> edges;
  for (const Face& f : kept) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(f[i], f[(i + 1) % 3]);
      edges.push_back({low, low});
      edges.push_back({low, high});
      edges.push_back({high, high});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Face> result;
  for (const Face& f : removed) {
    const auto [low, high] = std::minmax({f[0], f[1], f[2]});
    if (!std::binary_search(edges.begin(), edges.end(), std::array{low, high})) result.push_back(f);
  }
  return result;
}

std::vector<HoleRim> concatenation(std::vector<HoleRim> rims, const std::vector<HoleRim>& more) {
  rims.insert(rims.end(), more.begin(), more.end());
  return rims;
}

/// Of the longest extent of the mesh, as the limit of filling is.
double rim_extent_rel(const TriangleMesh& mesh, const HoleRim& rim) {
  return internal::rim_extent(mesh, rim) / longest_extent(mesh);
}

std::string percent(double share) {
  return shortest_decimal(std::round(1000.0 * share) / 10.0) + " %";
}

/// The repair of one mesh, step by step.
class Repair {
 public:
  /// What a refusal says beyond its reason.
  enum class Advice {
    None,
    Tried  ///< Other options that help: they are tried out.
  };

  /// `mesh` and `options` outlive the repair.
  Repair(const TriangleMesh& mesh, const MeshRepairOptions& options, Advice advice)
      : given_(mesh), options_(options), advice_(advice), extent_(longest_extent(mesh)) {
    result_.mesh = mesh;
  }

  RepairedMesh run() {
    result_.before = analyzed(result_.mesh);
    result_.after = result_.before;
    if (options_.mode == RepairMode::AsIs) return std::move(result_);
    if (options_.mode == RepairMode::Strict) refuse_defects();
    volume_ = volume_of(given_, result_.before.is_closed);
    if (options_.mode == RepairMode::Repair) {
      if (!is_good(result_.before)) mend_either_way();
      if (options_.self_intersections == SelfIntersections::Resolve) resolve_self_intersections();
      if (options_.wrap && !is_solid()) wrap();
    }
    refuse_open();
    if (!(volume_ > 0.0)) {
      throw DegenerateGeometry("the mesh encloses no volume" + advice_to_wrap("; "));
    }
    refuse_folded_filling();
    return std::move(result_);
  }

 private:
  MeshAnalysis analyzed(const TriangleMesh& mesh) const {
    return analyze(mesh, {.count_self_intersections =
                              options_.self_intersections != SelfIntersections::Leave});
  }

  static double volume_of(const TriangleMesh& mesh, bool is_closed) {
    return is_closed ? signed_volume(mesh) : internal::coned_volume(mesh);
  }

  bool is_solid() const { return result_.after.is_closed && volume_ > 0.0 && !is_filling_folded_; }

  void add_step(const char* what, std::size_t count, double hausdorff_bound) {
    if (count == 0) return;
    const double after = volume_of(result_.mesh, false);
    result_.steps.push_back({what, count, after - volume_, hausdorff_bound});
    volume_ = after;
  }

  HausdorffOptions distance_options() const {
    constexpr double kToleranceRel = 1e-4;  // Of the longest extent: a tenth of a voxel and less.
    constexpr int kMaxSteps = 4'000;        // The bound holds as it is then; it is not worth more.
    const double tolerance = kToleranceRel * extent_;
    return {.tolerance = tolerance > 0.0 ? tolerance : 1.0, .max_steps = kMaxSteps};
  }

  /// Bound for removing or adding `faces`: how far they reach from the rest of the surface.
  double reach_of(const std::vector<Face>& faces, const TriangleMesh& rest) const {
    if (faces.empty()) return 0.0;
    if (rest.faces.empty()) return std::numeric_limits<double>::infinity();
    return internal::one_sided_distance(internal::triangles_of(result_.mesh.vertices, faces),
                                        MeshQuery(rest), distance_options())
        .upper;
  }

  /// When holes that meet at vertices are filled.
  enum class MeetingHoles {
    AfterSplitting,  ///< The surface is split there, and each patch closed for itself.
    BeforeSplitting  ///< What the file holds together stays together.
  };

  /// Mends the mesh and judges the result. Where holes meet at vertices, there are two ways to
  /// close the surface. Solids that only touch come apart as they should; a surface of patches
  /// that hang together by vertices does so too, and then every patch is closed by a filling along
  /// its own inside, which leaves a hollow skin. A filling that folds inward loses volume, by
  /// which the two ways are told apart.
  void mend_either_way() {
    // Solids that touch lose less than a thousandth in scans and models from many sources; a skin
    // loses most of the volume.
    constexpr double kMostLostRel = 0.1;
    const auto loses_to = [&](double volume) { return volume_ < (1.0 - kMostLostRel) * volume; };
    mend(MeetingHoles::AfterSplitting);
    if (largest_meeting_rel_ == 0.0 || (is_solid() && !loses_to(open_volume_))) return;
    Repair other(given_, options_, Advice::None);
    other.result_.before = result_.before;
    other.volume_ = volume_of(given_, result_.before.is_closed);
    other.mend(MeetingHoles::BeforeSplitting);
    if (other.is_solid() && (!is_solid() || loses_to(other.volume_))) {
      result_ = std::move(other.result_);
      volume_ = other.volume_;
    } else if (is_solid() && !other.is_solid()) {
      is_filling_folded_ = true;
      largest_open_rel_ = other.largest_hole_rel();
    }
  }

  void mend(MeetingHoles meeting_holes) {
    TriangleMesh& mesh = result_.mesh;
    const auto [num_welded, farthest] = weld(mesh, options_.weld_distance_rel * extent_);
    add_step("welded vertices", num_welded, farthest);
    drop_collapsed_faces();
    drop_doubled_faces(TwoSided::Halved);
    add_step("removed unused vertices", remove_unused_vertices(mesh), 0.0);
    add_step("turned faces", make_consistent(mesh), 0.0);
    const std::vector<HoleRim> meeting = internal::holes_of(mesh).meeting;
    for (const HoleRim& rim : meeting) {
      largest_meeting_rel_ = std::max(largest_meeting_rel_, rim_extent_rel(mesh, rim));
    }
    if (!meeting.empty()) open_volume_ = volume_of(mesh, false);
    std::size_t num_filled = 0;
    if (meeting_holes == MeetingHoles::BeforeSplitting) num_filled += fill(meeting);
    add_step("split non-manifold vertices", split_nonmanifold(mesh), 0.0);
    const internal::Holes holes = internal::holes_of(mesh);
    num_filled += fill(concatenation(holes.single, holes.meeting));
    // A sheet without thickness is closed by its own mirror image: both go, it bounds nothing.
    if (num_filled > 0) drop_doubled_faces(TwoSided::Removed);
    add_step("removed unused vertices", remove_unused_vertices(mesh), 0.0);
    add_step("turned parts", turn_inside_out_parts(mesh), 0.0);
    if (!result_.steps.empty()) result_.after = analyzed(mesh);
  }

  /// Fills the holes that are small enough. Returns how many.
  std::size_t fill(const std::vector<HoleRim>& rims) {
    TriangleMesh& mesh = result_.mesh;
    if (rims.empty() || mesh.faces.empty()) return 0;
    const TriangleMesh open = mesh;
    const std::size_t count =
        fill_holes(mesh, rims, options_.max_hole_extent_rel * longest_extent(mesh));
    // Faces without area reach no farther than the rim and the other faces of their patch.
    std::vector<Face> patches;
    for (std::size_t face = open.faces.size(); face < mesh.faces.size(); ++face) {
      if (!internal::is_degenerate(mesh, face)) patches.push_back(mesh.faces[face]);
    }
    add_step("filled holes", count, reach_of(patches, open));
    return count;
  }

  void drop_collapsed_faces() {
    std::vector<Face> collapsed;
    for (const Face& face : result_.mesh.faces) {
      if (internal::has_repeated_vertex(face)) collapsed.push_back(face);
    }
    const std::size_t count = remove_collapsed_faces(result_.mesh);
    add_step("removed degenerate faces", count,
             reach_of(loose_segments(collapsed, result_.mesh.faces), result_.mesh));
  }

  void drop_doubled_faces(TwoSided two_sided) {
    const std::vector<Face> faces = result_.mesh.faces;
    const std::size_t count = remove_doubled_faces(result_.mesh, two_sided);
    if (count == 0) return;
    add_step("removed doubled faces", count,
             reach_of(faces_beyond(faces, result_.mesh.faces), result_.mesh));
  }

  /// Replaces the surface by the boundary of the solid that it means, if that is in order and
  /// crosses itself less. Rounding the cuts may leave crossings of an ulp; another round on what is
  /// left takes most of them.
  void resolve_self_intersections() {
    const std::size_t before = result_.after.num_self_intersections.value_or(0);
    if (before == 0 || !result_.after.is_closed) return;
    constexpr int kMaxRounds = 4;
    const TriangleMesh given = result_.mesh;
    std::size_t left = before;
    for (int round = 0; round < kMaxRounds && left > 0; ++round) {
      TriangleMesh resolved = solid_boundary(result_.mesh);
      remove_doubled_faces(resolved, TwoSided::Removed);
      remove_unused_vertices(resolved);
      if (resolved.faces.empty()) break;
      split_nonmanifold(resolved);
      const MeshAnalysis analysis = analyzed(resolved);
      const bool is_sound = analysis.is_outward && analysis.is_manifold;
      if (!is_sound || *analysis.num_self_intersections >= left) break;
      left = *analysis.num_self_intersections;
      result_.mesh = std::move(resolved);
      result_.after = analysis;
    }
    if (left == before) return;
    const double bound =
        hausdorff_distance(MeshQuery(given), MeshQuery(result_.mesh), distance_options()).upper;
    add_step("resolved self-intersections", before - left, bound);
  }

  void wrap() {
    if (!(extent_ > 0.0)) return;
    TriangleMesh wrapped =
        alpha_wrap(given_, options_.wrap->alpha_rel, options_.wrap->offset_rel, extent_);
    if (wrapped.faces.empty()) return;
    const MeshAnalysis analysis = analyzed(wrapped);
    if (!is_good(analysis) || !(signed_volume(wrapped) > 0.0) || !encloses(wrapped, given_)) return;
    result_.steps.clear();
    is_filling_folded_ = false;
    volume_ = volume_of(given_, result_.before.is_closed);
    const double bound =
        hausdorff_distance(MeshQuery(given_), MeshQuery(wrapped), distance_options()).upper;
    result_.mesh = std::move(wrapped);
    result_.after = analysis;
    add_step("wrapped", result_.mesh.faces.size(), bound);
  }

  void refuse_defects() const {
    const MeshAnalysis& mesh = result_.before;
    std::string defects = defects_of(mesh);
    if (defects.empty() && !mesh.is_manifold) defects = "pinched vertices";
    if (mesh.num_self_intersections.value_or(0) > 0) {
      defects += (defects.empty() ? "" : ", ") + std::to_string(*mesh.num_self_intersections) +
                 " pairs of crossing faces";
    }
    if (!defects.empty()) {
      throw InvalidInput("the mesh has " + defects +
                         "; strict mode repairs nothing, --repair repair mends what it can");
    }
  }

  void refuse_open() const {
    if (result_.after.is_closed) return;
    if (result_.mesh.faces.empty()) {
      throw DegenerateGeometry("the mesh encloses no volume: its faces cancel each other" +
                               advice_to_wrap("; "));
    }
    const double share = largest_hole_rel();
    std::string text;
    std::string advice;
    if (share > 0.0) {
      text = "; its largest hole spans " + rounded(share) + " of its longest extent, holes up to " +
             shortest_decimal(options_.max_hole_extent_rel) + " are filled";
      advice = advice_to_fill(share);
    }
    advice += advice_to_wrap(advice.empty() ? "" : "; ");
    throw InvalidInput("the mesh is not closed and could not be repaired: " +
                       defects_of(result_.after) + text + (advice.empty() ? "" : "; ") + advice);
  }

  void refuse_folded_filling() const {
    if (!is_filling_folded_) return;
    const std::string advice = advice_to_fill(largest_open_rel_);
    throw InvalidInput("the mesh is not closed, and filling its holes would leave a skin: " +
                       percent(volume_ / open_volume_) +
                       " of the volume that the surface encloses; its largest hole spans " +
                       rounded(largest_open_rel_) + " of its longest extent, holes up to " +
                       shortest_decimal(options_.max_hole_extent_rel) + " are filled" +
                       (advice.empty() ? "" : "; ") + advice + advice_to_wrap("; "));
  }

  /// Extent of the largest hole that is left, over that of the mesh. Where holes that meet were too
  /// large to be filled, those are the holes, and not the borders of the patches that came apart
  /// there.
  double largest_hole_rel() const {
    if (largest_meeting_rel_ > options_.max_hole_extent_rel) return largest_meeting_rel_;
    double largest = 0.0;
    const internal::Holes holes = internal::holes_of(result_.mesh);
    for (const HoleRim& rim : concatenation(holes.single, holes.meeting)) {
      largest = std::max(largest, rim_extent_rel(result_.mesh, rim));
    }
    return largest;
  }

  /// What a larger limit for holes would do: tried out, so that it is true.
  std::string advice_to_fill(double share) const {
    if (advice_ == Advice::None || options_.mode != RepairMode::Repair) return "";
    if (!(share > options_.max_hole_extent_rel)) return "";
    MeshRepairOptions wider = options_;
    wider.max_hole_extent_rel = std::min(1.0, std::ceil(1000.0 * share) / 1000.0);
    wider.self_intersections = SelfIntersections::Leave;
    wider.wrap.reset();
    try {
      Repair(given_, wider, Advice::None).run();
    } catch (const Error&) {
      return "";
    }
    return "--max-hole " + shortest_decimal(wider.max_hole_extent_rel) + " fills it";
  }

  static std::string rounded(double share) {
    return shortest_decimal(std::round(1000.0 * share) / 1000.0);
  }

  std::string advice_to_wrap(const char* before) const {
    if (options_.mode != RepairMode::Repair || !(extent_ > 0.0)) return "";
    return std::string(before) +
           (options_.wrap ? "no wrap could be laid around it either, another --wrap-alpha may do"
                          : "--wrap lays a closed surface around it");
  }

  const TriangleMesh& given_;
  const MeshRepairOptions& options_;
  const Advice advice_;
  const double extent_;
  RepairedMesh result_;
  double volume_ = 0.0;  ///< Of the mesh as it is now, holes closed by cones [m³].
  bool is_filling_folded_ = false;
  double largest_meeting_rel_ = 0.0;  ///< Extent of the largest hole that meets another, over
                                      ///< that of the mesh that it was in.
  double largest_open_rel_ = 0.0;     ///< Where the filling is folded: of the hole that it left.
  double open_volume_ = 0.0;          ///< As `volume_`, before anything is split and filled [m³].
};

void check_range(const char* field, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw InvalidInput(std::string("MeshRepairOptions: ") + field + " = " + shortest_decimal(value) +
                     ", must be in [" + shortest_decimal(least) + ", " + shortest_decimal(most) +
                     "]");
}

}  // namespace

void MeshRepairOptions::validate() const {
  check_range("weld_distance_rel", weld_distance_rel, 0.0, 0.01);
  check_range("max_hole_extent_rel", max_hole_extent_rel, 0.0, 1.0);
  if (!wrap) return;
  check_range("wrap.alpha_rel", wrap->alpha_rel, 1e-3, 1.0);
  check_range("wrap.offset_rel", wrap->offset_rel, 1e-4, 1.0);
}

RepairedMesh repair_mesh(const TriangleMesh& mesh, const MeshRepairOptions& options) {
  options.validate();
  if (mesh.faces.empty()) throw InvalidInput("the mesh has no faces");
  return Repair(mesh, options, Repair::Advice::Tried).run();
}

}  // namespace graspfit::geometry
