#include "graspfit/hands/hand_configuration.hpp"

#include <algorithm>
#include <cmath>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::hands {

namespace {

using base::InvalidInput;
using base::shortest_decimal;

void require_size(const HandModel& model, const Eigen::VectorXd& q) {
  if (q.size() == std::ssize(model.joints)) return;
  throw InvalidInput("hand " + model.name + ": " + std::to_string(q.size()) +
                     " joint positions for " + std::to_string(model.joints.size()) + " joints");
}

}  // namespace

HandConfiguration open_configuration(const HandModel& model) {
  HandConfiguration configuration;
  configuration.q.resize(std::ssize(model.joints));
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Joint& joint = model.joints[j];
    configuration.q[j] =
        joint.closing_sign != 0 ? joint.open_limit() : std::clamp(0.0, joint.lower, joint.upper);
  }
  apply_couplings(model, configuration.q);
  return configuration;
}

HandConfiguration closed_configuration(const HandModel& model, double share) {
  // Written so that NaN fails.
  if (!(share >= 0.0 && share <= 1.0)) {
    throw InvalidInput("hand " + model.name + ": share of closing " + shortest_decimal(share) +
                       " is not in 0 to 1");
  }
  HandConfiguration configuration = open_configuration(model);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Joint& joint = model.joints[j];
    if (joint.closing_sign == 0 || joint.coupling) continue;
    double& position = configuration.q[j];
    position = (1.0 - share) * position + share * joint.closed_limit();
  }
  // Followers are open at first: a breakaway joint would keep a position that is further closed.
  apply_couplings(model, configuration.q);
  return configuration;
}

double led_position(const Coupling& coupling, const Eigen::VectorXd& q) {
  return coupling.ratio * q[coupling.leader] + coupling.offset;
}

double followed_position(const Joint& joint, const Eigen::VectorXd& q) {
  return std::clamp(led_position(*joint.coupling, q), joint.lower, joint.upper);
}

void apply_couplings(const HandModel& model, Eigen::VectorXd& q) {
  require_size(model, q);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Joint& joint = model.joints[j];
    if (!joint.coupling) continue;
    double& position = q[j];
    const double follows = followed_position(joint, q);
    const bool has_gone_on =
        joint.coupling->breakaway && joint.closing_sign * (position - follows) > 0.0;
    position = has_gone_on ? std::clamp(position, joint.lower, joint.upper) : follows;
  }
}

void clamp_to_limits(const HandModel& model, Eigen::VectorXd& q) {
  require_size(model, q);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    double& position = q[j];
    position = std::clamp(position, model.joints[j].lower, model.joints[j].upper);
  }
}

void validate(const HandModel& model, const HandConfiguration& configuration) {
  require_size(model, configuration.q);
  if (!configuration.X_OH.matrix().allFinite()) {
    throw InvalidInput("hand " + model.name + ": palm pose is not finite");
  }
  constexpr double kSlack = 1e-9;  // rounding of positions that were written as text
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const Joint& joint = model.joints[j];
    const double position = configuration.q[j];
    // Written so that NaN fails.
    if (position >= joint.lower - kSlack && position <= joint.upper + kSlack) continue;
    throw InvalidInput("hand " + model.name + ": joint " + joint.name + " at " +
                       shortest_decimal(position) + " is outside " + shortest_decimal(joint.lower) +
                       " to " + shortest_decimal(joint.upper));
  }
}

}  // namespace graspfit::hands
