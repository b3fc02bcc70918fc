#include "derive/derived_exclusions.hpp"

#include <Eigen/Geometry>
#include <optional>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "model/hand_bodies.hpp"

namespace graspfit::hands::internal {

namespace {

constexpr std::size_t kNumPostures = 100;
constexpr double kAlwaysShare = 0.95;
constexpr std::uint64_t kPostureSeed = 20;

/// Surfaces of the links, prepared for collision tests, and their boxes.
struct Surfaces {
  std::vector<std::optional<geometry::MeshQuery>> queries;
  std::vector<Eigen::AlignedBox3d> boxes;
};

/// Whether two links share a point; their boxes are tested first.
bool meet(const Surfaces& surfaces, std::size_t a, std::size_t b,
          const std::vector<RigidTransform>& X_HL) {
  const RigidTransform X_AB = geometry::relative_pose(X_HL[a], X_HL[b]);
  constexpr double kSlack = 1e-9;  // [m]; far above the rounding of the box
  const Eigen::AlignedBox3d& box_B = surfaces.boxes[b];
  const Eigen::Vector3d center_A = X_AB * box_B.center();
  const Eigen::Vector3d half_A =
      X_AB.linear().cwiseAbs() * (0.5 * box_B.sizes()) + Eigen::Vector3d::Constant(kSlack);
  if (!surfaces.boxes[a].intersects(Eigen::AlignedBox3d(center_A - half_A, center_A + half_A))) {
    return false;
  }
  return geometry::do_intersect(*surfaces.queries[a], *surfaces.queries[b], X_AB);
}

HandConfiguration random_configuration(const HandModel& model, std::size_t sample) {
  base::Random random = base::Random::stream(kPostureSeed, sample);
  HandConfiguration configuration;
  configuration.q.resize(std::ssize(model.joints));
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    configuration.q[j] = random.uniform(model.joints[j].lower, model.joints[j].upper);
  }
  // A breakaway joint would keep its own random position.
  HandModel rigid = {};
  rigid.joints = model.joints;
  for (Joint& joint : rigid.joints) {
    if (joint.coupling) joint.coupling->breakaway = false;
  }
  apply_couplings(rigid, configuration.q);
  return configuration;
}

/// The nearest body between `body` and the root that has a surface, if there is one.
std::optional<int> body_above(const std::vector<Body>& bodies, int body) {
  std::optional<int> at = bodies[body].parent;
  while (at && bodies[*at].mesh.faces.empty()) {
    at = bodies[*at].parent;
  }
  return at;
}

std::string percent(std::size_t part, std::size_t whole) {
  return std::to_string((100 * part + whole / 2) / whole) + " %";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> derived_exclusions(const HandModel& model,
                                                                    Findings& findings) {
  Surfaces surfaces;
  for (const Link& link : model.links) {
    surfaces.queries.push_back(
        link.mesh_L.faces.empty() ? std::nullopt : std::optional<geometry::MeshQuery>(link.mesh_L));
    surfaces.boxes.push_back(geometry::bounding_box(link.mesh_L));
  }
  const std::vector<Body> bodies = bodies_of(model);
  const std::vector<int> body_of = body_of_links(bodies, model.links.size());
  const std::vector<RigidTransform> open = forward_kinematics(model, open_configuration(model));
  std::vector<std::vector<RigidTransform>> samples;
  for (std::size_t s = 0; s < kNumPostures; ++s) {
    samples.push_back(forward_kinematics(model, random_configuration(model, s)));
  }
  const auto largest_miss =
      static_cast<std::size_t>((1.0 - kAlwaysShare) * static_cast<double>(kNumPostures) + 0.5);

  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t a = 0; a < model.links.size(); ++a) {
    for (std::size_t b = a + 1; b < model.links.size(); ++b) {
      if (!surfaces.queries[a] || !surfaces.queries[b] || body_of[a] == body_of[b]) continue;
      const std::pair<std::string, std::string> names{model.links[a].name, model.links[b].name};
      const std::string item = "links " + names.first + " and " + names.second;
      const bool are_neighbors = body_above(bodies, body_of[b]) == body_of[a] ||
                                 body_above(bodies, body_of[a]) == body_of[b];
      if (meet(surfaces, a, b, open)) {
        pairs.push_back(names);
        if (!are_neighbors) {
          findings.note(item, "their collision is ignored: they meet in the open configuration");
        }
        continue;
      }
      std::size_t num_met = 0;
      for (std::size_t s = 0; s < kNumPostures; ++s) {
        num_met += meet(surfaces, a, b, samples[s]) ? 1U : 0U;
        // The answer cannot change any more.
        if (are_neighbors ? num_met > 0 : s + 1 - num_met > largest_miss) break;
      }
      if (are_neighbors ? num_met > 0 : num_met + largest_miss >= kNumPostures) {
        pairs.push_back(names);
        if (!are_neighbors) {
          findings.note(item, "their collision is ignored: they meet in " +
                                  percent(num_met, kNumPostures) + " of random configurations");
        }
      }
    }
  }
  return pairs;
}

}  // namespace graspfit::hands::internal
