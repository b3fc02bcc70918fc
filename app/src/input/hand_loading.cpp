#include "input/hand_loading.hpp"

#include <cstdio>

#include "graspfit/hands/hand_library.hpp"

namespace graspfit::app {
namespace {

const char* kind_text(hands::FindingKind kind) {
  switch (kind) {
    case hands::FindingKind::Fault:
      return "fault";
    case hands::FindingKind::Suspicious:
      return "suspicious";
    case hands::FindingKind::Note:
      break;
  }
  return "note";
}

std::string finding_text(const hands::HandFinding& finding) {
  return finding.item.empty() ? finding.what : finding.item + ": " + finding.what;
}

}  // namespace

hands::HandReading load_hand(const std::string& name_or_file) {
  return hands::read_hand(hands::find_hand_file(name_or_file));
}

void warn_of_findings(const std::string& command, const hands::HandReading& reading) {
  for (const hands::HandFinding& finding : reading.findings) {
    if (finding.kind != hands::FindingKind::Suspicious) continue;
    std::fprintf(stderr, "graspfit %s: %s: suspicious: %s\n", command.c_str(),
                 reading.model.description_file.c_str(), finding_text(finding).c_str());
  }
}

std::string finding_line(const hands::HandFinding& finding) {
  std::string line = kind_text(finding.kind);
  line.resize(12, ' ');
  return line + finding_text(finding);
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

}  // namespace graspfit::app
