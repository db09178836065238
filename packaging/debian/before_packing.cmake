# Read by cpack first: checks that its tools are installed, and sets the files' time to that of the changelog's last entry, so that
# two builds give the same bytes. SOURCE_DATE_EPOCH sets another time.
cmake_policy(VERSION 3.25)
foreach(tool dpkg-shlibdeps=dpkg-dev dpkg-parsechangelog=dpkg-dev file=file readelf=binutils gzip=gzip touch=coreutils sh=dash)
  string(REPLACE "=" ";" tool "${tool}")
  list(POP_FRONT tool program)
  # Only the PATH is searched, since the tool is called by name later. By default CMake also searches its own folder and /usr.
  find_program(EVICAL_TOOL "${program}" PATHS ENV PATH NO_DEFAULT_PATH NO_CACHE)
  if(NOT EVICAL_TOOL)
    message(FATAL_ERROR "${program} is missing, and packages cannot be built without it: apt-get install ${tool}")
  endif()
  unset(EVICAL_TOOL)
endforeach()

# The umask applies to folders and to the package's own files, and a package that only root can read is useless.
execute_process(COMMAND sh -c umask OUTPUT_VARIABLE umask OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
if(NOT umask MATCHES "^0*22$")
  message(FATAL_ERROR "The umask is ${umask}, but all users must be able to read the files: umask 022")
endif()

set(changelog "${CPACK_EVICAL_SOURCE}/packaging/debian/changelog")
function(read_changelog field result)
  execute_process(COMMAND dpkg-parsechangelog -l "${changelog}" -S "${field}" OUTPUT_VARIABLE text OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()
read_changelog(Version version)
if(NOT version STREQUAL "${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")
  message(FATAL_ERROR "${changelog} ends with ${version}, but this is ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}: "
                      "add an entry for it")
endif()
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  read_changelog(Timestamp time_s)
  set(ENV{SOURCE_DATE_EPOCH} "${time_s}")
endif()
