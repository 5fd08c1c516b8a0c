# What every target of tcs shares: the language, the warnings, the include root.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")

option(TCS_WERROR "Treat warnings as errors, as developers and CI do; compilers that come later warn of more" OFF)
# Three quarters of compiling go into headers, which are read once for all sources that are compiled as one. Missing
# includes do not show then: `./dev build dev` compiles each source by itself.
option(TCS_UNITY "Compile many sources of a library at a time" OFF)
set(TCS_UNITY_BATCH 24)
# GCC looks for memory to use again whenever it has taken a third more: a tenth of its time, and a quarter less memory.
if(TCS_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:--param ggc-min-expand=300 --param ggc-min-heapsize=524288>")
endif()
option(TCS_CHECK_ONLY "Sources are read, and nothing is made of them" OFF)
if(TCS_CHECK_ONLY)
  add_compile_options(-fsyntax-only)
  # A program that a target has to wait for has nothing that the target's sources include; what writes headers has.
  function(add_dependencies target)
    foreach(awaited IN LISTS ARGN)
      if(TARGET ${awaited})
        get_target_property(type ${awaited} TYPE)
        if(type STREQUAL "UTILITY")
          _add_dependencies(${target} ${awaited})
        endif()
      endif()
    endforeach()
  endfunction()
endif()

include(TcsSanitizers)

# tcs_target_defaults(name [NO_SANITIZE])
function(tcs_target_defaults target)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "NO_SANITIZE" "" "")
  target_include_directories(${target} PRIVATE "${CMAKE_SOURCE_DIR}")
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor>
                                           -Wno-missing-field-initializers)
  # GCC 12 sees overlaps in std::string's operator+ that are not there (GCC bug 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  # GCC 14 takes what a vector has just allocated for the middle of it (libtcs_preload/dds/deliverer.cc).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 14)
    target_compile_options(${target} PRIVATE -Wno-free-nonheap-object)
  endif()
  if(TCS_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(NOT ARG_NO_SANITIZE)
    tcs_target_sanitize(${target})
  endif()
  if(TCS_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${TCS_UNITY_BATCH})
  endif()
endfunction()

# What runs once, such as reading a command line by templates, is not worth the time of optimising it. Not -O0: of an
# inline function that is called in many sources the linker keeps the first copy, and would give it to the run's loop, too.
function(tcs_compile_quickly)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -Og SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# The same of a whole library.
function(tcs_target_compile_quickly target)
  target_compile_options(${target} PRIVATE -Og)
endfunction()

# For programs of many small sources with names of their own, which cannot be compiled as one. Not where each source is
# to show what it forgets to include.
function(tcs_read_headers_once target)
  if(TCS_UNITY)
    list(TRANSFORM ARGN REPLACE "(.+)" "$<$<COMPILE_LANGUAGE:CXX>:\\1>")
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

function(tcs_add_library target)
  add_library(${target} STATIC ${ARGN})
  tcs_target_defaults(${target})
endfunction()

function(tcs_add_executable target)
  add_executable(${target} ${ARGN})
  tcs_target_defaults(${target})
endfunction()

# What nearly all tests include: a tenth of the time that a batch of them takes to compile. The program does nothing, and has
# the flags of those that use its headers.
function(tcs_add_test_headers)
  file(GENERATE OUTPUT "${CMAKE_BINARY_DIR}/test_headers.cc" CONTENT "int main() {}\n")
  tcs_add_executable(tcs_test_headers "${CMAKE_BINARY_DIR}/test_headers.cc")
  set_target_properties(tcs_test_headers PROPERTIES EXCLUDE_FROM_ALL ON)
  tcs_target_compile_quickly(tcs_test_headers)
  target_link_libraries(tcs_test_headers PRIVATE GTest::gtest GTest::gmock)
  tcs_read_headers_once(tcs_test_headers <gtest/gtest.h> <gmock/gmock.h> <algorithm> <fstream> <functional> <map> <memory> <optional>
                        <string> <vector>)
endfunction()

# One GoogleTest executable, registered with CTest under one label: each suite is a test, or each case where CASES says
# so, for those that take long. A process for each case would double the time of `ctest -L unit`. Its own sources are
# compiled quickly, as what they test is not; OPTIMISED: they are not, either. WITH_C: a library brings sources in C.
#   tcs_add_gtest(name LABEL unit [OPTIMISED] [CASES] [WITH_C] SOURCES a.cc b.cc LIBS x y)
function(tcs_add_gtest target)
  cmake_parse_arguments(ARG "OPTIMISED;CASES;WITH_C" "LABEL" "SOURCES;LIBS" ${ARGN})
  tcs_add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE ${ARG_LIBS} GTest::gtest GTest::gtest_main GTest::gmock)
  if(NOT ARG_OPTIMISED)
    tcs_target_compile_quickly(${target})
    if(TCS_UNITY AND NOT ARG_WITH_C)
      target_precompile_headers(${target} REUSE_FROM tcs_test_headers)
    endif()
  endif()
  if(ARG_CASES)
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS ${ARG_LABEL} TIMEOUT 600)
  else()
    tcs_register_suites(${target} ${ARG_LABEL})
  endif()
endfunction()

function(tcs_register_suites target label)
  if(TCS_CHECK_ONLY) # There is no program to ask.
    return()
  endif()
  set(suites "${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake")
  add_custom_command(
    TARGET ${target} POST_BUILD BYPRODUCTS "${suites}" VERBATIM
    COMMAND "${CMAKE_COMMAND}" -D "EXECUTABLE=$<TARGET_FILE:${target}>" -D "FOLDER=${CMAKE_CURRENT_BINARY_DIR}"
            -D "LABEL=${label}" -D "TIMEOUT=300" -D "FILE=${suites}" -P "${CMAKE_SOURCE_DIR}/cmake/TcsSuites.cmake")
  file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake"
       "if(EXISTS \"${suites}\")\n  include(\"${suites}\")\nelse()\n  add_test(${target}_NOT_BUILT ${target}_NOT_BUILT)\n"
       "  set_tests_properties(${target}_NOT_BUILT PROPERTIES LABELS ${label})\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake")
endfunction()
