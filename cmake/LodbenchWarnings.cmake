# Warnings as a target: link lodbench_warnings (PRIVATE) and get them all.
add_library(lodbench_warnings INTERFACE)
target_compile_options(lodbench_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align=strict
  -Wnull-dereference -Wduplicated-cond -Wlogical-op -Wimplicit-fallthrough -Wextra-semi
  $<$<BOOL:${LODBENCH_WERROR}>:-Werror>
  # What it finds depends on what was inlined, and is wrong at times: std::vector's first element in GCC 12.
  $<$<BOOL:${LODBENCH_WERROR}>:-Wno-error=null-dereference>)
# GCC 12 sees overlaps in std::string's operator+ that are not there (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(lodbench_warnings INTERFACE -Wno-restrict)
endif()

# Contraction of a*b+c into one rounding would make results depend on the compiler's mood.
add_compile_options(-ffp-contract=off)
if(LODBENCH_SANITIZE)
  # What a sanitizer finds ends the program: a finding that is only printed fails no test.
  add_compile_options(-fsanitize=${LODBENCH_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${LODBENCH_SANITIZE})
endif()
if(LODBENCH_FUZZ)
  # So that libFuzzer sees which way the code went.
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
