# What the examples take from tcs's own build, where they are built without it: a copy of share/tcs/examples beside an
# installed tcs. What an example needs besides stands in its CMakeLists.txt.
find_package(tcs REQUIRED)
find_package(Threads REQUIRED)
find_package(OMPL QUIET)  # found beside tcs-config.cmake
find_package(CycloneDDS QUIET)
find_package(CLI11 QUIET)

set(CMAKE_CXX_STANDARD 20)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

function(tcs_add_executable target)
  add_executable(${target} ${ARGN})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/..")
endfunction()
function(tcs_add_library target)
  add_library(${target} STATIC ${ARGN})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/..")
endfunction()
# How quickly they compile is of no matter here.
function(tcs_compile_quickly)
endfunction()

# Which physics the installed tcsim has.
if(TCS_HAS_MUJOCO)
  add_library(tcs::mujoco INTERFACE IMPORTED)
endif()

# The messages of ROS 2 that tcs speaks.
if(OMPL_FOUND AND CycloneDDS_FOUND AND CLI11_FOUND)
  file(GLOB definitions "${TCS_IDL}/*.idl")
  idlc_generate(TARGET tcs_ros_idl FILES ${definitions} DEFAULT_EXTENSIBILITY final NO_TYPE_INFO)
  add_library(tcs_ros_types STATIC)
  target_link_libraries(tcs_ros_types PRIVATE tcs_ros_idl PUBLIC CycloneDDS::ddsc)
  target_include_directories(tcs_ros_types SYSTEM PUBLIC "${CMAKE_CURRENT_BINARY_DIR}")
  add_dependencies(tcs_ros_types tcs_ros_idl_generate)
endif()
