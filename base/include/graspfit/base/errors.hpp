#pragma once

#include <stdexcept>
#include <string>

/// \file
/// The exceptions of the toolkit. All are thrown at public boundaries, before work starts, with a
/// one-line message that says what, where, which value and, where it helps, what to do.

namespace graspfit::base {

/// Base of everything the toolkit throws on purpose.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The caller's mistake: an option out of range, a mesh that the operation refuses.
class InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A file that cannot be read, parsed or written.
class IoError : public Error {
 public:
  using Error::Error;
};

/// Input that is formally valid but spans no volume, plane or direction where one is needed.
class DegenerateGeometry : public Error {
 public:
  using Error::Error;
};

}  // namespace graspfit::base
