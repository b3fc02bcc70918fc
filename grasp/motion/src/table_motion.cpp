#include "graspfit/motion/table_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/geometry/used_vertices.hpp"
#include "graspfit/grasp/pre_grasp.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "scene/straight_way.hpp"

namespace graspfit::motion {

using Eigen::Vector3d;
using geometry::RigidTransform;
using hands::HandConfiguration;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Depth to which an object that rests on the table may be in it [m]: rounding of its pose.
constexpr double kRestTolerance = 1e-9;

constexpr std::array<std::pair<MotionPhase, const char*>, 7> kPhases = {
    {{MotionPhase::Reach, "reach"},
     {MotionPhase::Approach, "approach"},
     {MotionPhase::Lift, "lift"},
     {MotionPhase::Transport, "transport"},
     {MotionPhase::Place, "place"},
     {MotionPhase::Release, "release"},
     {MotionPhase::Retreat, "retreat"}}};

geometry::TriangleMesh hull_mesh(const geometry::TriangleMesh& mesh) {
  const std::vector<Vector3d> corners = geometry::used_vertices(mesh);
  const geometry::ConvexHull3 hull = geometry::convex_hull(corners);
  geometry::TriangleMesh result;
  std::vector<std::int32_t> index_of(corners.size(), -1);
  for (const std::size_t i : hull.vertices) {
    index_of[i] = base::as_index<std::int32_t>(result.vertices.size());
    result.vertices.push_back(corners[i]);
  }
  for (const geometry::HullFacet& facet : hull.facets) {
    result.faces.push_back({index_of[facet[0]], index_of[facet[1]], index_of[facet[2]]});
  }
  return result;
}

/// Whether the hand touches the handled object at one end of the segment.
bool is_touching(MotionPhase phase) {
  return phase == MotionPhase::Approach || phase == MotionPhase::Release;
}

/// Whether the carried object stands on the table at one end of the segment.
bool is_resting(MotionPhase phase) {
  return phase == MotionPhase::Lift || phase == MotionPhase::Place;
}

/// Upper bounds of how far the points of every body travel on a segment.
class Travel {
 public:
  Travel(const TableScene& scene, const MotionSegment& segment)
      : way_(scene.hand(), segment.from, segment.to), is_carrying_(is_carrying(segment.phase)) {
    const auto num_links = base::as_index<int>(scene.hand().links.size());
    if (!is_carrying_) {
      for (int link = 0; link < num_links; ++link) {
        links_.push_back(way_.speed(link));
      }
      return;
    }
    const SceneObject& object = scene.object(segment.object);
    const Vector3d& pivot_O = object.center_of_mass_O;
    const double path = (segment.X_WO_to * pivot_O - segment.X_WO_from * pivot_O).norm();
    const double turn = grasp::internal::turn_between(segment.X_WO_from, segment.X_WO_to);
    object_ = path + turn * geometry::largest_radius(object.surface_O.mesh(), pivot_O);
    const auto X_WL = hands::forward_kinematics(scene.hand(), segment.from);
    const Vector3d pivot_W = segment.X_WO_from * pivot_O;
    for (int link = 0; link < num_links; ++link) {
      const Vector3d pivot_L = geometry::inverted(X_WL[link]) * pivot_W;
      links_.push_back(path +
                       turn * geometry::largest_radius(scene.hand().links[link].mesh_L, pivot_L));
    }
  }

  double link(int link) const { return links_[link]; }
  double object() const { return object_; }
  double links_apart(int a, int b) const { return is_carrying_ ? 0.0 : way_.relative_speed(a, b); }
  double largest() const {
    return std::max(object_, *std::max_element(links_.begin(), links_.end()));
  }

