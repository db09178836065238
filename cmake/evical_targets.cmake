# Common settings of all targets: language level, warnings, ccache; and the functions that define libraries and tests.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
# Release builds: -O1, and -O3 for code that processes recordings (evical_optimise). Reports, commands and windows gain nothing
# from -O3 and take longer to compile.
set(CMAKE_CXX_FLAGS_RELEASE "-O1 -fno-math-errno -fno-trapping-math")

find_program(EVICAL_CCACHE ccache)
if(EVICAL_CCACHE)
  # Settings of ccache: those that precompiled headers require; paths relative to the build folder, so that another checkout
  # (a second work tree, CI) reuses this one's objects; precompiled headers are read once, not for each source.
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}"
      CCACHE_NOHASHDIR=1 CCACHE_INODECACHE=1 "${EVICAL_CCACHE}")
endif()

# moc reads every included header for macros that none of our headers defines. Without include folders its output is the
# same, in a fortieth of the time.
find_package(Qt6 QUIET COMPONENTS Core)
if(UNIX AND TARGET Qt6::moc)
  get_target_property(evical_moc Qt6::moc IMPORTED_LOCATION)
  configure_file(cmake/moc_alone.sh.in "${CMAKE_BINARY_DIR}/moc_alone.sh" @ONLY FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
endif()
function(evical_use_moc target)
  set_target_properties(${target} PROPERTIES AUTOMOC ON)
  if(EXISTS "${CMAKE_BINARY_DIR}/moc_alone.sh")
    set_target_properties(${target} PROPERTIES AUTOMOC_EXECUTABLE "${CMAKE_BINARY_DIR}/moc_alone.sh")
  endif()
endfunction()

# This linker needs a tenth of the default linker's time for the tests.
find_program(EVICAL_MOLD mold)
if(EVICAL_MOLD AND NOT (CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 12.1))
  add_link_options(-fuse-ld=mold)
endif()

# Only libraries that are used: static libraries name those of their dependencies, too.
if(UNIX AND NOT APPLE)
  add_link_options(-Wl,--as-needed)
endif()

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED)

