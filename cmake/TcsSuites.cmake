# Run when a GoogleTest executable has been linked: writes what CTest reads, one test for each suite.
#   cmake -DEXECUTABLE=bin/x_test -DFOLDER=tests/unit/x -DLABEL=unit -DTIMEOUT=300 -DFILE=x_suites.cmake -P TcsSuites.cmake
cmake_policy(VERSION 3.25)
execute_process(COMMAND "${EXECUTABLE}" --gtest_list_tests WORKING_DIRECTORY "${FOLDER}" OUTPUT_VARIABLE listed
                TIMEOUT 60 COMMAND_ERROR_IS_FATAL ANY)
# The suites' lines end with a point; those of their cases are indented. What follows # may hold any character.
string(REGEX REPLACE "\n +[^\n]*|[ ]+#[^\n]*" "" listed "\n${listed}")
string(REPLACE "\n" ";" suites "${listed}")
list(FILTER suites INCLUDE REGEX "^[A-Za-z0-9_/]+\\.$")

# Cases were skipped, and none failed: nothing comes behind the list of those skipped.
set(skipped [==[\[  SKIPPED \] [0-9]+ tests?, listed below:
(\[  SKIPPED \] [^
]*
)+$]==])

set(tests "")
foreach(suite IN LISTS suites)
  string(REPLACE "." "" suite "${suite}")
  string(APPEND tests
    "add_test([[${suite}]] [[${EXECUTABLE}]] [[--gtest_filter=${suite}.*]])\n"
    "set_tests_properties([[${suite}]] PROPERTIES LABELS ${LABEL} TIMEOUT ${TIMEOUT} WORKING_DIRECTORY [[${FOLDER}]]\n"
    "  SKIP_REGULAR_EXPRESSION [==[${skipped}]==])\n")
endforeach()
file(WRITE "${FILE}" "${tests}")
