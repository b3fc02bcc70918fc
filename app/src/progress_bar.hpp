#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace graspfit::app {

/// A line on standard error that shows how far the work is: on a terminal only, never when piped.
class ProgressBar {
 public:
  explicit ProgressBar(bool is_wanted);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// What is being done, without a measure of how far it is.
  void show(const std::string& what);
  /// `done` of `total`, then `text`; drawn at most ten times a second.
  void show(std::int64_t done, std::int64_t total, const std::string& text);
  void clear();

 private:
  bool is_shown_;
  bool has_line_ = false;
  std::chrono::steady_clock::time_point last_drawn_{};
};

}  // namespace graspfit::app
