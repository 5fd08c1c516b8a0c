#include "coordinator/cli/preload_library.h"

#include <filesystem>
#include <system_error>

namespace tcs {

namespace {

namespace fs = std::filesystem;

constexpr const char *kProgram = "tcsim", *kTools = "tcsim-tools";

// The folder of tcsim. In an installed tree tcsim-tools is not in that folder.
fs::path ProgramFolder() {
  std::error_code error;
  const fs::path own = fs::read_symlink("/proc/self/exe", error);
  const fs::path folder = own.parent_path();
  if (own.filename() != kTools || fs::exists(folder / kProgram, error)) return folder;
  return (folder / TCS_PROGRAM_FROM_LIBRARIES).lexically_normal();
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

std::string PhysicsLibrary() { return Library("libtcs_physics.so"); }

std::string OwnProgram() { return ProgramFolder() / kProgram; }

std::string ToolsProgram() { return Part(kTools, ProgramFolder()); }

std::string ViewServer() { return Part("tcsim-view", ProgramFolder()); }

std::string DataFolder() { return (ProgramFolder() / TCS_DATA_FROM_PROGRAM).lexically_normal(); }

}  // namespace tcs
