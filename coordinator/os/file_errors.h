// The sentences for result files that could not be written.
//
// The sentences are of errno as it is; 0: something that the system did not name.
#pragma once

#include <string.h>

#include <cerrno>
#include <string>

namespace tcs {

inline std::string FileError() {
  return errno == 0 ? "the disk is full, or does not exist any more" : strerror(errno);
}

inline std::string CannotBeWritten(const std::string& path) {
  return path + " cannot be written: " + FileError() + "; choose another folder with --out";
}

inline std::string NotWrittenWhole(const std::string& path) {
  return path + " was not written completely: " + FileError() +
         "; make room, or choose another folder with --out";
}

}  // namespace tcs
