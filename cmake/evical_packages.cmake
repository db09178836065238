# Debian packages, which packaging/packages.sh builds. Each component is a package; python3-evical is built if the
# build has a component `python`. Included last, when all components are known.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME evical)
set(CPACK_PACKAGE_CONTACT "The Evical authors <maintainers@users.noreply.h-seed-5b56ef5e.example>")
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY "${CMAKE_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES ON)
# Checks the tools and sets the files' time, then adds what install() does not do: compression, licences of linked libraries.
set(CPACK_PROJECT_CONFIG_FILE "${CMAKE_SOURCE_DIR}/packaging/debian/before_packing.cmake")
set(CPACK_PRE_BUILD_SCRIPTS "${CMAKE_SOURCE_DIR}/packaging/debian/finish_packages.cmake")
set(CPACK_EVICAL_SOURCE "${CMAKE_SOURCE_DIR}")

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SOURCE evical)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# evical_package(COMPONENT NAME SECTION SUMMARY TEXT...): TEXT's lines are those of the package's description.
function(evical_package component name section summary)
  string(TOUPPER "${component}" upper)
  list(JOIN ARGN "\n" text)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME "${name}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION "${section}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ON PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} "${component}" PARENT_SCOPE)
endfunction()

set(about "Evical estimates rotation, translation and time offset of event cameras,"
          "frame cameras and IMUs, each with a standard deviation, from one recording"
          "of a printed board that is moved by hand." "")
set(CPACK_COMPONENTS_ALL "")
evical_package(command_line evical science "calibrates event cameras and IMUs (command line)"
  ${about} "This package has the command line, which needs no display.")
evical_package(development libevical-dev libdevel "calibrates event cameras and IMUs (library)"
  ${about} "This package has the C++ library: headers, static libraries, and the package" "that CMake finds as Evical.")
# Libraries that find_package(Evical) requires: cmake/EvicalConfig.cmake.in.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libapriltag-dev, libblosc-dev, libbz2-dev, libceres-dev (>= 2.1), libeigen3-dev (>= 3.4), \
libfmt-dev, libhdf5-dev, liblz4-dev, liblzf-dev, libopencv-dev, libpng-dev, libsqlite3-dev, libyaml-cpp-dev, libzstd-dev, \
nlohmann-json3-dev, zlib1g-dev")
if(EVICAL_GUI)
  evical_package(desktop evical-gui science "calibrates event cameras and IMUs (desktop program)"
    ${about} "This package has the desktop program, which shows why a result can be trusted.")
  set(CPACK_DEBIAN_DESKTOP_PACKAGE_RECOMMENDS "evical, fonts-inter")
endif()
get_cmake_property(components COMPONENTS)
if("python" IN_LIST components)
  evical_package(python python3-evical python "calibrates event cameras and IMUs (Python)"
    ${about} "This package has the Python module evical.")
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
endif()

set(debian packaging/debian)
file(READ ${debian}/lintian-overrides.in overrides)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER "${component}" upper)
  set(package "${CPACK_DEBIAN_${upper}_PACKAGE_NAME}")
  set(folder "${CMAKE_INSTALL_DATADIR}/doc/${package}")
  string(CONFIGURE "${overrides}" text @ONLY)
  file(WRITE "${CMAKE_BINARY_DIR}/lintian/${package}" "${text}")
  install(FILES "${CMAKE_BINARY_DIR}/lintian/${package}" DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides"
          COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES CHANGELOG.md RENAME changelog DESTINATION "${folder}" COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${debian}/changelog RENAME changelog.Debian DESTINATION "${folder}" COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${debian}/copyright.in RENAME copyright DESTINATION "${folder}" COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
