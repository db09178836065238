# Files and destinations of `cmake --install`: the programs, core's libraries with their public headers, and the package for
# find_package(Evical). Included after all of core is declared.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

get_property(layers GLOBAL PROPERTY EVICAL_LAYERS)
list(TRANSFORM layers PREPEND evical_)

# All layers under one name.
add_library(evical_core INTERFACE)
add_library(evical::core ALIAS evical_core)
set_target_properties(evical_core PROPERTIES EXPORT_NAME core)
target_compile_features(evical_core INTERFACE cxx_std_20)
target_link_libraries(evical_core INTERFACE ${layers})

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/Evical")
install(TARGETS evical_core ${layers} EXPORT EvicalTargets
        ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
install(EXPORT EvicalTargets NAMESPACE evical:: DESTINATION "${package_folder}" COMPONENT development)
configure_package_config_file(cmake/EvicalConfig.cmake.in "${CMAKE_BINARY_DIR}/EvicalConfig.cmake"
                              INSTALL_DESTINATION "${package_folder}")
write_basic_package_version_file("${CMAKE_BINARY_DIR}/EvicalConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/EvicalConfig.cmake" "${CMAKE_BINARY_DIR}/EvicalConfigVersion.cmake"
              cmake/EvicalLibraries.cmake
        DESTINATION "${package_folder}" COMPONENT development)

# Determined at install time, so that the list is never outdated.
install(CODE "include(\"${CMAKE_SOURCE_DIR}/cmake/public_headers.cmake\")
  evical_public_headers(\"${CMAKE_SOURCE_DIR}\" headers)
  foreach(header IN LISTS headers)
    get_filename_component(folder \"\${header}\" DIRECTORY)
    file(INSTALL \"${CMAKE_SOURCE_DIR}/\${header}\"
         DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/evical/\${folder}\" TYPE FILE)
    list(APPEND folders \"\${folder}\")
  endforeach()
  # <evical/base/error.h> is core/base/error.h.
  list(TRANSFORM folders REPLACE \"^(core/[a-z]+)/.*\" \"\\\\1\")
  list(REMOVE_DUPLICATES folders)
  foreach(folder IN LISTS folders)
    if(folder MATCHES \"^core/([a-z]+)\$\")
      file(CREATE_LINK \"\${folder}\"
           \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/evical/\${CMAKE_MATCH_1}\" SYMBOLIC)
    endif()
  endforeach()" COMPONENT development)

install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT licence)  # packages: cmake/evical_packages.cmake
