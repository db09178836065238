# Target docs: pages of the public headers, by Doxygen, in <build>/docs/api. Not part of all.
find_program(EVICAL_DOXYGEN doxygen)
if(EVICAL_DOXYGEN)
  include(public_headers)
  evical_public_headers("${CMAKE_SOURCE_DIR}" evical_api_input)
  list(TRANSFORM evical_api_input REPLACE "(.+)" "\"${CMAKE_SOURCE_DIR}/\\1\"")
  list(JOIN evical_api_input " " evical_api_input)
  configure_file(docs/api/Doxyfile.in "${CMAKE_BINARY_DIR}/docs/Doxyfile" @ONLY)
  file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/docs/api")
  add_custom_target(docs COMMAND "${EVICAL_DOXYGEN}" "${CMAKE_BINARY_DIR}/docs/Doxyfile"
                         COMMAND "${CMAKE_COMMAND}" -E echo "Pages are in ${CMAKE_BINARY_DIR}/docs/api/index.html" VERBATIM)
else()
  add_custom_target(docs COMMAND "${CMAKE_COMMAND}" -E echo "Doxygen is missing: apt-get install doxygen, then configure again"
                         COMMAND "${CMAKE_COMMAND}" -E false VERBATIM)
endif()
