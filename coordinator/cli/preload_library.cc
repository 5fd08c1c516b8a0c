#include "coordinator/cli/preload_library.h"

#include <filesystem>
#include <system_error>

namespace tcs {

std::string PreloadLibrary() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return self.parent_path().parent_path() / "lib" / "libtcs_preload.so";
}

}  // namespace tcs
