#include "internal/page_data.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>
#include <utility>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::viewer {
namespace {

using geometry::InvalidInput;
using geometry::RigidTransform;
using geometry::TriangleMesh;
using Json = nlohmann::ordered_json;

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

// The numbers' bytes, lowest first whatever the machine's order is.
template <typename Number>
std::string base64_of(std::span<const Number> numbers) {
  using Bits = std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint32_t>;
  static_assert(sizeof(Bits) == sizeof(Number));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(numbers.size_bytes());
  for (const Number number : numbers) {
    const auto bits = std::bit_cast<Bits>(number);
    for (std::size_t k = 0; k < sizeof(Bits); ++k) {
      bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * k)));
    }
  }
  return base64(bytes);
}

Json to_json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

// Column-major 4×4, as WebGL takes it.
Json to_json(const RigidTransform& X) {
  const Eigen::Matrix4d matrix = X.matrix();
  return Json(std::vector<double>(matrix.data(), matrix.data() + 16));
}

Json to_json(const TriangleMesh& mesh) {
  std::vector<float> vertices;
  vertices.reserve(3 * mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) vertices.push_back(static_cast<float>(vertex[axis]));
  }
  std::vector<std::uint32_t> faces;
  faces.reserve(3 * mesh.faces.size());
  for (const geometry::Face& face : mesh.faces) {
    for (const std::int32_t vertex : face) faces.push_back(static_cast<std::uint32_t>(vertex));
  }
  return {{"vertices", base64_of<float>(vertices)}, {"faces", base64_of<std::uint32_t>(faces)}};
}

std::string finger_name(const hands::HandModel& hand, int finger) {
  return finger < 0 ? "palm" : hand.fingers[finger].name;
}

Json links(const hands::HandModel& hand) {
  Json list = Json::array();
  for (const hands::Link& link : hand.links) {
    list.push_back({{"name", link.name}, {"mesh", to_json(link.mesh_L)}});
  }
  return list;
}

/// Corners, triangles and edges of a clip volume, in the pad's frame; edges where faces meet at an
/// angle.
Json clip_volume(const hands::ContactPad& pad, double thickness) {
  const TriangleMesh mesh_C = hands::clip_volume_mesh_C(pad, thickness);
  Json points = Json::array();
  for (const Eigen::Vector3d& vertex : mesh_C.vertices) points.push_back(to_json(vertex));
  Json faces = Json::array();
  Json edges = Json::array();
  std::map<std::pair<std::int32_t, std::int32_t>, Eigen::Vector3d> normal_at;
  for (std::size_t f = 0; f < mesh_C.faces.size(); ++f) {
    const geometry::Face& face = mesh_C.faces[f];
    faces.push_back({face[0], face[1], face[2]});
    const Eigen::Vector3d normal = geometry::face_normal(mesh_C, f);
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = face[k];
      const std::int32_t b = face[(k + 1) % 3];
      const auto [other, is_first] = normal_at.emplace(std::minmax(a, b), normal);
      constexpr double kFlat = 1e-6;  // 1 - cosine: the hull cuts flat sides into triangles
      if (!is_first && other->second.dot(normal) < 1.0 - kFlat) edges.push_back({a, b});
    }
  }
  return {{"points", points}, {"faces", faces}, {"edges", edges}};
}

Json pads(const PageInput& input) {
  Json list = Json::array();
  for (const hands::ContactPad& pad : input.hand.pads) {
    const double thickness = pad.clip_thickness.value_or(input.clip_thickness);
    list.push_back({{"name", pad.name},
                    {"link", pad.link},
                    {"X_LC", to_json(pad.X_LC)},
                    {"clip", thickness > 0.0 ? clip_volume(pad, thickness) : Json(nullptr)}});
  }
  return list;
}

