#pragma once

#include <string>
#include <vector>

#include "graspfit/geometry/convex_decomposition.hpp"
#include "graspfit/hold_test/hold_batch.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::hold_test {

/// How well convex pieces stand for a solid.
struct PiecesReport {
  std::string name;  ///< Of the link; of the object its file.
  std::size_t num_pieces = 0;
  double volume_error = 0.0;       ///< As of ConvexDecomposition.
  double outward_deviation = 0.0;  ///< [m]
  double inward_deviation = 0.0;   ///< [m]
  bool is_within_deviation = true;
};

/// A run of the hold test: everything that its file (`hold.json`) says, so that it can be repeated.
/// The schema is grasp/hold_test/hold.schema.json.
struct HoldReport {
  std::string grasp_file;    ///< As given.
  std::string grasp_sha256;  ///< Of that file's bytes.
  std::string object_sha256;
  std::string hand_name;
  HoldProtocol protocol;
  std::vector<std::string>
      changed_parameters;  ///< Those that differ from the protocol of that name.
  geometry::ConvexDecompositionOptions decomposition;
  PiecesReport object;
  std::vector<PiecesReport> links;  ///< Those that have a surface.
  std::size_t num_grasps = 0;       ///< In the grasp file, tested or not.
  std::vector<TestedGrasp> tested;
};

/// The numbers of a decomposition, without its pieces.
PiecesReport pieces_report(const std::string& name, const geometry::ConvexDecomposition& shape);

/// The parameters in which a protocol differs from the shipped one of its name.
/// @throws InvalidInput if there is none of that name.
std::vector<std::string> changed_parameters(const HoldProtocol& protocol);

/// What the loads of a protocol are called, in the order of HoldVerdict::directions.
std::vector<std::string> load_names(const HoldProtocol& protocol);

/// The file's text: keys in fixed order, numbers in shortest round-trip form in the C locale. No
/// times in it: the same run, the same bytes.
std::string to_json(const HoldReport& report);

/// A row per tested grasp (`hold.csv`), units in the column names; cells of what was not reached or
/// not asked for are empty.
std::string to_csv(const HoldReport& report);

}  // namespace graspfit::hold_test
