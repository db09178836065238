# Libraries without a CMake package or a find module, as imported targets evical_external::NAME. The build and the installed
# EvicalConfig.cmake include this. Missing libraries are listed in evical_missing_libraries.
set(evical_missing_libraries "")

# evical_find_library(NAME HEADER LIBRARIES... [SUFFIXES folders...])
macro(evical_find_library name header)
  cmake_parse_arguments(evical_find "" "" "SUFFIXES" ${ARGN})
  find_path(EVICAL_${name}_INCLUDE_DIR ${header} PATH_SUFFIXES ${evical_find_SUFFIXES})
  find_library(EVICAL_${name}_LIBRARY NAMES ${evical_find_UNPARSED_ARGUMENTS})
  mark_as_advanced(EVICAL_${name}_INCLUDE_DIR EVICAL_${name}_LIBRARY)
  if(NOT EVICAL_${name}_INCLUDE_DIR OR NOT EVICAL_${name}_LIBRARY)
    list(APPEND evical_missing_libraries "${name} (${header})")
  elseif(NOT TARGET evical_external::${name})
    add_library(evical_external::${name} UNKNOWN IMPORTED GLOBAL)
    set_target_properties(evical_external::${name} PROPERTIES
      IMPORTED_LOCATION "${EVICAL_${name}_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${EVICAL_${name}_INCLUDE_DIR}")
  endif()
endmacro()

evical_find_library(lz4 lz4frame.h lz4)
evical_find_library(zstd zstd.h zstd)
# The serial build of HDF5; Debian has several builds.
evical_find_library(hdf5 hdf5.h hdf5_serial hdf5 SUFFIXES hdf5/serial)
evical_find_library(blosc blosc.h blosc)
evical_find_library(lzf liblzf/lzf.h lzf)
evical_find_library(apriltag apriltag/apriltag.h apriltag)
