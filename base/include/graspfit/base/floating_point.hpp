#pragma once

#include <cfloat>
#include <limits>

/// \file
/// What exact decisions need of the compiler: doubles of IEC 60559, rounded after every operation.
/// Programs that use graspfit are compiled like that, too: an option such as -ffast-math also
/// changes how the processor treats small numbers in all of a program that is linked with it.

// GCC says that parts of -ffast-math, -funsafe-math-optimizations for instance, are on by giving up
// the claim of IEC 60559; clang says nothing about them.
#if defined(__FAST_MATH__) || (defined(__GCC_IEC_559) && __GCC_IEC_559 == 0) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "graspfit: exact decisions need IEEE arithmetic; compile without -ffast-math (and -Ofast)"
#endif

namespace graspfit::base {

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<double>::digits == 53,
              "graspfit needs double to be binary64");
static_assert(FLT_EVAL_METHOD == 0,
              "graspfit needs doubles that are rounded after every operation");

}  // namespace graspfit::base
