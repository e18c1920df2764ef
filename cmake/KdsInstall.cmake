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

# kds::io reads mesh files by assimp, and tables of bodies by HDF5: only who asks for the component has to have these.
if(TARGET kds_io)
  install(TARGETS kds_io EXPORT kdsIoTargets
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT io
    FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kds" COMPONENT io)
  install(EXPORT kdsIoTargets NAMESPACE kds:: DESTINATION "${config_dir}" COMPONENT io)
  install(FILES "${CMAKE_CURRENT_LIST_DIR}/KdsHdf5.cmake" DESTINATION "${config_dir}" COMPONENT io)
endif()

# kds::mpi, for those who ask for the component: it is linked with MPI.
if(TARGET kds_mpi)
  install(TARGETS kds_mpi EXPORT kdsMpiTargets
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT mpi
    FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kds" COMPONENT mpi)
  install(EXPORT kdsMpiTargets NAMESPACE kds:: DESTINATION "${config_dir}" COMPONENT mpi)
endif()

# For programs that are not built by CMake: `pkg-config --cflags --libs kds`, or kds-turning.
# They may be moved with their folder.
file(RELATIVE_PATH to_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
foreach(package IN ITEMS kds kds-turning)
  configure_file("${CMAKE_CURRENT_LIST_DIR}/${package}.pc.in" "${PROJECT_BINARY_DIR}/${package}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${package}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT kds)
endforeach()

# Debian packages, of a build that is made: cpack --config build/release/CPackConfig.cmake
if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_CONTACT "the authors of kds")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENTS_ALL kds)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_COMPONENT_KDS_DESCRIPTION
    "Kinetic data structures and exact collision detection\n Headers and static libraries.")
  set(CPACK_DEBIAN_KDS_PACKAGE_NAME libkds-dev)
  set(CPACK_DEBIAN_KDS_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_KDS_PACKAGE_DEPENDS "libboost-dev (>= 1.74), libeigen3-dev (>= 3.4)")
  if(TARGET kds_io)
    list(APPEND CPACK_COMPONENTS_ALL io)
    set(CPACK_COMPONENT_IO_DESCRIPTION "Mesh files, scenes and replays for libkds-dev\n Headers and a static library.")
    set(CPACK_DEBIAN_IO_PACKAGE_NAME libkds-io-dev)
    set(CPACK_DEBIAN_IO_PACKAGE_SECTION libdevel)
    set(CPACK_DEBIAN_IO_PACKAGE_DEPENDS "libkds-dev (= ${PROJECT_VERSION}), libassimp-dev, zlib1g-dev, libhdf5-dev")
  endif()
  if(TARGET kds-collide)
    list(APPEND CPACK_COMPONENTS_ALL kds-collide)
    set(CPACK_COMPONENT_KDS-COLLIDE_DESCRIPTION "Exact collision detection of scenes of moving bodies\n A tool.")
    set(CPACK_DEBIAN_KDS-COLLIDE_PACKAGE_NAME kds-collide)
    set(CPACK_DEBIAN_KDS-COLLIDE_PACKAGE_SECTION science)
    set(CPACK_DEBIAN_KDS-COLLIDE_PACKAGE_SHLIBDEPS ON)
  endif()
  if(TARGET course_pages)
    list(APPEND CPACK_COMPONENTS_ALL course)
    set(CPACK_COMPONENT_COURSE_DESCRIPTION "A course on kinetic data structures\n Pages for a browser.")
    set(CPACK_DEBIAN_COURSE_PACKAGE_NAME libkds-doc)
    set(CPACK_DEBIAN_COURSE_PACKAGE_SECTION doc)
    set(CPACK_DEBIAN_COURSE_PACKAGE_ARCHITECTURE all)
  endif()
  include(CPack)
endif()
