# Debian packages only; the list that installs them is scripts/packages.
find_package(PkgConfig REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS OpenGL EGL)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
if(LODBENCH_SANITIZE MATCHES thread)
  # Loops of plain threads, which ThreadSanitizer sees through; see the header.
  include_directories(BEFORE ${CMAKE_CURRENT_LIST_DIR}/../tests/sanitizers/threads)
endif()
find_package(CLI11 REQUIRED)
find_package(PNG REQUIRED)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET GLOBAL tomlplusplus)
pkg_check_modules(jsoncpp REQUIRED IMPORTED_TARGET GLOBAL jsoncpp)
pkg_check_modules(stb REQUIRED IMPORTED_TARGET GLOBAL stb)
# The font of the pictures' text, which is built into the program.
find_file(LODBENCH_FONT DejaVuSans.ttf PATHS /usr/share/fonts PATH_SUFFIXES truetype/dejavu dejavu REQUIRED)
# The plots of the report, which are built into the program too.
find_file(LODBENCH_CHART_JS chart.min.js PATHS /usr/share/javascript PATH_SUFFIXES chart.js NO_DEFAULT_PATH)
if(NOT LODBENCH_CHART_JS)
  message(FATAL_ERROR "chart.min.js was not found below /usr/share/javascript: install Debian's package "
                      "libjs-chart.js, or name the file of Chart.js 3 with -DLODBENCH_CHART_JS=FILE")
endif()
if(LODBENCH_WITH_GDAL)
  find_package(GDAL REQUIRED)
endif()
if(LODBENCH_WITH_OIIO)
  # Its CMake package names programs that Debian ships apart (openimageio-tools); pkg-config does not.
  pkg_check_modules(oiio REQUIRED IMPORTED_TARGET GLOBAL OpenImageIO)
endif()
if(LODBENCH_WITH_WEBP)
  pkg_check_modules(webp REQUIRED IMPORTED_TARGET GLOBAL libwebp)
endif()
