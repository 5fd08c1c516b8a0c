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
  // Of most of its area: red, green, blue, from 0 to 1; none where the file gives it none.
  std::optional<std::array<double, 3>> colour{};
};

// Begins with this letter.
inline constexpr char kMeshFollows = 'H';

std::string Packed(const Surface& surface);

// False if it is none that could have been packed, or it is larger: whatever was in the mesh may
// have taken the child over.
bool Unpack(const std::string& packed, std::size_t most_vertices, std::size_t most_triangles,
            Surface* surface);

}  // namespace tcs
