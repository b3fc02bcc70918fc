#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"
#include "graspfit/hold_test/hold_test.hpp"

namespace graspfit::viewer {

/// A hold test of one grasp as it ran, to show. Positions are in the object frame O, in meters.
struct ReplayInput {
  std::string title;                ///< Heading and window title, plain text in UTF-8.
  std::string note;                 ///< A line below the heading, plain text; empty: none.
  geometry::TriangleMesh object_O;  ///< With at least one face.
  hold_test::HoldObject object;     ///< As the physics engine has it.
  hold_test::HoldHand hand;
  hold_test::HoldProtocol protocol;
  hold_test::HoldVerdict verdict;  ///< With at least one direction.
  /// HoldTest::replay of each direction of the verdict, at least one frame each.
  std::vector<std::vector<hold_test::HoldFrame>> replays;
};

/// Index of the most informative direction: the one that failed first (before any load, or at the
/// earliest check), else the one that came nearest to a limit. Of equal ones it is the first.
std::size_t telling_direction(const hold_test::HoldVerdict& verdict,
                              const hold_test::HoldProtocol& protocol);

/// The data of a replay for the page and the picture script (viewer/render_hold.py), as JSON:
/// meshes and convex pieces, and per direction the poses of object and links in every frame, the
/// object's shift and turn in the palm's frame since the squeezed pose (before this pose: since the
/// planned one), the table's height where the object is lifted, and the verdict. Frames end once
/// the object is two of its diagonals away. The same input gives the same bytes.
/// @throws InvalidInput if the object has no faces, the verdict no direction, a replay no frame, or
/// a frame does not fit the hand.
std::string replay_scene_json(const ReplayInput& input);

/// The page: one self-contained HTML document for any browser with WebGL 2, from disk and without a
/// network. It has play and pause, a slider over time, a choice of the load, the commanded load as
/// an arrow, shift and turn over time with their limits, and the verdict. It takes about 0.1 MB per
/// load beside the meshes. The same input gives the same bytes. @throws as `replay_scene_json`.
std::string replay_page_html(const ReplayInput& input);

/// Writes `replay_page_html` atomically. @throws IoError if that fails; InvalidInput as
/// `replay_scene_json`.
void write_replay_page(const std::filesystem::path& file, const ReplayInput& input);

}  // namespace graspfit::viewer
