# Target docs: Doxygen pages of the public headers, in <build>/docs/api. Not part of target all.
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

# Target docs_site: MkDocs site of docs/, in <build>/docs/site. Not part of target all.
find_program(EVICAL_MKDOCS mkdocs)
if(EVICAL_MKDOCS)
  set(evical_site "${CMAKE_BINARY_DIR}/docs/site")
  add_custom_target(docs_site COMMAND "${CMAKE_COMMAND}" -E env PYTHONDONTWRITEBYTECODE=1 "${EVICAL_MKDOCS}" build --strict
                                      --config-file "${CMAKE_SOURCE_DIR}/mkdocs.yml" --site-dir "${evical_site}"
                              COMMAND "${CMAKE_COMMAND}" -E echo "Pages are in ${evical_site}/index.html" VERBATIM)
else()
  add_custom_target(docs_site COMMAND "${CMAKE_COMMAND}" -E echo "MkDocs is missing: apt-get install mkdocs, then configure again"
                              COMMAND "${CMAKE_COMMAND}" -E false VERBATIM)
endif()
