#include "output/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "graspfit/sweep/result_table.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

using Numbers = std::vector<double>;

/// The middle of some numbers, of the middle two their mean; empty without numbers.
std::optional<double> median(Numbers numbers) {
  if (numbers.empty()) return std::nullopt;
  std::sort(numbers.begin(), numbers.end());
  const std::size_t half = numbers.size() / 2;
  return numbers.size() % 2 == 1 ? numbers[half] : 0.5 * (numbers[half - 1] + numbers[half]);
}

std::optional<double> largest(const Numbers& numbers) {
  if (numbers.empty()) return std::nullopt;
  return *std::max_element(numbers.begin(), numbers.end());
}

/// A number of each grasp that has it.
template <class NumberOf>
Numbers numbers_of(const ComparedSet& set, const NumberOf& number_of) {
  Numbers numbers;
  for (const ComparedGrasp& grasp : set.grasps) {
    if (const std::optional<double> number = number_of(grasp)) numbers.push_back(*number);
  }
  return numbers;
}

Numbers gaps_of(const ComparedSet& set) {
  Numbers gaps;
  for (const ComparedGrasp& grasp : set.grasps) {
    gaps.insert(gaps.end(), grasp.gaps.begin(), grasp.gaps.end());
  }
  return gaps;
}

std::optional<double> seconds_per_grasp(const ComparedSet& set) {
  if (set.num_timed == 0) return std::nullopt;
  return set.seconds / static_cast<double>(set.num_timed);
}

/// A number that is compared, beside the rates.
struct ComparedNumber {
  const char* words;   ///< In the table, with the table's unit.
  const char* column;  ///< In the CSV file, with the SI unit.
  double per_unit;     ///< By what it is multiplied for the table.
  int decimals;        ///< In the table.
  std::optional<double> (*of)(const ComparedSet& set);
};

const std::array<ComparedNumber, 10> kNumbers = {{
    {"gap, median [mm]", "median_gap_m", 1e3, 4,
     [](const ComparedSet& set) { return median(gaps_of(set)); }},
    {"gap, largest [mm]", "largest_gap_m", 1e3, 4,
     [](const ComparedSet& set) { return largest(gaps_of(set)); }},
    {"depth, largest [mm]", "largest_depth_m", 1e3, 3,
     [](const ComparedSet& set) {
       return largest(
           numbers_of(set, [](const auto& grasp) { return std::optional(grasp.depth); }));
     }},
    {"M, median", "median_m", 1.0, 4,
     [](const ComparedSet& set) {
       return median(numbers_of(set, [](const auto& grasp) { return std::optional(grasp.m); }));
     }},
    {"epsilon, median", "median_epsilon", 1.0, 4,
     [](const ComparedSet& set) {
       return median(
           numbers_of(set, [](const auto& grasp) { return std::optional(grasp.epsilon); }));
     }},
    {"margin, median [N]", "median_margin_force_N", 1.0, 2,
     [](const ComparedSet& set) {
       return median(numbers_of(set, [](const auto& grasp) { return grasp.margin_force; }));
     }},
    {"margin, median [N m]", "median_margin_torque_Nm", 1.0, 4,
     [](const ComparedSet& set) {
       return median(numbers_of(set, [](const auto& grasp) { return grasp.margin_torque; }));
     }},
    {"clusters", "num_clusters", 1.0, 0,
     [](const ComparedSet& set) { return std::optional<double>(set.num_clusters); }},
    {"variance on first axis", "first_axis_share", 1.0, 3,
     [](const ComparedSet& set) { return median(set.first_axis_shares); }},
    {"time per grasp [s]", "time_per_grasp_s", 1.0, 2, seconds_per_grasp},
}};

std::string percent(double share) { return fixed_decimal(100.0 * share, 0); }

/// "80 % (38-96)", with the interval; "-" where nothing is known.
std::string rate_text(const std::optional<ComparedRate>& rate) {
  if (!rate) return "-";
  const base::ShareInterval interval = rate->interval();
  return percent(rate->share()) + " % (" + percent(interval.low) + '-' + percent(interval.high) +
         ')';
}

