#pragma once

#include <memory>
#include <string>

#include "grasp/fitting_scene.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/planner_options.hpp"

/// \file
/// A planning method at work, without the planner around it.

namespace graspfit::testing {

struct Guided {
  Guided(const geometry::TriangleMesh& mesh, grasp::PlannerOptions planner_options,
         const std::string& hand_name = "barrett")
      : options(std::move(planner_options)),
        scene(mesh, hand_name, options),
        guidance(grasp::planning_methods()
                     .at(options.planner)
                     .make({scene.grasp_scene(), scene.parts, options})) {}

  grasp::PlannerOptions options;
  Scene scene;
  std::unique_ptr<grasp::GraspGuidance> guidance;
};

/// Returns options at the paper's level: voxels guard, nothing is refined.
inline grasp::PlannerOptions at_voxel_level(const std::string& planner) {
  grasp::PlannerOptions options;
  options.planner = planner;
  options.refine = false;
  options.fitting.guard = grasp::PenetrationGuard::Voxels;
  options.fitting.contact_state = grasp::ContactState::FirstGraze;
  options.acceptance = grasp::Acceptance::Usable;
  options.missing_contact = grasp::MissingContact::Measured;
  options.weak.reset();
  return options;
}

/// Returns Σ (observed − expected)² / expected.
template <class Observed, class Expected>
double chi_square(const Observed& observed, const Expected& expected) {
  double sum = 0.0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    const double off = static_cast<double>(observed[i]) - expected[i];
    sum += off * off / expected[i];
  }
  return sum;
}

}  // namespace graspfit::testing
