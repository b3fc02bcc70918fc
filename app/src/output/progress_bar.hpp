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

  /// Shows what is being done, without a measure of progress.
  void show(const std::string& what);
  /// Shows `done` of `total`, then `text`; it is drawn at most ten times a second.
  void show(std::int64_t done, std::int64_t total, const std::string& text);
  void clear();

 private:
  bool is_shown_;
  bool has_line_ = false;
  std::chrono::steady_clock::time_point last_drawn_{};
};

/// While this object lives, it shows what is being done and, from the first second on, for how many
/// seconds: for work that does not report its progress. It shows nothing where a ProgressBar shows
/// nothing.
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
  std::thread thread_;  ///< The only thread that draws.
};

}  // namespace graspfit::app
