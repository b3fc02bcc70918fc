#include "import/mjcf.hpp"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "description/joint_motion.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "import/mjcf_couplings.hpp"
#include "import/mjcf_files.hpp"
#include "import/mujoco_model.hpp"

namespace graspfit::hands::internal {

namespace {

using base::InvalidInput;
using Eigen::Vector3d;
using geometry::RigidTransform;

/// An anchor nearer than this to the axis through the body's origin counts as on the axis [m]. This
/// is far below any length that a file gives, and far above rounding.
constexpr double kOnAxis = 1e-12;

class MjcfReader {
 public:
  MjcfReader(const mjModel& model, const MjcfMeshFiles& mesh_files,
             const std::filesystem::path& file, Findings& findings)
      : model_(model),
        mesh_files_(mesh_files),
        file_(file),
        findings_(findings),
        link_of_(model.nbody),
        joint_of_(model.njnt) {}

  RobotDescription read() {
    const std::string_view name = model_.names;  // the first one is the model's
    description_.name = name == "MuJoCo Model" ? file_.stem().string() : std::string(name);
    choose_bodies();
    name_links_and_joints();
    for (const int body : bodies_) add_body(body);
    read_mjcf_couplings(model_, link_of_, joint_of_, description_, findings_);
    excluded_pairs();
    pairs_kept_apart_by_masks();
    if (has_meshes_) {
      findings_.note("", "MuJoCo gives vertices of meshes in single precision (relative 6e-8)");
    }
    return std::move(description_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(file_.string() + ": " + what);
  }

  bool is_solid(int geom) const {
    return model_.geom_type[geom] != mjGEOM_PLANE && model_.geom_type[geom] != mjGEOM_HFIELD;
  }
  bool has_solid_geoms(int body) const {
    const int first = model_.body_geomadr[body];
    for (int g = first; g < first + model_.body_geomnum[body]; ++g) {
      if (is_solid(g)) return true;
    }
    return false;
  }
  bool has_joint_of(int body, std::initializer_list<mjtJoint> types) const {
    const int first = model_.body_jntadr[body];
    for (int j = first; j < first + model_.body_jntnum[body]; ++j) {
      if (std::find(types.begin(), types.end(), model_.jnt_type[j]) != types.end()) return true;
    }
    return false;
  }
  std::string own_name(mjtObj kind, int id) const {
    const char* name = mj_id2name(&model_, kind, id);
    return name ? name : "";
  }
  std::string body_text(int body) const {
    const std::string name = own_name(mjOBJ_BODY, body);
    return "body " + (name.empty() ? std::to_string(body) : name);
  }

  /// Finds which bodies belong to the hand, and which one is its root.
  ///
  /// The hand is what hangs on the one child of the world that has movable joints on it or below
  /// it; its root is that child, or the world where a movable joint joins the two. If several
  /// children have such joints the world is the root, and what is fixed to it belongs to it:
  /// MuJoCo's URDF reader makes the URDF's root the world.
  void choose_bodies() {
    std::set<int> movable;  // children of the world
    for (int j = 0; j < model_.njnt; ++j) {
      if (model_.jnt_type[j] != mjJNT_FREE) {
        movable.insert(model_.body_rootid[model_.jnt_bodyid[j]]);
      }
    }
    std::vector<int> free;
    for (const int body : movable) {
      if (has_joint_of(body, {mjJNT_FREE})) free.push_back(body);
    }
    if (movable.size() > 1 && !free.empty()) {
      const int other = *movable.begin() == free[0] ? *movable.rbegin() : *movable.begin();
      fail(body_text(free[0]) + " moves freely of " + body_text(other) +
           ": keep one hand in the file");
    }
    if (movable.size() == 1 &&
        !has_joint_of(*movable.begin(), {mjJNT_HINGE, mjJNT_SLIDE, mjJNT_BALL})) {
      root_ = *movable.begin();
    }
    std::string left_out;
    for (int body = 0; body < model_.nbody; ++body) {
      const int top = model_.body_rootid[body];
      const bool is_apart =
          top != 0 && (has_joint_of(top, {mjJNT_FREE}) || model_.body_mocapid[top] >= 0);
      if (root_ == 0 ? !is_apart : top == root_) {
        bodies_.push_back(body);
      } else if (body == top && (body != 0 || has_solid_geoms(0))) {
        left_out += (left_out.empty() ? "" : ", ") + body_text(body);
      }
    }
    if (!left_out.empty()) {
      findings_.note("",
                     "left out, since no joint of the hand moves them and they are not its "
                     "palm: " +
                         left_out);
    }
    if (has_joint_of(root_, {mjJNT_FREE})) {
      findings_.note("link " + own_name(mjOBJ_BODY, root_),
                     "its free joint is left out: the palm's pose is the configuration's");
    }
  }

  /// A name that is not taken yet.
  static std::string unused(std::string name, std::set<std::string>& taken) {
    while (!taken.insert(name).second) name += "_";
    return name;
  }

  /// Names in the file come first: names that we give must differ from them.
  void name_links_and_joints() {
    std::set<std::string> links;
    std::set<std::string>& joints = joint_names_taken_;
    for (const int body : bodies_) links.insert(own_name(mjOBJ_BODY, body));
    for (int j = 0; j < model_.njnt; ++j) joints.insert(own_name(mjOBJ_JOINT, j));
    for (const int body : bodies_) {
      const std::string own = own_name(mjOBJ_BODY, body);
      const std::string link = own.empty() ? unused("body_" + std::to_string(body), links) : own;
      link_names_[body] = link;
      const int first = model_.body_jntadr[body];
      const int count = model_.body_jntnum[body];
      for (int j = first; j < first + count; ++j) {
        std::string joint = own_name(mjOBJ_JOINT, j);
        if (joint.empty()) {
          const std::string number = count > 1 ? "_" + std::to_string(j - first) : "";
          joint = unused(link + "_joint" + number, joints);
        }
        joint_names_[j] = joint;
        between_names_[j] = unused(link + "__" + joint, links);
      }
    }
  }

  Vector3d vector(const mjtNum* values, const std::string& item) const {
    const Vector3d v(values[0], values[1], values[2]);
    if (!v.allFinite()) fail(item + ": a number of MuJoCo's model is not finite");
    return v;
  }

  RigidTransform pose(const mjtNum* position, const mjtNum* quaternion,
                      const std::string& item) const {
    RigidTransform X = RigidTransform::Identity();
    X.translation() = vector(position, item);
    const Eigen::Quaterniond q(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
    if (!q.coeffs().allFinite()) fail(item + ": a number of MuJoCo's model is not finite");
    X.linear() = q.normalized().toRotationMatrix();
    return X;
  }

  void add_body(int body) {
    const std::string& name = link_names_.at(body);
    const std::string item = "link " + name;
    if (body != root_) add_joints(body, item);
    link_of_[body] = base::as_index<int>(description_.links.size());
    DescribedLink link;
    link.name = name;
    const int first = model_.body_geomadr[body];
    for (int g = first; g < first + model_.body_geomnum[body]; ++g) {
      if (!is_solid(g)) {
        findings_.note(item, "its planes and height fields are left out");
        continue;
      }
      (can_collide(g) ? link.collision : link.visual).push_back(geometry_of(g, item));
    }
    if (model_.body_mass[body] > 0.0) {
      LinkInertia inertia;
      const RigidTransform X_LI =
          pose(model_.body_ipos + 3 * body, model_.body_iquat + 4 * body, item);
      inertia.mass = model_.body_mass[body];
      inertia.center_L = X_LI.translation();
      inertia.inertia_L = X_LI.linear() *
                          vector(model_.body_inertia + 3 * body, item).asDiagonal() *
                          X_LI.linear().transpose();
      link.inertia = inertia;
    }
    description_.links.push_back(std::move(link));
  }

  /// Joins a body to its parent. MuJoCo's pose of a body in its parent is
  ///   X(body) · Π over its joints of  T(anchor) · R(axis, q − ref) · T(−anchor)  or
  ///   T((q − ref) · axis),
  /// with anchors and axes in the body's frame before the joint moves. The frame of a link is at
  /// its own joint here, so a body with several joints, or with an anchor beside its origin, needs
  /// intermediate links without mass or surface.
  void add_joints(int body, const std::string& item) {
    std::string parent = link_names_.at(model_.body_parentid[body]);
    RigidTransform X_P = pose(model_.body_pos + 3 * body, model_.body_quat + 4 * body, item);
    const int first = model_.body_jntadr[body];
    const int end = first + model_.body_jntnum[body];
    bool is_joined = false;
    for (int j = first; j < end; ++j) {
      DescribedJoint joint = movable_joint(j);
      const Vector3d anchor = joint.type == DescribedJoint::Type::Prismatic
                                  ? Vector3d::Zero()
                                  : anchor_beside_axis(j, joint.axis);
      joint.parent = parent;
      is_joined = j + 1 == end && anchor == Vector3d::Zero();
      joint.child = is_joined ? link_names_.at(body) : between_names_.at(j);
      if (!is_joined) description_.links.push_back(DescribedLink{joint.child, {}, {}, {}});
      // Rotations about one axis satisfy R(q − ref) = R(−ref) · R(q).
      joint.X_PJ = X_P * Eigen::Translation3d(anchor) *
                   joint_motion(joint, -model_.qpos0[model_.jnt_qposadr[j]]);
      parent = joint.child;
      X_P = RigidTransform(Eigen::Translation3d(-anchor));
      joint_of_[j] = base::as_index<int>(description_.joints.size());
      description_.joints.push_back(std::move(joint));
    }
    if (is_joined) return;
    DescribedJoint fixed;
    fixed.name = unused(link_names_.at(body) + "__fixed", joint_names_taken_);
    fixed.parent = parent;
    fixed.child = link_names_.at(body);
    fixed.X_PJ = X_P;
    description_.joints.push_back(std::move(fixed));
  }

  Vector3d anchor_beside_axis(int j, const Vector3d& axis) const {
    const Vector3d anchor = vector(model_.jnt_pos + 3 * j, "joint " + joint_names_.at(j));
    return axis.cross(anchor).norm() <= kOnAxis ? Vector3d::Zero() : anchor;
  }

  DescribedJoint movable_joint(int j) {
    DescribedJoint joint;
    joint.name = joint_names_.at(j);
    const std::string item = "joint " + joint.name;
    const int type = model_.jnt_type[j];
    if (type == mjJNT_BALL) fail(item + ": is a ball joint; write it as three hinges");
    if (type == mjJNT_FREE) fail(item + ": is a free joint inside the hand");
    joint.axis = vector(model_.jnt_axis + 3 * j, item).normalized();
    joint.lower = model_.jnt_range[2 * j];
    joint.upper = model_.jnt_range[2 * j + 1];
    const double ref = model_.qpos0[model_.jnt_qposadr[j]];
    if (!std::isfinite(joint.lower) || !std::isfinite(joint.upper) || !std::isfinite(ref)) {
      fail(item + ": a limit or ref is not finite");
    }
    joint.type =
        type == mjJNT_SLIDE ? DescribedJoint::Type::Prismatic : DescribedJoint::Type::Revolute;
    if (!model_.jnt_limited[j]) {
      joint.lower = joint.upper = 0.0;
      if (type == mjJNT_SLIDE) {
        findings_.attempt([&] { fail(item + ": no limits"); });
      } else {
        // The range is one turn: positions beyond it give the same poses.
        joint.type = DescribedJoint::Type::Continuous;
        joint.lower = -std::numbers::pi;
        joint.upper = std::numbers::pi;
      }
    }
    return joint;
  }

  bool can_collide(int geom) const {
    return model_.geom_contype[geom] != 0 || model_.geom_conaffinity[geom] != 0;
  }

  DescribedGeometry geometry_of(int geom, const std::string& item) {
    DescribedGeometry result;
    result.X_LG = pose(model_.geom_pos + 3 * geom, model_.geom_quat + 4 * geom, item);
    const Vector3d size = vector(model_.geom_size + 3 * geom, item);
    switch (model_.geom_type[geom]) {
      case mjGEOM_SPHERE:
        result.shape = SphereShape{size.x()};
        break;
      case mjGEOM_CAPSULE:
        result.shape = CapsuleShape{size.x(), 2.0 * size.y()};
        break;
      case mjGEOM_ELLIPSOID:
        result.shape = EllipsoidShape{size};
        break;
      case mjGEOM_CYLINDER:
        result.shape = CylinderShape{size.x(), 2.0 * size.y()};
        break;
      case mjGEOM_BOX:
        result.shape = BoxShape{2.0 * size};
        break;
      case mjGEOM_MESH:
        result.shape = mesh_of(model_.geom_dataid[geom], item);
        break;
      default:
        fail(item + ": a geom of a kind that is not known");
    }
    return result;
  }

  /// MuJoCo moves a mesh to its center of mass and principal axes, and the geom accordingly, so the
  /// two together lie where the file says. Vertices with the same position become one: MuJoCo
  /// repeats those that have several normals.
  LoadedMeshShape mesh_of(int id, const std::string& item) {
    has_meshes_ = true;
    LoadedMeshShape result;
    const std::string name = own_name(mjOBJ_MESH, id);
    if (const auto file = mesh_files_.find(name); file != mesh_files_.end()) {
      result.filename = file->second;
    }
    std::map<std::array<float, 3>, int> first_at;
    std::vector<int> welded;
    const float* vertices = model_.mesh_vert + 3 * model_.mesh_vertadr[id];
    for (int v = 0; v < model_.mesh_vertnum[id]; ++v) {
      const std::array<float, 3> at = {vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]};
      const Vector3d vertex(at[0], at[1], at[2]);
      if (!vertex.allFinite()) fail(item + ": mesh " + name + " has a vertex that is not finite");
      const auto [same, is_new] =
          first_at.emplace(at, base::as_index<int>(result.mesh.vertices.size()));
      if (is_new) result.mesh.vertices.push_back(vertex);
      welded.push_back(same->second);
    }
    const int* faces = model_.mesh_face + 3 * model_.mesh_faceadr[id];
    for (int f = 0; f < model_.mesh_facenum[id]; ++f) {
      geometry::Face face;
      for (std::size_t k = 0; k < 3; ++k) {
        face[k] = welded.at(faces[3 * f + static_cast<int>(k)]);
      }
      result.mesh.faces.push_back(face);
    }
    return result;
  }

  /// Reads <exclude>. A signature holds the indices of both bodies, each plus one, in 16 bits each.
  void excluded_pairs() {
    for (int e = 0; e < model_.nexclude; ++e) {
      const int signature = model_.exclude_signature[e];
      exclude((signature >> 16) - 1, (signature & 0xFFFF) - 1);
    }
  }

  void exclude(int body_a, int body_b) {
    const auto a = link_names_.find(body_a);
    const auto b = link_names_.find(body_b);
    if (a == link_names_.end() || b == link_names_.end()) return;
    description_.exclusions.emplace_back(a->second, b->second);
  }

  /// Excludes pairs of links whose geoms MuJoCo never tests against each other. It tests two geoms
  /// if contype of one and conaffinity of the other share a bit, and a <pair> whatever its bits
  /// are.
  void pairs_kept_apart_by_masks() {
    if (model_.opt.collision == mjCOL_PAIR) return;  // MuJoCo ignores the masks
    std::set<std::pair<int, int>> may_touch;
    for (int p = 0; p < model_.npair; ++p) {
      const int a = model_.geom_bodyid[model_.pair_geom1[p]];
      const int b = model_.geom_bodyid[model_.pair_geom2[p]];
      may_touch.insert(std::minmax(a, b));
    }
    std::set<std::pair<int, int>> both_collide;
    for (int g = 0; g < model_.ngeom; ++g) {
      for (int h = g + 1; h < model_.ngeom; ++h) {
        const auto bodies = std::minmax({model_.geom_bodyid[g], model_.geom_bodyid[h]});
        if (bodies.first == bodies.second || !is_solid(g) || !is_solid(h)) continue;
        if (!can_collide(g) || !can_collide(h)) continue;
        both_collide.insert(bodies);
        if ((model_.geom_contype[g] & model_.geom_conaffinity[h]) != 0 ||
            (model_.geom_contype[h] & model_.geom_conaffinity[g]) != 0) {
          may_touch.insert(bodies);
        }
      }
    }
    std::size_t count = 0;
    for (const auto& [a, b] : both_collide) {
      if (may_touch.contains({a, b}) || !link_names_.contains(a) || !link_names_.contains(b)) {
        continue;
      }
      exclude(a, b);
      ++count;
    }
    if (count > 0) {
      findings_.note("", std::to_string(count) +
                             " pairs of links are excluded from collision, "
                             "since contype and conaffinity keep them apart");
    }
  }

  const mjModel& model_;
  const MjcfMeshFiles& mesh_files_;
  const std::filesystem::path& file_;
  Findings& findings_;
  RobotDescription description_;
  int root_ = 0;                              ///< The body that becomes the root link.
  std::vector<int> bodies_;                   ///< Those of the hand, parents first.
  std::map<int, std::string> link_names_;     ///< Of bodies.
  std::map<int, std::string> joint_names_;    ///< Of joints.
  std::map<int, std::string> between_names_;  ///< Of the link that a joint moves, if it is no body.
  std::set<std::string> joint_names_taken_;   ///< Names of joints that are taken.
  std::vector<std::optional<int>> link_of_;
  std::vector<std::optional<int>> joint_of_;
  bool has_meshes_ = false;
};

}  // namespace

RobotDescription parse_mjcf(const std::string& text, const std::filesystem::path& file,
                            Findings& findings) {
  const MjcfMeshFiles mesh_files = check_mjcf_files(text, file);
  const MujocoModel loaded = load_mujoco_model(file);
  for (const std::string& warning : loaded.warnings) findings.suspicious("", "MuJoCo: " + warning);
  return MjcfReader(*loaded.model, mesh_files, file, findings).read();
}

}  // namespace graspfit::hands::internal
