# What `cmake --install` puts where. Everything in it finds the rest relative to itself, so the whole may be
# moved: bin/lodbench, its plugins and data; and for find_package(lodbench) the interface of methods.
include(CMakePackageConfigHelpers)
set(include_subdir ${CMAKE_INSTALL_INCLUDEDIR}/lodbench)
set(package_subdir ${CMAKE_INSTALL_LIBDIR}/cmake/lodbench)

install(TARGETS lodbench EXPORT lodbench RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS lodbench_plugin EXPORT lodbench ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/lodbench)
install(DIRECTORY harness/api harness/gl DESTINATION ${include_subdir} FILES_MATCHING PATTERN *.h
        PATTERN host EXCLUDE)  # gl/host is the harness's own
install(FILES ${PROJECT_BINARY_DIR}/generated/api/abi_tag.h DESTINATION ${include_subdir}/api)
install(DIRECTORY shaders/common DESTINATION ${include_subdir})  # blocks.glsl is compiled as C++ too

install(DIRECTORY scenarios DESTINATION ${LODBENCH_DATA_SUBDIR})
install(DIRECTORY methods/template DESTINATION ${LODBENCH_DATA_SUBDIR})
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT lodbench NAMESPACE lodbench:: FILE LodbenchTargets.cmake DESTINATION ${package_subdir})
configure_package_config_file(cmake/LodbenchConfig.cmake.in
  ${PROJECT_BINARY_DIR}/generated/lodbenchConfig.cmake INSTALL_DESTINATION ${package_subdir})
# The version is a promise about sources; whether a built plugin fits is decided by its ABI tag.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/lodbenchConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/lodbenchConfig.cmake
              ${PROJECT_BINARY_DIR}/generated/lodbenchConfigVersion.cmake
              cmake/LodbenchMethod.cmake cmake/EmbedShaders.cmake cmake/plugin.map
        DESTINATION ${package_subdir})
