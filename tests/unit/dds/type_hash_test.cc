// The hashes are ROS 2's own: those that its packages have as of Iron, Jazzy and Kilted.
#include "coordinator/dds/type_hash.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "coordinator/dds/message_fields.h"

namespace tcs::dds {
namespace {

const std::map<std::string, std::string> kOfRos = {
    {"builtin_interfaces/msg/Time",
     "b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197"},
    {"geometry_msgs/msg/Point", "6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881"},
    {"geometry_msgs/msg/Twist", "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"},
    {"geometry_msgs/msg/Wrench",
     "018e8519d57c16adbe97c9fe1460ef21fec7e31bc541de3d653a35895677ce52"},
    {"nav_msgs/msg/Odometry", "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"},
    {"rmw_dds_common/msg/ParticipantEntitiesInfo",
     "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"},
    {"rosgraph_msgs/msg/Clock", "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564"},
    {"sensor_msgs/msg/FluidPressure",
     "22dfb2b145a0bd5a31a1ac3882a1b32148b51d9b2f3bab250290d66f3595bc32"},
    {"sensor_msgs/msg/Image", "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"},
    {"sensor_msgs/msg/Imu", "7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b"},
    {"sensor_msgs/msg/JointState",
     "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
    {"sensor_msgs/msg/LaserScan",
     "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828"},
    {"sensor_msgs/msg/MagneticField",
     "e80f32f56a20486c9923008fc1a1db07bbb273cbbf6a5b3bfa00835ee00e4dff"},
    {"sensor_msgs/msg/NavSatFix",
     "62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404"},
    {"sensor_msgs/msg/PointCloud2",
     "9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"},
    {"sensor_msgs/msg/Range", "b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a"},
    {"std_msgs/msg/Bool", "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9"},
    {"std_msgs/msg/Float64MultiArray",
     "1025ddc6b9552d191f89ef1a8d2f60f3d373e28b283d8891ddcc974e8c55397f"},
    {"std_msgs/msg/Header", "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01"},
    {"std_msgs/msg/String", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
    {"tf2_msgs/msg/TFMessage", "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
    {"trajectory_msgs/msg/JointTrajectory",
     "179b33eba59d676f6d967ac71fe35e7ca2f64b2f3928f4a018cec115e213796e"},
};

TEST(TypeHash, IsTheOneThatRosHas) {
  for (const auto& [type, hash] : kOfRos) {
    EXPECT_EQ(TypeHashOf(type, RosRelease::kIron), "RIHS01_" + hash) << type;
    EXPECT_EQ(UserDataOf(type, RosRelease::kIron), "typehash=RIHS01_" + hash + ";") << type;
  }
}

TEST(TypeHash, IsThereForEveryMessageThatIsSpoken) {
  std::vector<std::string> spoken = SensorMessageNames();
  spoken.insert(spoken.end(), CommandMessageNames().begin(), CommandMessageNames().end());
  spoken.emplace_back(kClockMessageName);
  spoken.emplace_back(kDiscoveryMessageName);
  for (const std::string& type : spoken) EXPECT_TRUE(kOfRos.contains(type)) << type;
}

TEST(TypeHash, IsFoundInWhatAnEndpointSays) {
  const std::string hash = "RIHS01_" + kOfRos.at("std_msgs/msg/String");
  EXPECT_EQ(TypeHashIn(UserDataWith(hash)), hash);
  EXPECT_EQ(TypeHashIn("serviceid=1.2.3;typehash=" + hash + ";"), hash);
  for (const std::string& text :
       {std::string(), hash, "typehash=" + hash, "typehash=" + hash + "0;", "nothash=" + hash + ";",
        std::string("typehash=RIHS01_;"), "typehash=RIHS01_" + std::string(64, 'G') + ";",
        std::string(3, '\0'), std::string(";;;typehash=;")}) {
    EXPECT_EQ(TypeHashIn(text), "") << text;
  }
}

TEST(TypeHash, IsNotMadeUp) {
  for (const char* type : {"", "/msg/", "std_msgs/String", "std_msgs/msg/Int32", "my/msg/Own"}) {
    EXPECT_EQ(TypeHashOf(type, RosRelease::kIron), "") << type;
    EXPECT_EQ(UserDataOf(type, RosRelease::kIron), "") << type;
  }
  EXPECT_EQ(TypeHashOf("std_msgs/msg/String", RosRelease::kHumble), "");
  EXPECT_EQ(UserDataOf("std_msgs/msg/String", RosRelease::kHumble), "");
}

}  // namespace
}  // namespace tcs::dds
