#include "graspfit/base/nearest_name.hpp"

#include <algorithm>
#include <cstddef>

#include "graspfit/base/list_text.hpp"

namespace graspfit::base {
namespace {

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// Optimal string alignment by rows: entry j of row i is the distance of the first i letters of `a`
/// from the first j of `b`.
std::size_t alignment_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last;
  std::vector<std::size_t> last;
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = std::move(last);
    last = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swap) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view name,
                                        const std::vector<std::string>& known) {
  constexpr std::size_t kLeastStart = 3;
  if (name.empty()) return std::nullopt;
  const std::string wanted = in_lower_case(name);
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, wanted.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = alignment_distance(wanted, in_lower_case(candidate));
    // A name that differs in as many letters as it has is not a mistyped one.
    if (distance >= least || distance >= wanted.size()) continue;
    least = distance;
    nearest = &candidate;
  }
  if (nearest != nullptr) return *nearest;
  if (wanted.size() < kLeastStart) return std::nullopt;
  const auto start = std::find_if(known.begin(), known.end(), [&](const std::string& candidate) {
    return in_lower_case(candidate).starts_with(wanted);
  });
  return start == known.end() ? std::nullopt : std::optional(*start);
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  const std::optional<std::string> nearest = nearest_name(name, known);
  return nearest ? "; did you mean \"" + *nearest + "\"?" : "";
}

std::string known_names(std::string_view name, const std::vector<std::string>& known) {
  return list_text(known) + did_you_mean(name, known);
}

}  // namespace graspfit::base
