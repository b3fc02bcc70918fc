#include "graspfit/sweep/parameter_sweep.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <nlohmann/json.hpp>

#include "graspfit/base/sha256.hpp"

namespace graspfit::sweep {

std::uint64_t cell_seed(const std::string& experiment, std::uint64_t base_seed,
                        const std::vector<Axis>& axes, const std::vector<std::string>& labels) {
  assert(axes.size() == labels.size());
  std::map<std::string, std::string> by_axis;
  for (std::size_t i = 0; i < axes.size(); ++i) by_axis[axes[i].name] = labels[i];
  // As JSON text, no two different cells have the same identity.
  const nlohmann::json identity = {experiment, base_seed, by_axis};
  constexpr int kDigits = 14;      // of 4 bits each,
  constexpr int kSurplusBits = 3;  // less these: 53
  const std::string digest = base::sha256_hex(identity.dump()).substr(0, kDigits);
  return std::stoull(digest, nullptr, 16) >> kSurplusBits;
}

std::size_t ParameterSweep::num_cells() const {
  std::size_t count = 1;
  for (const Axis& axis : axes) count *= axis.values.size();
  return count;
}

Cell ParameterSweep::cell(std::size_t index) const {
  assert(index < num_cells());
  std::vector<const AxisValue*> values(axes.size());
  for (std::size_t i = axes.size(); i-- > 0;) {
    values[i] = &axes[i].values[index % axes[i].values.size()];
    index /= axes[i].values.size();
  }
  Cell cell;
  nlohmann::json merged = nlohmann::json::parse(settings);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    cell.labels.push_back(values[i]->label);
    cell.key += (i > 0 ? " " : "") + axes[i].name + '=' + values[i]->label;
    merged.update(nlohmann::json::parse(values[i]->settings));
  }
  cell.seed = cell_seed(experiment, base_seed, axes, cell.labels);
  cell.settings = merged.dump();
  return cell;
}

}  // namespace graspfit::sweep
