// Hulls of large meshes are kept between runs, and nothing depends on it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "coordinator/models/mesh_library.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

// The user's cache is in a folder of the test's.
class HullCaches : public testing::Test {
 protected:
  HullCaches() {
    setenv("XDG_CACHE_HOME", folder_.Path("cache").c_str(), 1);
    mesh_ = folder_.Write("ball.obj", Ball());
  }
  ~HullCaches() override { unsetenv("XDG_CACHE_HOME"); }

  // Some 130 KB.
  static std::string Ball() {
    constexpr int kRings = 60, kSides = 40;
    std::string text;
    for (int ring = 0; ring <= kRings; ++ring) {
      for (int side = 0; side < kSides; ++side) {
        const double down = M_PI * ring / kRings, around = 2 * M_PI * side / kSides;
        text += "v " + std::to_string(std::sin(down) * std::cos(around)) + ' ' +
                std::to_string(std::sin(down) * std::sin(around)) + ' ' +
                std::to_string(std::cos(down)) + '\n';
      }
    }
    for (int i = 1; i + kSides < (kRings + 1) * kSides; ++i) {
      text += "f " + std::to_string(i) + ' ' + std::to_string(i + 1) + ' ' +
              std::to_string(i + kSides) + '\n';
    }
    return text;
  }

  Mesh Read() const { return *MeshLibrary().Take(mesh_, {1, 1, 1}); }
  static void ExpectSame(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.vertices_m, b.vertices_m);
    EXPECT_EQ(a.triangles, b.triangles);
  }
  std::vector<std::filesystem::path> Kept() const {
    std::vector<std::filesystem::path> kept;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.Path("cache"))) {
      if (entry.is_regular_file()) kept.push_back(entry.path());
    }
    return kept;
  }

  ModelFolder folder_;
  std::string mesh_;
};

TEST_F(HullCaches, KeepOneFileForAMesh) {
  const Mesh first = Read();
  ASSERT_EQ(Kept().size(), 1u);
  ExpectSame(Read(), first);
  EXPECT_EQ(Kept().size(), 1u);
}

TEST_F(HullCaches, ThatAreDamagedAreAsIfTheyWereNotThere) {
  const Mesh first = Read();
  const std::string path = Kept().at(0);
  std::ifstream in(path, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  std::string changed = whole;
  changed[changed.size() / 2] ^= 1;
  for (const std::string& damaged : {changed, whole.substr(0, whole.size() - 1), std::string()}) {
    std::ofstream(path, std::ios::binary) << damaged;
    ExpectSame(Read(), first);
  }
}

TEST_F(HullCaches, ThatCannotBeWrittenAreMissedByNobody) {
  const Mesh first = Read();
  std::filesystem::remove_all(folder_.Path("cache"));
  folder_.Write("cache", "a file in the folder's place");
  ExpectSame(Read(), first);
}

}  // namespace
}  // namespace tcs
