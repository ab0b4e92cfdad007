# lodbench_add_method(NAME SOURCES file... [SHADERS file...] [LIBRARIES target...])
#
# Builds the plugin NAME.so. Shaders are embedded: each is known by its path relative to the folder of
# the CMakeLists.txt that calls this, and `lodbench::embedded_shaders()` gives them to gl::Program.
# Used in this tree and, after find_package(lodbench), outside it.

set(LODBENCH_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/EmbedShaders.cmake)
set(LODBENCH_VERSION_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/plugin.map)

function(lodbench_embed_shaders target function base)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders.cpp)
  string(REPLACE ";" "," files "${ARGN}")
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DFUNCTION=${function} -DBASE=${base}
            -DFILES=${files} -P ${LODBENCH_EMBED_SCRIPT}
    DEPENDS ${ARGN} ${LODBENCH_EMBED_SCRIPT}
    COMMENT "Embedding the shaders of ${target}" VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()

function(lodbench_add_method name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;SHADERS;LIBRARIES")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_SOURCES)
    message(FATAL_ERROR "lodbench_add_method(${name}): expected SOURCES file... [SHADERS file...] "
                        "[LIBRARIES target...], found '${arg_UNPARSED_ARGUMENTS}'")
  endif()
  add_library(${name} MODULE ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden
                        VISIBILITY_INLINES_HIDDEN ON)
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_link_libraries(${name} PRIVATE lodbench::plugin ${arg_LIBRARIES})
  # A plugin with a missing symbol is found when it is built, not when it is loaded; one exported symbol.
  if(LODBENCH_SANITIZE)
    target_compile_options(${name} PRIVATE -fsanitize=${LODBENCH_SANITIZE} -fno-sanitize-recover=all
                           -fno-omit-frame-pointer)
    target_link_options(${name} PRIVATE -fsanitize=${LODBENCH_SANITIZE})
  else()
    target_link_options(${name} PRIVATE LINKER:--no-undefined)
  endif()
  target_compile_options(${name} PRIVATE -ffp-contract=off)  # as the harness is compiled
  target_link_options(${name} PRIVATE LINKER:--version-script=${LODBENCH_VERSION_SCRIPT})
  set(shaders ${arg_SHADERS})
  list(TRANSFORM shaders PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  lodbench_embed_shaders(${name} lodbench::embedded_shaders ${CMAKE_CURRENT_SOURCE_DIR} ${shaders})
  if(TARGET lodbench_warnings)
    target_link_libraries(${name} PRIVATE lodbench_warnings)
  endif()
  if(LODBENCH_PLUGIN_OUTPUT_DIRECTORY)
    set_target_properties(${name} PROPERTIES
      LIBRARY_OUTPUT_DIRECTORY ${LODBENCH_PLUGIN_OUTPUT_DIRECTORY})
  endif()
  if(LODBENCH_PLUGIN_SUBDIR)
    set_property(GLOBAL APPEND PROPERTY LODBENCH_OWN_PLUGINS ${name})
    install(TARGETS ${name} LIBRARY DESTINATION ${LODBENCH_PLUGIN_SUBDIR})
  endif()
endfunction()
