# `find_package(kds)` for an installed copy. Headers go below include/kds, which becomes the include root, so that
# the folder names of the layers (structures, collision...) do not spread over the system's include directory.
include(CMakePackageConfigHelpers)

get_property(targets GLOBAL PROPERTY KDS_LAYER_TARGETS)
install(TARGETS ${targets} EXPORT kdsTargets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kds")

set(config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/kds")
install(EXPORT kdsTargets NAMESPACE kds:: DESTINATION "${config_dir}")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/kdsConfig.cmake.in" "${PROJECT_BINARY_DIR}/kdsConfig.cmake"
  INSTALL_DESTINATION "${config_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/kdsConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/kdsConfig.cmake" "${PROJECT_BINARY_DIR}/kdsConfigVersion.cmake"
  DESTINATION "${config_dir}")
