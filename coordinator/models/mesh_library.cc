#include "coordinator/models/mesh_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>
#include <variant>

#include "coordinator/models/file_text.h"
#include "coordinator/models/hull_cache.h"
#include "coordinator/models/in_child.h"
#include "coordinator/models/mesh_hull.h"
#include "coordinator/models/mesh_points.h"
#include "coordinator/models/model_mistake.h"
#include "coordinator/models/packed_mesh.h"
#include "coordinator/models/urdf_xml.h"
#include "simbody_bridge/model/convex_hull.h"

namespace tcs {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr std::size_t kMostVertices = 512;
constexpr unsigned kMostSeconds = 20;

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

// The child's other answers: a letter, and what follows it.
constexpr char kWhyNotFollows = 'W', kFlatFollows = 'F', kIsLine = 'L';
static_assert(kWhyNotFollows != kMeshFollows && kFlatFollows != kMeshFollows);

std::string HullInFile(const std::string& text, const std::string& path) {
  auto read = MeshPoints(text, path);
  if (const auto* why = std::get_if<std::string>(&read)) return kWhyNotFollows + *why;
  const auto& points = std::get<std::vector<Point>>(read);
  for (const Point& point : points) {
    for (const double x : point) {
      if (!std::isfinite(x)) return std::string(1, kWhyNotFollows) + "a vertex in it is not finite";
    }
  }
  if (points.empty()) return std::string(1, kWhyNotFollows) + "there is no vertex in it";
  const Hull hull = MeshHull(points, kMostVertices);
  if (!hull.vertices.empty()) return Packed({hull.vertices, hull.triangles});
  const Hull plate = MeshHull(PlateOf(points), kMostVertices);
  if (plate.vertices.empty()) return std::string(1, kIsLine);
  return kFlatFollows + Packed({plate.vertices, plate.triangles});
}

[[noreturn]] void Refuse(const std::string& path, std::string_view why) {
  throw ModelMistake{
      fmt::format("{}: this mesh cannot be used: {}; repair or replace it", path, why)};
}

// "stl".
std::string ReaderOf(const std::string& path) {
  std::string end = path.substr(path.find_last_of('.') + 1);
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return end;
}

// No vertices: a line or a point.
Mesh Read(const std::string& path, bool* is_flat) {
  if (!IsMeshName(path)) {
    throw ModelMistake{path +
                       ": is not a mesh that tcs reads; give a file of .stl, .obj, .dae or .glb"};
  }
  const std::string text = TextOf(path, kMostBytes, "a mesh");
  const HullCache cache(text, ReaderOf(path), kMostVertices);
  Surface hull;
  if (Unpack(cache.Find(), kMostVertices, 2 * kMostVertices, &hull)) {
    return {path, std::move(hull.vertices), std::move(hull.triangles)};
  }
  constexpr std::size_t kMostSaid = 1 << 20;
  const ChildWork done = DoInChild([&] { return HullInFile(text, path); }, kMostSeconds, kMostSaid);
  if (!done.failure.empty()) Refuse(path, done.failure);
  if (!done.result.empty() && done.result[0] == kWhyNotFollows) {
    constexpr std::size_t kLongest = 200;
    const std::string shown = Quoted(std::string_view(done.result).substr(1, kLongest));
    Refuse(path, shown.substr(1, shown.size() - 2));
  }
  if (done.result == std::string(1, kIsLine)) return {path, {}, {}};
  *is_flat = done.result.starts_with(kFlatFollows);
  if (!Unpack(done.result.substr(*is_flat ? 1 : 0), kMostVertices, 2 * kMostVertices, &hull)) {
    Refuse(path, "the library that reads it fails");
  }
  // A plate is not kept: nothing in the cache would say that it is one.
  if (!*is_flat) cache.Keep(done.result);
  return {path, std::move(hull.vertices), std::move(hull.triangles)};
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
  if (read == read_.end()) {
    bool is_flat = false;
    read = read_.emplace(path, Read(path, &is_flat)).first;
    if (is_flat) flat_files_.insert(path);
  }
  Mesh scaled = Scaled(read->second, scale);
  // The mesh is flat by its scale, or but for rounding.
  if (!scaled.vertices_m.empty() && !SpansVolume(scaled.vertices_m)) {
    Hull plate = MeshHull(PlateOf(scaled.vertices_m), kMostVertices);
    scaled = {path, std::move(plate.vertices), std::move(plate.triangles)};
    flat_.insert({path, scale});
  }
  if (scaled.vertices_m.empty()) return nullptr;
  mesh = std::make_shared<const Mesh>(std::move(scaled));
  return mesh;
}

bool MeshLibrary::IsFlat(const std::string& path, const Point& scale) const {
  return flat_files_.contains(path) || flat_.contains({path, scale});
}

}  // namespace tcs
