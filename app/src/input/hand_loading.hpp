#pragma once

#include <string>

#include "graspfit/hands/hand_io.hpp"

namespace graspfit::app {

/// A hand by the name of a shipped one or by its description's file, and what its reader noticed.
hands::HandReading load_hand(const std::string& name_or_file);

/// Prints what is suspicious about a hand on standard error, a line each.
void warn_of_findings(const std::string& command, const hands::HandReading& reading);

/// A finding as a line of a report: "note        link palm: its surface was repaired".
std::string finding_line(const hands::HandFinding& finding);

/// A number and its noun: "1 pad", "2 pads".
std::string counted(std::size_t count, const std::string& one, const std::string& many);

}  // namespace graspfit::app
