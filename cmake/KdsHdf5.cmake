# HDF5's C library as the target kds_hdf5, or KDS_HDF5_FOUND is false. CMake's own FindHDF5 compiles C for this, and
# neither kds nor who uses it needs to have enabled that language.
find_path(KDS_HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/serial DOC "Folder of hdf5.h")
find_library(KDS_HDF5_LIBRARY NAMES hdf5 hdf5_serial PATH_SUFFIXES hdf5/serial DOC "HDF5's C library")
set(KDS_HDF5_FOUND FALSE)
if(KDS_HDF5_INCLUDE_DIR AND KDS_HDF5_LIBRARY)
  set(KDS_HDF5_FOUND TRUE)
  if(NOT TARGET kds_hdf5)
    add_library(kds_hdf5 UNKNOWN IMPORTED GLOBAL)
    set_target_properties(kds_hdf5 PROPERTIES IMPORTED_LOCATION "${KDS_HDF5_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${KDS_HDF5_INCLUDE_DIR}")
  endif()
endif()
