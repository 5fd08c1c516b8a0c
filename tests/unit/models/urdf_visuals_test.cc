// What robots look like is read where it can be, and never stands in a run's way.
#include "coordinator/models/urdf_visuals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

std::vector<Visual> VisualsIn(const std::string& visuals) {
  const ModelFolder folder;
  const std::string path =
      folder.Write("robot.urdf",
                   "<robot name='r'><material name='red'><color rgba='1 0 0 1'/></material>"
                   "<link name='l'>" +
                       visuals + "</link></robot>");
  return ReadVisuals(path).at("l");
}

TEST(UrdfVisuals, HaveShapePlaceAndColour) {
  const auto visuals = VisualsIn(
      "<visual><origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/>"
      "<geometry><box size='1 2 3'/></geometry><material name='red'/></visual>"
      "<visual><geometry><cylinder radius='0.5' length='2'/></geometry>"
      "<material name='blue'><color rgba='0 0 1 0.5'/></material></visual>"
      "<visual><geometry><mesh filename='a.stl' scale='2 2 2'/></geometry></visual>");
  ASSERT_EQ(visuals.size(), 3u);
  EXPECT_EQ(std::get<BoxShape>(visuals[0].geometry).size_m, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(visuals[0].pose.position_m, (std::array<double, 3>{1, 2, 3}));
  EXPECT_NEAR(visuals[0].pose.orientation_xyzw[2], std::sqrt(0.5), 1e-12);
  EXPECT_EQ(visuals[0].colour_rgba, (std::array<double, 4>{1, 0, 0, 1}));
  EXPECT_EQ(std::get<CylinderShape>(visuals[1].geometry).length_m, 2);
  EXPECT_EQ(visuals[1].colour_rgba, (std::array<double, 4>{0, 0, 1, 0.5}));
  EXPECT_EQ(std::get<MeshFile>(visuals[2].geometry).name, "a.stl");
  EXPECT_EQ(std::get<MeshFile>(visuals[2].geometry).scale, (std::array<double, 3>{2, 2, 2}));
  EXPECT_FALSE(visuals[2].colour_rgba.has_value());
}

TEST(UrdfVisuals, ThatCannotBeUnderstoodAreLeftOut) {
  const auto visuals = VisualsIn(
      "<visual/><visual><geometry/></visual><visual><geometry><teapot/></geometry></visual>"
      "<visual><geometry><box size='1 2'/></geometry></visual>"
      "<visual><geometry><sphere radius='-1'/></geometry></visual>"
      "<visual><geometry><mesh/></geometry></visual>"
      "<visual><origin xyz='a b c'/><geometry><sphere radius='2'/></geometry>"
      "<material name='unknown'/></visual>");
  ASSERT_EQ(visuals.size(), 1u);
  EXPECT_EQ(std::get<SphereShape>(visuals[0].geometry).radius_m, 2);
  EXPECT_EQ(visuals[0].pose, Pose{});
  EXPECT_FALSE(visuals[0].colour_rgba.has_value());
}

TEST(UrdfVisuals, OfWhatIsNoRobotAreNone) {
  const ModelFolder folder;
  EXPECT_TRUE(ReadVisuals(folder.Path("gone.urdf")).empty());
  EXPECT_TRUE(ReadVisuals(folder.Write("robot.urdf", "<robot><link")).empty());
}

}  // namespace
}  // namespace tcs
