#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "coordinator/models/mesh_library.h"
#include "coordinator/models/model_mistake.h"
#include "simbody_bridge/model/convex_hull.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

using testing::HasSubstr;

std::string Complaint(const std::string& path) {
  try {
    static_cast<void>(MeshLibrary().Take(path, {1, 1, 1}));
  } catch (const ModelMistake& mistake) {
    EXPECT_TRUE(mistake.message.starts_with(path + ": ")) << mistake.message;
    EXPECT_EQ(mistake.message.find('\n'), std::string::npos) << mistake.message;
    return mistake.message.substr(path.size() + 2);
  }
  return "";
}

// As tools write it: 80 bytes of anything, a count, and 50 bytes for each triangle.
std::string BinaryStl(const std::vector<std::array<float, 9>>& triangles, std::uint32_t count) {
  std::string text(80, ' ');
  text.append(reinterpret_cast<const char*>(&count), sizeof count);
  for (const auto& triangle : triangles) {
    text.append(12, '\0');
    text.append(reinterpret_cast<const char*>(triangle.data()), sizeof triangle);
    text.append(2, '\0');
  }
  return text;
}

const std::vector<std::array<float, 9>> kTetrahedron = {{0, 0, 0, 0, 1, 0, 1, 0, 0},
                                                        {0, 0, 0, 1, 0, 0, 0, 0, 1},
                                                        {0, 0, 0, 0, 0, 1, 0, 1, 0},
                                                        {1, 0, 0, 0, 1, 0, 0, 0, 1}};

TEST(MeshLibrary, ReadsBinaryStl) {
  const ModelFolder folder;
  const std::string path = folder.Write("a.STL", BinaryStl(kTetrahedron, 4));
  const auto mesh = MeshLibrary().Take(path, {2, 2, 2});
  EXPECT_EQ(mesh->name, path);
  EXPECT_EQ(mesh->vertices_m.size(), 4u);
  EXPECT_EQ(mesh->triangles.size(), 4u);
  EXPECT_THAT(mesh->vertices_m, testing::Contains(std::array<double, 3>{0, 0, 2}));
}

TEST(MeshLibrary, ReadsEachFileOnceAndSharesWhatIsScaledTheSame) {
  const ModelFolder folder;
  const std::string path = folder.Write("a.stl", BinaryStl(kTetrahedron, 4));
  MeshLibrary library;
  const auto one = library.Take(path, {1, 1, 1});
  std::filesystem::remove(path);
  EXPECT_EQ(library.Take(path, {1, 1, 1}), one);
  EXPECT_NE(library.Take(path, {1, 1, 2}), one);
}

TEST(MeshLibrary, SaysWhatCannotBeUsed) {
  const ModelFolder folder;
  EXPECT_THAT(Complaint(folder.Path("none.stl")), HasSubstr("No such file"));
  EXPECT_THAT(Complaint(folder.Write("a.ply", "ply")),
              HasSubstr("give a file of .stl, .obj, .dae or .glb"));
  EXPECT_THAT(Complaint(folder.Write("a", "x")), HasSubstr("not a mesh that tcs reads"));
  EXPECT_THAT(Complaint(folder.Write("b.stl", "")), HasSubstr("cannot be used"));
  EXPECT_THAT(Complaint(folder.Write("c.stl", "solid x\nendsolid x\n")),
              HasSubstr("cannot be used"));
  EXPECT_THAT(Complaint(folder.Write("e.obj",
                                     "v 0 0 0\nv 1 0 0\nv nan 0 1\nv 0 1 0\n"
                                     "f 1 2 3\nf 1 2 4\n")),
              testing::AnyOf(HasSubstr("not finite"), HasSubstr("cannot be used")));
  EXPECT_THAT(Complaint(folder.Write("f.dae", "<COLLADA")), HasSubstr("cannot be used"));
  std::filesystem::create_directory(folder.Path("g.stl"));
  EXPECT_THAT(Complaint(folder.Path("g.stl")), HasSubstr("is not a regular file"));
}

TEST(MeshLibrary, TakesWhatIsFlatAsAThinPlate) {
  const ModelFolder folder;
  const std::string path = folder.Write("a.stl", BinaryStl({kTetrahedron[0]}, 1));
  MeshLibrary library;
  const auto plate = library.Take(path, {1, 1, 1});
  EXPECT_TRUE(library.IsFlat(path, {1, 1, 1}));
  ASSERT_EQ(plate->vertices_m.size(), 6u);
  for (const auto& vertex : plate->vertices_m) EXPECT_NEAR(std::abs(vertex[2]), 1.0 / 400, 1e-9);
  const std::string whole = folder.Write("b.stl", BinaryStl(kTetrahedron, 4));
  static_cast<void>(library.Take(whole, {1, 1, 1}));
  EXPECT_FALSE(library.IsFlat(whole, {1, 1, 1}));
}

