#include "internal/derivation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/jacobian.hpp"
#include "internal/derived_exclusions.hpp"
#include "internal/hand_bodies.hpp"
#include "internal/pad_fit.hpp"
#include "internal/sidecar_resolution.hpp"

namespace graspfit::hands::internal {

namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using geometry::InvalidInput;
using geometry::MeshQuery;

constexpr std::uint64_t kSeed = 4;
constexpr std::size_t kNumSamples = 48;
constexpr double kParallel = 0.64;     // cosine of 50°: axes that bend a finger the same way
constexpr double kTipShare = 0.2;      // of a link's length: what counts as its tip
constexpr double kForwardShare = 0.5;  // of a tip's way: toward the palm's front, or not
constexpr double kTranslation = 0.2;   // rotation times length over way: hardly turning

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// A finger: bodies from the one on the palm to the tip, and what moves them.
struct Chain {
  std::vector<int> bodies;
  std::vector<int> joints;   ///< Above each of the bodies.
  Vector3d tip_B;            ///< In the frame of the last body's first link.
  std::vector<int> leaders;  ///< Independent joints that move it, proximal to distal.
};

/// What an independent joint does to the hand.
enum class Role { None, Bend, Other };

/// Where a body of a finger goes when it closes.
struct Facing {
  Vector3d direction_H;  ///< Unit.
  Vector3d along_H;      ///< Unit, toward the tip.
  Vector3d point_H;      ///< Middle of the body.
};

class Deriver {
 public:
  Deriver(const HandModel& tree, const Sidecar& given, Findings& findings)
      : tree_(tree), given_(given), findings_(findings), bodies_(bodies_of(tree)) {}

  Sidecar derive() {
    Sidecar sidecar = given_;
    chains();
    signs();
    if (!sidecar.closing) sidecar.closing = closing();
    take_signs(*sidecar.closing);
    palm_direction();
    if (!given_.closing) {
      fore_joints();
      sidecar.closing = closing();
      take_signs(*sidecar.closing);
      note_closing(*sidecar.closing);
    }
    if (!sidecar.fingers) sidecar.fingers = fingers();
    if (!sidecar.palm || !sidecar.pads) {
      const std::vector<SidecarPad> found = pads(*sidecar.fingers);
      if (!sidecar.palm) sidecar.palm = palm(found, sidecar.pads);
      if (!sidecar.pads) sidecar.pads = found;
    }
    if (!sidecar.exclusions) sidecar.exclusions = derived_exclusions(tree_, findings_);
    return sidecar;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(tree_.description_file + ": " + what);
  }

  // ---- Kinematics -------------------------------------------------------------------------------

  int leader_of(int joint) const {
    const auto& coupling = tree_.joints[at(joint)].coupling;
    return coupling ? coupling->leader : joint;
  }

  /// With followers where their leaders put them (breakaway is not counted).
  HandConfiguration followed(const VectorXd& q) const {
    HandConfiguration configuration;
    configuration.q = q;
    for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
      const Joint& joint = tree_.joints[j];
      if (!joint.coupling) continue;
      configuration.q[static_cast<Eigen::Index>(j)] =
          std::clamp(joint.coupling->ratio * q[joint.coupling->leader] + joint.coupling->offset,
                     joint.lower, joint.upper);
    }
    return configuration;
  }

  std::vector<RigidTransform> poses(const VectorXd& q) const {
    return forward_kinematics(tree_, followed(q));
  }

