#include "graspfit/hands/hand_io.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "internal/sidecar.hpp"
#include "internal/urdf.hpp"

namespace graspfit::hands {

namespace {

namespace fs = std::filesystem;
using geometry::InvalidInput;
using geometry::IoError;
using internal::Sidecar;
using internal::Urdf;
using internal::UrdfGeometry;
using internal::UrdfJoint;
using internal::UrdfLink;

template <typename... Alternatives>
struct Overloaded : Alternatives... {
  using Alternatives::operator()...;
};
template <typename... Alternatives>
Overloaded(Alternatives...) -> Overloaded<Alternatives...>;

// ---- Mesh files ---------------------------------------------------------------------------------

/// The folder that a description may refer to: that of the nearest package.xml above the file, or
/// else the file's own folder.
fs::path package_folder(const fs::path& urdf_file) {
  const fs::path folder = fs::weakly_canonical(urdf_file).parent_path();
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
fs::path mesh_path(const fs::path& urdf_file, const std::string& name, const std::string& item) {
  const std::string scheme = "package://";
  const fs::path package = package_folder(urdf_file);
  const fs::path folder = fs::weakly_canonical(urdf_file).parent_path();
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
TriangleMesh surface(const UrdfGeometry& part, const fs::path& urdf_file, const std::string& item,
                     std::vector<std::string>& mesh_files) {
  const TriangleMesh mesh_G = std::visit(
      Overloaded{
          [](const internal::UrdfBox& box) { return geometry::box(box.size); },
          [](const internal::UrdfCylinder& cylinder) {
            return geometry::cylinder(cylinder.radius, cylinder.length, 48);
          },
          [](const internal::UrdfSphere& sphere) { return geometry::ball(sphere.radius, 3); },
          [&](const internal::UrdfMesh& mesh) {
            const fs::path file = mesh_path(urdf_file, mesh.filename, item);
            const fs::path folder = fs::weakly_canonical(urdf_file).parent_path();
            mesh_files.push_back(file.lexically_relative(folder).generic_string());
            return scaled_by(geometry::read_mesh(file).mesh, mesh.scale);
          }},
      part.shape);
  return transformed(mesh_G, part.X_LG);
}

/// The link's closed surface: collision geometry, or visual geometry where it has none.
void read_surface(const UrdfLink& source, const fs::path& urdf_file, Link& link) {
  const std::vector<UrdfGeometry>& parts =
      source.collision.empty() ? source.visual : source.collision;
  const std::string item = urdf_file.string() + ": link " + source.name;
  std::vector<TriangleMesh> meshes;
  for (const UrdfGeometry& part : parts) {
    TriangleMesh mesh = surface(part, urdf_file, item, link.mesh_files);
    const geometry::MeshAnalysis analysis = geometry::analyze(mesh);
    if (!analysis.is_closed || !analysis.is_manifold || !analysis.is_outward) {
      try {
        mesh = geometry::repair_mesh(mesh).mesh;
      } catch (const geometry::Error& error) {
        throw InvalidInput(item + ": its surface is not closed: " + error.what());
      }
    }
    meshes.push_back(std::move(mesh));
  }
  link.mesh_L = geometry::concatenated(meshes);
}

// ---- Tree ---------------------------------------------------------------------------------------

/// Links and joints in order parents first (depth first, children in the order of the file), with
/// the names that the tree gives them resolved. Surfaces are read later.
class TreeBuilder {
 public:
  TreeBuilder(const Urdf& urdf, std::string file) : urdf_(urdf), file_(std::move(file)) {}

  HandModel build() {
    if (urdf_.links.empty()) fail("no links");
    for (std::size_t i = 0; i < urdf_.links.size(); ++i) link_of_[urdf_.links[i].name] = i;
    std::map<std::string, std::string> joint_above;
    for (const UrdfJoint& joint : urdf_.joints) {
      for (const std::string& end : {joint.parent, joint.child}) {
        if (!link_of_.contains(end)) fail("joint " + joint.name + ": no link named " + end);
      }
      const auto [other, is_new] = joint_above.emplace(joint.child, joint.name);
      if (!is_new) {
        fail("link " + joint.child + " hangs on two joints, " + other->second + " and " +
             joint.name);
      }
    }
    std::vector<std::string> roots;
    for (const UrdfLink& link : urdf_.links) {
      if (!joint_above.contains(link.name)) roots.push_back(link.name);
    }
    if (roots.empty()) fail("the links form a cycle: every one is the child of a joint");
    if (roots.size() > 1) {
      fail("links " + roots[0] + " and " + roots[1] + " are both roots: no joint joins them");
    }
    if (std::all_of(urdf_.joints.begin(), urdf_.joints.end(),
                    [](const UrdfJoint& j) { return j.type == UrdfJoint::Type::Fixed; })) {
      fail("no movable joint");
    }
    model_.name = urdf_.name;
    add(roots[0], -1, nullptr);
    if (model_.links.size() != urdf_.links.size()) {
      for (const UrdfLink& link : urdf_.links) {
        if (!added_.contains(link.name)) {
          fail("the links form a cycle: link " + link.name + " is not reached from root " +
               roots[0]);
        }
      }
    }
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(file_ + ": " + what); }

  void add(const std::string& name, int parent, const UrdfJoint* above) {
    const int index = static_cast<int>(model_.links.size());
    added_.insert(name);
    Link link;
    link.name = name;
    link.parent_link = parent;
    link.inertia = urdf_.links[link_of_.at(name)].inertia;
    if (above != nullptr && above->type == UrdfJoint::Type::Fixed) {
      link.X_PL_fixed = above->X_PJ;
    } else if (above != nullptr) {
      link.parent_joint = static_cast<int>(model_.joints.size());
      Joint joint;
      joint.name = above->name;
      joint.type =
          above->type == UrdfJoint::Type::Prismatic ? JointType::Prismatic : JointType::Revolute;
      joint.parent_link = parent;
      joint.child_link = index;
      joint.X_PJ = above->X_PJ;
      joint.axis_J = above->axis;
      joint.lower = above->lower;
      joint.upper = above->upper;
      model_.joints.push_back(std::move(joint));
    }
    model_.links.push_back(std::move(link));
    for (const UrdfJoint& joint : urdf_.joints) {
      if (joint.parent == name) add(joint.child, index, &joint);
    }
  }

  const Urdf& urdf_;
  std::string file_;
  std::map<std::string, std::size_t> link_of_;
  std::set<std::string> added_;
  HandModel model_;
};

// ---- What the sidecar adds
// ------------------------------------------------------------------------

/// Resolves the sidecar's names in a model that has links and joints.
class SidecarResolver {
 public:
  SidecarResolver(HandModel& model, const Sidecar& sidecar, std::string file)
      : model_(model), sidecar_(sidecar), file_(std::move(file)) {}

  void resolve(const Urdf& urdf) {
    couplings(urdf);
    closing();
    palm();
    fingers();
    pads();
    tip_pads();
    exclusions();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(file_ + ": " + what); }

  int link(const std::string& name, const std::string& item) const {
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      if (model_.links[i].name == name) return static_cast<int>(i);
    }
    fail(item + ": the description has no link named " + name);
  }

  int joint(const std::string& name, const std::string& item) const {
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      if (model_.joints[j].name == name) return static_cast<int>(j);
    }
    fail(item + ": the description has no movable joint named " + name);
  }

  int pad(const std::string& name, const std::string& item) const {
    for (std::size_t p = 0; p < model_.pads.size(); ++p) {
      if (model_.pads[p].name == name) return static_cast<int>(p);
    }
    fail(item + ": no pad named " + name);
  }

  Joint& joint_at(int index) { return model_.joints[static_cast<std::size_t>(index)]; }

  void couplings(const Urdf& urdf) {
    for (const UrdfJoint& source : urdf.joints) {
      if (!source.mimic || source.type == UrdfJoint::Type::Fixed) continue;
      const std::string item = "<mimic> of joint " + source.name;
      joint_at(joint(source.name, item)).coupling = Coupling{
          joint(source.mimic->joint, item), source.mimic->multiplier, source.mimic->offset, false};
    }
    std::set<std::string> seen;
    for (const internal::SidecarCoupling& source : sidecar_.couplings) {
      const std::string item = "coupling of joint " + source.joint;
      if (!seen.insert(source.joint).second) fail(item + ": given twice");
      joint_at(joint(source.joint, item)).coupling =
          Coupling{joint(source.leader, item), source.ratio, source.offset, source.breakaway};
    }
    // A follower of a follower follows the first leader: q = a (b q0 + c) + d.
    for (Joint& follower : model_.joints) {
      if (!follower.coupling) continue;
      for (std::size_t steps = 0; joint_at(follower.coupling->leader).coupling; ++steps) {
        if (steps > model_.joints.size()) {
          fail("coupling of joint " + follower.name + ": the couplings form a cycle");
        }
        const Coupling above = *joint_at(follower.coupling->leader).coupling;
        Coupling& own = *follower.coupling;
        own.offset += own.ratio * above.offset;
        own.ratio *= above.ratio;
        own.leader = above.leader;
      }
    }
  }

  void closing() {
    for (const auto& [name, sign] : sidecar_.closing) {
      joint_at(joint(name, "closing")).closing_sign = sign;
    }
    // A follower that is not listed closes when its leader does.
    for (Joint& follower : model_.joints) {
      if (!follower.coupling || sidecar_.closing.contains(follower.name)) continue;
      const double ratio = follower.coupling->ratio;
      follower.closing_sign =
          joint_at(follower.coupling->leader).closing_sign * (ratio > 0.0   ? 1
                                                              : ratio < 0.0 ? -1
                                                                            : 0);
    }
  }

  void palm() {
    model_.palm.link = link(sidecar_.palm.link, "palm");
    if (model_.palm.link != 0) {
      fail("palm: link " + sidecar_.palm.link + " is not the root link " + model_.links[0].name);
    }
    model_.palm.center_H = sidecar_.palm.center_H;
    model_.palm.direction_H = sidecar_.palm.direction_H;
  }

  void fingers() {
    for (const internal::SidecarFinger& source : sidecar_.fingers) {
      const std::string item = "finger " + source.name;
      Finger finger;
      finger.name = source.name;
      finger.is_thumb = source.is_thumb;
      for (const std::string& name : source.links) finger.links.push_back(link(name, item));
      for (const std::string& name : source.joints) finger.joints.push_back(joint(name, item));
      if (source.swing_joint) finger.swing_joint = joint(*source.swing_joint, item);
      model_.fingers.push_back(std::move(finger));
    }
  }

  void pads() {
    for (const internal::SidecarPad& source : sidecar_.pads) {
      const std::string item = "pad " + source.name;
      ContactPad result;
      result.name = source.name;
      result.link = link(source.link, item);
      if (source.finger != "palm") {
        for (std::size_t f = 0; f < model_.fingers.size(); ++f) {
          if (model_.fingers[f].name == source.finger) result.finger = static_cast<int>(f);
        }
        if (result.finger == -1) fail(item + ": no finger named " + source.finger);
      }
      result.X_LC = source.X_LC;
      result.outline = source.outline;
      result.surface = source.surface;
      result.planes = surface_planes(result);
      result.clip_thickness = source.clip_thickness;
      model_.pads.push_back(std::move(result));
    }
    if (sidecar_.palm.pad) model_.palm.pad = pad(*sidecar_.palm.pad, "palm");
  }

  /// Where the sidecar names no tip pad: the last pad on the most distal link that has one.
  void tip_pads() {
    for (std::size_t f = 0; f < model_.fingers.size(); ++f) {
      Finger& finger = model_.fingers[f];
      if (sidecar_.fingers[f].tip_pad) {
        finger.tip_pad = pad(*sidecar_.fingers[f].tip_pad, "finger " + finger.name);
        continue;
      }
      for (std::size_t p = 0; p < model_.pads.size(); ++p) {
        const ContactPad& candidate = model_.pads[p];
        if (candidate.finger != static_cast<int>(f)) continue;
        if (finger.tip_pad == -1 ||
            candidate.link >= model_.pads[static_cast<std::size_t>(finger.tip_pad)].link) {
          finger.tip_pad = static_cast<int>(p);
        }
      }
    }
  }

  void exclusions() {
    for (const auto& [a, b] : sidecar_.exclusions) {
      model_.exclusions.push_back({link(a, "exclusions"), link(b, "exclusions")});
    }
    // Links that are fixed to each other never collide, whatever the file says.
    std::vector<int> body(model_.links.size());
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      const Link& own = model_.links[i];
      body[i] = own.parent_link >= 0 && own.parent_joint == -1
                    ? body[static_cast<std::size_t>(own.parent_link)]
                    : static_cast<int>(i);
      for (std::size_t k = 0; k < i; ++k) {
        if (body[k] == body[i] && !model_.is_excluded(static_cast<int>(k), static_cast<int>(i))) {
          model_.exclusions.push_back({static_cast<int>(k), static_cast<int>(i)});
        }
      }
    }
  }

