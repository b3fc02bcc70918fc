#include "internal/derivation.hpp"

#include "graspfit/geometry/errors.hpp"

namespace graspfit::hands::internal {

Sidecar completed(const HandModel& tree, const Sidecar& given, Findings&) {
  if (!given.is_complete()) {
    throw geometry::InvalidInput(tree.description_file + ": no complete sidecar beside it");
  }
  return given;
}

}  // namespace graspfit::hands::internal
