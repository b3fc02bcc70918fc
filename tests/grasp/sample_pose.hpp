#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "graspfit/base/random.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "graspfit/hands/pad_samples.hpp"

namespace graspfit::testing {

/// The hand with the joints of a sample, the others open, turned anyhow at the origin.
inline hands::HandConfiguration turned_sample(const hands::HandModel& hand,
                                              const hands::PadSamples& samples, std::int32_t sample,
                                              base::Random& random) {
  hands::HandConfiguration configuration = hands::open_configuration(hand);
  for (std::size_t j = 0; j < samples.joints.size(); ++j) {
    configuration.q[samples.joints[j]] = samples.positions(static_cast<Eigen::Index>(j), sample);
  }
  hands::apply_couplings(hand, configuration.q);
  configuration.X_OH.linear() =
      Eigen::Quaterniond(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                         random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0))
          .normalized()
          .toRotationMatrix();
  return configuration;
}

}  // namespace graspfit::testing
