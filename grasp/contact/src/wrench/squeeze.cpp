#include "graspfit/contact/squeeze.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/contact/grasp_balance.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/jacobian.hpp"

namespace graspfit::contact {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Evenness of the squeeze's forces: small enough to leave the residual to the balance, large
/// enough to decide among balanced forces well above rounding (its square, 1e-6, does).
constexpr double kEvenness = 1e-3;

/// Says for each joint whether it is a coupled one that stands where its leader puts it.
std::vector<bool> following_joints(const hands::HandModel& hand, const VectorXd& q) {
  std::vector<bool> follows;
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    follows.push_back(hands::follows_leader(hand, j, q, hands::Followers::InPlace));
  }
  return follows;
}

/// Generalized forces Σ Jᵀ f on the independent joints, in their order [N m or N].
VectorXd joint_forces(const hands::HandModel& hand, const hands::PosedConfiguration& grasp,
                      std::span<const Contact> contacts, const Eigen::Matrix3Xd& forces_O) {
  MatrixXd per_joint = MatrixXd::Zero(1, std::ssize(hand.joints));
  for (int i = 0; i < std::ssize(contacts); ++i) {
    const hands::RigidTransform& X = grasp.X_OL[contacts[i].link];
    const MatrixXd jacobian = hands::point_jacobian(hand, grasp.X_OL, contacts[i].link,
                                                    geometry::inverted(X) * contacts[i].point_O);
    per_joint += forces_O.col(i).transpose() * jacobian.topRows(3);
  }
  return hands::folded(hand, per_joint, grasp.configuration.q, hands::Followers::InPlace)
      .transpose();
}

/// Moves the independent joints by `displacement`, clamped to the limits, and their followers with
/// them. Returns whether a limit kept any joint back.
bool command(const hands::HandModel& hand, const VectorXd& displacement,
             const std::vector<bool>& follows, VectorXd& q) {
  bool is_clamped = false;
  const std::vector<int> independent = hands::independent_joints(hand);
  for (int k = 0; k < std::ssize(independent); ++k) {
    const double change = displacement[k];
    if (change == 0.0) continue;
    const hands::Joint& joint = hand.joints[independent[k]];
    const double wanted = q[independent[k]] + change;
    q[independent[k]] = std::clamp(wanted, joint.lower, joint.upper);
    is_clamped = is_clamped || q[independent[k]] != wanted;
  }
  // Followers are put where they belong first: the couplings would leave behind a breakaway joint
  // that its leader opens.
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    if (follows[j]) q[j] = hands::led_position(*hand.joints[j].coupling, q);
  }
  hands::apply_couplings(hand, q);
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    const bool is_left_behind =
        follows[j] && !hands::follows_leader(hand, j, q, hands::Followers::InPlace);
    is_clamped = is_clamped || is_left_behind;
  }
  return is_clamped;
}

}  // namespace

void SqueezeOptions::validate() const {
  const auto require = [](double value, std::string_view field, std::string_view rule,
                          bool is_met) {
    base::require(is_met && std::isfinite(value), "SqueezeOptions", field, value, rule);
  };
  require(normal_sum, "normal_sum", "finite and > 0 N", normal_sum > 0.0);
  require(stiffness, "stiffness", "finite and > 0 N m/rad", stiffness > 0.0);
  require(slide_stiffness, "slide_stiffness", "finite and > 0 N/m", slide_stiffness > 0.0);
  require(largest_residual, "largest_residual", "finite and >= 0", largest_residual >= 0.0);
}

Squeeze squeeze_configuration(const hands::HandModel& hand, const hands::PosedConfiguration& grasp,
                              std::span<const Contact> contacts, const SqueezeContext& context,
                              const SqueezeOptions& options) {
  options.validate();
  hands::validate(hand, grasp.configuration);
  const std::vector<Contact> touching = touching_contacts(contacts, context.bearing_gap);
  base::require(!touching.empty(), "squeeze_configuration", "number of contacts that touch",
                touching.size(), "at least 1");
  const int num_links = base::as_index<int>(hand.links.size());
  base::require(grasp.X_OL.size() == hand.links.size(), "squeeze_configuration",
                "number of link poses", grasp.X_OL.size(),
                "one per link of hand " + hand.name + ", " + std::to_string(num_links));
  for (const Contact& contact : contacts) {
    base::require(contact.link >= 0 && contact.link < num_links, "squeeze_configuration",
                  "link of a contact", contact.link,
                  "one of the " + std::to_string(num_links) + " of hand " + hand.name);
  }
  const BalanceForces balance = balance_forces(touching, context.center_of_mass_O, Wrench::Zero(),
                                               {.friction = context.friction,
                                                .least_normal_sum = options.normal_sum,
                                                .torque_scale = context.torque_scale,
                                                .evenness = kEvenness});
  Squeeze result{grasp.configuration, Eigen::Matrix3Xd::Zero(3, std::ssize(contacts)),
                 balance.residual_norm / options.normal_sum, false, false};
  Index next = 0;
  for (int i = 0; i < std::ssize(contacts); ++i) {
    const bool bears = !context.bearing_gap || contacts[i].gap <= *context.bearing_gap;
    if (bears) result.forces_O.col(i) = balance.forces_O.col(next++);
  }
  result.is_balanced = result.residual <= options.largest_residual;

  const std::vector<bool> follows = following_joints(hand, grasp.configuration.q);
  VectorXd displacement = joint_forces(hand, grasp, contacts, result.forces_O);
  const std::vector<int> independent = hands::independent_joints(hand);
  for (int k = 0; k < std::ssize(independent); ++k) {
    const bool is_slide = hand.joints[independent[k]].type == hands::JointType::Prismatic;
    displacement[k] /= is_slide ? options.slide_stiffness : options.stiffness;
  }
  result.is_clamped = command(hand, displacement, follows, result.configuration.q);
  return result;
}

Squeeze squeeze_configuration(const hands::HandModel& hand, const hands::HandConfiguration& grasp,
                              std::span<const Contact> contacts, const SqueezeContext& context,
                              const SqueezeOptions& options) {
  options.validate();
  hands::validate(hand, grasp);
  const std::vector<hands::RigidTransform> X_OL = hands::forward_kinematics(hand, grasp);
  return squeeze_configuration(hand, hands::PosedConfiguration{grasp, X_OL}, contacts, context,
                               options);
}

}  // namespace graspfit::contact
