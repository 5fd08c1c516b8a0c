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
std::string Part(const char* name, const fs::path& in_build_tree) {
  fs::path installed = (ProgramFolder() / TCS_LIBRARIES_FROM_PROGRAM / name).lexically_normal();
  std::error_code error;
  if (fs::exists(installed, error)) return installed;
  return in_build_tree / name;
}

std::string Library(const char* name) { return Part(name, ProgramFolder().parent_path() / "lib"); }

}  // namespace

std::string PreloadLibrary() { return Library("libtcs_preload.so"); }

std::string DdsLibrary() { return Library("libtcs_dds.so"); }

std::string AllocationLibrary() { return Library("libtcs_allocations.so"); }

std::string ViewServer() { return Part("tcsim-view", ProgramFolder()); }

std::string DataFolder() { return (ProgramFolder() / TCS_DATA_FROM_PROGRAM).lexically_normal(); }

}  // namespace tcs
