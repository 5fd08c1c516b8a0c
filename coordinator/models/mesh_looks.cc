#include "coordinator/models/mesh_looks.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "coordinator/models/decimate.h"
#include "coordinator/models/file_text.h"
#include "coordinator/models/in_child.h"
#include "coordinator/models/mesh_points.h"
#include "coordinator/models/model_mistake.h"

namespace tcs {
namespace {

constexpr std::size_t kMostLooksBytes = std::size_t{64} << 20;
constexpr unsigned kMostLooksSeconds = 10;

bool IsFinite(const Surface& surface) {
  return std::ranges::all_of(surface.vertices, [](const auto& vertex) {
    return std::ranges::all_of(vertex, [](double x) { return std::isfinite(x); });
  });
}

}  // namespace

std::optional<Surface> ReadLooks(const std::string& path, std::size_t most_triangles) {
  if (!IsMeshName(path) || most_triangles == 0) return {};
  try {
    CheckFile(path, kMostLooksBytes, "a mesh");
  } catch (const ModelMistake&) {
    return {};
  }
  const std::size_t most_vertices = 3 * most_triangles;
  const auto work = [&]() -> std::string {
    const auto read = MeshSurface(TextOf(path, kMostLooksBytes, "a mesh"), path);
    const auto* surface = std::get_if<Surface>(&read);
    if (surface == nullptr || !IsFinite(*surface) || surface->triangles.empty()) return {};
    Surface fewer = Decimated(*surface, most_triangles);
    fewer.colour = surface->colour;
    return Packed(fewer);
  };
  // Three numbers for each vertex, three indices for each triangle.
  const std::size_t most_packed = 64 + most_vertices * 24 + most_triangles * 12;
  const ChildWork done = DoInChild(work, kMostLooksSeconds, most_packed);
  Surface surface;
  if (!done.failure.empty() || !Unpack(done.result, most_vertices, most_triangles, &surface) ||
      !IsFinite(surface) || surface.triangles.empty()) {
    return {};
  }
  return surface;
}

}  // namespace tcs
