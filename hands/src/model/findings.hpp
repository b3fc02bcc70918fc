#pragma once

#include <string>
#include <utility>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/hands/hand_finding.hpp"

namespace graspfit::hands::internal {

/// Where the readers of descriptions put what they notice, and what a fault means to them: the end
/// for `read_hand`, one more line for `check_hand`.
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

  /// Runs a step that can be left out. Its base::Error goes on to the caller, or, when faults
  /// are collected, becomes one about `item`. Returns whether the step went through.
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
