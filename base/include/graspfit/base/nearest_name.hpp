#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// What an unknown name was probably meant to be, for messages.

namespace graspfit::base {

/// The known name that is nearest to an unknown one; none if none is near.
///
/// The distance is the least number of letters inserted, left out, replaced, or swapped with their
/// neighbor, no letter touched twice (optimal string alignment); case does not count. A name is
/// near if the distance is at most a third of the number of the unknown name's letters, or one, and
/// less than that number. If none is that near, the result is the first known name that begins with
/// the unknown name, if the unknown name has at least three letters. Of equally near names it is
/// the first.
std::optional<std::string> nearest_name(std::string_view name,
                                        const std::vector<std::string>& known);

/// `; did you mean "plan"?` for the end of a message about an unknown name; empty if none is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

/// `a, b, c; did you mean "b"?`: the known names, for the end of a message about an unknown name.
std::string known_names(std::string_view name, const std::vector<std::string>& known);

}  // namespace graspfit::base