 private:
  grasp::internal::StraightWay way_;
  bool is_carrying_;
  std::vector<double> links_;
  double object_ = 0.0;
};

/// Poses of hand, links and handled object at one share of a segment.
struct Posed {
  MotionState state;
  std::vector<RigidTransform> X_WL;
};

Posed posed(const TableScene& scene, const MotionSegment& segment, double share) {
  Posed result{state_at(scene, segment, share), {}};
  result.X_WL = hands::forward_kinematics(scene.hand(), result.state.hand);
  return result;
}

/// Links that have a surface.
std::vector<int> solid_links(const TableScene& scene) {
  std::vector<int> links;
  for (int link = 0; link < std::ssize(scene.hand().links); ++link) {
    if (scene.collision().link_solid(link)) links.push_back(link);
  }
  return links;
}

const std::string& link_name(const TableScene& scene, int link) {
  return scene.hand().links[link].name;
}

/// Proves a segment free, or finds two bodies for which it cannot.
class SegmentProof {
 public:
  SegmentProof(const TableScene& scene, std::span<const RigidTransform> X_WO,
               const MotionSegment& segment, double clearance)
      : scene_(scene),
        X_WO_(X_WO),
        segment_(segment),
        clearance_(clearance),
        travel_(scene, segment),
        only_translates_(is_carrying(segment.phase) &&
                         segment.X_WO_from.linear() == segment.X_WO_to.linear()),
        links_(solid_links(scene)) {}

  std::optional<Collision> operator()() {
    for (const int link : links_) {
      if (!is_link_over_table(link)) return Collision{link_name(scene_, link), "table"};
    }
    if (is_carrying(segment_.phase) && !is_object_over_table()) {
      return Collision{scene_.object(segment_.object).name, "table"};
    }
    for (int other = 0; other < std::ssize(scene_.objects()); ++other) {
      if (auto found = with_object(other)) return found;
    }
    return among_links();
  }

 private:
  using Distance = std::function<double(const Posed&, double enough)>;

  /// Says whether two bodies stay more than `clearance` apart, except for a path length of
  /// `tolerance` at the end at which the hand touches the object. The segment is traversed toward
  /// this end, a release therefore backward.
  bool stay_apart(double travel, double clearance, double tolerance,
                  const Distance& distance) const {
    const bool is_backward = segment_.phase == MotionPhase::Release;
    return grasp::internal::are_apart_on_way(travel, tolerance, [&](double share, double enough) {
      const Posed at = posed(scene_, segment_, is_backward ? 1.0 - share : share);
      return std::clamp(distance(at, enough + clearance) - clearance, 0.0, enough);
    });
  }

  /// Returns a lower bound of the distance of two surfaces up to `enough`; near `clearance` the
  /// bound is the distance itself.
  static double surface_distance(const geometry::MeshQuery& a, const geometry::MeshQuery& b,
                                 const RigidTransform& X_AB, double enough, double clearance,
                                 std::optional<geometry::ProximitySeed>& seed) {
    auto found =
        geometry::surface_clearance(a, b, X_AB, enough, grasp::internal::kNearEnough, seed);
    if (clearance > 0.0 && found.at_least < enough && found.at_least < 2.0 * clearance) {
      found = geometry::surface_clearance(a, b, X_AB, enough, 1.0, found.nearest);
    }
    seed = found.nearest;
    return found.at_least;
  }

  bool is_link_over_table(int link) const {
    const auto height = [&](const Posed& at, double enough) {
      return scene_.height_of_link(link, at.X_WL[link], enough);
    };
    if (!only_translates_) return stay_apart(travel_.link(link), clearance_, 0.0, height);
    const double enough = clearance_ + 1.0;
    return height(posed(scene_, segment_, 0.0), enough) > clearance_ &&
           height(posed(scene_, segment_, 1.0), enough) > clearance_;
  }

  bool is_object_over_table() const {
    const auto height = [&](const Posed& at, double) {
      return std::max(0.0, scene_.height_of_object(segment_.object, at.state.X_WO));
    };
    if (!only_translates_) return stay_apart(travel_.object(), clearance_, 0.0, height);
    const double start = scene_.height_of_object(segment_.object, segment_.X_WO_from);
    const double end = scene_.height_of_object(segment_.object, segment_.X_WO_to);
    if (is_resting(segment_.phase)) return std::min(start, end) >= -kRestTolerance;
    return std::min(start, end) > clearance_;
  }

