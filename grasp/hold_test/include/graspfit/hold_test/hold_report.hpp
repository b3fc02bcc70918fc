#pragma once

#include <string>
#include <vector>

#include "graspfit/geometry/convex_decomposition.hpp"
#include "graspfit/hold_test/hold_batch.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::hold_test {

/// How well convex pieces approximate a solid.
struct PiecesReport {
  std::string name;  ///< Name of the link, or the object's file.
  std::size_t num_pieces = 0;
  double volume_error = 0.0;       ///< Relative error of the volume, as in ConvexDecomposition.
  double outward_deviation = 0.0;  ///< [m]
  double inward_deviation = 0.0;   ///< [m]
  bool is_within_deviation = true;
};

/// A run of the hold test: everything that its file (`hold.json`) says, so that it can be repeated.
/// The schema is grasp/hold_test/hold.schema.json.
struct HoldReport {
  std::string grasp_file;    ///< Grasp file as given.
  std::string grasp_sha256;  ///< SHA-256 of the grasp file.
  std::string object_sha256;
  std::string hand_name;
  HoldProtocol protocol;
  std::vector<std::string> changed_parameters;  ///< Parameters that differ from those of the
                                                ///< shipped protocol of that name.
  geometry::ConvexDecompositionOptions decomposition;
  PiecesReport object;
  std::vector<PiecesReport> links;  ///< Links that have a surface.
  std::size_t num_grasps = 0;       ///< Number of grasps in the grasp file, tested or not.
  std::vector<TestedGrasp> tested;
};

/// The numbers of a decomposition, without its pieces.
PiecesReport pieces_report(const std::string& name, const geometry::ConvexDecomposition& shape);

/// The parameters in which a protocol differs from the shipped one of its name.
/// @throws InvalidInput if there is none of that name.
std::vector<std::string> changed_parameters(const HoldProtocol& protocol);

/// What the loads of a protocol are called, in the order of HoldVerdict::directions.
std::vector<std::string> load_names(const HoldProtocol& protocol);

/// Returns the text of `hold.json`, with keys in fixed order and numbers in shortest round-trip
/// form in the C locale. It holds no times, so that the same run on one build and processor gives
/// the same bytes.
std::string to_json(const HoldReport& report);

/// Returns the text of `hold.csv`, one row per tested grasp, with units in the column names. Cells
/// of what was not reached or not asked for are empty.
std::string to_csv(const HoldReport& report);

}  // namespace graspfit::hold_test
