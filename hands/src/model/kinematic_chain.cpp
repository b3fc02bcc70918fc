#include "graspfit/hands/kinematic_chain.hpp"

#include <algorithm>

namespace graspfit::hands {

std::vector<int> links_to(const HandModel& model, int link) {
  std::vector<int> links;
  for (std::optional<int> at = link; at; at = model.links[*at].parent_link) links.push_back(*at);
  std::reverse(links.begin(), links.end());
  return links;
}

std::vector<int> joints_to(const HandModel& model, int link) {
  std::vector<int> joints;
  for (const int at : links_to(model, link)) {
    if (const auto joint = model.links[at].parent_joint) joints.push_back(*joint);
  }
  return joints;
}

int leader_of(const HandModel& model, int joint) {
  const std::optional<Coupling>& coupling = model.joints[joint].coupling;
  return coupling ? coupling->leader : joint;
}

std::vector<int> leaders_of(const HandModel& model, const std::vector<int>& joints) {
  std::vector<int> leaders;
  for (const int joint : joints) leaders.push_back(leader_of(model, joint));
  std::sort(leaders.begin(), leaders.end());
  leaders.erase(std::unique(leaders.begin(), leaders.end()), leaders.end());
  return leaders;
}

}  // namespace graspfit::hands