std::string number_text(const std::optional<double>& number, int decimals) {
  return number ? fixed_decimal(*number, decimals) : "-";
}

/// "+3" or "-3"; "0" without a sign, whatever the rounding left of the difference.
std::string signed_decimal(double difference, int decimals) {
  const std::string text = fixed_decimal(std::abs(difference), decimals);
  const bool is_zero = text.find_first_not_of("0.") == std::string::npos;
  return is_zero ? "0" : (difference > 0.0 ? '+' : '-') + text;
}

/// The table of two sets.
std::string table_of(const ComparedSet& a, const ComparedSet& b) {
  const double difference =
      static_cast<double>(b.grasps.size()) - static_cast<double>(a.grasps.size());
  std::vector<std::vector<std::string>> rows = {
      {"measure", "A", "B", "difference"},
      {"grasps", std::to_string(a.grasps.size()), std::to_string(b.grasps.size()),
       signed_decimal(difference, 0)}};
  for (std::size_t i = 0; i < kComparedRates.size(); ++i) {
    const auto rate_a = rate_of(a, i);
    const auto rate_b = rate_of(b, i);
    rows.push_back({std::string(kComparedRates[i]), rate_text(rate_a), rate_text(rate_b),
                    rate_a && rate_b
                        ? signed_decimal(100.0 * (rate_b->share() - rate_a->share()), 0) + " points"
                        : "-"});
  }
  for (const ComparedNumber& number : kNumbers) {
    const auto of_a = number.of(a);
    const auto of_b = number.of(b);
    if (!of_a && !of_b) continue;
    const auto scaled = [&number](const std::optional<double>& value) {
      return value ? std::optional(number.per_unit * *value) : std::nullopt;
    };
    rows.push_back(
        {number.words, number_text(scaled(of_a), number.decimals),
         number_text(scaled(of_b), number.decimals),
         of_a && of_b ? signed_decimal(number.per_unit * (*of_b - *of_a), number.decimals) : "-"});
  }
  return text_table(rows);
}

/// "4/5", of grasps that have a property among those of which it is known.
std::string count_text(const std::optional<ComparedRate>& rate) {
  return rate ? std::to_string(rate->num_hits) + '/' + std::to_string(rate->num_known) : "-";
}

/// A row for each side of each object.
std::string object_table(const SetComparison& comparison) {
  std::vector<std::vector<std::string>> rows = {{"object", "side"}};
  for (const std::string_view property : kComparedRates) rows[0].emplace_back(property);
  rows[0].insert(rows[0].end(), {"M", "epsilon", "clusters"});
  for (const ComparedObject& object : comparison.objects) {
    for (const ComparedSide side : {ComparedSide::A, ComparedSide::B}) {
      const ComparedSet& set = object.sides[static_cast<std::size_t>(side)];
      std::vector<std::string> row = {object.name, side == ComparedSide::A ? "A" : "B"};
      for (std::size_t i = 0; i < kComparedRates.size(); ++i) {
        row.push_back(count_text(rate_of(set, i)));
      }
      for (const ComparedNumber& number : kNumbers) {
        const std::string_view column = number.column;
        if (column == "median_m" || column == "median_epsilon" || column == "num_clusters") {
          row.push_back(number_text(number.of(set), number.decimals));
        }
      }
      rows.push_back(std::move(row));
    }
  }
  return text_table(rows);
}

std::vector<sweep::Column> columns() {
  std::vector<sweep::Column> columns = {{"object", "", "name of the object, or all"},
                                        {"object_sha256", "", "of its file"},
                                        {"side", "", "A or B"},
                                        {"grasps", "", "path of the side"},
                                        {"protocol", "", "of the physics test"},
                                        {"num_grasps", "1", ""}};
  for (const std::string_view property : kComparedRates) {
    const std::string name(property);
    columns.push_back({"num_" + name, "1", "how many are"});
    columns.push_back({name + "_rate", "1", "share of them"});
    columns.push_back({name + "_low", "1", "lower end of the 95 % interval"});
    columns.push_back({name + "_high", "1", "upper end"});
  }
  for (const ComparedNumber& number : kNumbers) columns.push_back({number.column, "", ""});
  return columns;
}

