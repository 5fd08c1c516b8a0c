// Where the parts of tcs are that belong to this tcsim. The parts are found from the program's own
// place, so that an installed tree can be moved: ../LIBDIR/tcs and ../share/tcs beside the folder
// of the program (CMake's GNUInstallDirs); in a build tree ../lib and ../share/tcs.
#pragma once

#include <string>

namespace tcs {

// The shim.
std::string PreloadLibrary();

// The library that knows Cyclone DDS: the shim loads this library into programs that use Cyclone
// DDS. The library has to be beside the shim.
std::string DdsLibrary();
// The library that charges allocations under fixed accounting, beside the shim.
std::string AllocationLibrary();

// The engines.
std::string PhysicsLibrary();

// tcsim itself, also where tcsim-tools asks (cli/tools.h), and tcsim-tools.
std::string OwnProgram();
std::string ToolsProgram();

// The server of a live page; in a build tree beside the program.
std::string ViewServer();

// The folder of templates, the scenario's schema and the examples.
std::string DataFolder();

}  // namespace tcs
