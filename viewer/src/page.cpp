#include "graspfit/viewer/page.hpp"

#include <string_view>
#include <utility>

#include "graspfit/geometry/atomic_file.hpp"
#include "internal/page_data.hpp"
#include "internal/page_template.hpp"

namespace graspfit::viewer {
namespace {

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

}  // namespace

std::string page_html(const PageInput& input) {
  const std::string title = escaped_for_html(input.title);
  const std::string data = page_data(input);
  const std::pair<std::string_view, std::string_view> places[] = {
      {"{{title}}", title}, {"{{style}}", kPageCss}, {"{{script}}", kPageJs}, {"{{data}}", data}};

  // One pass over the template: what is put in is never searched for places.
  std::string html;
  html.reserve(kPageHtml.size() + kPageCss.size() + kPageJs.size() + data.size() + title.size());
  std::string_view rest = kPageHtml;
  while (!rest.empty()) {
    const std::size_t brace = rest.find("{{");
    html += rest.substr(0, brace);
    if (brace == std::string_view::npos) break;
    rest.remove_prefix(brace);
    bool is_place = false;
    for (const auto& [place, text] : places) {
      if (!rest.starts_with(place)) continue;
      html += text;
      rest.remove_prefix(place.size());
      is_place = true;
      break;
    }
    if (!is_place) {
      html += "{{";
      rest.remove_prefix(2);
    }
  }
  return html;
}

void write_page(const std::filesystem::path& file, const PageInput& input) {
  geometry::write_file_atomically(file, page_html(input));
}

}  // namespace graspfit::viewer
