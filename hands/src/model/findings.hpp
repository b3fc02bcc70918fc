#pragma once

#include <string>
#include <utility>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/hands/hand_finding.hpp"

namespace graspfit::hands::internal {

/// Collects what the readers of descriptions notice, and decides what a fault does: it ends
/// `read_hand`, and is one more line for `check_hand`.
class Findings {
 public:
  enum class AtFault { Throw, Collect };

  explicit Findings(AtFault at_fault) : at_fault_(at_fault) {}

  void suspicious(std::string item, std::string what) {
    list_.push_back({FindingKind::Suspicious, std::move(item), std::move(what)});
  }
  void note(std::string item, std::string what) {
    list_.push_back({FindingKind::Note, std::move(item), std::move(what)});
  }

  /// Runs a step that can be left out. A base::Error of the step is passed on to the caller or,
  /// where faults are collected, becomes a fault about `item`. Returns whether the step succeeded.
  template <class Step>
  bool attempt(const Step& step, const std::string& item = "") {
    try {
      step();
      return true;
    } catch (const base::Error& error) {
      if (at_fault_ == AtFault::Throw) throw;
      list_.push_back({FindingKind::Fault, item, error.what()});
      has_faults_ = true;
      return false;
    }
  }

  bool has_faults() const { return has_faults_; }
  const std::vector<HandFinding>& list() const { return list_; }

 private:
  AtFault at_fault_;
  bool has_faults_ = false;
  std::vector<HandFinding> list_;
};

}  // namespace graspfit::hands::internal
