#include "cli/command_line.hpp"

#include <algorithm>
#include <boost/program_options/parsers.hpp>
#include <boost/program_options/positional_options.hpp>
#include <boost/program_options/value_semantic.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <system_error>

#include "graspfit/base/nearest_name.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;

const char* const kPositional = "argument without a flag";
const char* const kSecondPositional = "second argument without a flag";

template <class Number>
Number parse_number(const std::string& name, const std::string& text, const char* kind) {
  Number value{};
  const char* first = text.data();
  const char* last = first + text.size();
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  const std::string given = "--" + name + " \"" + text + "\"";
  if (error == std::errc::result_out_of_range) {
    throw UsageError(given + " is out of range");
  }
  bool is_finite = true;
  if constexpr (std::is_floating_point_v<Number>) is_finite = std::isfinite(value);
  if (error != std::errc() || end != last || !is_finite) {
    const bool has_comma = text.find(',') != std::string::npos;
    throw UsageError(given + " is not " + kind +
                     (has_comma ? " (decimals are written with a point)" : ""));
  }
  return value;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  if (!text.empty() && text.back() == separator) parts.emplace_back();
  return parts;
}

std::vector<std::string> split_at_commas(const std::string& text) { return split(text, ','); }

/// Refuses an unknown option. `given` is the word of the command line, "--resol=10".
[[noreturn]] void fail_unknown(const Command& command, const std::string& given) {
  std::vector<std::string> known = {"--help"};
  for (const auto& option : command.options.options()) {
    known.push_back("--" + option->long_name());
  }
  const std::string name = given.substr(0, given.find('='));
  std::error_code error;
  const bool is_file = std::filesystem::exists(given, error);
  throw UsageError(
      "unknown option " + name +
      (is_file ? "; the file of that name is given after --" : base::did_you_mean(name, known)));
}

}  // namespace

po::options_description option_group(const std::string& caption) {
  constexpr unsigned kLineLength = 100;
  constexpr unsigned kDescriptionLength = 62;
  return po::options_description(caption, kLineLength, kDescriptionLength);
}

void add_option(po::options_description& options, const std::string& name,
                const std::string& value_name, const std::optional<std::string>& fallback,
                const std::string& description) {
  auto* value = po::value<std::string>()->value_name(value_name);
  if (fallback) value->default_value(*fallback);
  options.add_options()(name.c_str(), value, description.c_str());
}

void add_repeatable_option(po::options_description& options, const std::string& name,
                           const std::string& value_name, const std::string& description) {
  options.add_options()(name.c_str(), po::value<std::vector<std::string>>()->value_name(value_name),
                        description.c_str());
}

void add_switch(po::options_description& options, const std::string& name,
                const std::string& description) {
  options.add_options()(name.c_str(), description.c_str());
}

void fail_choice(const std::string& flag, const std::string& text, const std::string& choices) {
  throw UsageError("--" + flag + " \"" + text + "\" is not one of " + choices +
                   base::did_you_mean(text, split(choices, '|')));
}

