# Writes OUTPUT, a C++ source that holds PAGE_DIR's files as string literals.
set(content "// Written by viewer/page/embed.cmake from viewer/page/; edit those.\n")
string(APPEND content "#include \"page_template.hpp\"\n\nnamespace graspfit::viewer::internal {\n")
foreach(file IN ITEMS page.html page.css shapes.js stage.js controls.js grasp_scene.js grasps.js hand.js player.js
        replay.js motion.js)
  file(READ ${PAGE_DIR}/${file} text)
  string(REGEX REPLACE "[._]" ";" words ${file})
  set(name "k")
  foreach(word IN LISTS words)
    string(SUBSTRING ${word} 0 1 first)
    string(SUBSTRING ${word} 1 -1 rest)
    string(TOUPPER ${first} first)
    string(APPEND name "${first}${rest}")
  endforeach()
  string(APPEND content
    "\nconst std::string_view ${name} = R\"graspfit_page(${text})graspfit_page\";\n")
endforeach()
string(APPEND content "\n}  // namespace graspfit::viewer::internal\n")
file(WRITE ${OUTPUT} "${content}")
