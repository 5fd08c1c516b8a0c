// The meshes that robots are drawn with and that never collide.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "coordinator/models/packed_mesh.h"

namespace tcs {

// The surface in the file `path` (STL, OBJ, COLLADA, glTF), in metres, as ROS takes it, of at most
// so many triangles (decimate.h). None for a file that is no mesh, has no triangles, is larger than
// 64 MiB, or takes longer than 10 s to read: nothing depends on how a robot looks.
[[nodiscard]] std::optional<Surface> ReadLooks(const std::string& path, std::size_t most_triangles);

}  // namespace tcs
