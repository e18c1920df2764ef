# `find_package(kds)` for an installed copy. Headers go below include/kds, which becomes the include root, so that
# the folder names of the layers (structures, collision...) do not spread over the system's include directory.
include(CMakePackageConfigHelpers)

set(config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/kds")
get_property(targets GLOBAL PROPERTY KDS_LAYER_TARGETS)
list(REMOVE_ITEM targets kds_gsl)
list(APPEND targets kds_collision_turning)
if(KDS_BUILD_SPLINES)
  list(APPEND targets kds_collision_splines)
endif()
install(TARGETS ${targets} EXPORT kdsTargets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT kds
  FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kds" COMPONENT kds)
install(EXPORT kdsTargets NAMESPACE kds:: DESTINATION "${config_dir}" COMPONENT kds)
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/kdsConfig.cmake.in" "${PROJECT_BINARY_DIR}/kdsConfig.cmake"
  INSTALL_DESTINATION "${config_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/kdsConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/kdsConfig.cmake" "${PROJECT_BINARY_DIR}/kdsConfigVersion.cmake"
  DESTINATION "${config_dir}" COMPONENT kds)

# What is linked with the GSL is installed only by who asks for it (cmake --install ... --component gsl), and found only
# by who asks for it: so its licence concerns nobody else, and nobody else has to build it.
if(TARGET kds_gsl)
  install(TARGETS kds_gsl EXPORT kdsGslTargets
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT gsl EXCLUDE_FROM_ALL
    FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kds" COMPONENT gsl EXCLUDE_FROM_ALL)
  install(EXPORT kdsGslTargets NAMESPACE kds:: DESTINATION "${config_dir}" COMPONENT gsl EXCLUDE_FROM_ALL)
endif()
