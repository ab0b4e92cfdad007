# A method outside the tree: installs lodbench into a prefix, moves that prefix, and there writes, builds,
# validates and flies a new method with nothing but what was installed.
#
# cmake -DBUILD_DIR=... -DGENERATOR=... -P out_of_tree.cmake

# Not in the build tree, where the program would use the build's own plugins.
set(temporary $ENV{TMPDIR})
if(NOT temporary)
  set(temporary /tmp)
endif()
string(RANDOM LENGTH 8 suffix)
set(WORK_DIR ${temporary}/lodbench-out-of-tree-${suffix})

function(stop message)
  file(REMOVE_RECURSE ${WORK_DIR})
  message(FATAL_ERROR "${message}")
endfunction()
# step(WHAT command...): runs it in WORK_DIR, and gives its output as `output`.
function(step what)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK_DIR} RESULT_VARIABLE status
                  OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT status EQUAL 0)
    stop("${what}: exit status ${status}\n${text}")
  endif()
  set(output "${text}" PARENT_SCOPE)
endfunction()

file(MAKE_DIRECTORY ${WORK_DIR})
step("install" ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/installed)
file(RENAME ${WORK_DIR}/installed ${WORK_DIR}/moved)
set(lodbench ${WORK_DIR}/moved/bin/lodbench)

file(GLOB_RECURSE host_headers ${WORK_DIR}/moved/include/*/gl/host/*)
if(host_headers OR NOT EXISTS ${WORK_DIR}/moved/include/lodbench/gl/device.h)
  stop("expected the headers of plugins, gl/device.h among them, and none of gl/host; found of the latter: ${host_headers}")
endif()

step("list of the installed methods" ${lodbench} list --json)
if(NOT output MATCHES "\"id\":\"template\"" OR NOT output MATCHES "${WORK_DIR}/moved/.*/template_method.so")
  stop("the installed program does not find its own plugins:\n${output}")
endif()

# Files that the two reader modules of the prefix read.
load_cache(${BUILD_DIR} READ_WITH_PREFIX built_ LODBENCH_WITH_GDAL LODBENCH_WITH_OIIO)
function(expect_terrain what file)
  step("${what}" ${lodbench} terrain info ${file})
  foreach(line IN LISTS ARGN)
    if(NOT output MATCHES "${line}")
      stop("${what}: expected ${line} in\n${output}")
    endif()
  endforeach()
endfunction()
if(built_LODBENCH_WITH_OIIO)
  file(GLOB_RECURSE puget ${WORK_DIR}/moved/share/*/puget_sound_1025_160m.png)
  expect_terrain("PNG read by the installed program" "${puget}" "through OpenImageIO"
                 "1025 rows x 1025 columns" "160 m east" "voids +0 filled")
endif()
if(built_LODBENCH_WITH_GDAL)
  file(WRITE ${WORK_DIR}/small.asc "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 25\n"
                                   "NODATA_value -9999\n1 2 3\n4 -9999 6\n")
  expect_terrain("elevation model read by the installed program" ${WORK_DIR}/small.asc "through GDAL"
                 "2 rows x 3 columns" "25 m east" "voids +1 filled")
endif()

step("new-method" ${lodbench} new-method hello)
step("configure" ${CMAKE_COMMAND} -S ${WORK_DIR}/hello -B ${WORK_DIR}/hello/build -G ${GENERATOR}
     -DCMAKE_PREFIX_PATH=${WORK_DIR}/moved)
step("build" ${CMAKE_COMMAND} --build ${WORK_DIR}/hello/build)

step("list of the new method" ${lodbench} list --json --plugin-dir ${WORK_DIR}/hello/build)
if(NOT output MATCHES "\"id\":\"hello\"")
  stop("the new method is not listed:\n${output}")
endif()
step("promises of the new method" ${lodbench} validate ${WORK_DIR}/hello/build/hello.so)
step("flight of the new method" ${lodbench} run --plugin-dir ${WORK_DIR}/hello/build --method hello
     --frames 3 --size 64x48 --repeat 1 --out ${WORK_DIR}/results)
file(READ ${WORK_DIR}/results/cells.jsonl cells)
if(NOT cells MATCHES "\"status\" *: *\"ok\"")
  stop("the new method did not fly:\n${cells}")
endif()
file(REMOVE_RECURSE ${WORK_DIR})
