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
/// neighbor, no letter touched twice (optimal string alignment); case does not count. Near is up to
/// a third of the unknown name's letters, at least one of them. Where none is that near, the first
/// known name that begins with the unknown one, of three letters at least. Ties: the first known.
std::optional<std::string> nearest_name(std::string_view name,
                                        const std::vector<std::string>& known);

/// `; did you mean "plan"?` for the end of a message about an unknown name; empty if none is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

/// `a, b, c; did you mean "b"?`: the names there are, for the end of a message about an unknown
/// one.
std::string known_names(std::string_view name, const std::vector<std::string>& known);

}  // namespace graspfit::base
