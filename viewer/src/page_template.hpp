#pragma once

#include <string>
#include <string_view>

namespace graspfit::viewer::internal {

// The files of viewer/page/, compiled in by viewer/page/embed.cmake: the frame of a page with the
// places {{title}}, {{style}}, {{stage}}, {{script}} and {{data}}, and what goes there.
extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kStageJs;  // before a page's own script
extern const std::string_view kGraspsJs;
extern const std::string_view kHandJs;
extern const std::string_view kPlayerJs;  // before the script of a page that plays frames
extern const std::string_view kReplayJs;
extern const std::string_view kMotionJs;

// What tells one page from another.
struct PageParts {
  std::string_view title;  // plain text
  std::string script;      // after stage.js, in one function with it
  std::string_view data;   // JSON without "<"
};

// The script of a page that plays frames: what such pages share, then its own.
std::string script_of_player(std::string_view script);

// The text of a page, with everything in it.
std::string filled_page(const PageParts& parts);

}  // namespace graspfit::viewer::internal
