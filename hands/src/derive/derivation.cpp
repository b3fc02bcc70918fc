#include "derive/derivation.hpp"

#include "derive/deriver.hpp"

namespace graspfit::hands::internal {

Sidecar completed(const HandModel& tree, const Sidecar& given, Findings& findings) {
  if (given.is_complete()) return given;
  return Deriver(tree, given, findings).derive();
}

}  // namespace graspfit::hands::internal