  std::optional<Collision> with_object(int other) const {
    const bool is_handled = other == segment_.object;
    if (is_handled && is_carrying(segment_.phase)) return std::nullopt;
    const RigidTransform X_OW = geometry::inverted(is_handled ? segment_.X_WO_from : X_WO_[other]);
    const SceneObject& object = scene_.object(other);
    const double tolerance = is_handled && is_touching(segment_.phase) ? kTouchTolerance : 0.0;
    const auto is_apart = [&](const geometry::MeshQuery& body, double travel, const auto& X_WB) {
      for (const double end : {0.0, 1.0}) {
        const RigidTransform X_OB = X_OW * X_WB(posed(scene_, segment_, end));
        if (geometry::do_intersect(object.surface_O, body, X_OB)) return false;
      }
      std::optional<geometry::ProximitySeed> seed;
      return stay_apart(travel, clearance_, tolerance, [&](const Posed& at, double enough) {
        return surface_distance(object.surface_O, body, X_OW * X_WB(at), enough, clearance_, seed);
      });
    };
    for (const int link : links_) {
      const auto X_WL = [&](const Posed& at) { return at.X_WL[link]; };
      if (is_apart(*scene_.collision().link_solid(link), travel_.link(link), X_WL)) continue;
      return Collision{link_name(scene_, link), object.name};
    }
    if (!is_carrying(segment_.phase)) return std::nullopt;
    const SceneObject& carried = scene_.object(segment_.object);
    if (is_apart(carried.surface_O, travel_.object(),
                 [](const Posed& at) { return at.state.X_WO; })) {
      return std::nullopt;
    }
    return Collision{carried.name, object.name};
  }

  std::optional<Collision> among_links() const {
    for (const int a : links_) {
      for (const int b : links_) {
        if (b <= a || scene_.hand().is_excluded(a, b)) continue;
        const double travel = travel_.links_apart(a, b);
        if (!(travel > 0.0)) continue;
        std::optional<geometry::ProximitySeed> seed;
        const bool is_apart = stay_apart(travel, 0.0, 0.0, [&](const Posed& at, double enough) {
          const RigidTransform& X_WA = at.X_WL[a];
          const RigidTransform& X_WB = at.X_WL[b];
          return surface_distance(*scene_.collision().link_solid(a),
                                  *scene_.collision().link_solid(b),
                                  geometry::relative_pose(X_WA, X_WB), enough, 0.0, seed);
        });
        if (!is_apart) return Collision{link_name(scene_, a), link_name(scene_, b)};
      }
    }
    return std::nullopt;
  }

  const TableScene& scene_;
  std::span<const RigidTransform> X_WO_;
  const MotionSegment& segment_;
  double clearance_;
  Travel travel_;
  bool only_translates_;
  std::vector<int> links_;
};

}  // namespace

TableScene::TableScene(hands::HandModel hand, std::vector<SceneObject> objects)
    : hand_(std::move(hand)),
      collision_(hand_),
      table_(hand_, {.table_z_O = 0.0, .obstacles = {}}),
      objects_(std::move(objects)) {
  std::set<std::string> names;
  for (const SceneObject& object : objects_) {
    if (!names.insert(object.name).second) {
      throw base::InvalidInput("TableScene: two objects are called " + object.name);
    }
    hulls_O_.push_back(hull_mesh(object.surface_O.mesh()));
  }
}

double TableScene::height_of_link(int link, const RigidTransform& X_WL, double enough) const {
  return std::min(enough, table_.distance(collision_, link, X_WL, enough).distance);
}

double TableScene::height_of_object(int object, const RigidTransform& X_WO) const {
  double lowest = kInfinity;
  for (const Vector3d& corner : hull_O(object).vertices) {
    lowest = std::min(lowest, (X_WO * corner).z());
  }
  return lowest;
}

const char* phase_name(MotionPhase phase) {
  for (const auto& [value, name] : kPhases) {
    if (value == phase) return name;
  }
  return "";
}

std::optional<MotionPhase> phase_named(std::string_view name) {
  for (const auto& [value, text] : kPhases) {
    if (name == text) return value;
  }
  return std::nullopt;
}

bool is_carrying(MotionPhase phase) { return is_resting(phase) || phase == MotionPhase::Transport; }

MotionState state_at(const TableScene& scene, const MotionSegment& segment, double share) {
  if (!is_carrying(segment.phase)) {
    return {grasp::interpolated(segment.from, segment.to, share), segment.X_WO_from};
  }
  if (share == 0.0) return {segment.from, segment.X_WO_from};
  if (share == 1.0) return {segment.to, segment.X_WO_to};
  // The object is interpolated like a hand without joints whose palm frame is at the center of
  // mass.
  const Eigen::Translation3d center(scene.object(segment.object).center_of_mass_O);
  const HandConfiguration pivot =
      grasp::interpolated({segment.X_WO_from * center, Eigen::VectorXd()},
                          {segment.X_WO_to * center, Eigen::VectorXd()}, share);
  MotionState state{segment.from, pivot.X_OH * center.inverse()};
  state.hand.X_OH = state.X_WO * geometry::relative_pose(segment.X_WO_from, segment.from.X_OH);
  return state;
}

