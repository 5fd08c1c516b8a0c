# OMPL::ompl: the library and its headers. Debian's pkg-config file of OMPL is broken, and its CMake
# package asks for more than its users need: look for the header and the library themselves.
include(FindPackageHandleStandardArgs)

find_path(OMPL_INCLUDE_DIR ompl/control/planners/sst/SST.h PATH_SUFFIXES ompl-1.6 ompl-1.5)
find_library(OMPL_LIBRARY ompl)
find_package(Boost QUIET)  # headers only, which OMPL's own headers include
find_package_handle_standard_args(OMPL REQUIRED_VARS OMPL_LIBRARY OMPL_INCLUDE_DIR Boost_FOUND)

if(OMPL_FOUND AND NOT TARGET OMPL::ompl)
  add_library(OMPL::ompl UNKNOWN IMPORTED)
  set_target_properties(OMPL::ompl PROPERTIES
    IMPORTED_LOCATION "${OMPL_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OMPL_INCLUDE_DIR};${Boost_INCLUDE_DIRS}")
  target_link_libraries(OMPL::ompl INTERFACE Eigen3::Eigen)
endif()
