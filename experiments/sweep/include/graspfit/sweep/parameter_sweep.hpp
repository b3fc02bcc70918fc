#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace graspfit::sweep {

/// One value of an axis.
struct AxisValue {
  std::string label;     ///< What rows and `--set` call it: letters, digits and _ . + - only.
  std::string settings;  ///< Settings of the value, a JSON object as text.
};

/// A named direction of a sweep.
struct Axis {
  std::string name;
  std::vector<AxisValue> values;  ///< At least one; labels differ.
};

/// One unit of work of an experiment.
struct Cell {
  std::vector<std::string> labels;  ///< One per axis, in their order.
  std::string key;                  ///< "object=bunny hand=barrett seed=3".
  std::uint64_t seed = 0;           ///< Seed of this cell's random numbers: `cell_seed`.
  std::string settings;  ///< Common settings and those of its axis values: a JSON object as text.
};

/// Seed of a cell: the first 53 bits (so that any tool keeps it exactly) of the SHA-256 of
/// experiment, base seed and the cell's axes with their labels, sorted by axis. It does not depend
/// on the cell's index, so other cells may be added and removed.
std::uint64_t cell_seed(const std::string& experiment, std::uint64_t base_seed,
                        const std::vector<Axis>& axes, const std::vector<std::string>& labels);

/// All combinations of the values of some axes, the last axis fastest.
struct ParameterSweep {
  std::string experiment;
  std::uint64_t base_seed = 1;
  std::vector<Axis> axes;       ///< At least one.
  std::string settings = "{}";  ///< Settings of all cells, a JSON object as text; those of axis
                                ///< values override them.

  std::size_t num_cells() const;
  /// Cell number `index` in row order. Precondition: index < num_cells().
  Cell cell(std::size_t index) const;
};

}  // namespace graspfit::sweep
