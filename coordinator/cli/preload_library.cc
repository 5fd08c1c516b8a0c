#include "coordinator/cli/preload_library.h"

#include <filesystem>
#include <system_error>

namespace tcs {

namespace {

std::string Library(const char* name) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return self.parent_path().parent_path() / "lib" / name;
}

}  // namespace

std::string PreloadLibrary() { return Library("libtcs_preload.so"); }

std::string DdsLibrary() { return Library("libtcs_dds.so"); }

std::string AllocationLibrary() { return Library("libtcs_allocations.so"); }

}  // namespace tcs
