#include "commands/commands.hpp"
#include "versions.hpp"

namespace graspfit::app {

std::vector<std::pair<std::string, std::string>> version_rows() {
  return {{"graspfit", kVersion},  {"compiler", kCompiler},
          {"build", kBuildType},   {"CGAL", kCgal},
          {"Eigen", kEigen},       {"assimp", kAssimp},
          {"Boost", kBoost},       {"nlohmann-json", kNlohmannJson},
          {"tinyxml2", kTinyxml2}, {"yaml-cpp", kYamlCpp},
          {"OpenSSL", kOpenSsl},   {"MuJoCo", kMujoco}};
}

std::string version_text() {
  constexpr std::size_t kNameWidth = 14;
  std::string text;
  for (auto [name, version] : version_rows()) {
    name.resize(kNameWidth, ' ');
    text += name + version + '\n';
  }
  return text;
}

}  // namespace graspfit::app
