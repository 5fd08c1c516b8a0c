// Surfaces that are looked at, and fewer triangles for them.
#include "coordinator/models/mesh_looks.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coordinator/models/decimate.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

using testing::SizeIs;

// A bowl: half a ball of radius 1, which a hull would close.
Surface Bowl(int rings, int around) {
  Surface bowl;
  for (int ring = 0; ring <= rings; ++ring) {
    const double down = std::numbers::pi / 2 * ring / rings;
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      bowl.vertices.push_back(
          {std::cos(down) * std::cos(angle), std::cos(down) * std::sin(angle), -std::sin(down)});
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < around; ++i) {
      const auto at = [&](int r, int k) {
        return static_cast<std::uint32_t>(r * around + k % around);
      };
      bowl.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i)});
      bowl.triangles.push_back({at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)});
    }
  }
  return bowl;
}

std::string ObjOf(const Surface& surface) {
  std::string text;
  for (const auto& [x, y, z] : surface.vertices) text += fmt::format("v {} {} {}\n", x, y, z);
  for (const auto& [a, b, c] : surface.triangles) {
    text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return text;
}

double AreaOf(const Surface& surface) {
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto &p = surface.vertices[a], &q = surface.vertices[b], &r = surface.vertices[c];
    const std::array<double, 3> u = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    const std::array<double, 3> v = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
    area += std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                       u[0] * v[1] - u[1] * v[0]) /
            2;
  }
  return area;
}

TEST(Decimated, LeavesWhatIsSmallEnough) {
  const Surface bowl = Bowl(4, 12);
  const Surface same = Decimated(bowl, 1000);
  EXPECT_THAT(same.triangles, SizeIs(2 * 4 * 12));
  EXPECT_NEAR(AreaOf(same), AreaOf(bowl), 1e-12);
}

TEST(Decimated, JoinsCornersAtOnePlace) {
  Surface soup;
  for (const auto& triangle : Bowl(4, 12).triangles) {
    for (const std::uint32_t vertex : triangle) {
      soup.vertices.push_back(Bowl(4, 12).vertices[vertex]);
    }
    const auto count = static_cast<std::uint32_t>(soup.vertices.size());
    soup.triangles.push_back({count - 3, count - 2, count - 1});
  }
  EXPECT_LE(Decimated(soup, 1000).vertices.size(), 4u * 12 + 12);
}

TEST(Decimated, IsStillTheSameSurface) {
  const Surface bowl = Bowl(60, 200);
  const Surface few = Decimated(bowl, 2000);
  EXPECT_LE(few.triangles.size(), 2000u);
  EXPECT_GT(few.triangles.size(), 800u) << "as many as may be, or nearly";
  EXPECT_NEAR(AreaOf(few), 2 * std::numbers::pi, 0.05 * 2 * std::numbers::pi);
  for (const auto& [x, y, z] : few.vertices) EXPECT_NEAR(std::hypot(x, y, z), 1, 0.06);
  for (const auto& triangle : few.triangles) {
    for (const std::uint32_t vertex : triangle) EXPECT_LT(vertex, few.vertices.size());
  }
}

TEST(Decimated, EndsWhateverIsAskedFor) {
  EXPECT_LE(Decimated(Bowl(10, 30), 1).triangles.size(), 1u);
}

TEST(MeshLooks, AreTheSurfaceAndNotItsHull) {
  const ModelFolder folder;
  const auto read = ReadLooks(folder.Write("bowl.obj", ObjOf(Bowl(60, 200))), 2000);
  ASSERT_TRUE(read.has_value());
  EXPECT_LE(read->triangles.size(), 2000u);
  EXPECT_NEAR(AreaOf(*read), 2 * std::numbers::pi, 0.05 * 2 * std::numbers::pi)
      << "the hull has a lid: 3 pi";
}

TEST(MeshLooks, HavePolygonsAsTriangles) {
  const ModelFolder folder;
  const auto read =
      ReadLooks(folder.Write("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4\n"), 2000);
  ASSERT_TRUE(read.has_value()) << "what is flat has looks, though no volume";
  EXPECT_NEAR(AreaOf(*read), 2, 1e-6);
}

TEST(MeshLooks, AreNoneWhereTheyCannotBeRead) {
  const ModelFolder folder;
  EXPECT_FALSE(ReadLooks(folder.Path("gone.stl"), 100));
  EXPECT_FALSE(ReadLooks(folder.Write("a.stl", "nonsense"), 100));
  EXPECT_FALSE(ReadLooks(folder.Write("a.txt", ObjOf(Bowl(4, 12))), 100));
  EXPECT_FALSE(ReadLooks(folder.Write("points.obj", "v 0 0 0\nv 1 0 0\nv 1 2 0\n"), 100));
  EXPECT_FALSE(ReadLooks(folder.Path(""), 100)) << "a folder";
}

// Two materials: of most of its area it is orange.
TEST(MeshLooks, HaveTheColourOfMostOfTheirArea) {
  const ModelFolder folder;
  std::string dae = TextOfZoo("zoo_description/meshes/wedge.dae");
  const auto put = [&dae](std::string_view before, std::string_view text) {
    dae.insert(dae.find(before), text);
  };
  const auto effect = [](std::string_view name, std::string_view rgba) {
    return "<effect id='" + std::string(name) +
           "-fx'><profile_COMMON><technique sid='common'><lambert><diffuse><color>" +
           std::string(rgba) + "</color></diffuse></lambert></technique></profile_COMMON></effect>";
  };
  put("<library_geometries>", "<library_effects>" + effect("orange", "1 0.5 0 1") +
                                  effect("black", "0 0 0 1") +
                                  "</library_effects><library_materials><material id='orange'>"
                                  "<instance_effect url='#orange-fx'/></material><material "
                                  "id='black'><instance_effect url='#black-fx'/></material>"
                                  "</library_materials>");
  // The first triangle of the ten is black.
  const std::string_view all = "<triangles count=\"10\">";
  dae.replace(dae.find(all), all.size(), "<triangles count=\"9\" material='orange'>");
  const std::string_view first = "<p>0 2 1 ";
  dae.replace(dae.find(first), first.size(), "<p>");
  put("</mesh>",
      "<triangles count='1' material='black'><input semantic='VERTEX' source='#wedge-vertices' "
      "offset='0'/><p>0 2 1</p></triangles>");
  const std::string_view instance = "<instance_geometry url=\"#wedge-mesh\"/>";
  dae.replace(dae.find(instance), instance.size(),
              "<instance_geometry url='#wedge-mesh'><bind_material><technique_common>"
              "<instance_material symbol='orange' target='#orange'/><instance_material "
              "symbol='black' target='#black'/></technique_common></bind_material>"
              "</instance_geometry>");
  const auto looks = ReadLooks(folder.Write("a.dae", dae), 100);
  ASSERT_TRUE(looks && looks->colour);
  EXPECT_THAT(looks->triangles, SizeIs(10));
  EXPECT_NEAR((*looks->colour)[0], 1, 1e-6);
  EXPECT_NEAR((*looks->colour)[1], 0.5, 1e-6);
  EXPECT_NEAR((*looks->colour)[2], 0, 1e-6);
}

}  // namespace
}  // namespace tcs