  HandModel& model_;
  const Sidecar& sidecar_;
  std::string file_;
};

}  // namespace

HandModel read_hand_model(const fs::path& urdf_file) {
  const std::string file = urdf_file.string();
  std::error_code error;
  if (!fs::exists(urdf_file, error)) throw IoError(file + ": no such hand description");
  if (!fs::is_regular_file(urdf_file, error)) throw IoError(file + ": is not a file");
  const std::string urdf_text = geometry::read_file(urdf_file);
  const Urdf urdf = internal::parse_urdf(urdf_text, file);
  HandModel model = TreeBuilder(urdf, file).build();
  model.description_file = file;
  model.description_sha256 = geometry::sha256_hex(urdf_text);

  const fs::path sidecar_file = fs::path(urdf_file).replace_extension(".graspfit.json");
  if (!fs::is_regular_file(sidecar_file, error)) {
    throw IoError(file + ": no sidecar " + sidecar_file.filename().string() + " beside it");
  }
  const std::string sidecar_text = geometry::read_file(sidecar_file);
  const Sidecar sidecar = internal::parse_sidecar(sidecar_text, sidecar_file.string());
  model.sidecar_file = sidecar_file.string();
  model.sidecar_sha256 = geometry::sha256_hex(sidecar_text);
  SidecarResolver(model, sidecar, sidecar_file.string()).resolve(urdf);
  try {
    validate(model);
  } catch (const InvalidInput& invalid) {
    throw InvalidInput(sidecar_file.string() + ": " + invalid.what());
  }

  for (const UrdfLink& source : urdf.links) {
    Link& link = model.links[static_cast<std::size_t>(model.link_index(source.name))];
    read_surface(source, urdf_file, link);
  }
  return model;
}

}  // namespace graspfit::hands
