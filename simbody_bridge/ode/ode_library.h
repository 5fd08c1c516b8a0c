// libode as a whole: set up once in a process, and checked to be the library that its headers
// describe.
#pragma once

namespace tcs {

// Call before anything else of ODE's; does something the first time only. From then on an error of
// ODE is thrown as DynamicsError instead of ending the process, and any other message of ODE is one
// line on stderr. Throws DynamicsError if libode cannot be used.
void OpenOde();

}  // namespace tcs
