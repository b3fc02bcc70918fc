#pragma once

#include <stdexcept>

namespace graspfit::app {

/// What the program's exit code means; stated in every --help.
enum ExitCode : int {
  kSuccess = 0,
  kInternalError = 1,  ///< An error in the program.
  kBadInput = 2,       ///< A file or a flag that cannot be used; one line says why.
  kNoGrasp = 3,        ///< `plan` found no grasp; the line says how the attempts ended.
  kDiffers = 4,  ///< `evaluate` or `experiment verify` found other results than those on file;
                 ///< `motion` found a segment that is not free of collisions.
  kInterrupted = 128,  ///< Plus the signal's number: 130 for Ctrl-C, whether the work was ended or,
                       ///< by `plan`, finished with the grasps found.
};

/// A command line that cannot be understood.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace graspfit::app