  /// Every joint at the value nearest zero.
  VectorXd rest() const {
    VectorXd q(static_cast<Eigen::Index>(tree_.joints.size()));
    for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
      q[static_cast<Eigen::Index>(j)] =
          std::clamp(0.0, tree_.joints[j].lower, tree_.joints[j].upper);
    }
    return q;
  }

  /// Closing joints this far from open to closed, the others at rest.
  VectorXd closed_by(double share) const {
    VectorXd q = rest();
    for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
      const Joint& joint = tree_.joints[j];
      if (joint.closing_sign == 0) continue;
      const double open = joint.closing_sign > 0 ? joint.lower : joint.upper;
      const double closed = joint.closing_sign > 0 ? joint.upper : joint.lower;
      q[static_cast<Eigen::Index>(j)] = open + share * (closed - open);
    }
    return q;
  }

  const RigidTransform& pose_of_body(const std::vector<RigidTransform>& X_HL, int body) const {
    return X_HL[at(bodies_[at(body)].links.front())];
  }

  Vector3d tip(const Chain& chain, const std::vector<RigidTransform>& X_HL) const {
    return pose_of_body(X_HL, chain.bodies.back()) * chain.tip_B;
  }

  Vector3d axis_H(int joint, const std::vector<RigidTransform>& X_HL) const {
    // The axis does not turn under its own joint.
    const Joint& j = tree_.joints[at(joint)];
    return X_HL[at(j.child_link)].linear() * j.axis_J;
  }

  // ---- Fingers ----------------------------------------------------------------------------------

  /// Middle of the part of a body that is farthest from its joint: of a slide, of all of it.
  Vector3d tip_of(const Body& body) const {
    const bool is_slide = tree_.joints[at(body.joint)].type == JointType::Prismatic;
    Vector3d far = Vector3d::Zero();
    for (const Vector3d& v : body.mesh.vertices) {
      if (v.squaredNorm() > far.squaredNorm()) far = v;
    }
    Eigen::AlignedBox3d box;
    for (const Vector3d& v : body.mesh.vertices) {
      if (is_slide || v.dot(far) >= (1.0 - kTipShare) * far.squaredNorm()) box.extend(v);
    }
    return box.center();
  }

  double reach_of(const Chain& chain) const {
    const auto X_HL = poses(rest());
    return (tip(chain, X_HL) - pose_of_body(X_HL, chain.bodies.front()).translation()).norm();
  }

  void chains() {
    if (given_.fingers) {
      given_chains();
    } else {
      // A leaf of the tree of bodies ends a finger, if it has a surface; else the last body above
      // it that has one.
      std::vector<bool> is_end(bodies_.size(), false);
      std::vector<bool> has_end_below(bodies_.size(), false);
      for (std::size_t b = bodies_.size(); b-- > 1;) {
        is_end[b] = !has_end_below[b] && !bodies_[b].mesh.faces.empty();
        if (is_end[b] || has_end_below[b]) has_end_below[at(bodies_[b].parent)] = true;
      }
      for (std::size_t b = 1; b < bodies_.size(); ++b) {
        if (!is_end[b]) continue;
        Chain chain;
        for (int up = static_cast<int>(b); up > 0; up = bodies_[at(up)].parent) {
          chain.bodies.insert(chain.bodies.begin(), up);
        }
        chains_.push_back(std::move(chain));
      }
      for (Chain& chain : chains_) complete(chain);
      drop_linkage_members();
      share_out_trunks();
    }
    if (chains_.empty()) {
      fail(
          "no link with a surface hangs on a movable joint: no finger can be derived; write "
          "\"fingers\" into the sidecar");
    }
  }

  void given_chains() {
    const std::vector<int> body_of = body_of_links(bodies_, tree_.links.size());
    for (const SidecarFinger& finger : *given_.fingers) {
      Chain chain;
      for (const std::string& name : finger.links) {
        for (std::size_t i = 0; i < tree_.links.size(); ++i) {
          if (tree_.links[i].name != name) continue;
          const int body = body_of[i];
          if (body > 0 && (chain.bodies.empty() || chain.bodies.back() != body)) {
            chain.bodies.push_back(body);
          }
        }
      }
      if (chain.bodies.empty()) {
        fail("finger " + finger.name + ": none of its links moves: nothing can be derived for it");
      }
      complete(chain);
      chains_.push_back(std::move(chain));
    }
  }

  void complete(Chain& chain) const {
    chain.joints.clear();
    chain.leaders.clear();
    for (const int body : chain.bodies) {
      const int joint = bodies_[at(body)].joint;
      chain.joints.push_back(joint);
      const int leader = leader_of(joint);
      if (std::find(chain.leaders.begin(), chain.leaders.end(), leader) == chain.leaders.end()) {
        chain.leaders.push_back(leader);
      }
    }
    chain.tip_B = tip_of(bodies_[at(chain.bodies.back())]);
  }

  /// Bars of a linkage: a chain that only follows, on joints that another chain follows too, and
  /// that touches that chain beyond their common part in all sampled configurations, is no finger
  /// of its own if the other reaches farther.
  void drop_linkage_members() {
    std::vector<std::vector<RigidTransform>> samples;
    for (std::size_t s = 0; s < 5; ++s) samples.push_back(poses(sampled(s)));
    std::vector<Chain> kept;
    for (const Chain& chain : chains_) {
      const bool only_follows = std::all_of(chain.joints.begin(), chain.joints.end(), [&](int j) {
        return tree_.joints[at(j)].coupling.has_value();
      });
      const Chain* carrier = nullptr;
      for (const Chain& other : chains_) {
        if (!only_follows || &other == &chain || other.leaders != chain.leaders) continue;
        if (reach_from_palm(other) <= reach_from_palm(chain)) continue;
        if (always_touch(chain, other, samples)) carrier = &other;
      }
      if (carrier == nullptr) {
        kept.push_back(chain);
        continue;
      }
      findings_.note("link " + name_of_body(chain.bodies.back()),
                     "is no finger: it follows its joints and always touches link " +
                         name_of_body(carrier->bodies.back()) + ", a bar of that finger's linkage");
    }
    chains_ = std::move(kept);
  }

  double reach_from_palm(const Chain& chain) const {
    const auto X_HL = poses(rest());
    const Body& body = bodies_[at(chain.bodies.back())];
    double reach = 0.0;
    for (const Vector3d& v : body.mesh.vertices) {
      reach = std::max(reach, (pose_of_body(X_HL, chain.bodies.back()) * v).norm());
    }
    return reach;
  }

  bool always_touch(const Chain& a, const Chain& b,
                    const std::vector<std::vector<RigidTransform>>& samples) const {
    for (const auto& X_HL : samples) {
      bool touch = false;
      for (const int body_a : a.bodies) {
        for (const int body_b : b.bodies) {
          if (touch || body_a == body_b) continue;
          const TriangleMesh& mesh_a = bodies_[at(body_a)].mesh;
          const TriangleMesh& mesh_b = bodies_[at(body_b)].mesh;
          if (mesh_a.faces.empty() || mesh_b.faces.empty()) continue;
          touch = geometry::do_intersect(
              MeshQuery(mesh_a), MeshQuery(mesh_b),
              pose_of_body(X_HL, body_a).inverse() * pose_of_body(X_HL, body_b));
        }
      }
      if (!touch) return false;
    }
    return true;
  }

  /// Where a branch forks, the part before the fork belongs to the finger that reaches farthest.
  void share_out_trunks() {
    std::set<int> taken;
    std::vector<std::size_t> order(chains_.size());
    for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return reach_of(chains_[a]) > reach_of(chains_[b]);
    });
    for (const std::size_t c : order) {
      std::erase_if(chains_[c].bodies, [&](int body) { return taken.contains(body); });
      taken.insert(chains_[c].bodies.begin(), chains_[c].bodies.end());
      complete(chains_[c]);
    }
  }

  std::string name_of_body(int body) const {
    const Body& b = bodies_[at(body)];
    for (const int link : b.links) {
      if (!tree_.links[at(link)].mesh_L.faces.empty()) return tree_.links[at(link)].name;
    }
    return tree_.links[at(b.links.front())].name;
  }

  // ---- Closing ----------------------------------------------------------------------------------

  VectorXd sampled(std::size_t sample) const {
    geometry::Random random = geometry::Random::stream(kSeed, sample);
    VectorXd q(static_cast<Eigen::Index>(tree_.joints.size()));
    for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
      q[static_cast<Eigen::Index>(j)] =
          random.uniform(tree_.joints[j].lower, tree_.joints[j].upper);
    }
    return q;
  }

  /// How far apart the hand is: of every fingertip its distance from the palm and the mean one from
  /// the other tips.
  double spread(const std::vector<RigidTransform>& X_HL) const {
    std::vector<Vector3d> tips;
    for (const Chain& chain : chains_) tips.push_back(tip(chain, X_HL));
    double sum = 0.0;
    for (std::size_t f = 0; f < tips.size(); ++f) {
      sum += (tips[f] - palm_middle_).norm();
      for (std::size_t g = 0; g < tips.size(); ++g) {
        if (g != f) sum += (tips[f] - tips[g]).norm() / static_cast<double>(tips.size() - 1);
      }
    }
    return sum;
  }

  /// Which joints bend fingers, and which way closes.
  void signs() {
    if (!bodies_[0].mesh.faces.empty()) {
      palm_middle_ = geometry::bounding_box(bodies_[0].mesh).center();
    } else {
      for (const Chain& chain : chains_) {
        palm_middle_ += tree_.joints[at(chain.joints.front())].X_PJ.translation() /
                        static_cast<double>(chains_.size());
      }
    }
    role_.assign(tree_.joints.size(), Role::None);
    sign_.assign(tree_.joints.size(), 0);
    const auto X_rest = poses(rest());
    for (const Chain& chain : chains_) {
      const int last = chain.joints.back();
      for (const int joint : chain.joints) {
        const bool bends = tree_.joints[at(joint)].type == JointType::Prismatic ||
                           tree_.joints[at(last)].type == JointType::Prismatic ||
                           std::abs(axis_H(joint, X_rest).dot(axis_H(last, X_rest))) >= kParallel;
        Role& role = role_[at(leader_of(joint))];
        if (bends) {
          role = Role::Bend;
        } else if (role == Role::None) {
          role = Role::Other;
        }
      }
    }
    std::vector<double> gain(tree_.joints.size(), 0.0);
    for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
      if (role_[j] != Role::Bend) continue;
      for (std::size_t s = 0; s < kNumSamples; ++s) {
        VectorXd q = sampled(s);
        q[static_cast<Eigen::Index>(j)] = tree_.joints[j].lower;
        gain[j] += spread(poses(q));
        q[static_cast<Eigen::Index>(j)] = tree_.joints[j].upper;
        gain[j] -= spread(poses(q));
      }
    }
    // All joints that bend one finger bend it the same way: the sum decides, each turned to the
    // last joint's axis.
    std::vector<double> vote(tree_.joints.size(), 0.0);
    for (const Chain& chain : chains_) {
      double sum = 0.0;
      std::vector<std::pair<int, double>> turned;
      for (const int leader : chain.leaders) {
        if (role_[at(leader)] != Role::Bend) continue;
        const double side = side_of(chain, leader, X_rest);
        turned.emplace_back(leader, side);
        sum += side * gain[at(leader)];
      }
      for (const auto& [leader, side] : turned) vote[at(leader)] += side * sum;
    }
    for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
      if (role_[j] == Role::Bend) sign_[j] = vote[j] >= 0.0 ? 1 : -1;
    }
  }

  /// +1 if a growing leader turns the finger as its last joint does when growing, −1 if against.
  double side_of(const Chain& chain, int leader, const std::vector<RigidTransform>& X_HL) const {
    const int last = chain.joints.back();
    for (const int joint : chain.joints) {
      if (leader_of(joint) != leader) continue;
      const auto& coupling = tree_.joints[at(joint)].coupling;
      const double ratio = coupling && coupling->ratio < 0.0 ? -1.0 : 1.0;
      if (tree_.joints[at(joint)].type == JointType::Prismatic ||
          tree_.joints[at(last)].type == JointType::Prismatic) {
        return ratio;
      }
      return axis_H(joint, X_HL).dot(axis_H(last, X_HL)) < 0.0 ? -ratio : ratio;
    }
    return 1.0;
  }

  std::map<std::string, int> closing() const {
    std::map<std::string, int> result;
    for (std::size_t j = 0; j < tree_.joints.size(); ++j) {
      if (sign_[j] != 0) result[tree_.joints[j].name] = sign_[j];
    }
    return result;
  }

  /// The model's own signs, as the reader will resolve them.
  void take_signs(const std::map<std::string, int>& signs) {
    for (Joint& joint : tree_.joints) {
      const auto found = signs.find(joint.name);
      joint.closing_sign = found == signs.end() ? 0 : found->second;
    }
    for (Joint& joint : tree_.joints) {
      if (!joint.coupling || signs.contains(joint.name)) continue;
      const double ratio = joint.coupling->ratio;
      joint.closing_sign =
          tree_.joints[at(joint.coupling->leader)].closing_sign * (ratio > 0.0   ? 1
                                                                   : ratio < 0.0 ? -1
                                                                                 : 0);
    }
    bool closes = false;
    for (const Chain& chain : chains_) {
      for (const int joint : chain.joints) {
        closes = closes || tree_.joints[at(joint)].closing_sign != 0;
      }
    }
    if (!closes) fail("no joint of any finger closes it; write \"closing\" into the sidecar");
  }

  void note_closing(const std::map<std::string, int>& signs) {
    std::string text;
    for (const auto& [name, sign] : signs) {
      text += (text.empty() ? "" : ", ") + name + (sign > 0 ? " +" : " -");
    }
    findings_.note("", "closing directions derived (toward palm and other tips): " + text);
  }

  // ---- Palm -------------------------------------------------------------------------------------

  /// How a body of a finger faces in a configuration, if its closing joints move it.
  std::optional<Facing> facing(const Chain& chain, std::size_t number, const VectorXd& q) const {
    const Body& body = bodies_[at(chain.bodies[number])];
    if (body.mesh.faces.empty()) return std::nullopt;
    // The nearest closing joint above says what drives it. What only an opposing joint moves faces
    // nothing: its leading side looks away from the palm.
    int leader = -1;
    for (std::size_t i = 0; i <= number; ++i) {
      const int candidate = leader_of(chain.joints[i]);
      if (tree_.joints[at(chain.joints[i])].closing_sign == 0) continue;
      if (role_[at(candidate)] == Role::Bend) leader = candidate;
    }
    if (leader < 0) return std::nullopt;
    const auto X_HL = poses(q);
    const RigidTransform& X_HB = pose_of_body(X_HL, chain.bodies[number]);
    // From its joint to the next one, of the last body to its tip.
    Vector3d end_B = chain.tip_B;
    Vector3d start_B = Vector3d::Zero();
    if (number + 1 < chain.bodies.size()) {
      end_B = X_HB.inverse() * pose_of_body(X_HL, chain.bodies[number + 1]).translation();
    }
    if (end_B.norm() < 0.2 * geometry::longest_extent(body.mesh)) {
      // Its frame stands at its end (or both joints in one place).
      end_B = geometry::bounding_box(body.mesh).center();
    }
    const Eigen::MatrixXd jacobian =
        folded(tree_, point_jacobian(tree_, followed(q), body.links.front(), end_B));
    const std::vector<int> independent = independent_joints(tree_);
    const auto column =
        std::find(independent.begin(), independent.end(), leader) - independent.begin();
    const int sign = tree_.joints[at(leader)].closing_sign;
    const Vector3d velocity = sign * jacobian.col(column).head<3>();
    const Vector3d turning = sign * jacobian.col(column).tail<3>();
    const Vector3d along = X_HB.linear() * (end_B - start_B);
    Facing result;
    result.point_H = X_HB * (0.5 * (start_B + end_B));
    if (turning.norm() * along.norm() <= kTranslation * velocity.norm()) {
      if (velocity.norm() == 0.0) return std::nullopt;
      result.direction_H = velocity.normalized();
      result.point_H = X_HB * geometry::bounding_box(body.mesh).center();
    } else {
      result.direction_H = turning.cross(along).normalized();
    }
    result.along_H = along.normalized();
    if (!result.direction_H.allFinite() || !result.along_H.allFinite()) return std::nullopt;
    return result;
  }

  /// Where the half-closed fingers face: the point nearest to all lines along which their bodies
  /// face, drawn a little to the middle of the bodies, so that parallel lines have one too.
  Vector3d facing_center() const {
    constexpr double kDraw = 0.05;  // weight against that of a line
    const VectorXd q = closed_by(0.5);
    Eigen::Matrix3d system = Eigen::Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const Chain& chain : chains_) {
      for (std::size_t i = 0; i < chain.bodies.size(); ++i) {
        const auto f = facing(chain, i, q);
        if (!f) continue;
        const Eigen::Matrix3d across =
            Eigen::Matrix3d::Identity() - f->direction_H * f->direction_H.transpose();
        const Eigen::Matrix3d weight = across + kDraw * Eigen::Matrix3d::Identity();
        system += weight;
        right += weight * f->point_H;
      }
    }
    return system.ldlt().solve(right);
  }

  void palm_direction() {
    facing_center_ = facing_center();
    Vector3d base = Vector3d::Zero();
    const auto X_HL = poses(rest());
    for (const Chain& chain : chains_) {
      base += pose_of_body(X_HL, chain.bodies.front()).translation() /
              static_cast<double>(chains_.size());
    }
    palm_center_ = base;
    palm_direction_ = facing_center_ - base;
    if (!bodies_[0].mesh.faces.empty()) look_at_palm();
    if (const auto resting = resting_direction()) {
      constexpr double kAgree = 0.64;  // cosine of 50°
      if (resting->dot(palm_direction_.normalized()) >= kAgree) palm_direction_ = *resting;
    }
    // What nearly is an axis of the root link is meant to be that axis.
    constexpr double kAxis = 0.9986;  // cosine of 3°
    for (int k = 0; k < 3; ++k) {
      if (std::abs(palm_direction_[k]) < kAxis * palm_direction_.norm()) continue;
      palm_direction_ = std::copysign(1.0, palm_direction_[k]) * Vector3d::Unit(k);
    }
    if (!bodies_[0].mesh.faces.empty()) {
      const MeshQuery palm(bodies_[0].mesh);
      const Vector3d above = facing_center_ + longest_extent(bodies_[0].mesh) * palm_direction_;
      if (const auto below = palm.first_hit(above, -palm_direction_)) palm_center_ = below->point;
    }
    if (given_.palm) {
      palm_direction_ = given_.palm->direction_H;
      palm_center_ = given_.palm->center_H;
    }
    if (!(palm_direction_.norm() > 0.0)) {
      fail("the palm's direction cannot be derived; write \"palm\" into the sidecar");
    }
    palm_direction_.normalize();
  }

  /// The way in which more than half of the fingers face at rest, if they agree within 45°.
  std::optional<Vector3d> resting_direction() const {
    constexpr double kAgree = 0.7;
    const VectorXd q = rest();
    std::vector<Vector3d> directions;
    for (const Chain& chain : chains_) {
      for (std::size_t i = 0; i < chain.bodies.size(); ++i) {
        const auto faces = facing(chain, i, q);
        if (!faces) continue;
        directions.push_back(faces->direction_H);
        break;
      }
    }
    std::optional<Vector3d> best;
    std::size_t most = std::max<std::size_t>(1, chains_.size() / 2);
    for (const Vector3d& direction : directions) {
      Vector3d sum = Vector3d::Zero();
      std::size_t count = 0;
      for (const Vector3d& other : directions) {
        if (direction.dot(other) < kAgree) continue;
        sum += other;
        ++count;
      }
      if (count <= most) continue;
      most = count;
      best = sum.normalized();
    }
    return best;
  }

  /// The side of the palm that is seen from the fingers' center: the direction that most of the
  /// field of view faces.
  void look_at_palm() {
    const MeshQuery palm(bodies_[0].mesh);
    Vector3d eye = facing_center_;
    const Vector3d away = (facing_center_ - palm_middle_).normalized();
    const double step = 0.05 * geometry::longest_extent(bodies_[0].mesh);
    for (int i = 0; i < 40 && palm.containment(eye) != geometry::Containment::Outside; ++i) {
      eye += step * away;
    }
    constexpr int kNumLooks = 3000;
    struct Look {
      Vector3d normal;
      double weight = 0.0;
    };
    std::vector<Look> looks;
    for (int i = 0; i < kNumLooks; ++i) {  // a spiral over the sphere: equal shares of view
      const double z = 1.0 - 2.0 * (i + 0.5) / kNumLooks;
      const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
      const double r = std::sqrt(1.0 - z * z);
      const Vector3d ray(r * std::cos(turn), r * std::sin(turn), z);
      const auto hit = palm.first_hit(eye, ray);
      if (!hit) continue;
      const Vector3d normal = geometry::face_normal(palm.mesh(), at(hit->face));
      if (normal.dot(ray) < 0.0) looks.push_back({normal, -normal.dot(ray)});
    }
    if (looks.empty()) return;
    // The normal with most of the view within kSameSide, then the mean of those.
    constexpr double kSameSide = 0.94;  // cosine of 20°
    const auto mean_around = [&](const Vector3d& normal) {
      Vector3d sum = Vector3d::Zero();
      for (const Look& other : looks) {
        if (other.normal.dot(normal) >= kSameSide) sum += other.weight * other.normal;
      }
      return sum;
    };
    Vector3d best = Vector3d::Zero();
    for (std::size_t i = 0; i < looks.size(); i += std::max<std::size_t>(1, looks.size() / 300)) {
      const Vector3d sum = mean_around(looks[i].normal);
      if (sum.norm() > best.norm()) best = sum;
    }
    palm_direction_ = best.normalized();
  }

  /// Joints that bend no finger but bring its half-closed tip before the palm (a thumb's
  /// opposition) close it that way: of every finger first the one that does so most, then, with
  /// that one half closed, the next.
  void fore_joints() {
    for (const Chain& chain : chains_) {
      std::vector<int> open;
      for (const int leader : chain.leaders) {
        if (role_[at(leader)] == Role::Other && sign_[at(leader)] == 0) open.push_back(leader);
      }
      while (!open.empty()) {
        int best = -1;
        double farthest = 0.0;
        for (const int leader : open) {
          const double forward = forward_of(chain, leader);
          if (std::abs(forward) <= std::abs(farthest)) continue;
          farthest = forward;
          best = leader;
        }
        if (best < 0) break;
        sign_[at(best)] = farthest > 0.0 ? 1 : -1;
        tree_.joints[at(best)].closing_sign = sign_[at(best)];
        std::erase(open, best);
      }
    }
  }

  /// How far a joint moves the half-closed finger's tip along the palm's direction, lower limit to
  /// upper; 0 if that is less than kForwardShare of the tip's way.
  double forward_of(const Chain& chain, int leader) const {
    constexpr int kNumSteps = 16;
    const Joint& joint = tree_.joints[at(leader)];
    VectorXd q = closed_by(0.5);
    double way = 0.0;
    Vector3d first = Vector3d::Zero();
    Vector3d before = Vector3d::Zero();
    for (int i = 0; i <= kNumSteps; ++i) {
      q[leader] = joint.lower + (joint.upper - joint.lower) * i / kNumSteps;
      const Vector3d now = tip(chain, poses(q));
      if (i == 0) {
        first = now;
      } else {
        way += (now - before).norm();
      }
      before = now;
    }
    const double forward = palm_direction_.dot(before - first);
    return std::abs(forward) >= kForwardShare * way ? forward : 0.0;
  }

  // ---- Names and thumb --------------------------------------------------------------------------

  /// The finger whose tip, when closing, goes against the others'; none if no one does so clearly,
  /// or if there are only two.
  int thumb() const {
    if (chains_.size() < 3) return -1;
    const auto open = poses(closed_by(0.0));
    const auto closed = poses(closed_by(0.5));
    std::vector<Vector3d> way;
    for (const Chain& chain : chains_) {
      Vector3d w = tip(chain, closed) - tip(chain, open);
      w -= w.dot(palm_direction_) * palm_direction_;
      way.push_back(w.norm() > 0.0 ? Vector3d(w.normalized()) : w);
    }
    int least = -1;
    double agreement = 0.0;
    double second = 0.0;
    for (std::size_t f = 0; f < way.size(); ++f) {
      double sum = 0.0;
      for (std::size_t g = 0; g < way.size(); ++g) {
        if (g != f) sum += way[f].dot(way[g]) / static_cast<double>(way.size() - 1);
      }
      if (least == -1 || sum < agreement) {
        second = agreement;
        agreement = sum;
        least = static_cast<int>(f);
      } else if (least == 0 && f == 1) {
        second = sum;
      } else {
        second = std::min(second, sum);
      }
    }
    constexpr double kClear = 0.2;  // difference of mean cosines
    return second - agreement >= kClear ? least : -1;
  }

  /// What the names of a finger's links begin with, up to a separator; finger_1, … where that does
  /// not tell the fingers apart.
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const Chain& chain : chains_) {
      std::string prefix;
      bool is_first = true;
      for (const int body : chain.bodies) {
        for (const int link : bodies_[at(body)].links) {
          const std::string& name = tree_.links[at(link)].name;
          if (is_first) prefix = name;
          is_first = false;
          const auto differ = std::mismatch(prefix.begin(), prefix.end(), name.begin(), name.end());
          prefix.erase(differ.first, prefix.end());
        }
      }
      while (!prefix.empty() && std::string("_-. /").find(prefix.back()) != std::string::npos) {
        prefix.pop_back();
      }
      result.push_back(prefix);
    }
    const std::set<std::string> distinct(result.begin(), result.end());
    const bool are_names =
        distinct.size() == result.size() && !distinct.contains("palm") &&
        std::all_of(result.begin(), result.end(), [](const auto& n) { return n.size() > 1; });
    for (std::size_t f = 0; f < result.size() && !are_names; ++f) {
      result[f] = "finger_" + std::to_string(f + 1);
    }
    return result;
  }

  std::vector<SidecarFinger> fingers() {
    std::vector<SidecarFinger> result;
    const int its_thumb = thumb();
    const std::vector<std::string> its_names = names();
    const auto X_rest = poses(rest());
    for (std::size_t f = 0; f < chains_.size(); ++f) {
      const Chain& chain = chains_[f];
      SidecarFinger finger;
      finger.name = its_names[f];
      finger.is_thumb = static_cast<int>(f) == its_thumb;
      for (const int body : chain.bodies) {
        for (const int link : bodies_[at(body)].links) {
          finger.links.push_back(tree_.links[at(link)].name);
        }
      }
      // Bodies are complete subtrees of fixed links, which may interleave with the next joint's.
      std::sort(finger.links.begin(), finger.links.end(),
                [&](const std::string& a, const std::string& b) {
                  return tree_.link_index(a) < tree_.link_index(b);
                });
      for (const int joint : chain.joints) finger.joints.push_back(tree_.joints[at(joint)].name);
      // Of the joints that neither close nor open, the one whose axis is nearest to the palm's
      // direction; a tenth of a cosine decides nothing, then the proximal one does.
      double nearest = -0.1;
      for (const int joint : chain.joints) {
        if (tree_.joints[at(joint)].closing_sign != 0) continue;
        if (tree_.joints[at(joint)].type == JointType::Prismatic) continue;
        const double cosine = std::abs(axis_H(joint, X_rest).dot(palm_direction_));
        if (cosine <= nearest + 0.1) continue;
        nearest = cosine;
        finger.swing_joint = tree_.joints[at(joint)].name;
      }
      if (given_.pads) {  // pads that are given name their fingers
        for (const SidecarPad& pad : *given_.pads) {
          if (std::find(finger.links.begin(), finger.links.end(), pad.link) != finger.links.end()) {
            finger.name = pad.finger;
          }
        }
      }
      result.push_back(std::move(finger));
    }
    std::string text;
    for (const SidecarFinger& finger : result) {
      text += (text.empty() ? "" : "; ") + finger.name + (finger.is_thumb ? " (thumb)" : "");
      for (const std::string& joint : finger.joints) {
        text += " " + joint + (finger.swing_joint == joint ? " (swing)" : "");
      }
    }
    findings_.note("", "fingers derived from the tree's leaves: " + text);
    return result;
  }

  // ---- Pads -------------------------------------------------------------------------------------

  std::vector<SidecarPad> pads(const std::vector<SidecarFinger>& fingers) {
    std::vector<SidecarPad> result;
    const VectorXd q = closed_by(0.5);
    const auto X_HL = poses(q);
    for (std::size_t f = 0; f < chains_.size(); ++f) {
      const Chain& chain = chains_[f];
      for (std::size_t i = 0; i < chain.bodies.size(); ++i) {
        const auto faces = facing(chain, i, q);
        if (!faces) continue;
        const Body& body = bodies_[at(chain.bodies[i])];
        for (const int link : body.links) {
          if (tree_.links[at(link)].mesh_L.faces.empty()) continue;
          if (std::find(fingers[f].links.begin(), fingers[f].links.end(),
                        tree_.links[at(link)].name) == fingers[f].links.end()) {
            continue;
          }
          std::vector<MeshQuery> others;
          for (const int other : body.links) {
            if (other == link || tree_.links[at(other)].mesh_L.faces.empty()) continue;
            others.emplace_back(transformed(tree_.links[at(other)].mesh_L,
                                            X_HL[at(link)].inverse() * X_HL[at(other)]));
          }
          const Eigen::Matrix3d R_LH = X_HL[at(link)].linear().transpose();
          PadSearch search{R_LH * faces->direction_H, R_LH * faces->along_H, std::nullopt, 0.0};
          const auto found = fit_pad(MeshQuery(tree_.links[at(link)].mesh_L), others, search);
          const bool is_tip = i + 1 == chain.bodies.size();
          if (found && !is_tip && is_shut_in(*found, link, chain)) continue;
          add_pad(result, found, tree_.links[at(link)].name, fingers[f].name);
        }
      }
    }
    // A tip pad that is given by name alone is the one on the last link that has a pad.
    for (const SidecarFinger& finger : fingers) {
      if (!finger.tip_pad) continue;
      for (auto pad = result.rbegin(); pad != result.rend(); ++pad) {
        if (pad->finger != finger.name) continue;
        pad->name = *finger.tip_pad;
        break;
      }
    }
    if (!bodies_[0].mesh.faces.empty()) {
      const PadSearch search{palm_direction_, palm_axis(), palm_center_, palm_reach()};
      const auto pad = fit_pad(MeshQuery(bodies_[0].mesh), {}, search);
      add_pad(result, pad, tree_.links[0].name, "palm");
    }
    return result;
  }

  /// How far the palm goes from its center: as far as the fingers' first joints and half-closed
  /// tips, seen along its direction. Leaves out a wrist.
  double palm_reach() const {
    const auto X_HL = poses(closed_by(0.5));
    double reach = 0.0;
    for (const Chain& chain : chains_) {
      for (const Vector3d& point :
           {Vector3d(pose_of_body(X_HL, chain.bodies.front()).translation()), tip(chain, X_HL)}) {
        reach = std::max(reach, palm_direction_.cross(point - palm_center_).norm());
      }
    }
    return reach;
  }

  /// Whether a pad looks at its own finger, the palm or a bar of a linkage close by, the hand being
  /// open and half closed: then nothing can get between.
  bool is_shut_in(const FittedPad& pad, int link, const Chain& chain) const {
    constexpr double kStart = 1e-4;  // [m], off the pad itself
    constexpr double kClose = 0.05;  // [m]; less than what hands are made to hold
    double height = 0.0;
    for (const Vector3d& point : pad.surface) height = std::max(height, point.z());
    for (const double share : {0.0, 0.5}) {
      const auto X_HL = poses(closed_by(share));
      const RigidTransform X_HC = X_HL[at(link)] * pad.X_LC;
      bool is_hit = false;
      for (std::size_t b = 0; b < bodies_.size() && !is_hit; ++b) {
        const int body = static_cast<int>(b);
        const bool is_other_finger =
            std::any_of(chains_.begin(), chains_.end(), [&](const Chain& other) {
              return &other != &chain && std::find(other.bodies.begin(), other.bodies.end(),
                                                   body) != other.bodies.end();
            });
        const std::vector<int>& own = bodies_[b].links;
        if (is_other_finger || bodies_[b].mesh.faces.empty() ||
            std::find(own.begin(), own.end(), link) != own.end()) {
          continue;
        }
        const RigidTransform X_BC = pose_of_body(X_HL, body).inverse() * X_HC;
        const auto hit =
            MeshQuery(bodies_[b].mesh)
                .first_hit(X_BC * Vector3d(0.0, 0.0, height + kStart), X_BC.linear().col(2));
        is_hit = hit && hit->distance < kClose;
      }
      if (!is_hit) return false;
    }
    return true;
  }

  /// A direction in the palm's plane: of the root link's axes the one most across its direction.
  Vector3d palm_axis() const {
    int least = 0;
    palm_direction_.cwiseAbs().minCoeff(&least);
    return Vector3d::Unit(least);
  }

  void add_pad(std::vector<SidecarPad>& list, const std::optional<FittedPad>& found,
               const std::string& link, const std::string& finger) {
    if (!found) return;
    constexpr double kLeastArea = 2e-5;  // [m²], 20 mm²: smaller ones are edges
    if (found->area < kLeastArea) return;
    SidecarPad pad;
    pad.name = finger != "palm"                  ? link + "_pad"
               : given_.palm && given_.palm->pad ? *given_.palm->pad
                                                 : "palm_pad";
    pad.link = link;
    pad.finger = finger;
    pad.X_LC = found->X_LC;
    pad.outline = found->outline;
    pad.surface = found->surface;
    list.push_back(pad);
    const auto millimeters = [](double meters) {
      return geometry::shortest_decimal(std::round(meters * 1e5) / 100.0);
    };
    findings_.note("pad " + pad.name,
                   std::string("derived: ") + (pad.surface.empty() ? "flat" : "bulging") + ", " +
                       std::to_string(static_cast<int>(std::round(found->area * 1e6))) +
                       " mm^2, within " + millimeters(found->deviation) + " mm of the mesh");
  }

  SidecarPalm palm(const std::vector<SidecarPad>& found,
                   const std::optional<std::vector<SidecarPad>>& given) {
    SidecarPalm result;
    result.link = tree_.links[0].name;
    result.center_H = palm_center_;
    result.direction_H = palm_direction_;
    for (const SidecarPad& pad : given ? *given : found) {
      if (pad.finger != "palm") continue;
      result.pad = pad.name;
    }
    const auto text = [](const Vector3d& v) {
      std::string list;
      for (int i = 0; i < 3; ++i) {
        const double rounded = std::round(v[i] * 1e3) / 1e3 + 0.0;  // no negative zero
        list += (i ? " " : "") + geometry::shortest_decimal(rounded);
      }
      return list;
    };
    findings_.note("link " + result.link, "palm derived: center " + text(palm_center_) +
                                              " m, direction " + text(palm_direction_) +
                                              ", toward where the half-closed fingers face");
    return result;
  }

  HandModel tree_;  ///< A copy: closing signs are set on the way.
  const Sidecar& given_;
  Findings& findings_;
  std::vector<Body> bodies_;
  std::vector<Chain> chains_;
  std::vector<Role> role_;  ///< Per joint; None for joints that follow.
  std::vector<int> sign_;
  Vector3d palm_middle_ = Vector3d::Zero();
  Vector3d facing_center_ = Vector3d::Zero();
  Vector3d palm_center_ = Vector3d::Zero();
  Vector3d palm_direction_ = Vector3d::UnitZ();
};

}  // namespace

Sidecar completed(const HandModel& tree, const Sidecar& given, Findings& findings) {
  if (given.is_complete()) return given;
  return Deriver(tree, given, findings).derive();
}

}  // namespace graspfit::hands::internal
