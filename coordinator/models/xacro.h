// Files of xacro, which make URDF of macros: expanded by the machine's own `xacro`.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace tcs {

// Whether a program `xacro` is in PATH.
bool HasXacro();

// The output of `xacro PATH NAME:=VALUE …`, with `arguments` by name. Throws ModelMistake, "PATH:
// …", with what xacro says where it fails, and where it takes longer than 60 s of processor time.
std::string ExpandedByXacro(const std::string& path,
                            const std::map<std::string, std::string>& arguments);

}  // namespace tcs
