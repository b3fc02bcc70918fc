#pragma once

#include <vector>

#include "graspfit/grasp/contact.hpp"

namespace graspfit::grasp::internal {

/// Marks the contacts of the pad `pad` as targets; whether there are any.
inline bool mark_targets(std::vector<Contact>& contacts, int pad) {
  bool is_any = false;
  for (Contact& contact : contacts) {
    if (contact.pad == pad) is_any = contact.is_target = true;
  }
  return is_any;
}

}  // namespace graspfit::grasp::internal
