#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace graspfit::base {

/// How deep arrays and objects of a JSON file may nest. What this project writes nests a dozen
/// deep; trees of a hundred thousand levels exhaust the stack of whoever copies them.
constexpr int kDeepestJson = 64;

/// How large a JSON file may be [bytes]: 256 MiB, tens of thousands of grasps. Its tree in memory
/// takes up to some twenty times as much.
constexpr std::size_t kLargestJson = std::size_t{256} << 20;

/// How many members an object may have where their order is kept, which takes time by the square of
/// their number. What this project writes has some hundred at most.
constexpr std::size_t kMostOrderedMembers = 10000;

/// Refuses a text that no parser of JSON should build a tree from: longer than `kLargestJson`,
/// nested deeper than `kDeepestJson`, or with an object of more than `most_members`. The content of
/// strings does not count. Errors of syntax are left for the parser to find: up to the first one,
/// this function counts as a parser does.
/// @throws IoError "<name>: line 3, column 70: nests deeper than 64 levels, ...".
void require_bounded_json(std::string_view text, const std::string& name,
                          std::size_t most_members = kLargestJson);

/// The text of a JSON file that anybody may have written; all such files are read by this function.
/// @throws IoError if it cannot be read, or is refused by `require_bounded_json`; a file that is
/// too large is refused before it is read.
std::string read_json_file(const std::filesystem::path& file);

/// A parse error's message of nlohmann's library, without its prefix
/// "[json.exception.parse_error.101] ".
std::string json_fault(const std::string& what);

}  // namespace graspfit::base
