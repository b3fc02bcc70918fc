#include "graspfit/base/lies_in.hpp"

#include <algorithm>

namespace graspfit::base {

namespace fs = std::filesystem;

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

bool lies_in(const fs::path& path, const std::vector<fs::path>& folders) {
  return std::any_of(folders.begin(), folders.end(),
                     [&](const fs::path& folder) { return lies_in(path, folder); });
}

}  // namespace graspfit::base
