#include "coordinator/models/mesh_library.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <utility>
#include <variant>

#include "coordinator/models/file_text.h"
#include "coordinator/models/in_child.h"
#include "coordinator/models/mesh_hull.h"
#include "coordinator/models/mesh_points.h"
#include "coordinator/models/model_mistake.h"
#include "coordinator/models/urdf_xml.h"

namespace tcs {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr std::size_t kMostVertices = 512;
constexpr unsigned kMostSeconds = 20;

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

// What the child says: a word, and what follows it.
constexpr char kHullFollows = 'H', kWhyNotFollows = 'W';

std::string Packed(const Hull& hull) {
  const std::uint64_t sizes[2] = {hull.vertices.size(), hull.triangles.size()};
  std::string packed(1, kHullFollows);
  packed.append(reinterpret_cast<const char*>(sizes), sizeof sizes);
  packed.append(reinterpret_cast<const char*>(hull.vertices.data()), sizes[0] * sizeof(Point));
  packed.append(reinterpret_cast<const char*>(hull.triangles.data()), sizes[1] * sizeof(Triangle));
  return packed;
}

// False if it is no hull that could have been packed: whatever was in the mesh may have taken the
// child over.
bool Unpack(const std::string& packed, Mesh* mesh) {
  std::uint64_t sizes[2];
  if (packed.size() < 1 + sizeof sizes || packed[0] != kHullFollows) return false;
  std::memcpy(sizes, packed.data() + 1, sizeof sizes);
  if (sizes[0] > kMostVertices || sizes[1] > 2 * kMostVertices) return false;
  const std::size_t points = sizes[0] * sizeof(Point), triangles = sizes[1] * sizeof(Triangle);
  if (packed.size() != 1 + sizeof sizes + points + triangles) return false;
  mesh->vertices_m.resize(sizes[0]);
  mesh->triangles.resize(sizes[1]);
  const char* from = packed.data() + 1 + sizeof sizes;
  if (points > 0) std::memcpy(mesh->vertices_m.data(), from, points);
  if (triangles > 0) std::memcpy(mesh->triangles.data(), from + points, triangles);
  for (const Triangle& triangle : mesh->triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= sizes[0]) return false;
    }
  }
  return true;
}

std::string HullInFile(const std::string& path) {
  auto read = MeshPoints(TextOf(path, kMostBytes, "a mesh"), path);
  if (const auto* why = std::get_if<std::string>(&read)) return kWhyNotFollows + *why;
  const auto& points = std::get<std::vector<Point>>(read);
  for (const Point& point : points) {
    for (const double x : point) {
      if (!std::isfinite(x)) return std::string(1, kWhyNotFollows) + "a vertex in it is not finite";
    }
  }
  const Hull hull = MeshHull(points, kMostVertices);
  if (hull.vertices.empty()) {
    return kWhyNotFollows + fmt::format("its {} vertices span no volume", points.size());
  }
  return Packed(hull);
}

[[noreturn]] void Refuse(const std::string& path, std::string_view why) {
  throw ModelMistake{
      fmt::format("{}: this mesh cannot be used: {}; repair or replace it", path, why)};
}

Mesh Read(const std::string& path) {
  if (!IsMeshName(path)) {
    throw ModelMistake{path + ": is not a mesh that tcs reads; give a file of .stl, .obj or .dae"};
  }
  CheckFile(path, kMostBytes, "a mesh");
  constexpr std::size_t kMostSaid = 1 << 20;
  const ChildWork done = DoInChild([&path] { return HullInFile(path); }, kMostSeconds, kMostSaid);
  if (!done.failure.empty()) Refuse(path, done.failure);
  if (!done.result.empty() && done.result[0] == kWhyNotFollows) {
    constexpr std::size_t kLongest = 200;
    const std::string shown = Quoted(std::string_view(done.result).substr(1, kLongest));
    Refuse(path, shown.substr(1, shown.size() - 2));
  }
  Mesh mesh{path, {}, {}};
  if (!Unpack(done.result, &mesh)) Refuse(path, "the library that reads it fails");
  return mesh;
}

Mesh Scaled(Mesh mesh, const Point& scale) {
  for (Point& vertex : mesh.vertices_m) {
    for (std::size_t i = 0; i < 3; ++i) vertex[i] *= scale[i];
  }
  // A mirror turns triangles inside out.
  if (scale[0] * scale[1] * scale[2] < 0) {
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

}  // namespace

std::shared_ptr<const Mesh> MeshLibrary::Take(const std::string& path, const Point& scale) {
  std::shared_ptr<const Mesh>& mesh = scaled_[{path, scale}];
  if (mesh != nullptr) return mesh;
  auto read = read_.find(path);
  if (read == read_.end()) read = read_.emplace(path, Read(path)).first;
  mesh = std::make_shared<const Mesh>(Scaled(read->second, scale));
  return mesh;
}

}  // namespace tcs
