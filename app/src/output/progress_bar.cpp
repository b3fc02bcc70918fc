#include "output/progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace graspfit::app {

ProgressBar::ProgressBar(bool is_wanted) {
  const char* const terminal = std::getenv("TERM");
  is_shown_ = is_wanted && isatty(STDERR_FILENO) != 0 && terminal != nullptr &&
              std::string_view(terminal) != "dumb";
}

void ProgressBar::show(const std::string& what) {
  if (!is_shown_) return;
  std::fprintf(stderr, "\r\033[K%s", what.c_str());
  std::fflush(stderr);
  has_line_ = true;
}

void ProgressBar::show(std::int64_t done, std::int64_t total, const std::string& text) {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_drawn_ < std::chrono::milliseconds(100) && done < total) return;
  last_drawn_ = now;
  constexpr std::int64_t kWidth = 30;
  const std::int64_t filled = total > 0 ? std::min(kWidth, kWidth * done / total) : 0;
  show('[' + std::string(static_cast<std::size_t>(filled), '#') +
       std::string(static_cast<std::size_t>(kWidth - filled), '.') + "] " + text);
}

void ProgressBar::clear() {
  if (!has_line_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  has_line_ = false;
}

SecondsBar::SecondsBar(bool is_wanted, std::string what)
    : bar_(is_wanted), what_(std::move(what)), thread_([this] { show_until_done(); }) {}

SecondsBar::~SecondsBar() {
  {
    const std::lock_guard lock(mutex_);
    is_done_ = true;
  }
  done_.notify_one();
  thread_.join();
}

void SecondsBar::show_until_done() {
  std::unique_lock lock(mutex_);
  for (int seconds = 1;; ++seconds) {
    if (done_.wait_for(lock, std::chrono::seconds(1), [this] { return is_done_; })) return;
    bar_.show(what_ + ", " + std::to_string(seconds) + " s");
  }
}

}  // namespace graspfit::app
