#pragma once

#include <span>

#include "graspfit/contact/contact.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/grasp/planner_options.hpp"

namespace graspfit::grasp::internal {

/// How firm a grasp of such wrenches (graspfit's convention) is [R]: the lesser of
/// `contact::epsilon_bound` and 0.3 of `contact::least_force`, which is about three times as large.
/// Of 511 grasps by Allegro and Shadow hand (14 objects) the force alone tells those that hold
/// under `dexonomy-hard` better than ε does (area under the ROC curve 0.84 against 0.78); ε alone
/// sees torques, and how far contacts may be off. Not positive: the grasp does not close.
/// @param enough of what is no more than this only so much is known
double firmness(const contact::Wrenches& wrenches, double enough);

/// That of contacts, at least one. Of two, which cannot close, it is how far their line is within
/// both cones: the friction less the tangent of the larger lean; of more than a right angle, minus
/// the lean [rad]; of one place twice, minus infinity.
double firmness(std::span<const contact::Contact> contacts, const contact::WrenchObject& object,
                double friction);

/// Coulomb's coefficient of firmness: between that of closure and that within which a squeeze is to
/// balance, since what is firm there still closes where normals turn out a little different.
double firmness_friction(const PlannerOptions& options);

/// The rule for two contacts.
double firmness_of_pinch(const contact::Contact& a, const contact::Contact& b, double friction);

}  // namespace graspfit::grasp::internal
