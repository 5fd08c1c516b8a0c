# Sanitizers: -DTCS_SANITIZE="address;undefined" instruments every target of tcs except the guest
# side. A library that is preloaded into other people's programs cannot bring a sanitizer's runtime
# with it, and the programs it is preloaded into would find that runtime loaded second; so both go
# without.
#
# A folder of the guest side is added with tcs_add_guest_subdirectory(), or says
# set(TCS_SANITIZE "") itself; one target opts out with tcs_target_defaults(name NO_SANITIZE).

set(TCS_SANITIZE "" CACHE STRING "Sanitizers for all but the guest side, as a list for -fsanitize=")

function(tcs_target_sanitize target)
  if(TCS_SANITIZE)
    list(JOIN TCS_SANITIZE "," sanitizers)
    target_compile_options(${target} PRIVATE -fsanitize=${sanitizers} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    # INTERFACE too: whoever links a sanitized static library needs the runtime.
    target_link_options(${target} PUBLIC -fsanitize=${sanitizers})
  endif()
endfunction()

function(tcs_add_guest_subdirectory directory)
  set(TCS_SANITIZE "")
  add_subdirectory(${directory})
endfunction()
