#pragma once

#include <stdexcept>

namespace graspfit::app {

/// What the program's exit code means; stated in every --help.
enum ExitCode : int {
  kSuccess = 0,
  kInternalError = 1,  ///< Our mistake.
  kBadInput = 2,       ///< A file or a flag that cannot be used; one line says why.
  kNoGrasp = 3,        ///< `plan` found no grasp; the line says how the attempts ended.
  kDiffers = 4,  ///< `evaluate` computed other measures than the file has; `experiment verify`
                 ///< found other results than the published ones.
};

/// A command line that cannot be understood.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace graspfit::app
