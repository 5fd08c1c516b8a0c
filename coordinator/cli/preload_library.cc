#include "coordinator/cli/preload_library.h"

#include <filesystem>
#include <system_error>

namespace tcs {

namespace {

namespace fs = std::filesystem;

fs::path ProgramFolder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

// The places in an installed tree are CMake's, seen from the program's folder.
std::string Library(const char* name) {
  const fs::path folder = ProgramFolder();
  fs::path installed = (folder / TCS_LIBRARIES_FROM_PROGRAM / name).lexically_normal();
  std::error_code error;
  if (fs::exists(installed, error)) return installed;
  return folder.parent_path() / "lib" / name;
}

}  // namespace

std::string PreloadLibrary() { return Library("libtcs_preload.so"); }

std::string DdsLibrary() { return Library("libtcs_dds.so"); }

std::string AllocationLibrary() { return Library("libtcs_allocations.so"); }

std::string DataFolder() { return (ProgramFolder() / TCS_DATA_FROM_PROGRAM).lexically_normal(); }

}  // namespace tcs
