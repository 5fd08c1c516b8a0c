// A mesh as a child process hands it over (in_child.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tcs {

// Triangles are of vertices by index.
struct Surface {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // The colour of most of the surface's area: red, green, blue, from 0 to 1; none where the file
  // gives no colour.
  std::optional<std::array<double, 3>> colour{};
};

// A packed mesh begins with this letter.
inline constexpr char kMeshFollows = 'H';

std::string Packed(const Surface& surface);

// False if `packed` is no mesh that could have been packed, or is larger: whatever was in the mesh
// may have taken the child over.
bool Unpack(const std::string& packed, std::size_t most_vertices, std::size_t most_triangles,
            Surface* surface);

}  // namespace tcs
