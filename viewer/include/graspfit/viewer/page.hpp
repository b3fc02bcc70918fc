#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::viewer {

/// What a page shows. All positions are in the object frame O, in meters.
struct PageInput {
  std::string title;                ///< Heading and window title, plain text in UTF-8.
  std::string note;                 ///< A line below the heading, plain text; empty: none.
  geometry::TriangleMesh object_O;  ///< With at least one face.
  hands::HandModel hand;  ///< Link meshes are stored once; poses are stored per grasp, also for its
                          ///< pre-grasp and squeeze where it has them.
  std::vector<grasp::Grasp> grasps;  ///< Numbered from 1 in this order, listed by M; may be none.
  /// Voxels, patches and scores; without it the page has no voxel and score map layers.
  const grasp::ObjectModel* model = nullptr;
  /// Of clip volumes whose pad states none [m], > 0; empty: those are not drawn.
  std::optional<double> clip_thickness = {};
  /// Table and obstacles, drawn where there are any; null: none.
  const grasp::Surroundings* surroundings = nullptr;
  /// Center of mass to draw; empty: the model's, or none without a model.
  std::optional<Eigen::Vector3d> center_of_mass_O;
};

/// The page: one self-contained HTML document for any browser with WebGL 2, from disk (`file://`)
/// and without a network. The same input gives the same bytes.
///
/// The page takes about 48 bytes per vertex of the object and of the hand's links, and 60 KB
/// besides: 2.2 MB for 35 000 vertices and the Barrett hand. Nothing is decimated; coordinates are
/// rounded to float (relative 6e-8).
/// @throws InvalidInput if the object has no faces or an index of it is out of range, if a grasp
/// does not fit the hand (number of joints, indices of contacts), or for a thickness that is not
/// finite and above 0.
std::string page_html(const PageInput& input);

/// Writes `page_html` atomically. @throws IoError if that fails; InvalidInput as `page_html`.
void write_page(const std::filesystem::path& file, const PageInput& input);

}  // namespace graspfit::viewer
