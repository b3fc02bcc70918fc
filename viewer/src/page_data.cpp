#include "page_data.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "hand_data.hpp"

namespace graspfit::viewer::internal {
namespace {

using base::InvalidInput;
using geometry::RigidTransform;

Json contacts(const PageInput& input, const grasp::Grasp& grasp) {
  Json list = Json::array();
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const contact::Contact& contact = grasp.contacts[i];
    Json entry = {{"point", to_json(contact.point_O)},
                  {"normal", to_json(contact.inward_normal_O)},
                  {"finger", input.hand.part_name(contact.finger)},
                  {"link", input.hand.links[contact.link].name},
                  {"gap", contact.gap},
                  {"area", contact.area},
                  {"d", contact.pad_boundary_distance},
                  {"target", contact.is_target},
                  {"weak", contact.weak ? Json(*contact.weak) : Json()}};
    if (i < grasp.quality.terms.size()) {
      const contact::SustainabilityTerm& term = grasp.quality.terms[i];
      entry["term"] = {{"d", term.boundary_distance}, {"a", term.area}, {"s", term.strength}};
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json targets(const PageInput& input, const grasp::Grasp& grasp) {
  Json list = Json::array();
  for (const grasp::TargetContact& target : grasp.targets.contacts) {
    list.push_back(
        {{"point", to_json(target.point_O)},
         {"normal", to_json(target.outward_normal_O)},
         {"finger", target.is_palm || target.finger ? input.hand.part_name(target.finger) : ""},
         {"score", target.score}});
  }
  return list;
}

Json quality(const contact::ContactQuality& quality) {
  Json pairs = Json::array();
  for (const contact::StablePair& pair : quality.stable_pairs) {
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
  const auto link_name = [&](const std::optional<int>& link) {
    return link ? Json(hand.links[*link].name) : Json();
  };
  return {{"object", penetration.object_intersects},
          {"object_depth", penetration.object_depth},
          {"object_depth_bound", penetration.object_depth_bound},
          {"object_link", link_name(penetration.object_link)},
          {"self", penetration.self_intersects},
          {"self_depth", penetration.self_depth},
          {"self_link_a", link_name(penetration.self_link_a)},
          {"self_link_b", link_name(penetration.self_link_b)},
          {"surroundings", penetration.surroundings_touched}};
}

/// Joints and the poses of all links.
Json configuration(const hands::HandModel& hand, const hands::HandConfiguration& configuration) {
  Json poses = Json::array();
  for (const RigidTransform& X_OL : hands::forward_kinematics(hand, configuration)) {
    poses.push_back(to_json(X_OL));
  }
  const Eigen::VectorXd& q = configuration.q;
  return {{"X_OL", poses}, {"q", std::vector<double>(q.data(), q.data() + q.size())}};
}

Json pre_grasp(const hands::HandModel& hand, const std::optional<grasp::PreGrasp>& pre_grasp) {
  if (!pre_grasp) return {};
  Json json = configuration(hand, pre_grasp->configuration);
  json["clearance"] = pre_grasp->clearance;
  json["opening"] = pre_grasp->opening;
  json["retreat"] = pre_grasp->retreat;
  return json;
}

Json squeeze(const hands::HandModel& hand, const std::optional<contact::Squeeze>& squeeze) {
  if (!squeeze) return {};
  Json json = configuration(hand, squeeze->configuration);
  json["residual"] = squeeze->residual;
  json["is_balanced"] = squeeze->is_balanced;
  json["is_clamped"] = squeeze->is_clamped;
  Json forces = Json::array();
  for (const auto& force : squeeze->forces_O.colwise()) {
    forces.push_back(to_json(Eigen::Vector3d(force)));
  }
  json["forces"] = forces;
  return json;
}

Json wrench(const std::optional<contact::WrenchQuality>& wrench) {
  if (!wrench) return {};
  return {{"epsilon", wrench->epsilon},
          {"is_force_closure", wrench->is_force_closure},
          {"convention", contact::describe(wrench->convention)}};
}

Json grasps(const PageInput& input) {
  Json list = Json::array();
  for (const grasp::Grasp& grasp : input.grasps) {
    list.push_back({{"grasp", configuration(input.hand, grasp.configuration)},
                    {"pre_grasp", pre_grasp(input.hand, grasp.pre_grasp)},
                    {"squeeze", squeeze(input.hand, grasp.squeeze)},
                    {"contacts", contacts(input, grasp)},
                    {"targets", targets(input, grasp)},
                    {"quality", quality(grasp.quality)},
                    {"wrench", wrench(grasp.wrench)},
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

Json surroundings(const grasp::Surroundings* surroundings) {
  if (surroundings == nullptr || surroundings->is_empty()) return {};
  Json obstacles = Json::array();
  for (const geometry::MeshQuery& obstacle : surroundings->obstacles) {
    obstacles.push_back(to_json(obstacle.mesh()));
  }
  return {{"table_z", surroundings->table_z_O ? Json(*surroundings->table_z_O) : Json()},
          {"obstacles", obstacles}};
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
          {"indices", base64_of(indices)},
          {"scores", base64_of(scores)}};
}

void validate(const PageInput& input) {
  const auto refuse = [](const std::string& what) { throw InvalidInput("write_page: " + what); };
  if (input.clip_thickness &&
      !(*input.clip_thickness > 0.0 && std::isfinite(*input.clip_thickness))) {
    refuse("clip_thickness is " + std::to_string(*input.clip_thickness) +
           ", must be finite and above 0");
  }
  if (input.object_O.faces.empty()) refuse("the object has no faces");
  const auto num_vertices = std::ssize(input.object_O.vertices);
  for (std::size_t face = 0; face < input.object_O.faces.size(); ++face) {
    for (const std::int32_t vertex : input.object_O.faces[face]) {
      if (vertex < 0 || vertex >= num_vertices) {
        refuse("face " + std::to_string(face) + " of the object uses vertex " +
               std::to_string(vertex) + " of " + std::to_string(num_vertices));
      }
    }
  }
  const auto is_index = [](int index, std::size_t size) {
    return index >= 0 && std::cmp_less(index, size);
  };
  const hands::HandModel& hand = input.hand;
  const auto has_no_finger = [&](const std::optional<int>& finger) {
    return finger && !is_index(*finger, hand.fingers.size());
  };
  for (std::size_t i = 0; i < input.grasps.size(); ++i) {
    const grasp::Grasp& grasp = input.grasps[i];
    const std::string name = "grasp " + std::to_string(i + 1);
    const auto require_joints = [&](const std::string& what, const Eigen::VectorXd& q) {
      if (q.size() == std::ssize(hand.joints)) return;
      refuse(what + " has " + std::to_string(q.size()) + " joint positions, " + hand.name +
             " has " + std::to_string(hand.joints.size()) + " joints");
    };
    require_joints(name, grasp.configuration.q);
    if (grasp.pre_grasp) require_joints("pre-grasp of " + name, grasp.pre_grasp->configuration.q);
    if (grasp.squeeze) require_joints("squeeze of " + name, grasp.squeeze->configuration.q);
    for (const contact::Contact& contact : grasp.contacts) {
      if (!is_index(contact.link, hand.links.size()) || has_no_finger(contact.finger)) {
        refuse(name + " has a contact of link " + std::to_string(contact.link) + " and finger " +
               (contact.finger ? std::to_string(*contact.finger) : "none") + ", which " +
               hand.name + " does not have");
      }
    }
    for (const grasp::TargetContact& target : grasp.targets.contacts) {
      if (has_no_finger(target.finger)) {
        refuse(name + " has a target of finger " + std::to_string(*target.finger) + ", which " +
               hand.name + " does not have");
      }
    }
    const int num_contacts = base::as_index<int>(grasp.contacts.size());
    for (const contact::StablePair& pair : grasp.quality.stable_pairs) {
      if (!is_index(pair.first, num_contacts) || !is_index(pair.second, num_contacts)) {
        refuse(name + " has a stable pair of contacts " + std::to_string(pair.first) + " and " +
               std::to_string(pair.second) + " of " + std::to_string(num_contacts));
      }
    }
    for (const std::optional<int>& link :
         {grasp.penetration.object_link, grasp.penetration.self_link_a,
          grasp.penetration.self_link_b}) {
      if (link && !is_index(*link, hand.links.size())) {
        refuse(name + " penetrates with link " + std::to_string(*link) + ", which " + hand.name +
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

  Json data = {{"object", to_json(input.object_O)},
               {"center_of_mass", center_of_mass_O ? to_json(*center_of_mass_O) : Json()},
               {"hand", hand_data(input.hand, input.clip_thickness)},
               {"voxels", input.model ? voxels(*input.model) : Json()},
               {"surroundings", surroundings(input.surroundings)},
               {"grasps", grasps(input)}};
  if (!input.note.empty()) data["note"] = input.note;
  return script_text(data);
}

}  // namespace graspfit::viewer::internal
