#include "page_template.hpp"

#include <initializer_list>
#include <utility>

namespace graspfit::viewer::internal {

std::string escaped_for_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

namespace {

using Replacements = std::initializer_list<std::pair<std::string_view, std::string_view>>;

// Fills a template in one pass: texts that replace placeholders are never searched for
// placeholders.
std::string filled(std::string_view rest, const Replacements& replacements) {
  std::string html;
  while (!rest.empty()) {
    const std::size_t brace = rest.find("{{");
    html += rest.substr(0, brace);
    if (brace == std::string_view::npos) break;
    rest.remove_prefix(brace);
    bool is_placeholder = false;
    for (const auto& [placeholder, text] : replacements) {
      if (!rest.starts_with(placeholder)) continue;
      html += text;
      rest.remove_prefix(placeholder.size());
      is_placeholder = true;
      break;
    }
    if (!is_placeholder) {
      html += "{{";
      rest.remove_prefix(2);
    }
  }
  return html;
}

}  // namespace

std::string script_of_player(std::string_view script) {
  return std::string(kPlayerJs).append(script);
}

std::string filled_page(const PageParts& parts) {
  const std::string title = escaped_for_html(parts.title);
  return filled(kPageHtml, {{"{{title}}", title},
                            {"{{style}}", kPageCss},
                            {"{{shapes}}", kShapesJs},
                            {"{{stage}}", kStageJs},
                            {"{{controls}}", kControlsJs},
                            {"{{script}}", parts.script},
                            {"{{data}}", parts.data}});
}

}  // namespace graspfit::viewer::internal
