#pragma once

#include "graspfit/viewer/replay_page.hpp"

namespace graspfit::testing {

/// Returns the ball and the hand of sample_scene.hpp in a hold test that is made up by formulas.
/// After 0.2 s of closing and 0.2 s of squeezing, the load +x shifts the ball by 1 mm and it holds;
/// under +y it slides off as y = 5 m/s² · t²/2 and turns about x by 1 rad/s. Limits are 50 mm and
/// 15°, checked every 0.1 s: it fails at 0.2 s, where it has shifted by 100 mm. There is a frame
/// every 0.02 s. The ball's pieces are the octants of a cube around it, those of links their own
/// boxes.
viewer::ReplayInput sample_replay();

}  // namespace graspfit::testing
