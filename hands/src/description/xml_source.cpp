#include "description/xml_source.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "description/control_characters.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::hands::internal {

using base::InvalidInput;
using base::IoError;
using tinyxml2::XMLElement;

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

const XMLElement& XmlSource::parse(const std::string& text, std::string_view root,
                                   const std::string& format,
                                   tinyxml2::XMLDocument& document) const {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw IoError(file_ + ": empty file");
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw IoError(file_ + ": line " + std::to_string(document.ErrorLineNum()) + ": not XML (" +
                  std::string(document.ErrorName()) + ")");
  }
  const XMLElement* element = document.RootElement();
  if (element == nullptr || std::string_view(element->Name()) != root) {
    throw IoError(file_ + ": not " + format + ": its root element is <" +
                  (element ? std::string(element->Name()) : std::string()) + ">, not <" +
                  std::string(root) + ">");
  }
  return *element;
}

void XmlSource::fail(const XMLElement& at, const std::string& what) const {
  std::string message = file_ + ": " + line(at) + what;
  std::replace_if(message.begin(), message.end(), is_control, ' ');  // texts of several lines
  throw InvalidInput(message);
}

std::string XmlSource::line(const XMLElement& at) {
  return "line " + std::to_string(at.GetLineNum()) + ": ";
}

std::string XmlSource::text_of(const XMLElement& e, const char* attribute,
                               const std::string& item) const {
  const char* value = e.Attribute(attribute);
  if (value == nullptr || *value == '\0') {
    fail(e, item + ": <" + e.Name() + "> has no " + attribute);
  }
  return plain(e, value, item);
}

std::string XmlSource::plain(const XMLElement& e, const std::string& text,
                             const std::string& item) const {
  if (std::any_of(text.begin(), text.end(), is_control)) {
    fail(e, item + ": <" + e.Name() + "> \"" + text + "\" has control characters");
  }
  return text;
}

std::vector<double> XmlSource::numbers(const XMLElement& e, std::string_view text,
                                       std::size_t count, const std::string& item) const {
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  const auto complain = [&](const std::string& why) {
    fail(e, item + ": <" + e.Name() + "> \"" + std::string(text) + "\" " + why);
  };
  while (true) {
    while (at != end && is_blank(*at)) ++at;
    if (at == end) break;
    if (*at == '+') ++at;
    double value = 0.0;
    const auto [rest, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !(rest == end || is_blank(*rest))) complain("is not a number");
    if (!std::isfinite(value)) complain("is not finite");
    values.push_back(value);
    at = rest;
  }
  if (values.size() != count) {
    complain("has " + std::to_string(values.size()) + " of " + std::to_string(count) + " numbers");
  }
  return values;
}

double XmlSource::number(const XMLElement& e, const char* attribute,
                         const std::string& item) const {
  return numbers(e, text_of(e, attribute, item), 1, item)[0];
}

double XmlSource::number_or(const XMLElement& e, const char* attribute, double otherwise,
                            const std::string& item) const {
  return e.Attribute(attribute) ? number(e, attribute, item) : otherwise;
}

}  // namespace graspfit::hands::internal
