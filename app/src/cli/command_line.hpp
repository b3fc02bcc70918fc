#pragma once

#include <Eigen/Core>
#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/exit_codes.hpp"
#include "graspfit/base/number_range.hpp"
#include "graspfit/grasp/option_names.hpp"

namespace graspfit::app {

/// A command of the program: its arguments and options, and the text of its help.
struct Command {
  std::string name;        ///< "plan"
  std::string positional;  ///< Name of the argument without a flag, "OBJECT"; empty: none.
  std::string summary;     ///< One or more sentences for --help.
  boost::program_options::options_description options;
  std::string epilog;                  ///< Printed after the options.
  std::string second_positional = "";  ///< A second argument without a flag, "OUT"; empty: none.
  /// The options that --help shows, in this order; --help-all shows all. Empty: --help shows all,
  /// too.
  std::vector<std::string> basics = {};
};

/// A group of options under a caption, laid out for --help.
boost::program_options::options_description option_group(const std::string& caption = "");

/// An option with a text as its value; `fallback` is its default, shown by --help.
void add_option(boost::program_options::options_description& options, const std::string& name,
                const std::string& value_name, const std::optional<std::string>& fallback,
                const std::string& description);

/// An option that may be given any number of times.
void add_repeatable_option(boost::program_options::options_description& options,
                           const std::string& name, const std::string& value_name,
                           const std::string& description);

/// An option without a value, which is given or not.
void add_switch(boost::program_options::options_description& options, const std::string& name,
                const std::string& description);

/// @throws UsageError `--FLAG "TEXT" is not one of CHOICES`, with the nearest of them; the choices
/// are separated by |.
[[noreturn]] void fail_choice(const std::string& flag, const std::string& text,
                              const std::string& choices);

/// The values of a command's options as texts, converted when asked for.
///
/// Numbers are read in the C locale to their last character: "abc", "1.5x" and "1,5" are errors,
/// and so are infinities and NaN. All members throw UsageError.
class Flags {
 public:
  /// @throws UsageError for unknown options, missing values, repeated options, too many arguments.
  Flags(const Command& command, const std::vector<std::string>& arguments);

  bool wants_help() const { return has("help") || wants_all_help(); }
  bool wants_all_help() const { return has("help-all"); }
  /// The argument without a flag; it must be given.
  const std::string& positional() const;
  /// The second argument without a flag; it must be given.
  const std::string& second_positional() const;

  bool has(const std::string& name) const { return values_.count(name) > 0; }
  bool is_default(const std::string& name) const { return values_[name].defaulted(); }
  const std::string& text(const std::string& name) const;
  double number(const std::string& name) const;
  std::optional<double> optional_number(const std::string& name) const;
  int integer(const std::string& name) const;
  double number(const std::string& name, const base::NumberRange& range) const;
  int integer(const std::string& name, const base::NumberRange& range) const;
  /// True if the text is `yes`, false if it is `no`; no other text is allowed.
  bool either(const std::string& name, const char* yes, const char* no) const;
  /// The values of a repeatable option.
  std::vector<std::string> texts(const std::string& name) const;
  std::uint64_t unsigned_integer(const std::string& name) const;
  std::vector<std::string> words(const std::string& name) const;  ///< Separated by commas.
  std::vector<double> numbers(const std::string& name) const;     ///< Separated by commas.
  Eigen::Vector3d vector(const std::string& name) const;          ///< Three numbers.

  /// Reads ranks separated by commas, which count from 1, as indices, which count from 0. They are
  /// ascending, each once; none if the option is not given.
  std::vector<std::size_t> indices(const std::string& name) const;

  /// The value of an enumeration by its name.
  template <class Enum>
  Enum choice(const std::string& name) const {
    const auto value = grasp::value_named<Enum>(text(name));
    if (!value) {
      fail_choice(name, text(name), grasp::names_of<Enum>());
    }
    return *value;
  }
  /// Reads NAME=VALUE,... with numbers as values.
  std::vector<std::pair<std::string, double>> settings(const std::string& name) const;

 private:
  std::string positional_name_;
  std::string second_positional_name_;
  boost::program_options::variables_map values_;
};

/// The help of a command: usage, options with their defaults, and exit codes. If `is_short`, it has
/// only the basic options.
std::string help_text(const Command& command, bool is_short = false);

}  // namespace graspfit::app
