#include "import/robot_file.hpp"

#include <tinyxml2.h>

#include <string_view>

#include "graspfit/base/errors.hpp"
#include "import/graspit.hpp"
#include "import/mjcf.hpp"
#include "import/urdf.hpp"

namespace graspfit::hands::internal {

RobotDescription parse_robot_file(const std::string& text, const std::filesystem::path& file,
                                  Findings& findings) {
  const std::string name = file.string();
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw base::IoError(name + ": empty file");
  }
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw base::IoError(name + ": line " + std::to_string(document.ErrorLineNum()) + ": not XML (" +
                        std::string(document.ErrorName()) + ")");
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  const std::string_view tag = root ? root->Name() : "";
  if (tag == "mujoco") return parse_mjcf(text, file, findings);
  if (tag == "robot" && root->FirstChildElement("palm")) return parse_graspit(text, file, findings);
  if (tag == "robot") return parse_urdf(text, name, findings);
  throw base::IoError(name + ": not a robot description: its root element is <" + std::string(tag) +
                      ">; URDF and GraspIt! XML have <robot>, MJCF has <mujoco>");
}

}  // namespace graspfit::hands::internal
