#include "dataset/dataset_card.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "graspfit/experiments/grasp_dataset.hpp"
#include "graspfit/grasp/grasp_io.hpp"

namespace graspfit::experiments::internal {
namespace {

constexpr std::size_t kMostReasons = 20;

const char* const kConventions = R"(## Conventions

Lengths are in meters, angles in radians, forces in newtons. `O` is the object's frame: that of its
mesh file, scaled by `object_scale`. A configuration (`*_qpos`) is the position of the hand's root
link in O, the quaternion of its orientation in the order w, x, y, z, and the joints in the order of
`joint_names`. Contact normals point into the object. A pre-grasp is clear of the object; the way
from there to the grasp is free; the squeeze is what joints are commanded to so that contact forces
balance.
)";

const char* const kLoading = R"(## Load it

Python, with NumPy alone:

```python
import numpy as np
a = np.load("%s")
g = int(np.argmax(a["held"] == 1))  # the first grasp that held
position, wxyz, joints = np.split(a["grasp_qpos"][g], [3, 7])
points = a["contact_point"][a["contact_start"][g]:a["contact_start"][g + 1]]
```

C++, with all that is known of each grasp (hand and meshes must be where they were):

```cpp
#include "graspfit/grasp/grasp_io.hpp"
const graspfit::grasp::GraspFile file = graspfit::grasp::read_grasps("cells/OBJECT,HAND/grasps.json");
for (const graspfit::grasp::Grasp& grasp : file.grasps) use(grasp.configuration, grasp.contacts);
```
)";

const char* const kLimits = R"(## Limits

- Grasps were planned from geometry, for rigid hands and objects, in free space unless the settings
  say otherwise; no arm was considered.
- A hold test is a simulation with the parameters of its protocol (`graspfit hold --help`), not an
  experiment. Grasps that were lost are kept, and say so (`held` is 0).
- Grasps of an object are distinct, but no sample of all that there are.
- Meshes are not part of the data set: `object_path` and `object_sha256` say which they were.
)";

std::string share_text(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return "-";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%lld (%.1f %%)", static_cast<long long>(part),
                100.0 * static_cast<double>(part) / static_cast<double>(whole));
  return text.data();
}

std::string table_of(const DatasetCounts& counts, bool is_tested) {
  std::string text = "| hand | objects | with grasps | attempts | grasps |";
  text += is_tested ? " held |\n| --- | --- | --- | --- | --- | --- |\n"
                    : "\n| --- | --- | --- | --- | --- |\n";
  for (const HandCounts& hand : counts.hands) {
    text += "| " + hand.name + " | " + std::to_string(hand.cells) + " | " +
            share_text(hand.with_grasps, hand.cells) + " | " + std::to_string(hand.attempts) +
            " | " + std::to_string(hand.grasps) + " |";
    text += is_tested ? ' ' + share_text(hand.held, hand.grasps) + " |\n" : "\n";
  }
  return text;
}

std::string files_text(const DatasetCounts& counts) {
  std::string text =
      "## Files\n\n"
      "- `dataset.csv`: the index, a row per object and hand: the mesh's file, hash, license and "
      "scale, how many grasps, how many held; `status` and `reason` where there are none.\n"
      "- `dataset.details.csv`: a row per grasp: measures, how far it came in the hold test, "
      "margins.\n"
      "- `dataset.columns.json`: every column with unit and meaning.\n"
      "- `cells/OBJECT,HAND/grasps.json`: the grasp file, for `graspfit evaluate`, `hold` and "
      "`convert`.\n"
      "- `dataset.config.json`, `dataset.manifest.json`: how it was made: settings, versions, "
      "hashes of all inputs.\n";
  for (const std::string& file : counts.arrays) text += "- `" + file + "`\n";
  return text +
         "\nThe arrays hold the same grasps for NumPy, a file for each hand and thousand objects; "
         "what is in them, `graspfit/exchange/grasp_arrays.hpp` says.\n";
}

std::string counts_text(const std::map<std::string, std::int64_t>& counts, const char* unnamed) {
  std::vector<std::pair<std::int64_t, std::string>> sorted;
  for (const auto& [text, count] : counts) sorted.emplace_back(-count, text);
  std::sort(sorted.begin(), sorted.end());
  std::string lines;
  for (std::size_t i = 0; i < std::min(sorted.size(), kMostReasons); ++i) {
    const auto& [count, text] = sorted[i];
    lines += "- " + std::to_string(-count) + ": " + (text.empty() ? unnamed : text) + '\n';
  }
  if (sorted.size() > kMostReasons) {
    lines += "- and " + std::to_string(sorted.size() - kMostReasons) + " more: see the index\n";
  }
  return lines;
}

std::string settings_text(const sweep::ExperimentConfig& config) {
  std::string text = "## How it was made\n\ngraspfit " + std::string(grasp::library_version()) +
                     ", seed " + std::to_string(config.sweep.base_seed) +
                     ", configuration with SHA-256 `" + config.sha256 + "`. Settings:\n\n";
  const auto settings = nlohmann::json::parse(config.sweep.settings);
  for (const auto& [name, value] : settings.items()) {
    text +=
        "- `" + name + "`: " + (value.is_string() ? value.get<std::string>() : value.dump()) + '\n';
  }
  return text +
         "\n`graspfit dataset run FOLDER` with that configuration in FOLDER makes it "
         "again: the same bytes by the same build on the same kind of processor, whatever "
         "the shards and interruptions.\n";
}

}  // namespace

std::string dataset_card(const sweep::ExperimentConfig& config, const DatasetCounts& counts) {
  const std::string protocol =
      nlohmann::json::parse(config.sweep.settings).value("protocol", kNoProtocol);
  const bool is_tested = protocol != kNoProtocol;
  std::int64_t grasps = 0;
  for (const HandCounts& hand : counts.hands) grasps += hand.grasps;
  std::string card = "# " + std::to_string(grasps) + " grasps of " +
                     std::to_string(counts.objects) + " objects\n\n" + table_of(counts, is_tested) +
                     '\n';
  if (is_tested) {
    card += "Held: under the protocol `" + protocol + "`, of the grasps in the data set.\n\n";
  }
  card += files_text(counts) + '\n' + settings_text(config) + '\n' + kConventions + '\n';
  if (!counts.arrays.empty()) {
    std::string loading = kLoading;
    card += loading.replace(loading.find("%s"), 2, counts.arrays.front()) + '\n';
  }
  if (!counts.reasons.empty()) {
    card += "## Without results\n\nRows of the index, by reason:\n\n" +
            counts_text(counts.reasons, "no reason") + '\n';
  }
  card +=
      "## Licenses\n\nRows of the index by the license of their mesh, as its source states "
      "it:\n\n" +
      counts_text(counts.licenses, "none stated") + '\n' + kLimits;
  return card;
}

}  // namespace graspfit::experiments::internal
