# Benchmarks beside what they measure: the harness's in benchmarks/, a method's in methods/METHOD/bench. A file is a
# subject of the program lodbench_benchmarks: tile_counts_benchmark.cpp has the function tile_counts_benchmark,
# and is run by the name tile-counts.

# lodbench_add_method_benchmarks(NAME [LIBRARIES target...]): the folder `bench` of a method, whose plugin of this name,
# where there is one, is built first.
function(lodbench_add_method_benchmarks name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LIBRARIES")
  if(NOT LODBENCH_BENCHMARKS)
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS bench/*.cpp)
  add_library(${name}_benchmarks OBJECT ${sources})
  target_include_directories(${name}_benchmarks PRIVATE ${PROJECT_SOURCE_DIR}/methods
                             ${PROJECT_SOURCE_DIR}/benchmarks)
  target_link_libraries(${name}_benchmarks PUBLIC ${arg_LIBRARIES} lodbench_run fmt::fmt PRIVATE lodbench_warnings)
  if(TARGET ${name})
    add_dependencies(${name}_benchmarks ${name})
  endif()
  lodbench_benchmark_subjects(${sources})
  set_property(GLOBAL APPEND PROPERTY LODBENCH_BENCHMARK_LIBRARIES ${name}_benchmarks)
endfunction()

# lodbench_benchmark_subjects(file...): makes every *_benchmark.cpp among them a subject.
function(lodbench_benchmark_subjects)
  foreach(source IN LISTS ARGN)
    if(source MATCHES "([a-z0-9_]+)_benchmark\\.cpp$")
      set_property(GLOBAL APPEND PROPERTY LODBENCH_BENCHMARK_SUBJECTS ${CMAKE_MATCH_1})
    endif()
  endforeach()
endfunction()
