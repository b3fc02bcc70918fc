#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace graspfit::app {

/// From here on, an interrupt (Ctrl-C, a kill, a closed terminal) runs the cleanups that are in
/// force and ends the program with 128 + the signal's number. Call once, before any other thread
/// exists.
void watch_interrupts();

/// From here on, a file that grows beyond what the system allows it (`ulimit -f`) is an error of
/// the write that does it, reported and cleaned up like a full disk, and not a signal that ends the
/// program without a word. Programs that this one starts inherit it.
void report_file_size_limit();

/// A cleanup that is in force while this object lives. Those made later run first.
class CleanupOnInterrupt {
 public:
  explicit CleanupOnInterrupt(std::function<void()> cleanup);
  ~CleanupOnInterrupt();
  CleanupOnInterrupt(const CleanupOnInterrupt&) = delete;
  CleanupOnInterrupt& operator=(const CleanupOnInterrupt&) = delete;
};

/// While this object lives, the first interrupt does not end the program: it asks for a stop, and
/// says on standard error that a second one will not wait. One at a time.
class StopOnInterrupt {
 public:
  explicit StopOnInterrupt(std::string message);
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

  std::stop_token token() const;
};

/// The signal of the interrupt that has asked for a stop, if one has.
std::optional<int> interrupt_heard();

/// Runs `work`; interrupts wait until it is done.
void without_interrupts(const std::function<void()>& work);

/// What came of running another program.
struct ProgramEnd {
  int code = 0;        ///< Its exit code; 128 + signal if it was killed, 127 if it did not start.
  std::string errors;  ///< What it wrote to standard error.
};

/// Runs a program and waits for it. Its standard output is dropped. An interrupt ends it too.
ProgramEnd run_program(const std::vector<std::string>& arguments);

}  // namespace graspfit::app
