#pragma once

#include <functional>
#include <string>
#include <vector>

namespace graspfit::app {

/// From here on, an interrupt (Ctrl-C, a kill, a closed terminal) runs the cleanups that are in
/// force and ends the program with 128 + the signal's number. Call once, before any other thread
/// exists.
void watch_interrupts();

/// A cleanup that is in force while this object lives. One at a time.
class CleanupOnInterrupt {
 public:
  explicit CleanupOnInterrupt(std::function<void()> cleanup);
  ~CleanupOnInterrupt();
  CleanupOnInterrupt(const CleanupOnInterrupt&) = delete;
  CleanupOnInterrupt& operator=(const CleanupOnInterrupt&) = delete;
};

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
