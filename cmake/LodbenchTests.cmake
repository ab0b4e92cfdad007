# Tests beside what they test: a room's in tests/ROOM, a method's in methods/METHOD/tests. One executable a folder
# and label, one process a test.
if(NOT LODBENCH_TESTS)
  function(lodbench_tests)
  endfunction()
  function(lodbench_add_method_tests)
  endfunction()
  function(lodbench_add_conformance_test)
  endfunction()
  return()
endif()
find_package(GTest REQUIRED)
include(GoogleTest)

# lodbench_tests(NAME [FOLDER folder] [LABEL label] [INCLUDES folder...] [LIBRARIES target...]): every *_test.cpp of
# the folder (NAME). The end of a file's name is its label: *_gl_test.cpp draws, *_cli_test.cpp runs the program,
# *_conformance_test.cpp holds methods to their promises; all others have LABEL (unit). *_slow_test.cpp is labelled
# LABEL_slow, and runs with `scripts/test --all`.
function(lodbench_tests name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "FOLDER;LABEL" "INCLUDES;LIBRARIES")
  if(NOT arg_FOLDER)
    set(arg_FOLDER ${name})
  endif()
  if(NOT arg_LABEL)
    set(arg_LABEL unit)
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${arg_FOLDER}/*_test.cpp)
  set(labels "")
  foreach(source IN LISTS sources)
    set(label ${arg_LABEL})
    if(source MATCHES "_(gl|cli|conformance)(_slow)?_test\\.cpp$")
      set(label ${CMAKE_MATCH_1})
    endif()
    if(source MATCHES "_slow_test\\.cpp$")
      # gtest_discover_tests takes no list: one label, which -L gl, -L slow and -LE slow all find in.
      string(APPEND label _slow)
    endif()
    list(APPEND labels ${label})
    list(APPEND sources_${label} ${source})
  endforeach()
  list(REMOVE_DUPLICATES labels)
  foreach(label IN LISTS labels)
    string(REGEX REPLACE "^${arg_LABEL}_?" "" half ${label})
    string(JOIN _ program ${name} ${half} test)
    add_executable(${program} ${sources_${label}})
    # Where `run/locations` knows it for a program of the build.
    set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
    add_dependencies(${program} lodbench_under_test)
    target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR}/tests ${arg_INCLUDES})
    target_link_libraries(${program} PRIVATE ${arg_LIBRARIES} lodbench_reproduce lodbench_extremes lodbench_conformance lodbench_plugin
                          PkgConfig::jsoncpp GTest::gmock GTest::gtest_main lodbench_warnings)
    target_compile_definitions(${program} PRIVATE
      $<$<BOOL:${LODBENCH_WITH_GDAL}>:LODBENCH_WITH_GDAL>
      $<$<BOOL:${LODBENCH_WITH_OIIO}>:LODBENCH_WITH_OIIO>
      $<$<BOOL:${LODBENCH_WITH_WEBP}>:LODBENCH_WITH_WEBP>
      LODBENCH_BINARY="${CMAKE_BINARY_DIR}/bin/lodbench"
      LODBENCH_PLUGINS="${LODBENCH_PLUGIN_OUTPUT_DIRECTORY}"
      LODBENCH_BUILD_DIR="${CMAKE_BINARY_DIR}"
      LODBENCH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    gtest_discover_tests(${program} TEST_PREFIX "${program}." DISCOVERY_MODE PRE_TEST
                         PROPERTIES LABELS "${label}" TIMEOUT 600)
  endforeach()
  set_property(GLOBAL APPEND PROPERTY LODBENCH_TEST_SOURCES ${sources})
endfunction()

# lodbench_add_method_tests(NAME [LIBRARIES target...]): those of the folder `tests` of the method's own.
function(lodbench_add_method_tests name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LIBRARIES")
  lodbench_tests(${name} FOLDER ${CMAKE_CURRENT_SOURCE_DIR}/tests INCLUDES ${PROJECT_SOURCE_DIR}/methods
                 LIBRARIES ${arg_LIBRARIES})
endfunction()

# lodbench_add_conformance_test(PLUGIN NAME METHOD.PARAM=VALUE...): the suite once more, conformance.PLUGIN.NAME, with
# settings that change what is drawn and that no default covers.
function(lodbench_add_conformance_test plugin name)
  set(settings ${ARGN})
  list(TRANSFORM settings PREPEND "--set;")
  add_test(NAME conformance.${plugin}.${name} COMMAND lodbench validate $<TARGET_FILE:${plugin}> ${settings})
  set_tests_properties(conformance.${plugin}.${name} PROPERTIES LABELS conformance TIMEOUT 1800)
endfunction()

# A test in a folder that nobody builds would be no test.
function(lodbench_require_all_tests_built)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/*_test.cpp
       ${PROJECT_SOURCE_DIR}/methods/*_test.cpp)
  get_property(built GLOBAL PROPERTY LODBENCH_TEST_SOURCES)
  list(REMOVE_ITEM sources ${built})
  if(sources)
    list(JOIN sources "\n  " sources)
    message(FATAL_ERROR "tests in a folder that is not built; move them to tests/ROOM or to the folder `tests` of a "
                        "method that calls lodbench_add_method_tests:\n  ${sources}")
  endif()
endfunction()