double largest_travel(const TableScene& scene, const MotionSegment& segment) {
  return Travel(scene, segment).largest();
}

std::optional<Collision> find_collision(const TableScene& scene,
                                        std::span<const RigidTransform> X_WO,
                                        const MotionSegment& segment, double clearance) {
  return SegmentProof(scene, X_WO, segment, clearance)();
}

MotionClearance clearance_at(const TableScene& scene, std::span<const RigidTransform> X_WO,
                             const MotionSegment& segment, double share) {
  const Posed at = posed(scene, segment, share);
  const bool carries = is_carrying(segment.phase);
  MotionClearance nearest{kInfinity, kInfinity};
  const std::vector<int> links = solid_links(scene);
  for (const int link : links) {
    const RigidTransform& X_WL = at.X_WL[link];
    nearest.hand = std::min(nearest.hand, scene.height_of_link(link, X_WL, nearest.hand));
  }
  if (carries && !is_resting(segment.phase)) {
    nearest.object = std::max(0.0, scene.height_of_object(segment.object, at.state.X_WO));
  }
  for (int other = 0; other < std::ssize(scene.objects()); ++other) {
    const bool is_handled = other == segment.object;
    if (is_handled && (carries || is_touching(segment.phase))) continue;
    const geometry::MeshQuery& surface = scene.objects()[other].surface_O;
    const RigidTransform X_OW = geometry::inverted(is_handled ? segment.X_WO_from : X_WO[other]);
    const auto approach = [&](const geometry::MeshQuery& body, const RigidTransform& X_WB,
                              double& least) {
      const RigidTransform X_OB = X_OW * X_WB;
      least = geometry::do_intersect(surface, body, X_OB)
                  ? 0.0
                  : geometry::surface_clearance(surface, body, X_OB, least, 1.0).at_least;
    };
    for (const int link : links) {
      approach(*scene.collision().link_solid(link), at.X_WL[link], nearest.hand);
    }
    if (carries) approach(scene.object(segment.object).surface_O, at.state.X_WO, nearest.object);
  }
  return nearest;
}

std::optional<Collision> find_overlap(const TableScene& scene, std::span<const RigidTransform> X_WO,
                                      const MotionSegment& segment, double share) {
  const Posed at = posed(scene, segment, share);
  const bool carries = is_carrying(segment.phase);
  const auto X_WB = [&](int link) { return at.X_WL[link]; };
  const std::vector<int> links = solid_links(scene);
  for (const int a : links) {
    if (scene.height_of_link(a, X_WB(a), 1.0) <= 0.0) {
      return Collision{link_name(scene, a), "table"};
    }
    for (const int b : links) {
      if (b <= a || scene.hand().is_excluded(a, b)) continue;
      if (geometry::do_intersect(*scene.collision().link_solid(a), *scene.collision().link_solid(b),
                                 geometry::relative_pose(X_WB(a), X_WB(b)))) {
        return Collision{link_name(scene, a), link_name(scene, b)};
      }
    }
  }
  if (carries && scene.height_of_object(segment.object, at.state.X_WO) < -kRestTolerance) {
    return Collision{scene.object(segment.object).name, "table"};
  }
  for (int other = 0; other < std::ssize(scene.objects()); ++other) {
    const bool is_handled = other == segment.object;
    const SceneObject& object = scene.objects()[other];
    const RigidTransform X_OW = geometry::inverted(is_handled ? at.state.X_WO : X_WO[other]);
    for (const int link : links) {
      if (scene.collision().link_intersects(object.surface_O, link, X_OW * X_WB(link))) {
        return Collision{link_name(scene, link), object.name};
      }
    }
    if (!carries || is_handled) continue;
    const SceneObject& carried = scene.object(segment.object);
    if (geometry::do_intersect(object.surface_O, carried.surface_O, X_OW * at.state.X_WO)) {
      return Collision{carried.name, object.name};
    }
  }
  return std::nullopt;
}

}  // namespace graspfit::motion
