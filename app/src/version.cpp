#include <array>
#include <utility>

#include "commands.hpp"
#include "versions.hpp"

namespace graspfit::app {

std::string version_text() {
  constexpr std::array<std::pair<const char*, const char*>, 10> kRows = {
      {{"graspfit      ", kVersion},
       {"compiler      ", kCompiler},
       {"build         ", kBuildType},
       {"CGAL          ", kCgal},
       {"Eigen         ", kEigen},
       {"assimp        ", kAssimp},
       {"Boost         ", kBoost},
       {"nlohmann-json ", kNlohmannJson},
       {"tinyxml2      ", kTinyxml2},
       {"OpenSSL       ", kOpenSsl}}};
  std::string text;
  for (const auto& [name, version] : kRows) text += std::string(name) + version + '\n';
  return text;
}

}  // namespace graspfit::app
