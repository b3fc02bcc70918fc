#include "description/description_package.hpp"

#include <algorithm>
#include <optional>
#include <system_error>

namespace graspfit::hands::internal {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPackageFile = "package.xml";

fs::path own_folder(const fs::path& description_file) {
  return fs::weakly_canonical(description_file).parent_path();
}

/// The nearest folder above the file that has a package.xml.
std::optional<fs::path> declared_package(const fs::path& description_file) {
  std::error_code error;
  for (fs::path at = own_folder(description_file); at.has_relative_path(); at = at.parent_path()) {
    if (fs::exists(at / kPackageFile, error)) return at;
  }
  return std::nullopt;
}

/// The deepest folder that contains both `file` and `folder`.
fs::path common_folder(const fs::path& file, const fs::path& folder) {
  const auto [ours, theirs] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  fs::path common;
  for (auto part = folder.begin(); part != ours; ++part) common /= *part;
  return common;
}

}  // namespace

fs::path package_folder(const fs::path& description_file) {
  return declared_package(description_file).value_or(own_folder(description_file));
}

std::vector<fs::path> readable_folders(const fs::path& description_file) {
  if (const auto package = declared_package(description_file)) return {*package};
  const fs::path own = own_folder(description_file);
  return {own, own.parent_path() / "meshes"};
}

std::string outside_text(const fs::path& description_file, const fs::path& file) {
  const auto package = declared_package(description_file);
  const fs::path own = own_folder(description_file);
  const std::string text =
      "lies outside the description's package " + package.value_or(own).string();
  const fs::path common = common_folder(file, own);
  // A package.xml in the root folder would make all files of the machine one package.
  if (!common.has_relative_path()) return text + "; copy it there";
  return text + "; " + (package ? "move its package.xml to " : "an empty file package.xml in ") +
         common.string() + (package ? ", where a package of both begins" : " makes one of both");
}

}  // namespace graspfit::hands::internal
