// The program writes the pages that the browser test opens: write_sample_pages FOLDER.

#include <filesystem>
#include <iostream>

#include "graspfit/base/errors.hpp"
#include "graspfit/viewer/hand_page.hpp"
#include "graspfit/viewer/motion_page.hpp"
#include "graspfit/viewer/page.hpp"
#include "graspfit/viewer/replay_page.hpp"
#include "sample_motion.hpp"
#include "sample_replay.hpp"
#include "sample_scene.hpp"

int main(int argc, char** argv) {
  using namespace graspfit;
  if (argc != 2) {
    std::cerr << "Usage: write_sample_pages FOLDER\n";
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    const testing::SampleScene scene = testing::sample_scene();
    grasp::ObjectModelOptions options;
    options.resolution = 16;
    const grasp::ObjectModel model = grasp::build_object_model(scene.object_O, options);

    viewer::PageInput input;
    input.title = "Ball <40 mm> & three fingers";
    input.object_O = scene.object_O;
    input.hand = scene.hand;
    input.grasps = scene.grasps;
    input.model = &model;
    input.clip_thickness = 0.003;
    input.surroundings = &scene.surroundings;
    viewer::write_page(folder / "ball.html", input);

    input.title = "Without voxels";
    input.model = nullptr;
    input.surroundings = nullptr;
    viewer::write_page(folder / "without_model.html", input);

    input.title = "No grasps";
    input.grasps.clear();
    viewer::write_page(folder / "no_grasps.html", input);

    viewer::write_hand_page(folder / "hand.html", testing::sample_hand_scene());
    viewer::write_replay_page(folder / "replay.html", testing::sample_replay());
    viewer::write_motion_page(folder / "motion.html", testing::sample_motion());
  } catch (const base::Error& error) {
    std::cerr << "write_sample_pages: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
