#include "coordinator/report/looks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "coordinator/models/mesh_looks.h"
#include "coordinator/report/bytes.h"

namespace tcs::report {
namespace {

using Json = nlohmann::ordered_json;

// A triangle takes some 10 bytes with its share of the vertices.
constexpr std::size_t kMostTriangles = 60'000, kMostOfOne = 6'000, kMostFiles = 60;

// A coordinate has 16 bits over the mesh's span, in steps of a micrometre at the least.
constexpr double kStepsOfLooks = 65'535, kLeastLookM = 1e-6;

Json MeshJson(const Surface& surface) {
  std::array<double, 3> least{}, step{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto along = [axis](const std::array<double, 3>& vertex) { return vertex[axis]; };
    const auto [low, high] = std::ranges::minmax_element(surface.vertices, {}, along);
    least[axis] = along(*low);
    step[axis] = std::max(kLeastLookM, (along(*high) - along(*low)) / kStepsOfLooks);
  }
  std::string vertices, triangles;
  std::array<std::int64_t, 3> before{};
  for (const auto& vertex : surface.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t now = std::llround((vertex[axis] - least[axis]) / step[axis]);
      PutSigned(&vertices, now - before[axis]);
      before[axis] = now;
    }
  }
  std::int64_t last = 0;
  for (const auto& triangle : surface.triangles) {
    for (const std::uint32_t vertex : triangle) {
      PutSigned(&triangles, static_cast<std::int64_t>(vertex) - last);
      last = vertex;
    }
  }
  return {{"least", least},
          {"step", step},
          {"vertices", Base64(vertices)},
          {"triangles", Base64(triangles)}};
}

}  // namespace

Looks::Looks(std::size_t files)
    : most_triangles_(
          std::min(kMostOfOne, kMostTriangles / std::clamp<std::size_t>(files, 1, kMostFiles))),
      files_left_(kMostFiles) {}

std::optional<std::size_t> Looks::Take(const std::string& path, const std::array<double, 3>& scale,
                                       Json* meshes) {
  const auto [known, is_new] = taken_.try_emplace({path, scale});
  if (!is_new || files_left_ == 0) return known->second;
  --files_left_;
  auto surface = ReadLooks(path, most_triangles_);
  if (!surface) return {};
  for (auto& vertex : surface->vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) vertex[axis] *= scale[axis];
  }
  // A mirror turns triangles inside out.
  if (scale[0] * scale[1] * scale[2] < 0) {
    for (auto& triangle : surface->triangles) std::swap(triangle[1], triangle[2]);
  }
  known->second = meshes->size();
  meshes->push_back(MeshJson(*surface));
  if (surface->colour) colours_[*known->second] = *surface->colour;
  return known->second;
}

std::optional<std::array<double, 3>> Looks::ColourOf(std::size_t mesh) const {
  const auto known = colours_.find(mesh);
  return known == colours_.end() ? std::nullopt : std::optional(known->second);
}

}  // namespace tcs::report
