# Writes OUTPUT, a C++ source that holds PAGE_DIR's three files as string literals.
set(content "// Written by viewer/page/embed.cmake from viewer/page/; edit those.\n")
string(APPEND content "#include \"internal/page_template.hpp\"\n\nnamespace graspfit::viewer {\n")
foreach(part IN ITEMS Html Css Js)
  string(TOLOWER ${part} extension)
  file(READ ${PAGE_DIR}/page.${extension} text)
  string(APPEND content
    "\nconst std::string_view kPage${part} = R\"graspfit_page(${text})graspfit_page\";\n")
endforeach()
string(APPEND content "\n}  // namespace graspfit::viewer\n")
file(WRITE ${OUTPUT} "${content}")
