#pragma once

#include <CGAL/Gmpq.h>

namespace graspfit::geometry::internal {

/// The exact kernel's number: any double converts to it without loss. Used where a filter fails.
using Rational = CGAL::Gmpq;

inline int sign_of(const Rational& value) { return static_cast<int>(CGAL::sign(value)); }

}  // namespace graspfit::geometry::internal
