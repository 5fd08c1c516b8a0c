#include "coordinator/models/packed_mesh.h"

#include <algorithm>
#include <cstring>

namespace tcs {
namespace {

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

}  // namespace

std::string Packed(const Surface& surface) {
  const std::uint64_t sizes[2] = {surface.vertices.size(), surface.triangles.size()};
  std::string packed(1, kMeshFollows);
  packed.append(reinterpret_cast<const char*>(sizes), sizeof sizes);
  packed.append(reinterpret_cast<const char*>(surface.vertices.data()), sizes[0] * sizeof(Point));
  packed.append(reinterpret_cast<const char*>(surface.triangles.data()),
                sizes[1] * sizeof(Triangle));
  if (surface.colour) {
    packed.append(reinterpret_cast<const char*>(surface.colour->data()), sizeof(Point));
  }
  return packed;
}

bool Unpack(const std::string& packed, std::size_t most_vertices, std::size_t most_triangles,
            Surface* surface) {
  std::uint64_t sizes[2];
  if (packed.size() < 1 + sizeof sizes || packed[0] != kMeshFollows) return false;
  std::memcpy(sizes, packed.data() + 1, sizeof sizes);
  if (sizes[0] > most_vertices || sizes[1] > most_triangles) return false;
  const std::size_t points = sizes[0] * sizeof(Point), triangles = sizes[1] * sizeof(Triangle);
  const std::size_t colourless = 1 + sizeof sizes + points + triangles;
  const bool has_colour = packed.size() == colourless + sizeof(Point);
  if (packed.size() != colourless && !has_colour) return false;
  surface->vertices.resize(sizes[0]);
  surface->triangles.resize(sizes[1]);
  const char* from = packed.data() + 1 + sizeof sizes;
  if (points > 0) std::memcpy(surface->vertices.data(), from, points);
  if (triangles > 0) std::memcpy(surface->triangles.data(), from + points, triangles);
  for (const Triangle& triangle : surface->triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= sizes[0]) return false;
    }
  }
  if (!has_colour) return true;
  Point& colour = surface->colour.emplace();
  std::memcpy(colour.data(), from + points + triangles, sizeof colour);
  return std::ranges::all_of(colour, [](double part) { return part >= 0 && part <= 1; });
}

}  // namespace tcs