std::string csv_row(const std::vector<sweep::Column>& columns, const SetComparison& comparison,
                    const std::string& object, const std::string& sha256, ComparedSide side,
                    const ComparedSet& set) {
  sweep::ResultRow row(columns);
  row.set("object", object);
  if (!sha256.empty()) row.set("object_sha256", sha256);
  row.set("side", std::string(side == ComparedSide::A ? "A" : "B"));
  row.set("grasps", comparison.names[static_cast<std::size_t>(side)]);
  if (!comparison.protocol.empty()) row.set("protocol", comparison.protocol);
  row.set("num_grasps", static_cast<std::int64_t>(set.grasps.size()));
  for (std::size_t i = 0; i < kComparedRates.size(); ++i) {
    const auto rate = rate_of(set, i);
    if (!rate) continue;
    const std::string name(kComparedRates[i]);
    row.set("num_" + name, rate->num_hits);
    row.set(name + "_rate", rate->share());
    row.set(name + "_low", rate->interval().low);
    row.set(name + "_high", rate->interval().high);
  }
  for (const ComparedNumber& number : kNumbers) {
    const auto value = number.of(set);
    if (value) row.set(number.column, *value);
  }
  return sweep::csv_line(row.csv_fields());
}

}  // namespace

void ComparedSet::add(const ComparedSet& other) {
  grasps.insert(grasps.end(), other.grasps.begin(), other.grasps.end());
  num_clusters += other.num_clusters;
  first_axis_shares.insert(first_axis_shares.end(), other.first_axis_shares.begin(),
                           other.first_axis_shares.end());
  seconds += other.seconds;
  num_timed += other.num_timed;
}

ComparedSet SetComparison::all(ComparedSide side) const {
  ComparedSet set;
  for (const ComparedObject& object : objects) {
    set.add(object.sides[static_cast<std::size_t>(side)]);
  }
  return set;
}

std::optional<ComparedRate> rate_of(const ComparedSet& set, std::size_t property) {
  ComparedRate rate;
  for (const ComparedGrasp& grasp : set.grasps) {
    const std::array<std::optional<bool>, kComparedRates.size()> known = {
        grasp.touches, grasp.is_clear, grasp.valid, grasp.is_closed, grasp.held};
    if (!known.at(property)) continue;
    ++rate.num_known;
    if (*known.at(property)) ++rate.num_hits;
  }
  if (rate.num_known == 0) return std::nullopt;
  return rate;
}

std::string comparison_text(const SetComparison& comparison) {
  std::string text = "A: " + comparison.names[0] + "\nB: " + comparison.names[1] + '\n';
  text += comparison.objects.size() == 1 ? "object " + comparison.objects[0].name + '\n'
                                         : std::to_string(comparison.objects.size()) + " objects\n";
  if (!comparison.protocol.empty()) text += "held: under " + comparison.protocol + '\n';
  text += table_of(comparison.all(ComparedSide::A), comparison.all(ComparedSide::B));
  if (comparison.objects.size() > 1) text += '\n' + object_table(comparison);
  return text;
}

std::string comparison_csv(const SetComparison& comparison) {
  const std::vector<sweep::Column> named = columns();
  std::vector<std::string> names;
  for (const sweep::Column& column : named) names.push_back(column.name);
  std::string text = sweep::csv_line(names);
  for (const ComparedSide side : {ComparedSide::A, ComparedSide::B}) {
    text += csv_row(named, comparison, "all", "", side, comparison.all(side));
  }
  for (const ComparedObject& object : comparison.objects) {
    for (const ComparedSide side : {ComparedSide::A, ComparedSide::B}) {
      text += csv_row(named, comparison, object.name, object.sha256, side,
                      object.sides[static_cast<std::size_t>(side)]);
    }
  }
  return text;
}

}  // namespace graspfit::app
