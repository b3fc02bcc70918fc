#pragma once

#include <string>
#include <string_view>

namespace graspfit::viewer::internal {

// The files of viewer/page/, compiled in by viewer/page/embed.cmake: the template of a page with
// the placeholders {{title}}, {{style}}, {{shapes}}, {{stage}}, {{controls}}, {{script}} and
// {{data}}, and the texts that replace them.
extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kShapesJs;  // this and the next two stand before a page's own script
extern const std::string_view kStageJs;
extern const std::string_view kControlsJs;
extern const std::string_view kGraspSceneJs;  // before what the page of grasps says
extern const std::string_view kGraspsJs;
extern const std::string_view kHandJs;
extern const std::string_view kPlayerJs;  // before the script of a page that plays frames
extern const std::string_view kReplayJs;
extern const std::string_view kMotionJs;

// The parts in which pages differ.
struct PageParts {
  std::string_view title;  // plain text
  std::string script;      // after controls.js, in one function with it
  std::string_view data;   // JSON without "<"
};

// The script of a page that plays frames: first the part that such pages share, then the page's
// own.
std::string script_of_player(std::string_view script);

// The text with what means something to HTML replaced.
std::string escaped_for_html(std::string_view text);

// The text of a page, filled from the template.
std::string filled_page(const PageParts& parts);

}  // namespace graspfit::viewer::internal
