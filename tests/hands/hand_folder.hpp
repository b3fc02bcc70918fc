#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "support/catch.hpp"

namespace graspfit::testing {

/// A new folder to write a hand's files into, removed at the end.
class HandFolder {
 public:
  HandFolder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "graspfit-hand-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  HandFolder(const HandFolder&) = delete;
  HandFolder& operator=(const HandFolder&) = delete;
  ~HandFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }

  const std::filesystem::path& path() const { return path_; }

  /// Writes a file, with the folders before it. Returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

  /// Copies a hand's whole folder into this one.
  void copy(const std::filesystem::path& folder) const {
    std::filesystem::copy(folder, path_, std::filesystem::copy_options::recursive);
  }

 private:
  std::filesystem::path path_;
};

/// The least that a sidecar can say: one finger of one link and joint, no pads. Enough for the
/// kinematics of any description.
inline std::string least_sidecar(const std::string& palm, const std::string& link,
                                 const std::string& joint,
                                 const std::vector<std::string>& closing) {
  std::string signs;
  for (const std::string& name : closing) signs += (signs.empty() ? "\"" : ", \"") + name + "\": 1";
  return R"({"format": {"name": "graspfit hand sidecar", "version": 1},
  "fingers": [{"name": "finger", "links": [")" +
         link + R"("], "joints": [")" + joint + R"("]}], "pads": [],
  "palm": {"link": ")" +
         palm + R"(", "center_m": [0, 0, 0], "direction": [0, 0, 1]},
  "closing": {)" +
         signs + R"(}, "exclusions": []})";
}

/// `text` with the only occurrence of `old` replaced.
inline std::string with(std::string text, const std::string& old, const std::string& fresh) {
  INFO(old);
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  REQUIRE(text.find(old, at + 1) == std::string::npos);
  return text.replace(at, old.size(), fresh);
}

}  // namespace graspfit::testing
