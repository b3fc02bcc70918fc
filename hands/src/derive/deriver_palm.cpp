#include <algorithm>
#include <cmath>
#include <numbers>

#include "derive/deriver.hpp"
#include "graspfit/hands/jacobian.hpp"

namespace graspfit::hands::internal {
namespace {

// Least motion along the palm's direction, relative to the length of a tip's path.
constexpr double kForwardShare = 0.5;
// A body hardly turns if its rotation times its length is at most this share of its motion.
constexpr double kTranslation = 0.2;

}  // namespace

std::optional<Facing> Deriver::facing(const Chain& chain, std::size_t number,
                                      const VectorXd& q) const {
  const Body& body = bodies_[chain.bodies[number]];
  if (body.mesh.faces.empty()) return std::nullopt;
  // The body is driven by the nearest closing joint before it. A body that only an opposing joint
  // moves faces nothing: its leading side faces away from the palm.
  std::optional<int> leader;
  for (std::size_t i = 0; i <= number; ++i) {
    const int candidate = leader_of(tree_, chain.joints[i]);
    if (tree_.joints[chain.joints[i]].closing_sign == 0) continue;
    if (role_[candidate] == Role::Bend) leader = candidate;
  }
  if (!leader) return std::nullopt;
  const auto X_HL = poses(q);
  const RigidTransform& X_HB = pose_of_body(X_HL, chain.bodies[number]);
  // The body reaches from its joint to the next joint, the last body to its tip.
  Vector3d end_B = chain.tip_B;
  Vector3d start_B = Vector3d::Zero();
  if (number + 1 < chain.bodies.size()) {
    end_B = geometry::inverted(X_HB) * pose_of_body(X_HL, chain.bodies[number + 1]).translation();
  }
  if (end_B.norm() < 0.2 * geometry::longest_extent(body.mesh)) {
    // The body's frame is at its end (or both joints are at the same position).
    end_B = geometry::bounding_box(body.mesh).center();
  }
  const Eigen::MatrixXd jacobian =
      folded(tree_, point_jacobian(tree_, X_HL, body.links.front(), end_B));
  const std::vector<int> independent = independent_joints(tree_);
  const auto column =
      std::find(independent.begin(), independent.end(), *leader) - independent.begin();
  const int sign = tree_.joints[*leader].closing_sign;
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

Vector3d Deriver::facing_center() const {
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

void Deriver::palm_direction() {
  facing_center_ = facing_center();
  Vector3d base = Vector3d::Zero();
  const auto X_HL = poses(rest());
  for (const Chain& chain : chains_) {
    base += pose_of_body(X_HL, chain.bodies.front()).translation() /
            static_cast<double>(chains_.size());
  }
  palm_center_ = base;
  palm_direction_ = facing_center_ - base;
  if (!bodies_[0].mesh.faces.empty()) find_palm_direction_by_view();
  if (const auto resting = resting_direction()) {
    constexpr double kAgree = 0.64;  // cosine of 50°
    if (resting->dot(palm_direction_.normalized()) >= kAgree) palm_direction_ = *resting;
  }
  // A direction that is nearly an axis of the root link is meant to be that axis.
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

std::optional<Vector3d> Deriver::resting_direction() const {
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

void Deriver::find_palm_direction_by_view() {
  const MeshQuery palm(bodies_[0].mesh);
  Vector3d eye = facing_center_;
  const Vector3d away = (facing_center_ - palm_middle_).normalized();
  const double step = 0.05 * geometry::longest_extent(bodies_[0].mesh);
  for (int i = 0; i < 40 && palm.containment(eye) != geometry::Containment::Outside; ++i) {
    eye += step * away;
  }
  constexpr int kNumRays = 3000;
  struct SeenPoint {
    Vector3d normal;
    double weight = 0.0;
  };
  std::vector<SeenPoint> seen;
  for (int i = 0; i < kNumRays; ++i) {  // a spiral over the sphere: equal shares of view
    const double z = 1.0 - 2.0 * (i + 0.5) / kNumRays;
    const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    const Vector3d ray(r * std::cos(turn), r * std::sin(turn), z);
    const auto hit = palm.first_hit(eye, ray);
    if (!hit) continue;
    const Vector3d normal = geometry::face_normal(palm.mesh(), hit->face);
    if (normal.dot(ray) < 0.0) seen.push_back({normal, -normal.dot(ray)});
  }
  if (seen.empty()) return;
  // Finds the normal with most of the view within kSameSide of it, and takes the mean of these
  // normals.
  constexpr double kSameSide = 0.94;  // cosine of 20°
  const auto mean_around = [&](const Vector3d& normal) {
    Vector3d sum = Vector3d::Zero();
    for (const SeenPoint& other : seen) {
      if (other.normal.dot(normal) >= kSameSide) sum += other.weight * other.normal;
    }
    return sum;
  };
  Vector3d best = Vector3d::Zero();
  for (std::size_t i = 0; i < seen.size(); i += std::max<std::size_t>(1, seen.size() / 300)) {
    const Vector3d sum = mean_around(seen[i].normal);
    if (sum.norm() > best.norm()) best = sum;
  }
  palm_direction_ = best.normalized();
}

void Deriver::fore_joints() {
  for (const Chain& chain : chains_) {
    std::vector<int> open;
    for (const int leader : chain.leaders) {
      if (role_[leader] == Role::Other && sign_[leader] == 0) open.push_back(leader);
    }
    while (!open.empty()) {
      std::optional<int> best;
      double farthest = 0.0;
      for (const int leader : open) {
        const double forward = forward_of(chain, leader);
        if (std::abs(forward) <= std::abs(farthest)) continue;
        farthest = forward;
        best = leader;
      }
      if (!best) break;
      sign_[*best] = farthest > 0.0 ? 1 : -1;
      tree_.joints[*best].closing_sign = sign_[*best];
      std::erase(open, *best);
    }
  }
}

double Deriver::forward_of(const Chain& chain, int leader) const {
  constexpr int kNumSteps = 16;
  const Joint& joint = tree_.joints[leader];
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

}  // namespace graspfit::hands::internal