Flags::Flags(const Command& command, const std::vector<std::string>& arguments)
    : positional_name_(command.positional), second_positional_name_(command.second_positional) {
  po::options_description all;
  all.add(command.options);
  all.add_options()("help,h", "")("help-all", "")(kPositional, po::value<std::string>())(
      kSecondPositional, po::value<std::string>());
  po::positional_options_description positional;
  positional.add(kPositional, 1);
  if (!second_positional_name_.empty()) positional.add(kSecondPositional, 1);
  // Options are not guessed: an abbreviation that works today may be ambiguous tomorrow.
  const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  try {
    po::store(
        po::command_line_parser(arguments).options(all).positional(positional).style(style).run(),
        values_);
  } catch (const po::unknown_option& error) {
    fail_unknown(command, error.get_option_name());
  } catch (const po::too_many_positional_options_error&) {
    throw UsageError(positional_name_.empty() ? "takes no argument without a flag"
                     : second_positional_name_.empty()
                         ? "more than one " + positional_name_ + " given"
                         : "more than " + positional_name_ + " and " + second_positional_name_ +
                               " given");
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
  if (positional_name_.empty() && has(kPositional)) {
    throw UsageError("takes no argument without a flag, but \"" + text(kPositional) +
                     "\" is given");
  }
}

const std::string& Flags::positional() const {
  if (!has(kPositional)) throw UsageError("no " + positional_name_ + " given");
  return text(kPositional);
}

const std::string& Flags::second_positional() const {
  if (!has(kSecondPositional)) throw UsageError("no " + second_positional_name_ + " given");
  return text(kSecondPositional);
}

const std::string& Flags::text(const std::string& name) const {
  return values_[name].as<std::string>();
}

double Flags::number(const std::string& name) const {
  return parse_number<double>(name, text(name), "a number");
}

std::optional<double> Flags::optional_number(const std::string& name) const {
  return has(name) ? std::optional(number(name)) : std::nullopt;
}

int Flags::integer(const std::string& name) const {
  return parse_number<int>(name, text(name), "an integer");
}

double Flags::number(const std::string& name, const base::NumberRange& range) const {
  return range.checked("--" + name, number(name));
}

int Flags::integer(const std::string& name, const base::NumberRange& range) const {
  return static_cast<int>(range.checked("--" + name, integer(name)));
}

bool Flags::either(const std::string& name, const char* yes, const char* no) const {
  if (text(name) == yes) return true;
  if (text(name) == no) return false;
  throw UsageError("--" + name + " \"" + text(name) + "\" is neither " + yes + " nor " + no);
}

std::vector<std::string> Flags::texts(const std::string& name) const {
  return has(name) ? values_[name].as<std::vector<std::string>>() : std::vector<std::string>();
}

std::uint64_t Flags::unsigned_integer(const std::string& name) const {
  return parse_number<std::uint64_t>(name, text(name), "an integer from 0");
}

std::vector<std::string> Flags::words(const std::string& name) const {
  const std::vector<std::string> words = split_at_commas(text(name));
  for (const std::string& word : words) {
    if (word.empty()) throw UsageError("--" + name + " \"" + text(name) + "\" has an empty name");
  }
  return words;
}

std::vector<double> Flags::numbers(const std::string& name) const {
  std::vector<double> numbers;
  for (const std::string& part : split_at_commas(text(name))) {
    numbers.push_back(parse_number<double>(name, part, "a number"));
  }
  return numbers;
}

Eigen::Vector3d Flags::vector(const std::string& name) const {
  const std::vector<double> values = numbers(name);
  if (values.size() != 3) {
    throw UsageError("--" + name + " \"" + text(name) + "\" is not three numbers X,Y,Z");
  }
  return {values[0], values[1], values[2]};
}

std::vector<std::size_t> Flags::indices(const std::string& name) const {
  std::vector<std::size_t> indices;
  if (!has(name)) return indices;
  for (const double rank : numbers(name)) {
    if (!(rank >= 1.0 && rank <= 1e9 && rank == std::floor(rank))) {
      throw UsageError("--" + name + " \"" + text(name) + "\" does not list ranks from 1");
    }
    indices.push_back(static_cast<std::size_t>(rank) - 1);
  }
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  if (indices.empty()) throw UsageError("--" + name + " names no grasp");
  return indices;
}

std::vector<std::pair<std::string, double>> Flags::settings(const std::string& name) const {
  std::vector<std::pair<std::string, double>> settings;
  for (const std::string& word : words(name)) {
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos || sign == 0) {
      throw UsageError("--" + name + " \"" + word + "\" is not NAME=VALUE");
    }
    settings.emplace_back(
        word.substr(0, sign),
        parse_number<double>(name + ' ' + word.substr(0, sign), word.substr(sign + 1), "a number"));
  }
  return settings;
}

std::string help_text(const Command& command, bool is_short) {
  po::options_description basics = option_group("Options");
  for (const std::string& name : command.basics) {
    for (const auto& option : command.options.options()) {
      if (option->long_name() == name) basics.add(option);
    }
  }
  std::ostringstream text;
  text << "Usage: graspfit " << command.name
       << (command.positional.empty() ? "" : " " + command.positional)
       << (command.second_positional.empty() ? "" : " " + command.second_positional)
       << " [options]\n\n"
       << command.summary << (is_short ? "\n" : "") << (is_short ? basics : command.options)
       << "\n  -h [ --help ]                       print this text\n";
  if (!command.basics.empty()) {
    text << "  --help-all                          all " << command.options.options().size()
         << " options, by what they are about\n";
  }
  if (!command.positional.empty()) {
    text
        << "  --                                  what follows is no option: a name may begin with "
           "-\n";
  }
  if (!command.epilog.empty()) text << '\n' << command.epilog;
  text << "\nExit codes: 0 success; 1 internal error; 2 input or flags that cannot be used (one "
          "line says why,\nnothing is written, except that grasps are kept if drawing their "
          "pictures fails); 3 no grasp\nfound; 4 evaluate: measures differ; motion: not "
          "free of\ncollisions; experiment verify: results differ; 130 interrupted.\n";
  return text.str();
}

}  // namespace graspfit::app
