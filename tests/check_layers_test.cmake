# Tests the checker itself: a clean tree passes, and each kind of offence fails with its message.
# cmake -DCHECKER=tests/check_layers.cmake -DSCRATCH=<folder> -P tests/check_layers_test.cmake
cmake_minimum_required(VERSION 3.25)

# check(NAME expected-text path content [path content ...]); an empty text expects success.
function(check name expected)
  set(tree "${SCRATCH}/${name}")
  file(REMOVE_RECURSE "${tree}")
  file(WRITE "${tree}/core/base/error.h" "#include <string>\n")
  while(ARGN)
    list(POP_FRONT ARGN path content)
    file(WRITE "${tree}/${path}" "${content}\n")
  endwhile()
  execute_process(COMMAND "${CMAKE_COMMAND}" -DROOT=${tree} -P "${CHECKER}" RESULT_VARIABLE code
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(expected STREQUAL "" AND NOT code EQUAL 0)
    message(FATAL_ERROR "${name}: a clean tree was refused:\n${output}")
  elseif(NOT expected STREQUAL "" AND code EQUAL 0)
    message(FATAL_ERROR "${name}: passed, and should not")
  elseif(NOT expected STREQUAL "")
    string(REGEX REPLACE "[ \n]+" " " output "${output}")
    if(NOT output MATCHES "${expected}")
      message(FATAL_ERROR "${name}: expected '${expected}', got:\n${output}")
    endif()
  endif()
endfunction()

check(clean "" core/frontend/a.cpp "#include \"core/data/event.h\"" core/data/event.h "#include <Eigen/Core>"
      core/pipeline/rig/p.cpp "#include \"core/frontend/a.h\"" core/optimisation/solve.cpp "#include <ceres/ceres.h>")
check(stage_to_stage "core/frontend may not include core/optimisation"
      core/frontend/a.cpp "#include \"core/optimisation/b.h\"")
check(against_arrow "core/base may not include core/geometry" core/base/a.h "#include \"core/geometry/b.h\"")
check(numerics_to_geometry "core/numerics may not include core/geometry" core/numerics/a.h "#include \"core/geometry/b.h\"")
check(numerics_everywhere "" core/geometry/a.cpp "#include \"core/numerics/b.h\"" core/report/a.cpp "#include \"core/numerics/b.h\""
      core/numerics/b.h "#include <Eigen/Core>")
check(stage_to_pipeline "core/report may not include core/pipeline" core/report/a.h "#include \"core/pipeline/b.h\"")
check(program_to_program "core/pipeline/rig may not include core/pipeline/check" core/pipeline/rig/a.h
      "#include \"core/pipeline/check/b.h\"")
check(program_of_no_layer "core/pipeline is not a layer" core/pipeline/a.h "#include <string>")
check(core_to_app "core may not include app" core/report/a.cpp "#include \"app/b.h\"")
check(qt_in_core "core may not include Qt or VTK" core/report/a.cpp "#include <QString>")
check(qt_module_in_core "core may not include Qt or VTK" core/report/a.cpp "#  include <QtCore/QString>")
check(vtk_in_core "core may not include Qt or VTK" core/geometry/a.cpp "#include <vtkActor.h>")
check(qt_in_command_line "the command line may not" app/evical.cpp "#include <QCoreApplication>")
check(python_clean "" python/a.cpp "#include \"core/data/event.h\"" python/b.cpp "#include \"python/a.h\"" python/a.h
      "#include <pybind11/pybind11.h>")
check(python_to_app "the Python module may include only core" python/a.cpp "#include \"app/b.h\"")
check(python_to_qt "the Python module may include only core" python/a.cpp "#include <QString>")
check(core_to_python "core may not include python" core/report/a.cpp "#include \"python/b.h\"")
check(app_to_python "app may not include python" app/evical.cpp "#include \"python/b.h\"")
check(qt_linked "links Qt or VTK" core/report/CMakeLists.txt "target_link_libraries(x Qt6::Core)")
check(unknown_layer "is not a layer" core/helpers/a.cpp "#include <string>")
check(library_in_header "shows ceres/ceres.h" core/optimisation/a.h "#include <ceres/ceres.h>"
      core/pipeline/rig/p.cpp "#include \"core/optimisation/a.h\"")
check(library_by_way_of_header "core/optimisation/b.h: shows fmt/format.h" core/optimisation/a.h
      "#include \"core/optimisation/b.h\"" core/optimisation/b.h "#include <fmt/format.h>" core/pipeline/rig/p.cpp
      "#include \"core/optimisation/a.h\"")
check(library_in_own_header "" core/optimisation/a.h "#include <ceres/ceres.h>" core/optimisation/a.cpp
      "#include \"core/optimisation/a.h\"")
check(ui_screen_to_screen "ui/plots may not include ui/scene" ui/plots/a.cpp "#include \"ui/scene/b.h\"")
check(ui_screen_to_document "ui/detection may not include ui/document" ui/detection/a.cpp
      "#include \"ui/document/b.h\"")
check(ui_unknown_folder "is not a folder" ui/helpers/a.cpp "#include \"ui/theme/theme.h\"")
check(ui_clean "" ui/window/a.cpp "#include \"ui/plots/b.h\"" ui/plots/b.h "#include <QWidget>")
check(ui_page_to_jobs "" ui/plots/a.cpp "#include \"ui/jobs/latest_job.h\"")
check(ui_jobs_to_page "ui/jobs may not include ui/plots" ui/jobs/a.cpp "#include \"ui/plots/b.h\"")