Json contacts(const PageInput& input, const grasp::Grasp& grasp) {
  Json list = Json::array();
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const grasp::Contact& contact = grasp.contacts[i];
    Json entry = {{"point", to_json(contact.point_O)},
                  {"normal", to_json(contact.inward_normal_O)},
                  {"finger", finger_name(input.hand, contact.finger)},
                  {"link", input.hand.links[contact.link].name},
                  {"gap", contact.gap},
                  {"area", contact.area},
                  {"d", contact.pad_boundary_distance},
                  {"target", contact.is_target},
                  {"weak", contact.weak ? Json(*contact.weak) : Json()}};
    if (i < grasp.quality.terms.size()) {
      const grasp::SustainabilityTerm& term = grasp.quality.terms[i];
      entry["term"] = {{"d", term.boundary_distance}, {"a", term.area}, {"s", term.strength}};
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json targets(const PageInput& input, const grasp::Grasp& grasp) {
  Json list = Json::array();
  for (const grasp::TargetContact& target : grasp.targets.contacts) {
    list.push_back({{"point", to_json(target.point_O)},
                    {"normal", to_json(target.outward_normal_O)},
                    {"finger", target.finger < 0 ? "" : finger_name(input.hand, target.finger)},
                    {"score", target.score}});
  }
  return list;
}

Json quality(const grasp::ContactQuality& quality) {
  Json pairs = Json::array();
  for (const grasp::StablePair& pair : quality.stable_pairs) {
    pairs.push_back({{"first", pair.first}, {"second", pair.second}, {"angle", pair.angle}});
  }
  return {{"m", quality.m},
          {"m1", quality.m1},
          {"m2", quality.m2},
          {"m3", quality.m3},
          {"regularity", quality.regularity},
          {"centroid_distance", quality.centroid_distance},
          {"scaled_centroid_distance", quality.scaled_centroid_distance},
          {"stable_pairs", pairs}};
}

Json penetration(const hands::HandModel& hand, const grasp::GraspPenetration& penetration) {
  const auto link_name = [&](int link) { return link < 0 ? Json() : Json(hand.links[link].name); };
  return {{"object", penetration.object_intersects},
          {"object_depth", penetration.object_depth},
          {"object_depth_bound", penetration.object_depth_bound},
          {"object_link", link_name(penetration.object_link)},
          {"self", penetration.self_intersects},
          {"self_depth", penetration.self_depth},
          {"self_link_a", link_name(penetration.self_link_a)},
          {"self_link_b", link_name(penetration.self_link_b)}};
}

Json grasps(const PageInput& input) {
  Json list = Json::array();
  for (const grasp::Grasp& grasp : input.grasps) {
    Json poses = Json::array();
    for (const RigidTransform& X_OL : hands::forward_kinematics(input.hand, grasp.configuration)) {
      poses.push_back(to_json(X_OL));
    }
    const Eigen::VectorXd& q = grasp.configuration.q;
    list.push_back({{"X_OL", poses},
                    {"q", std::vector<double>(q.data(), q.data() + q.size())},
                    {"contacts", contacts(input, grasp)},
                    {"targets", targets(input, grasp)},
                    {"quality", quality(grasp.quality)},
                    {"ideal_m", grasp.ideal_m},
                    {"penetration", penetration(input.hand, grasp.penetration)},
                    {"has_all_contacts", grasp.has_all_contacts},
                    {"is_usable", grasp.is_usable()},
                    {"is_valid", grasp.is_valid()},
                    {"attempt", grasp.attempt},
                    {"iterations", grasp.iterations}});
  }
  return list;
}

Json voxels(const grasp::ObjectModel& model) {
  const geometry::VoxelLattice& lattice = model.grid.lattice;
  std::vector<std::uint16_t> indices;
  std::vector<float> scores;
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    const Eigen::Vector3i voxel = lattice.voxel(model.patches[i].voxel);
    for (int axis = 0; axis < 3; ++axis) indices.push_back(static_cast<std::uint16_t>(voxel[axis]));
    scores.push_back(i < model.scores.scores.size() ? static_cast<float>(model.scores.scores[i])
                                                    : std::numeric_limits<float>::quiet_NaN());
  }
  return {{"origin", to_json(lattice.origin)},
          {"size", lattice.voxel_size},
          {"indices", base64_of<std::uint16_t>(indices)},
          {"scores", base64_of<float>(scores)}};
}

void validate(const PageInput& input) {
  const auto refuse = [](const std::string& what) { throw InvalidInput("write_page: " + what); };
  if (!(input.clip_thickness >= 0.0) || !std::isfinite(input.clip_thickness)) {
    refuse("clip_thickness is " + std::to_string(input.clip_thickness) +
           ", must be finite and at least 0");
  }
  if (input.object_O.faces.empty()) refuse("the object has no faces");
  const auto num_vertices = static_cast<std::int64_t>(input.object_O.vertices.size());
  for (std::size_t face = 0; face < input.object_O.faces.size(); ++face) {
    for (const std::int32_t vertex : input.object_O.faces[face]) {
      if (vertex < 0 || vertex >= num_vertices) {
        refuse("face " + std::to_string(face) + " of the object uses vertex " +
               std::to_string(vertex) + " of " + std::to_string(num_vertices));
      }
    }
  }
  const auto is_index = [](int index, std::size_t size, int lowest) {
    return index >= lowest && index < static_cast<int>(size);
  };
  const hands::HandModel& hand = input.hand;
  for (std::size_t i = 0; i < input.grasps.size(); ++i) {
    const grasp::Grasp& grasp = input.grasps[i];
    const std::string name = "grasp " + std::to_string(i + 1);
    if (grasp.configuration.q.size() != static_cast<Eigen::Index>(hand.joints.size())) {
      refuse(name + " has " + std::to_string(grasp.configuration.q.size()) + " joint positions, " +
             hand.name + " has " + std::to_string(hand.joints.size()) + " joints");
    }
    for (const grasp::Contact& contact : grasp.contacts) {
      if (!is_index(contact.link, hand.links.size(), 0) ||
          !is_index(contact.finger, hand.fingers.size(), -1)) {
        refuse(name + " has a contact of link " + std::to_string(contact.link) + " and finger " +
               std::to_string(contact.finger) + ", which " + hand.name + " does not have");
      }
    }
    for (const grasp::TargetContact& target : grasp.targets.contacts) {
      if (!is_index(target.finger, hand.fingers.size(), -1)) {
        refuse(name + " has a target of finger " + std::to_string(target.finger) + ", which " +
               hand.name + " does not have");
      }
    }
    const int num_contacts = static_cast<int>(grasp.contacts.size());
    for (const grasp::StablePair& pair : grasp.quality.stable_pairs) {
      if (!is_index(pair.first, num_contacts, 0) || !is_index(pair.second, num_contacts, 0)) {
        refuse(name + " has a stable pair of contacts " + std::to_string(pair.first) + " and " +
               std::to_string(pair.second) + " of " + std::to_string(num_contacts));
      }
    }
    for (const int link : {grasp.penetration.object_link, grasp.penetration.self_link_a,
                           grasp.penetration.self_link_b}) {
      if (!is_index(link, hand.links.size(), -1)) {
        refuse(name + " penetrates with link " + std::to_string(link) + ", which " + hand.name +
               " does not have");
      }
    }
  }
}

}  // namespace