// By its scale, or for the rounding of a plane that is tilted.
TEST(MeshLibrary, TakesWhatIsFlatByItsScaleOrButForRoundingAsAPlate) {
  const ModelFolder folder;
  const std::string solid = folder.Write("solid.stl", BinaryStl(kTetrahedron, 4));
  std::vector<std::array<float, 9>> tilted;
  for (int i = 0; i < 10; ++i) {
    std::array<float, 9> triangle{};
    for (int corner = 0; corner < 3; ++corner) {
      const double x = std::cos(i + 2.1 * corner), y = std::sin(i + 2.1 * corner);
      triangle[3 * corner] = static_cast<float>(x);
      triangle[3 * corner + 1] = static_cast<float>(y);
      triangle[3 * corner + 2] = static_cast<float>(0.3 * x + 0.7 * y);
    }
    tilted.push_back(triangle);
  }
  const std::string plane = folder.Write("plane.stl", BinaryStl(tilted, 10));
  MeshLibrary library;
  for (const auto& [path, scale] : {std::pair{solid, std::array<double, 3>{1, 1, 0}},
                                    {solid, {1, -1, 1e-7}},
                                    {plane, {1, 1, 1}}}) {
    const auto mesh = library.Take(path, scale);
    ASSERT_NE(mesh, nullptr) << path;
    EXPECT_TRUE(library.IsFlat(path, scale)) << path;
    EXPECT_TRUE(SpansVolume(mesh->vertices_m)) << path;
  }
  EXPECT_FALSE(library.IsFlat(solid, {1, 1, 1}));
  EXPECT_EQ(library.Take(solid, {1, 0, 0}), nullptr) << "a line";
}

TEST(MeshLibrary, TakesNothingOfALine) {
  const ModelFolder folder;
  const std::string path = folder.Write(
      "a.stl", BinaryStl({{0, 0, 0, 1, 0, 0, 2, 0, 0}, {1, 0, 0, 2, 0, 0, 3, 0, 0}}, 2));
  EXPECT_EQ(MeshLibrary().Take(path, {1, 1, 1}), nullptr);
}

TEST(MeshLibrary, TakesNothingThatIsTooLarge) {
  const ModelFolder folder;
  const std::string path = folder.Write("a.stl", "");
  std::filesystem::resize_file(path, std::uintmax_t{2} << 30);
  EXPECT_THAT(Complaint(path), HasSubstr("has 2147483648 bytes, more than the 64 MiB"));
}

// None of what a mesh promises makes the reader take the promised memory, or the process down.
TEST(MeshLibrary, SurvivesMeshesThatAreNotWhatTheySay) {
  const ModelFolder folder;
  EXPECT_NE(Complaint(folder.Write("a.stl", BinaryStl(kTetrahedron, 0xffffffffu))), "");
  EXPECT_NE(Complaint(folder.Write("b.stl", BinaryStl(kTetrahedron, 5))), "");
  EXPECT_NE(Complaint(folder.Write("c.obj", "v 0 0 0\nf 1 2 99999999\nf -7 1 1\n")), "");
  const std::string dae = TextOfZoo("zoo_description/meshes/wedge.dae");
  std::string many = dae;
  many.replace(many.find("count=\"7\""), 9, "count=\"4000000000\"");
  static_cast<void>(Complaint(folder.Write("d.dae", many)));
  std::string deep;
  for (int i = 0; i < 200'000; ++i) deep += "<node>";
  std::string nested = dae;
  nested.insert(nested.find("<node id"), deep);
  EXPECT_NE(Complaint(folder.Write("e.dae", nested)), "");
  std::string bomb = "<!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\">";
  for (char c = 'b'; c < 'p'; ++c) {
    bomb += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 10; ++i) bomb += std::string("&") + static_cast<char>(c - 1) + ";";
    bomb += "\">";
  }
  std::string entities = dae;
  entities.insert(entities.find("<COLLADA"), bomb + "]>");
  entities.replace(entities.find("0 0 0 "), 6, "&o; 0 0 0 ");
  static_cast<void>(Complaint(folder.Write("f.dae", entities)));
  for (std::size_t size = 0; size < dae.size(); size += 97) {
    static_cast<void>(Complaint(folder.Write("g.dae", dae.substr(0, size))));
  }
}

}  // namespace
}  // namespace tcs
