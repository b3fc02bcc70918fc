#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_check.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "hands/sidecar_text.hpp"
#include "support/catch.hpp"
#include "support/small_hand.hpp"
#include "support/temporary_folder.hpp"

/// \file
/// Checks that what is wrong with a hand's files is said in one line that names the file, the item
/// and the value.

namespace graspfit::testing {

using base::Error;
using base::InvalidInput;
using base::IoError;
namespace fs = std::filesystem;

/// The small hand's files, of which one may be broken.
struct HandFiles {
  std::string urdf = kSmallHandUrdf;
  std::string sidecar = kSmallHandSidecar;
  std::string mesh = kSmallHandMesh;
};

/// Writes the files into a package of their own, so that meshes have an outside that is still in
/// the test's folder.
inline fs::path write(const TemporaryFolder& folder, const HandFiles& files) {
  folder.write("package/meshes/bar.obj", files.mesh);
  folder.write("package/pincer.graspfit.json", files.sidecar);
  return folder.write("package/pincer.urdf", files.urdf);
}

inline bool is_one_line(const std::string& message) {
  return !message.empty() &&
         std::none_of(message.begin(), message.end(), [](char c) { return c >= 0 && c < ' '; });
}

enum class Refusal { Io, Invalid };

/// Checks that `read_hand` refuses the file with one line that has all of `named` in it, and that
/// `check_hand` reports the same as a fault instead of throwing.
inline void check_refused(const fs::path& file, Refusal expected,
                          const std::vector<std::string>& named) {
  std::string message;
  try {
    hands::read_hand(file);
    FAIL_CHECK("accepted");
    return;
  } catch (const IoError& error) {
    message = error.what();
    CAPTURE(message);
    CHECK(expected == Refusal::Io);
  } catch (const InvalidInput& error) {
    message = error.what();
    CAPTURE(message);
    CHECK(expected == Refusal::Invalid);
  }
  CAPTURE(message);
  CHECK(is_one_line(message));
  for (const std::string& part : named) {
    CAPTURE(part);
    CHECK(message.find(part) != std::string::npos);
  }
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    CHECK_THROWS_AS(hands::check_hand(file), IoError);
    return;
  }
  hands::HandCheck report;
  REQUIRE_NOTHROW(report = hands::check_hand(file));
  CHECK_FALSE(report.model.has_value());
  CHECK(report.count(hands::FindingKind::Fault) > 0);
  for (const hands::HandFinding& finding : report.findings) CHECK(is_one_line(finding.what));
}

/// One edit of a good file, and what the message has to name besides the file.
struct Row {
  std::string old, fresh;
  std::vector<std::string> named;
  Refusal expected = Refusal::Invalid;
};

inline void check_rows(std::string HandFiles::*file, const std::string& file_name,
                       const std::vector<Row>& rows) {
  const TemporaryFolder folder;
  for (const Row& row : rows) {
    CAPTURE(row.old, row.fresh);
    HandFiles files;
    files.*file = with(files.*file, row.old, row.fresh);
    std::vector<std::string> named = row.named;
    named.push_back(file_name);
    check_refused(write(folder, files), row.expected, named);
  }
}

inline void check_urdf_rows(const std::vector<Row>& rows) {
  check_rows(&HandFiles::urdf, "pincer.urdf", rows);
}

inline void check_sidecar_rows(const std::vector<Row>& rows) {
  check_rows(&HandFiles::sidecar, "pincer.graspfit.json", rows);
}

}  // namespace graspfit::testing
