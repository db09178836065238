# Installs a build into a separate folder, builds examples/ with find_package(Evical) from there, and runs the
# examples.
cmake_minimum_required(VERSION 3.25)
set(prefix "${SCRATCH}/prefix")
set(examples "${SCRATCH}/examples")

function(run result)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${code}\n${output}\n${errors}")
  endif()
  set(${result} "${output}" PARENT_SCOPE)
endfunction()

function(expect text pattern what)
  if(NOT text MATCHES "${pattern}")
    message(FATAL_ERROR "${what}: no \"${pattern}\" in\n${text}")
  endif()
endfunction()

file(REMOVE_RECURSE "${prefix}")
run(ignored "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")

# A package that refers to its build folder does not work elsewhere.
file(GLOB_RECURSE package_files "${prefix}/*/Evical*.cmake")
if(NOT package_files)
  message(FATAL_ERROR "${prefix} contains no EvicalConfig.cmake")
endif()
foreach(file IN LISTS package_files)
  file(STRINGS "${file}" lines REGEX "Dir|DIR|[/]")
  foreach(line IN LISTS lines)
    string(FIND "${line}" "${SOURCE}" at)
    string(FIND "${line}" "${prefix}" at_prefix)
    if(NOT at EQUAL -1 AND at_prefix EQUAL -1)
      message(FATAL_ERROR "${file} names the source folder: ${line}")
    endif()
  endforeach()
endforeach()

run(version "${prefix}/bin/evical" --version)
expect("${version}" "${VERSION}" "evical --version")
if(GUI)
  foreach(file bin/evical-gui share/applications/evical.desktop share/mime/packages/evical.xml share/icons/hicolor/scalable/apps/evical.svg)
    if(NOT EXISTS "${prefix}/${file}")
      message(FATAL_ERROR "${file} is not installed")
    endif()
  endforeach()
endif()

run(ignored "${CMAKE_COMMAND}" --fresh -S "${SOURCE}/examples" -B "${examples}" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${prefix}"
    "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(ignored "${CMAKE_COMMAND}" --build "${examples}")

file(GLOB recording "${RECORDING}/recording*")
run(output "${examples}/read_events" ${recording})
expect("${output}" "[1-9][0-9]+ events, of which [1-9][0-9]+ are ON" read_events)
expect("${output}" "[1-9][0-9]+ IMU samples" read_events)
run(output "${examples}/detect_board" "${RECORDING}/session.yaml")
expect("${output}" "board in [1-9][0-9]+ of [0-9]+ windows" detect_board)
run(output "${examples}/calibrate" "${RECORDING}/session.yaml")
expect("${output}" "translation .* sigma .*time offset .* ms" calibrate)

# Headers by the package's name alone, and the target spelt like the package.
set(prefixed "${SCRATCH}/prefixed")
file(WRITE "${prefixed}/main.cpp" "#include <evical/base/error.h>
#include <evical/pipeline/session/session.h>
int main() {
  try {
    evical::readSession(\"nowhere.yaml\");
  } catch (const evical::CalibrationError&) {
    return 0;
  }
  return 1;
}
")
file(WRITE "${prefixed}/CMakeLists.txt" "cmake_minimum_required(VERSION 3.25)
project(prefixed LANGUAGES C CXX)
find_package(Evical REQUIRED)
add_executable(prefixed main.cpp)
target_link_libraries(prefixed PRIVATE Evical::core)
")
run(ignored "${CMAKE_COMMAND}" --fresh -S "${prefixed}" -B "${prefixed}/build" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${prefix}"
    "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(ignored "${CMAKE_COMMAND}" --build "${prefixed}/build")
run(ignored "${prefixed}/build/prefixed")