std::string page_data(const PageInput& input) {
  validate(input);
  std::optional<Eigen::Vector3d> center_of_mass_O = input.center_of_mass_O;
  if (!center_of_mass_O && input.model) center_of_mass_O = input.model->mass.center_of_mass;

  Json joints = Json::array();
  for (const hands::Joint& joint : input.hand.joints) {
    joints.push_back({{"name", joint.name},
                      {"is_angle", joint.type == hands::JointType::Revolute},
                      {"is_coupled", joint.coupling.has_value()}});
  }
  const hands::Palm& palm = input.hand.palm;
  const Json data = {{"object", to_json(input.object_O)},
                     {"center_of_mass", center_of_mass_O ? to_json(*center_of_mass_O) : Json()},
                     {"hand",
                      {{"name", input.hand.name},
                       {"links", links(input.hand)},
                       {"joints", joints},
                       {"pads", pads(input)},
                       {"palm",
                        {{"link", palm.link},
                         {"center", to_json(palm.center_H)},
                         {"direction", to_json(palm.direction_H)}}}}},
                     {"voxels", input.model ? voxels(*input.model) : Json()},
                     {"grasps", grasps(input)}};
  const std::string text = data.dump(-1, ' ', false, nlohmann::detail::error_handler_t::replace);

  // "</" would end the script element early, "<!--" would change how its end is found.
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace graspfit::viewer