add_library(evical_warnings INTERFACE)
target_compile_options(evical_warnings INTERFACE -Wall -Wextra -Wconversion -Wno-sign-conversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # With precompiled headers, GCC 12 raises these falsely inside std::string (its bugs 105329 and 105651), and GCC 14 the last
  # one inside Eigen's views by indices.
  target_compile_options(evical_warnings INTERFACE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
  # At -O1 GCC cannot track the contents of std::optional and of Eigen's small matrices.
  target_compile_options(evical_warnings INTERFACE $<$<CONFIG:Release>:-Wno-maybe-uninitialized>)
endif()
if(EVICAL_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(evical_warnings INTERFACE -Wshadow=local  # a local name may be one of a neighbouring source
                         -Wno-subobject-linkage)  # sources count as headers
elseif(NOT EVICAL_UNITY)
  target_compile_options(evical_warnings INTERFACE -Wshadow)
endif()
if(EVICAL_WARNINGS_AS_ERRORS)
  target_compile_options(evical_warnings INTERFACE -Werror)
endif()

# evical_optimise(TARGET): -O3 in release builds, for loops over events, samples, pixels and knots. In debug builds they
# have -O1: at -O0 nine tests of the front end needed more than 100 s.
function(evical_optimise target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O3> $<$<CONFIG:Debug>:-O1>)
endfunction()

# evical_unite(TARGET [BATCH]): with EVICAL_UNITY several sources are compiled as one unit, since most of a source's compile time
# goes into headers and templates that its neighbours need, too. Therefore no two sources of a folder may define the same name,
# not even in unnamed namespaces. Batches of more than 12 sources gain nothing: GCC's time per template grows with their number.
# If most templates are Eigen's, 7 is better.
function(evical_unite target)
  if(EVICAL_UNITY)
    set(batch 12)
    if(ARGC GREATER 1)
      set(batch ${ARGV1})
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
  endif()
endfunction()

# evical_precompile(NAME HEADERS... [LIBS...]): headers that many sources of one kind begin with, compiled once. A target uses
# them by evical_use_precompiled(TARGET NAME). It must link the same libraries, since macros must agree. Unity units do not need
# this: they read each header once for many sources.
function(evical_precompile name)
  if(EVICAL_UNITY)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBS" ${ARGN})
  file(WRITE "${CMAKE_BINARY_DIR}/precompiled/${name}.cpp" "")
  add_library(${name} OBJECT "${CMAKE_BINARY_DIR}/precompiled/${name}.cpp")
  target_link_libraries(${name} PRIVATE Eigen3::Eigen Threads::Threads evical_warnings ${ARG_LIBS})
  target_precompile_headers(${name} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory>
                            <optional> <span> <string> <vector> <Eigen/Core> <Eigen/Geometry> ${ARG_HEADERS})
endfunction()

function(evical_use_precompiled target name)
  if(NOT EVICAL_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()

# evical_make_shareable(TARGET): position-independent code, since it is also linked into the Python module, a shared object.
# Without interposition this has no cost elsewhere.
function(evical_make_shareable target)
  if(EVICAL_PYTHON)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_options(${target} PRIVATE -fno-semantic-interposition)
  endif()
endfunction()

find_package(Ceres 2.1 REQUIRED)
find_package(fmt 9 REQUIRED)
evical_precompile(evical_headers)
evical_precompile(evical_headers_fmt HEADERS <fmt/format.h> LIBS fmt::fmt)
evical_precompile(evical_headers_ceres HEADERS <fmt/format.h> <Eigen/Cholesky> <Eigen/Eigenvalues> <ceres/manifold.h>
                  <ceres/problem.h> <ceres/sized_cost_function.h> <ceres/solver.h> <ceres/sphere_manifold.h>
                  LIBS Ceres::ceres fmt::fmt)
foreach(headers evical_headers evical_headers_fmt evical_headers_ceres)
  if(TARGET ${headers})
    evical_make_shareable(${headers})
  endif()
endforeach()

# evical_add_layer(NAME [FAST] [NOT_INSTALLED] SOURCES... [PUBLIC libs...] [PRIVATE libs...] [HEADERS precompiled]): one library
# per folder of core. FAST: code that processes recordings.
function(evical_add_layer name)
  cmake_parse_arguments(ARG "FAST;NOT_INSTALLED" "HEADERS" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(evical_${name} STATIC ${ARG_SOURCES})
  add_library(evical::${name} ALIAS evical_${name})
  set_target_properties(evical_${name} PROPERTIES EXPORT_NAME ${name})
  if(NOT ARG_NOT_INSTALLED)
    set_property(GLOBAL APPEND PROPERTY EVICAL_LAYERS ${name})  # cmake/evical_install.cmake
  endif()
  target_include_directories(evical_${name} PUBLIC "$<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>"
                                                   "$<INSTALL_INTERFACE:include>" "$<INSTALL_INTERFACE:include/evical>")
  target_link_libraries(evical_${name} PUBLIC Eigen3::Eigen Threads::Threads ${ARG_PUBLIC}
                                       PRIVATE $<BUILD_INTERFACE:evical_warnings> ${ARG_PRIVATE})
  if(NOT ARG_HEADERS STREQUAL "evical_headers_ui")
    evical_make_shareable(evical_${name})
  endif()
  if(NOT ARG_HEADERS AND "Ceres::ceres" IN_LIST ARG_PRIVATE)
    set(ARG_HEADERS evical_headers_ceres)
  elseif(NOT ARG_HEADERS AND "fmt::fmt" IN_LIST ARG_PRIVATE)
    set(ARG_HEADERS evical_headers_fmt)
  elseif(NOT ARG_HEADERS)
    set(ARG_HEADERS evical_headers)
  endif()
  evical_use_precompiled(evical_${name} ${ARG_HEADERS})
  if(ARG_FAST)
    evical_optimise(evical_${name})
    evical_unite(evical_${name} 7)
  else()
    evical_unite(evical_${name})
  endif()
endfunction()

# evical_add_ui_layer(NAME SOURCES... [PUBLIC libs...] [PRIVATE libs...]): one library per folder of ui, with Qt's moc.
function(evical_add_ui_layer name)
  evical_add_layer(ui_${name} ${ARGN} HEADERS evical_headers_ui)
  evical_use_moc(evical_ui_${name})
  set_target_properties(evical_ui_${name} PROPERTIES AUTORCC ON)
  target_link_libraries(evical_ui_${name} PUBLIC Qt6::Widgets)
endfunction()

# evical_add_test_program(NAME HEADERS SOURCES LIBS...): the tests of a folder in one program, and a ctest entry for each
# source tst_*.cpp among them, which must end in EVICAL_TEST (tests/support/test_program.h).
function(evical_add_test_program name)
  cmake_parse_arguments(ARG "WINDOWS" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES} "${CMAKE_SOURCE_DIR}/tests/support/test_program.cpp")
  evical_use_moc(${name})
  target_include_directories(${name} PRIVATE "${CMAKE_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE evical_warnings evical_qt_test evical_test_folders ${ARG_LIBS})
  if(ARG_WINDOWS)
    evical_use_precompiled(${name} evical_headers_ui)
  else()
    evical_use_precompiled(${name} evical_headers_test)
  endif()
  evical_unite(${name})
  foreach(source IN LISTS ARG_SOURCES)
    cmake_path(GET source STEM test)
    if(test MATCHES "^tst_")
      add_test(NAME ${test} COMMAND ${name} ${test})
    endif()
  endforeach()
endfunction()

# evical_add_ui_test_program(NAME SOURCES... LIBS...): the same for tests of widgets, which run without a display.
function(evical_add_ui_test_program name)
  evical_add_test_program(${name} WINDOWS ${ARGN} LIBS Qt6::Widgets)
  target_compile_definitions(${name} PRIVATE EVICAL_TEST_WITH_WINDOWS)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  foreach(source IN LISTS ARG_SOURCES)
    cmake_path(GET source STEM test)
    if(test MATCHES "^tst_")
      set_tests_properties(${test} PROPERTIES ENVIRONMENT "QT_QPA_PLATFORM=offscreen" LABELS ui)
    endif()
  endforeach()
  if(NOT TARGET ui_tests)
    add_custom_target(ui_tests)
  endif()
  add_dependencies(ui_tests ${name})
endfunction()
