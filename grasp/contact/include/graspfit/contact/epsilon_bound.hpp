#pragma once

#include <limits>

#include "graspfit/contact/grasp_wrench_space.hpp"

namespace graspfit::contact {

/// An upper bound of ε (l1), nearly always ε itself, for callers that compare candidates by the
/// thousand: some 0.05 ms for 32 wrenches, where their hull takes milliseconds.
///
/// From the origin rays are shot at the hull of the wrenches, about along the six axes, both ways,
/// each by a linear program, and from the facet that a ray meets along its normal, until that
/// leads to no nearer facet: the result is the distance of the nearest facet found. In double
/// arithmetic: to rounding it is at least ε, but 0 where a ray's program does not end. Where the
/// origin is outside the hull, or on it, the result is at most zero: the distance from the origin
/// to a point of the hull near the nearest one [Gilbert 1966], negative.
///
/// The search ends with the first bound that is no more than `enough`, for callers who then need no
/// better one; where `enough` is not negative, with any point of a hull that the origin is outside.
/// @throws InvalidInput unless there is at least one wrench and all are finite.
double epsilon_bound(const Wrenches& wrenches,
                     double enough = -std::numeric_limits<double>::infinity());

/// The largest force without torque that the hull of the wrenches contains in each of 14
/// directions, those of the axes and of the diagonals between them: of contacts with wrenches of
/// normal force 1 the weight, over the sum of normal forces, that they bear however it pulls, a
/// task wrench space of forces [Borst et al. 2004]. 0 where it contains none along
/// some direction. In double arithmetic, to a hundred-thousandth of the longest wrench, by a linear
/// program for each direction. `enough` is as above.
/// @throws InvalidInput unless there is at least one wrench and all are finite.
double least_force(const Wrenches& wrenches,
                   double enough = -std::numeric_limits<double>::infinity());

}  // namespace graspfit::contact
