#include "import/mjcf_files.hpp"

#include <strings.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "description/description_package.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/lies_in.hpp"

namespace graspfit::hands::internal {

namespace {

namespace fs = std::filesystem;
using base::InvalidInput;
using base::IoError;
using tinyxml2::XMLElement;

/// Attributes whose numbers determine a hand.
constexpr std::array<std::string_view, 22> kNumbers = {
    "axis",  "axisangle", "coef", "density", "diaginertia", "euler", "fromto", "fullinertia",
    "mass",  "polycoef",  "pos",  "quat",    "range",       "ref",   "refpos", "refquat",
    "scale", "size",      "user", "vertex",  "xyaxes",      "zaxis"};

/// Whether one of the words of `text` is what MuJoCo reads as not a number or infinite.
bool names_no_number(std::string_view text) {
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    const char* bare = word.c_str() + (word[0] == '+' || word[0] == '-' ? 1 : 0);
    if (strcasecmp(bare, "nan") == 0 || strcasecmp(bare, "inf") == 0 ||
        strcasecmp(bare, "infinity") == 0) {
      return true;
    }
  }
  return false;
}

/// An attribute of an asset that names a file.
struct NamedFile {
  std::string element;
  std::string asset;  ///< Name of the asset; empty: named by the file.
  std::string file;
};

class FileChecker {
 public:
  explicit FileChecker(const fs::path& file)
      : file_(file.string()),
        folder_(fs::weakly_canonical(file).parent_path()),
        readable_(readable_folders(file)) {}

  MjcfMeshFiles check(const std::string& text) {
    collect_from(text, file_);
    MjcfMeshFiles result;
    for (const NamedFile& named : named_files_) {
      fs::path name = named.file;
      if (strips_paths_) name = name.filename();
      const fs::path& folder = named.element == "texture" ? texture_folder_ : mesh_folder_;
      const fs::path path = checked(folder / name, named.element, named.file);
      if (named.element != "mesh") continue;
      result[named.asset.empty() ? name.stem().string() : named.asset] =
          path.lexically_relative(folder_).generic_string();
    }
    return result;
  }

 private:
  /// The file that `path`, relative to the description's folder or absolute, leads to.
  fs::path checked(const fs::path& path, const std::string& element,
                   const std::string& name) const {
    const std::string item = file_ + ": <" + element + "> " + name;
    const fs::path file = fs::weakly_canonical(folder_ / path);
    if (!base::lies_in(file, readable_)) throw InvalidInput(item + " " + outside_text(file_, file));
    std::error_code error;
    if (!fs::is_regular_file(file, error)) {
      throw IoError(item + " is not there: no file " + file.string());
    }
    return file;
  }

  void collect_from(const std::string& text, const std::string& source) {
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
      throw IoError(source + ": line " + std::to_string(document.ErrorLineNum()) + ": not XML (" +
                    std::string(document.ErrorName()) + ")");
    }
    if (document.RootElement() != nullptr) collect_below(*document.RootElement(), source);
  }

  void collect_below(const XMLElement& parent, const std::string& source) {
    for (const XMLElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (strcasecmp(e->Name(), "include") == 0) {
        include(*e);
      } else if (std::string_view(e->Name()) == "compiler") {
        compiler(*e);
      } else if (names_files(e->Name())) {
        asset(*e);
      }
      require_numbers(*e, source);
      collect_below(*e, source);
    }
  }

  /// Whether an element names files, wherever it is: an included file may hold only the children of
  /// an <asset>.
  static bool names_files(std::string_view element) {
    return element == "mesh" || element == "texture" || element == "hfield" || element == "skin";
  }

  static void require_numbers(const XMLElement& e, const std::string& source) {
    for (const tinyxml2::XMLAttribute* a = e.FirstAttribute(); a; a = a->Next()) {
      if (std::find(kNumbers.begin(), kNumbers.end(), a->Name()) == kNumbers.end()) continue;
      if (!names_no_number(a->Value())) continue;
      throw InvalidInput(source + ": line " + std::to_string(e.GetLineNum()) + ": <" + e.Name() +
                         "> " + a->Name() + " \"" + a->Value() + "\" is not finite");
    }
  }

  /// Paths in an included file are relative to the main file's folder, too.
  void include(const XMLElement& e) {
    const char* name = e.Attribute("file");
    if (name == nullptr || !included_.insert(name).second) return;  // MuJoCo refuses both
    const fs::path file = checked(name, e.Name(), name);
    collect_from(base::read_file(file), file.string());
  }

  /// A later <compiler> overrides an earlier one, wherever the assets stand.
  void compiler(const XMLElement& e) {
    if (const char* folder = e.Attribute("meshdir")) mesh_folder_ = folder;
    if (const char* folder = e.Attribute("texturedir")) texture_folder_ = folder;
    if (const char* strips = e.Attribute("strippath")) {
      strips_paths_ = std::string_view(strips) == "true";
    }
  }

  /// A cubic texture names up to six files: file, fileright, ...
  void asset(const XMLElement& e) {
    const char* name = e.Attribute("name");
    for (const tinyxml2::XMLAttribute* a = e.FirstAttribute(); a; a = a->Next()) {
      if (std::strncmp(a->Name(), "file", 4) != 0 || *a->Value() == '\0') continue;
      named_files_.push_back({e.Name(), name ? name : "", a->Value()});
    }
  }

  std::string file_;
  fs::path folder_;
  std::vector<fs::path> readable_;
  std::set<std::string> included_;
  std::vector<NamedFile> named_files_;
  fs::path mesh_folder_;
  fs::path texture_folder_;
  bool strips_paths_ = false;
};

}  // namespace

MjcfMeshFiles check_mjcf_files(const std::string& text, const fs::path& file) {
  return FileChecker(file).check(text);
}

}  // namespace graspfit::hands::internal
