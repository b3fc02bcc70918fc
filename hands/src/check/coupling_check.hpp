#pragma once

#include "model/findings.hpp"
#include "model/joint_tree.hpp"

namespace graspfit::hands::internal {

/// Says which joints that are independent look as if they should follow others: descriptions
/// converted from other formats lose couplings.
void report_lost_couplings(const JointTree& joints, Findings& findings);

}  // namespace graspfit::hands::internal
