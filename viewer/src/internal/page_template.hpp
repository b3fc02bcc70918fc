#pragma once

#include <string_view>

namespace graspfit::viewer {

// The files of viewer/page/, compiled in by viewer/page/embed.cmake. The first holds the places
// {{title}}, {{style}}, {{script}} and {{data}}.
extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;

}  // namespace graspfit::viewer
