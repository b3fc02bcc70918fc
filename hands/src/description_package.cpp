#include "internal/description_package.hpp"

#include <system_error>

namespace graspfit::hands::internal {

namespace fs = std::filesystem;

fs::path package_folder(const fs::path& description_file) {
  const fs::path folder = fs::weakly_canonical(description_file).parent_path();
  std::error_code error;
  for (fs::path at = folder; at.has_relative_path(); at = at.parent_path()) {
    if (fs::exists(at / "package.xml", error)) return at;
  }
  return folder;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace graspfit::hands::internal
