# Functions that every module's CMakeLists.txt uses:
#
#   graspfit_add_module(name HEADERS ... FOLDERS ... SOURCES ... PUBLIC ... PRIVATE ...)
#   graspfit_target_defaults(target)      warnings and rounding, for programs and tests
#   graspfit_install_package()            once, at the end of the root CMakeLists.txt

include(CMakePackageConfigHelpers)

# Everything that checks a public header compiles alone; no part of the default build.
add_custom_target(header_check)

# Warnings and the rounding of our sources are private to our targets; warnings are errors in CI only.
function(graspfit_target_defaults target)
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align
    -Wunused -Wextra-semi
    # A product and a sum are rounded one by one, as error bounds assume, on processors with FMA too.
    -ffp-contract=off
    # GCC 12 warns of overlaps in std::string's own operator+ (its bug 105329).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    # GCC 13 and later take a reference to what a view points at for one to the view itself.
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-dangling-reference>
    # It takes the sources that a unity build includes for headers, whose anonymous namespaces would
    # be a mistake.
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>
    $<$<BOOL:${GRASPFIT_WARNINGS_AS_ERRORS}>:-Werror>)
  if(GRASPFIT_SANITIZE)
    # GCC 12 then takes std::regex for uninitialized (its bug 105562).
    target_compile_options(${target} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  endif()
endfunction()

# In a unity build, the sources of one folder are one batch.
function(graspfit_unity_folders target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS ARGN)
    if(IS_ABSOLUTE ${source})
      continue()  # generated
    endif()
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${folder}" group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${group}")
  endforeach()
endfunction()

# The static library graspfit_<name>, known as graspfit::<name> here and to whoever finds the
# installed package; without SOURCES an interface library.
#
#   HEADERS   public headers, relative to the module's folder: include/graspfit/<name>/x.hpp
#   FOLDERS   folders below src/, each of one topic, in the order of who may include whom: one
#             knows those before it (tests/repository/check_folders.py). A unity build compiles it
#             at once
#   SOURCES   src/<folder>/*.cpp, with their private headers beside them: "folder/x.hpp"
#   PUBLIC    libraries that the public headers show
#   PRIVATE   libraries that only sources use; their flags and headers do not reach users
#
# The headers are a file set: they are installed, and <name>_header_check compiles each one alone
# with nothing but what a user of the library would have.
function(graspfit_add_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;FOLDERS;SOURCES;PUBLIC;PRIVATE")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "graspfit_add_module(${name}): unknown argument ${arg_UNPARSED_ARGUMENTS}")
  endif()

  set(target graspfit_${name})
  if(arg_SOURCES)
    add_library(${target} STATIC)
    set(scope PUBLIC)
    graspfit_target_defaults(${target})
    target_sources(${target} PRIVATE ${arg_SOURCES})
    graspfit_unity_folders(${target} ${arg_SOURCES})
    target_include_directories(${target} PRIVATE src)
    target_link_libraries(${target} PRIVATE ${arg_PRIVATE})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(graspfit::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name}
    POSITION_INDEPENDENT_CODE ON
    VERIFY_INTERFACE_HEADER_SETS ON)
  target_compile_features(${target} ${scope} cxx_std_20)
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS include FILES ${arg_HEADERS})
  target_link_libraries(${target} ${scope} ${arg_PUBLIC})

  # CMake defines <target>_verify_interface_header_sets when it generates the build.
  add_custom_target(${name}_header_check)
  add_dependencies(${name}_header_check ${target}_verify_interface_header_sets)
  add_dependencies(header_check ${name}_header_check)

  install(TARGETS ${target} EXPORT graspfit_${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT graspfit_${name}
    FILE graspfit-${name}-targets.cmake
    NAMESPACE graspfit::
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/graspfit)

  # What graspfitConfig.cmake has to find before it loads this module: a static library asks its
  # user to link private libraries too.
  set(components "")
  set(packages "")
  foreach(library IN LISTS arg_PUBLIC arg_PRIVATE)
    if(library MATCHES "^graspfit::(.+)$")
      list(APPEND components ${CMAKE_MATCH_1})
    elseif(library STREQUAL "Eigen3::Eigen")
      list(APPEND packages "Eigen3 3.4 NO_MODULE")
    elseif(library STREQUAL "CGAL::CGAL")
      list(APPEND packages "CGAL 5.5")
    elseif(library STREQUAL "Boost::boost" OR library STREQUAL "Boost::headers")
      list(APPEND packages "Boost 1.74")
    elseif(library MATCHES "^Boost::(.+)$")
      list(APPEND packages "Boost 1.74 COMPONENTS ${CMAKE_MATCH_1}")
    elseif(library STREQUAL "mujoco::mujoco")
      list(APPEND packages "mujoco 2.2...<3")
    elseif(library STREQUAL "yaml-cpp::yaml-cpp")
      list(APPEND packages "yaml-cpp 0.7")
    elseif(library MATCHES "^OpenSSL::")
      list(APPEND packages "OpenSSL 3.0 COMPONENTS Crypto")
    elseif(library MATCHES "^([A-Za-z0-9_]+)::")
      list(APPEND packages "${CMAKE_MATCH_1}")
    else()
      message(FATAL_ERROR "graspfit_add_module(${name}): link ${library} by its imported target")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES packages)
  set_property(GLOBAL APPEND PROPERTY GRASPFIT_MODULES ${name})
  set_property(GLOBAL PROPERTY GRASPFIT_MODULE_COMPONENTS_${name} "${components}")
  set_property(GLOBAL PROPERTY GRASPFIT_MODULE_PACKAGES_${name} "${packages}")
endfunction()

# graspfitConfig.cmake for find_package(graspfit COMPONENTS geometry ...).
function(graspfit_install_package)
  get_property(modules GLOBAL PROPERTY GRASPFIT_MODULES)
  set(GRASPFIT_COMPONENT_TABLE "")
  foreach(module IN LISTS modules)
    get_property(components GLOBAL PROPERTY GRASPFIT_MODULE_COMPONENTS_${module})
    get_property(packages GLOBAL PROPERTY GRASPFIT_MODULE_PACKAGES_${module})
    string(APPEND GRASPFIT_COMPONENT_TABLE
      "set(_graspfit_${module}_components \"${components}\")\n"
      "set(_graspfit_${module}_packages \"${packages}\")\n")
  endforeach()
  set(GRASPFIT_COMPONENTS "${modules}")
  configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/graspfitConfig.cmake.in
    ${PROJECT_BINARY_DIR}/graspfitConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/graspfit
    NO_SET_AND_CHECK_MACRO)
  write_basic_package_version_file(
    ${PROJECT_BINARY_DIR}/graspfitConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES
    ${PROJECT_BINARY_DIR}/graspfitConfig.cmake
    ${PROJECT_BINARY_DIR}/graspfitConfigVersion.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/graspfit)
endfunction()
