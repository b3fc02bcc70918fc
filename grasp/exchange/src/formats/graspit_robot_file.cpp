#include "formats/graspit_robot_file.hpp"

#include <tinyxml2.h>

#include <charconv>
#include <string>
#include <string_view>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/sha256.hpp"

namespace graspfit::exchange::internal {
namespace {

using tinyxml2::XMLElement;

std::string text_without_blanks(const XMLElement* element) {
  std::string packed;
  for (const char c : std::string_view(element && element->GetText() ? element->GetText() : "")) {
    if (c != ' ' && c != '\t' && c != '\n' && c != '\r') packed += c;
  }
  return packed;
}

/// Number of the degree of freedom and ratio in a text like "d1*0.33+40", which the reader of hands
/// has checked.
struct Expression {
  std::size_t dof = 0;
  double ratio = 1.0;
};
Expression expression(const std::string& text) {
  Expression result;
  const char* const last = text.data() + text.size();
  const char* at = std::from_chars(text.data() + 1, last, result.dof).ptr;
  if (at != last && *at == '*') {
    if (++at != last && *at == '+') ++at;
    std::from_chars(at, last, result.ratio);
  }
  return result;
}

}  // namespace

std::optional<std::vector<GraspItDof>> graspit_dofs(const hands::HandModel& hand) {
  const std::string text = base::read_file(hand.description_file);
  if (base::sha256_hex(text) != hand.description_sha256) {
    throw base::IoError(hand.description_file + ": is not the file that hand " + hand.name +
                        " was read from: its SHA-256 is another one");
  }
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  const XMLElement* const root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "robot" ||
      root->FirstChildElement("dof") == nullptr || root->FirstChildElement("chain") == nullptr) {
    return std::nullopt;
  }
  std::vector<GraspItDof> dofs;
  for (const XMLElement* e = root->FirstChildElement("dof"); e; e = e->NextSiblingElement("dof")) {
    const char* const type = e->Attribute("type");
    dofs.push_back({.breaks_away = type != nullptr && std::string_view(type) == "b", .joints = {}});
  }
  int chain = 0;
  for (const XMLElement* c = root->FirstChildElement("chain"); c;
       c = c->NextSiblingElement("chain"), ++chain) {
    int index = 0;
    for (const XMLElement* j = c->FirstChildElement("joint"); j;
         j = j->NextSiblingElement("joint"), ++index) {
      const char* const type = j->Attribute("type");
      const bool is_revolute = type != nullptr && std::string_view(type) == "Revolute";
      const Expression value =
          expression(text_without_blanks(j->FirstChildElement(is_revolute ? "theta" : "d")));
      const std::string name = "d" + std::to_string(value.dof) + "_chain" + std::to_string(chain) +
                               "_joint" + std::to_string(index);
      dofs.at(value.dof).joints.push_back({hand.joint_index(name), value.ratio});
    }
  }
  return dofs;
}

}  // namespace graspfit::exchange::internal
