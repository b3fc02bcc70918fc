#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

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

/// Shows what is being done, and from its first second on for how many, while it lives: for work
/// that does not say how far it is. Where a ProgressBar shows nothing, nor does this.
class SecondsBar {
 public:
  SecondsBar(bool is_wanted, std::string what);
  ~SecondsBar();
  SecondsBar(const SecondsBar&) = delete;
  SecondsBar& operator=(const SecondsBar&) = delete;

 private:
  void show_until_done();

  ProgressBar bar_;
  std::string what_;
  std::mutex mutex_;
  std::condition_variable done_;
  bool is_done_ = false;
  std::thread thread_;  ///< The only one that draws.
};

}  // namespace graspfit::app
