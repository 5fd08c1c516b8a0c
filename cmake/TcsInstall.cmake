# What `cmake --install` and the Debian package have. tcsim finds its libraries and its data from its own place
# (coordinator/cli/preload_library.h), so the tree may be moved.
include(CMakePackageConfigHelpers)

install(TARGETS tcsim RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
# Guests of other programs, which nobody links with: not where the linker looks.
install(TARGETS tcs_preload tcs_allocations tcs_dds_endpoints LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/tcs")
# What tcsim loads where there is a world.
install(TARGETS tcs_physics LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/tcs")
# What tcsim starts for `--view` and `tcsim view`, for the commands that do not fly, and for DDS by sockets.
install(TARGETS tcsim_tools tcsim_view tcs_dds_gateway RUNTIME DESTINATION "${CMAKE_INSTALL_LIBDIR}/tcs")

# For programs that know of tcs.
install(TARGETS tcs_api EXPORT tcs ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(FILES "${CMAKE_SOURCE_DIR}/libtcs_preload/api/tcs.h" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/tcs")
set(tcs_cmake "${CMAKE_INSTALL_LIBDIR}/cmake/tcs")
install(EXPORT tcs NAMESPACE tcs:: DESTINATION "${tcs_cmake}" FILE tcs-targets.cmake)
set(TCS_HAS_MUJOCO OFF)
if(TARGET tcs::mujoco)
  set(TCS_HAS_MUJOCO ON)
endif()
configure_package_config_file("${CMAKE_SOURCE_DIR}/cmake/tcs-config.cmake.in" "${CMAKE_BINARY_DIR}/tcs-config.cmake"
                              INSTALL_DESTINATION "${tcs_cmake}" PATH_VARS CMAKE_INSTALL_BINDIR CMAKE_INSTALL_DATADIR)
write_basic_package_version_file("${CMAKE_BINARY_DIR}/tcs-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/tcs-config.cmake" "${CMAKE_BINARY_DIR}/tcs-config-version.cmake" DESTINATION "${tcs_cmake}")
install(FILES "${CMAKE_SOURCE_DIR}/cmake/FindOMPL.cmake" DESTINATION "${tcs_cmake}")
file(RELATIVE_PATH tcs_prefix_from_pkgconfig "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
configure_file("${CMAKE_SOURCE_DIR}/cmake/tcs.pc.in" "${CMAKE_BINARY_DIR}/tcs.pc" @ONLY)
install(FILES "${CMAKE_BINARY_DIR}/tcs.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")

# Written by `tcsim generate` in the build.
install(DIRECTORY "${CMAKE_BINARY_DIR}/share/manual/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" FILES_MATCHING PATTERN "*.1")
install(FILES "${CMAKE_BINARY_DIR}/share/manual/tcsim" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
install(FILES "${CMAKE_BINARY_DIR}/share/manual/_tcsim" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions")

install(DIRECTORY "${CMAKE_BINARY_DIR}/share/tcs/" DESTINATION "${CMAKE_INSTALL_DATADIR}/tcs")
# Examples, as sources: each folder can be copied, built and flown.
install(DIRECTORY "${CMAKE_SOURCE_DIR}/examples" DESTINATION "${CMAKE_INSTALL_DATADIR}/tcs"
        PATTERN "experiment.sh" EXCLUDE PATTERN "sweep.py" EXCLUDE)
# The definitions of the messages that tcs speaks, for idlc.
install(DIRECTORY "${CMAKE_SOURCE_DIR}/coordinator/dds/idl" DESTINATION "${CMAKE_INSTALL_DATADIR}/tcs"
        FILES_MATCHING PATTERN "*.idl")
set(tcs_doc "${CMAKE_INSTALL_DATADIR}/doc/tcsim")
install(FILES "${CMAKE_SOURCE_DIR}/README.md" "${CMAKE_SOURCE_DIR}/CONTRIBUTING.md" DESTINATION "${tcs_doc}")
install(DIRECTORY "${CMAKE_SOURCE_DIR}/docs" DESTINATION "${tcs_doc}")

# --- The Debian package: `cpack -G DEB` in a folder configured for /usr; `./dev package` does both. ------------------

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tcsim)
set(CPACK_PACKAGE_VENDOR tcs)
# As Debian's own tools take it. The address stands for one: DEBFULLNAME and DEBEMAIL name whoever makes the package.
set(CPACK_PACKAGE_CONTACT "tcs maintainers <tcs@example.org>")
if(DEFINED ENV{DEBEMAIL})
  set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulation of robots in which computing takes time")
set(CPACK_PACKAGE_DESCRIPTION
    "tcs runs unmodified robot programs (controllers, planners, DDS
nodes) in a simulation in which computing takes time: a planner that needs
0.8 s of processor time finds the world 0.8 s older when it is done.
.
Programs run in virtual time. A scheduler in user space runs them against the
physics, and charges the processor time that they really use, so that a run's
outcome depends neither on how fast the physics is nor on how loaded the host
is.")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Looked for in the private folder of this package, too.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_BINARY_DIR}/lib")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "gdb, cyclonedds-tools, cmake, g++")
# The release that it is for: a package of one is not for the other, as their libraries differ.
execute_process(COMMAND sed -n "s/^VERSION_ID=\"\\?\\([0-9]*\\)\"\\?$/\\1/p" /etc/os-release
                OUTPUT_VARIABLE tcs_debian OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
if(tcs_debian)
  set(CPACK_DEBIAN_PACKAGE_RELEASE "1~deb${tcs_debian}u1")
endif()
set(CPACK_PRE_BUILD_SCRIPTS "${CMAKE_SOURCE_DIR}/cmake/debian_files.cmake")
set(CPACK_TCS_SOURCE "${CMAKE_SOURCE_DIR}")
set(CPACK_TCS_VERSION "${PROJECT_VERSION}-1~deb${tcs_debian}u1")
set(CPACK_TCS_MAINTAINER "${CPACK_PACKAGE_CONTACT}")
include(CPack)
