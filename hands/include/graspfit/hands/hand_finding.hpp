#pragma once

#include <string>
#include <vector>

namespace graspfit::hands {

/// How much a finding about a hand description matters.
enum class FindingKind {
  Fault,       ///< The hand cannot be used until this is mended.
  Suspicious,  ///< The hand can be used, but is probably not what its author meant.
  Note,        ///< What the reader did: closed a mesh, derived a pad, left something out.
};

/// One thing about a hand description that is missing or suspicious, or that its reader did.
struct HandFinding {
  FindingKind kind = FindingKind::Note;
  std::string item;  ///< "link palm", "joint j3", "pad index"; empty for the hand as a whole.
  std::string what;  ///< One line: what it is, which value, what to do.
};

}  // namespace graspfit::hands
