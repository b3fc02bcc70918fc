#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Names of the shipped hands, sorted: the folders of the hand library that hold `<name>.urdf`.
std::vector<std::string> shipped_hands();

/// The URDF of a shipped hand. @throws InvalidInput that lists the shipped hands, if there is none
/// of that name.
std::filesystem::path shipped_hand_file(const std::string& name);

/// The path of a shipped hand's file relative to the folder of shipped hands
/// ("barrett/barrett.urdf"), wherever that folder is. Any other path is returned as it is. Only the
/// texts of the paths are compared.
std::filesystem::path path_in_library(const std::filesystem::path& file);

/// The description file of the shipped hand of that name ("barrett"), else the argument as a path.
/// @throws InvalidInput that lists the shipped hands, if the argument neither names one, nor looks
/// like a path, nor exists as a file.
std::filesystem::path find_hand_file(const std::string& name_or_file);

/// A hand by the name of a shipped one ("barrett") or by the path of a description; shipped hands
/// are read by the same reader as anybody's. @throws as `read_hand_model` and `find_hand_file`.
HandModel find_hand(const std::string& name_or_file);

}  // namespace graspfit::hands
