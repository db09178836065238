# What every target shares: language level, warnings, ccache; and the functions that make libraries and tests.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -fno-math-errno -fno-trapping-math")

find_program(EVICAL_CCACHE ccache)
if(EVICAL_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${EVICAL_CCACHE}")
endif()

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED)

add_library(evical_warnings INTERFACE)
target_compile_options(evical_warnings INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion)
if(EVICAL_WARNINGS_AS_ERRORS)
  target_compile_options(evical_warnings INTERFACE -Werror)
endif()

# evical_add_layer(NAME SOURCES... [PUBLIC libs...] [PRIVATE libs...]): one library a folder of core.
function(evical_add_layer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(evical_${name} STATIC ${ARG_SOURCES})
  add_library(evical::${name} ALIAS evical_${name})
  set_target_properties(evical_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY EVICAL_LAYERS ${name})  # cmake/evical_install.cmake
  target_include_directories(evical_${name} PUBLIC "$<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>"
                                                   "$<INSTALL_INTERFACE:include/evical>")
  target_link_libraries(evical_${name} PUBLIC Eigen3::Eigen Threads::Threads ${ARG_PUBLIC}
                                       PRIVATE $<BUILD_INTERFACE:evical_warnings> ${ARG_PRIVATE})
endfunction()

# evical_add_test(NAME SOURCE libs...): a Qt Test executable without a GUI, run by ctest.
function(evical_add_test name source)
  add_executable(${name} ${source})
  set_target_properties(${name} PROPERTIES AUTOMOC ON)
  target_include_directories(${name} PRIVATE "${CMAKE_SOURCE_DIR}")
  target_compile_definitions(${name} PRIVATE EVICAL_TEST_DATA="${CMAKE_SOURCE_DIR}/tests/data"
                                             EVICAL_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE evical_warnings Qt6::Test ${ARGN})
  add_test(NAME ${name} COMMAND ${name})
endfunction()

# evical_add_ui_layer(NAME SOURCES... [PUBLIC libs...] [PRIVATE libs...]): one library a folder of ui, with Qt's moc.
function(evical_add_ui_layer name)
  evical_add_layer(ui_${name} ${ARGN})
  set_target_properties(evical_ui_${name} PROPERTIES AUTOMOC ON AUTORCC ON)
  target_link_libraries(evical_ui_${name} PUBLIC Qt6::Widgets)
endfunction()

# evical_add_ui_test(NAME SOURCE libs...): a Qt Test executable with a GUI, run by ctest without a display.
function(evical_add_ui_test name source)
  evical_add_test(${name} ${source} Qt6::Widgets ${ARGN})
  target_compile_definitions(${name} PRIVATE EVICAL_SCREENSHOTS="${CMAKE_BINARY_DIR}/screenshots")
  set_tests_properties(${name} PROPERTIES ENVIRONMENT "QT_QPA_PLATFORM=offscreen" LABELS ui)
  if(NOT TARGET ui_tests)
    add_custom_target(ui_tests)
  endif()
  add_dependencies(ui_tests ${name})
endfunction()
