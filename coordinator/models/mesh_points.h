// The points and the triangles of a mesh file.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/models/packed_mesh.h"

namespace tcs {

// All vertices of a mesh, in metres (COLLADA's unit is applied), along the file's own axes, as ROS
// takes them: an up axis is not turned. `text` is what is in the file; the end of the file's name,
// `path`, says whether it is STL, OBJ, COLLADA or glTF. No other file is opened. Assimp reads the
// mesh, and may not survive what is in it: call the function in a process of its own (in_child.h).
// Half a sentence where the mesh cannot be read.
[[nodiscard]] std::variant<std::vector<std::array<double, 3>>, std::string> MeshPoints(
    const std::string& text, const std::string& path);

// The same with the mesh's triangles; polygons are divided into triangles. COLLADA and glTF have a
// colour.
[[nodiscard]] std::variant<Surface, std::string> MeshSurface(const std::string& text,
                                                             const std::string& path);

// Whether the file can be a mesh: by the end of its name.
bool IsMeshName(const std::string& path);

}  // namespace tcs
