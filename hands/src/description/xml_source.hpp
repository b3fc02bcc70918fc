#pragma once

#include <tinyxml2.h>

#include <string>
#include <string_view>
#include <vector>

namespace graspfit::hands::internal {

/// An XML file, and functions that read values of it and report errors: every message names the
/// file, the line and the item. Numbers are read in the C locale whatever the program's locale is,
/// and must be finite.
class XmlSource {
 public:
  explicit XmlSource(std::string file) : file_(std::move(file)) {}

  const std::string& file() const { return file_; }

  /// Parses `text` into `document`. @throws IoError if it is empty, no XML, or its root element is
  /// not `<root>`; `format` says what it should be.
  const tinyxml2::XMLElement& parse(const std::string& text, std::string_view root,
                                    const std::string& format,
                                    tinyxml2::XMLDocument& document) const;

  /// @throws InvalidInput, in one line.
  [[noreturn]] void fail(const tinyxml2::XMLElement& at, const std::string& what) const;

  /// "line 12: ", for findings.
  static std::string line(const tinyxml2::XMLElement& at);

  /// A required attribute that is not empty and has no control characters.
  std::string text_of(const tinyxml2::XMLElement& e, const char* attribute,
                      const std::string& item) const;

  /// Returns `text`, a name that one-line messages will show; it must not have control characters.
  std::string plain(const tinyxml2::XMLElement& e, const std::string& text,
                    const std::string& item) const;

  /// `count` numbers separated by blanks.
  std::vector<double> numbers(const tinyxml2::XMLElement& e, std::string_view text,
                              std::size_t count, const std::string& item) const;

  /// A number in an attribute.
  double number(const tinyxml2::XMLElement& e, const char* attribute,
                const std::string& item) const;
  double number_or(const tinyxml2::XMLElement& e, const char* attribute, double otherwise,
                   const std::string& item) const;

 private:
  std::string file_;
};

}  // namespace graspfit::hands::internal
