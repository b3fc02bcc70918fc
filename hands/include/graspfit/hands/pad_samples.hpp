#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Where a pad is, and where it faces, over a grid of the independent joints that move it; in H.
///
/// Joints that also move pads of other fingers come last and vary slowest, and have the same
/// positions for all these pads: the samples that agree in them are a range. Coupled joints follow;
/// a breakaway joint goes no farther than its coupling.
struct PadSamples {
  int pad = 0;
  std::vector<int> joints;
  std::size_t num_shared = 0;  ///< How many of `joints`, the last ones, are shared.
  std::size_t range_size = 0;  ///< Samples that agree in the shared joints: every range of so many.
  Eigen::MatrixXd positions;   ///< A row per joint [rad or m], a column per sample.
  Eigen::Matrix3Xd points_H;   ///< Contact points (`pad_contact_point`) [m].
  Eigen::Matrix3Xd normals_H;  ///< Unit normals, toward the touched object.

  std::size_t size() const { return static_cast<std::size_t>(points_H.cols()); }
};

/// The samples of some pads, at most `max_samples` each (at least two per joint, however many that
/// is, and at most 64 per joint), in the order of `pads`. @throws InvalidInput as the model's
/// `validate`, and for `max_samples` < 1.
/// @param along_pads the contact points of long flat pads lie all along them, from their middles to
/// their ends (`pad_point_toward_end_C`), from sample to sample elsewhere
std::vector<PadSamples> pad_samples(const HandModel& model, const std::vector<int>& pads,
                                    int max_samples, bool along_pads = false);

}  // namespace graspfit::hands
