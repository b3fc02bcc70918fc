#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace graspfit::app {

/// From this call on, an interrupt (Ctrl-C, a kill, a closed terminal) runs the cleanups that are
/// in force and ends the program with 128 + the signal's number. Call once, before any other thread
/// exists.
void watch_interrupts();

/// From this call on, a write that makes a file larger than the system allows (`ulimit -f`) fails
/// with an error, which is reported and cleaned up after like a full disk. Without it, a signal
/// ends the program without a message. Programs that this one starts inherit this behavior.
void report_file_size_limit();

/// A cleanup that is in force while this object lives. Cleanups made later run first.
class CleanupOnInterrupt {
 public:
  explicit CleanupOnInterrupt(std::function<void()> cleanup);
  ~CleanupOnInterrupt();
  CleanupOnInterrupt(const CleanupOnInterrupt&) = delete;
  CleanupOnInterrupt& operator=(const CleanupOnInterrupt&) = delete;
};

/// While this object lives, the first interrupt does not end the program: it requests a stop, and
/// prints the message, by which users learn that a second interrupt will not wait. Only one such
/// object may exist at a time.
class StopOnInterrupt {
 public:
  explicit StopOnInterrupt(std::string message);
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

  std::stop_token token() const;
};

/// The signal of the interrupt that has requested a stop, if one has.
std::optional<int> interrupt_heard();

/// Runs `work`; interrupts wait until it is done.
void without_interrupts(const std::function<void()>& work);

/// Result of running another program.
struct ProgramEnd {
  int code = 0;        ///< Exit code; 128 + signal if it was killed, 127 if it did not start.
  std::string errors;  ///< What the program wrote to standard error.
};

/// Runs a program and waits for it. Its standard output is dropped. An interrupt ends it too.
ProgramEnd run_program(const std::vector<std::string>& arguments);

}  // namespace graspfit::app
