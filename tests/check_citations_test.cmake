# check_citations.cmake must pass good citations and find each kind of bad one.
# Run with -DCHECKER=<check_citations.cmake> -DSCRATCH=<folder>; -P.
cmake_minimum_required(VERSION 3.25)

function(expect outcome what maths comment)
  file(REMOVE_RECURSE "${SCRATCH}")
  file(WRITE "${SCRATCH}/docs/maths.md" "${maths}")
  file(WRITE "${SCRATCH}/core/a/b.h" "${comment}\n")
  execute_process(COMMAND "${CMAKE_COMMAND}" "-DROOT=${SCRATCH}" -P "${CHECKER}" RESULT_VARIABLE code OUTPUT_QUIET
                  ERROR_QUIET)
  if(outcome STREQUAL "passes" AND NOT code EQUAL 0)
    message(FATAL_ERROR "${what}: refused")
  elseif(outcome STREQUAL "fails" AND code EQUAL 0)
    message(FATAL_ERROR "${what}: let through")
  endif()
endfunction()

set(good "# Mathematics\n\n## 1. One\n\n### 1.1 First\n\n### 1.2 Second\n\n## 2. Two\n")
expect(passes "a section" "${good}" "// Text (docs/maths.md, 1.2).")
expect(passes "a chapter" "${good}" "// Text (docs/maths.md, 2; A. Author).")
expect(passes "a range" "${good}" "// Text (docs/maths.md, 1.1 to 1.2).")
expect(fails "a section that isn't there" "${good}" "// Text (docs/maths.md, 1.3).")
expect(fails "the end of a range" "${good}" "// Text (docs/maths.md, 1.1 to 2.1).")
expect(fails "no section" "${good}" "// Text (docs/maths.md, edge timing).")
expect(fails "a document that isn't there" "${good}" "// Text (docs/other.md).")
expect(fails "a heading without a number" "${good}\n## Three\n" "// Text.")
expect(fails "a number that is left out" "${good}\n## 4. Four\n" "// Text.")
message(STATUS "check_citations.cmake tells good citations from bad ones.")
