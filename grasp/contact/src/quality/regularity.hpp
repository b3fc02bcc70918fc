#pragma once

#include "graspfit/contact/contact_quality.hpp"
#include "quality/contact_hull.hpp"

namespace graspfit::contact::internal {

/// R of a hull; see the public `regularity`.
double regularity(const ContactHull& contact_hull, Regularity definition);

}  // namespace graspfit::contact::internal
