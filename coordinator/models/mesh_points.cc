#include "coordinator/models/mesh_points.h"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

std::string EndOf(const std::string& path) {
  std::string end = std::filesystem::path(path).extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end;
}

// A mesh may name other files (materials), which could be anything: there are none.
class NoFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

}  // namespace

bool IsMeshName(const std::string& path) {
  const std::string end = EndOf(path);
  return end == ".stl" || end == ".obj" || end == ".dae" || end == ".glb" || end == ".gltf";
}

namespace {

// Appends a mesh of the scene, at its place in the scene.
void Append(const aiMesh& mesh, const aiMatrix4x4& transform, bool with_triangles,
            Surface* surface) {
  const auto first = static_cast<std::uint32_t>(surface->vertices.size());
  for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
    const aiVector3D at = transform * mesh.mVertices[k];
    surface->vertices.push_back({at.x, at.y, at.z});
  }
  if (!with_triangles) return;
  for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
    const aiFace& face = mesh.mFaces[k];
    for (unsigned corner = 2; corner < face.mNumIndices; ++corner) {
      const unsigned a = face.mIndices[0], b = face.mIndices[corner - 1], c = face.mIndices[corner];
      if (std::max({a, b, c}) >= mesh.mNumVertices) continue;
      surface->triangles.push_back({first + a, first + b, first + c});
    }
  }
}

// The colour of the mesh in the file's own materials. STL and OBJ have none here: their materials
// are in other files.
std::optional<std::array<double, 3>> ColourOf(const aiScene& scene, const aiMesh& mesh) {
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return {};
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  aiColor4D colour;
  if (material.Get(AI_MATKEY_BASE_COLOR, colour) != AI_SUCCESS &&
      material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) != AI_SUCCESS) {
    return {};
  }
  std::array<double, 3> parts = {colour.r, colour.g, colour.b};
  for (double& part : parts) {
    if (!std::isfinite(part)) return {};
    part = std::clamp(part, 0.0, 1.0);
  }
  return parts;
}

// The area of the triangles of a surface from the number `first` on.
double AreaFrom(const Surface& surface, std::size_t first) {
  double area = 0;
  for (std::size_t i = first; i < surface.triangles.size(); ++i) {
    const auto& [a, b, c] = surface.triangles[i];
    const auto across = Cross(Minus(surface.vertices[b], surface.vertices[a]),
                              Minus(surface.vertices[c], surface.vertices[a]));
    area += std::sqrt(Dot(across, across)) / 2;
  }
  return area;
}

std::variant<Surface, std::string> Read(const std::string& text, const std::string& path,
                                        bool with_triangles) {
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);  // the importer owns it then
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene =
      importer.ReadFileFromMemory(text.data(), text.size(), 0, EndOf(path).c_str() + 1);
  if (scene == nullptr) return std::string("it cannot be read: ") + importer.GetErrorString();
  if (scene->mRootNode == nullptr) return "there is nothing in it";
  Surface surface;
  const std::string end = EndOf(path);
  const bool has_colours = with_triangles && end != ".stl" && end != ".obj";
  std::map<std::array<double, 3>, double> areas;  // of each colour
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> to_do = {{scene->mRootNode, aiMatrix4x4()}};
  while (!to_do.empty()) {
    const auto [node, above] = to_do.back();
    to_do.pop_back();
    const aiMatrix4x4 transform = above * node->mTransformation;
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      const aiMesh& mesh = *scene->mMeshes[node->mMeshes[i]];
      const std::size_t first = surface.triangles.size();
      Append(mesh, transform, with_triangles, &surface);
      const auto colour = has_colours ? ColourOf(*scene, mesh) : std::nullopt;
      if (colour) areas[*colour] += AreaFrom(surface, first);
    }
    for (unsigned i = 0; i < node->mNumChildren; ++i) {
      to_do.emplace_back(node->mChildren[i], transform);
    }
  }
  const auto largest = std::ranges::max_element(
      areas, {}, [](const auto& colour_and_area) { return colour_and_area.second; });
  if (largest != areas.end()) surface.colour = largest->first;
  return surface;
}

}  // namespace

std::variant<std::vector<std::array<double, 3>>, std::string> MeshPoints(const std::string& text,
                                                                         const std::string& path) {
  auto read = Read(text, path, false);
  if (auto* why = std::get_if<std::string>(&read)) return std::move(*why);
  return std::move(std::get<Surface>(read).vertices);
}

std::variant<Surface, std::string> MeshSurface(const std::string& text, const std::string& path) {
  return Read(text, path, true);
}

}  // namespace tcs
