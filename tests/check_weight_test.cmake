# Tests the check of folder sizes: a folder within its budget passes; one beyond it or without a budget fails.
# cmake -DCHECKER=packaging/weight.sh -DSCRATCH=<folder> -P tests/check_weight_test.cmake
cmake_minimum_required(VERSION 3.25)

# check(NAME expected-text budget-row): core/base has 22 lines; an empty text expects success.
function(check name expected row)
  set(tree "${SCRATCH}/${name}")
  file(REMOVE_RECURSE "${tree}")
  string(REPEAT "int a;\n" 22 content)
  file(WRITE "${tree}/core/base/a.h" "${content}")
  file(WRITE "${tree}/docs/architecture.md" "| folder | purpose | budget, lines |\n|---|---|---|\n${row}\n")
  execute_process(COMMAND "${CHECKER}" --check "${tree}" RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(expected STREQUAL "" AND NOT code EQUAL 0)
    message(FATAL_ERROR "${name}: failed, and should not:\n${output}")
  elseif(NOT expected STREQUAL "" AND (code EQUAL 0 OR NOT output MATCHES "${expected}"))
    message(FATAL_ERROR "${name}: expected a failure with '${expected}', got exit code ${code}:\n${output}")
  endif()
endfunction()

check(within "" "| `core/base/` | errors | 22 |")
check(heavy "core/base has 22 lines, and its budget is 21" "| `core/base/` | errors | 21 |")
check(without_budget "core/base has no budget" "| `core/data/` | structs | 22 |")
