# What a Debian package has besides, once CPack has put its files together: its changelog and copyright, and the manual
# pages compressed.
set(root "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr")
set(doc "${root}/share/doc/tcsim")

string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE "${doc}/changelog.Debian"
     "tcsim (${CPACK_TCS_VERSION}) unstable; urgency=medium

  * Packaged by CPack; what has changed stands in changelog.gz.

 -- ${CPACK_TCS_MAINTAINER}  ${now}
")
configure_file("${CPACK_TCS_SOURCE}/CHANGELOG.md" "${doc}/changelog" COPYONLY)
configure_file("${CPACK_TCS_SOURCE}/cmake/debian_copyright" "${doc}/copyright" COPYONLY)

file(CHMOD "${doc}/changelog" "${doc}/changelog.Debian" "${doc}/copyright" PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)

file(GLOB compressed "${doc}/changelog" "${doc}/changelog.Debian" "${root}/share/man/man1/*.1")
foreach(file IN LISTS compressed)
  execute_process(COMMAND gzip -9nf "${file}" COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(GLOB_RECURSE files LIST_DIRECTORIES true "${root}/*")
foreach(file IN LISTS files)
  if(IS_DIRECTORY "${file}")
    file(CHMOD "${file}" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  endif()
endforeach()
