#include <cmath>

#include "tests/zoo/robots.h"
#include "tests/zoo/urdf_text.h"

namespace tcs::zoo {
namespace {

const char* Side(int i) { return i == 0 ? "left" : "right"; }
double SignOf(int i) { return i == 0 ? 1 : -1; }

std::string Friction(const std::string& link, double mu) {
  const std::string value = std::to_string(mu);
  return "<gazebo reference=\"" + link + "\"><mu1>" + value + "</mu1><mu2>" + value +
         "</mu2></gazebo>";
}

// A root on the floor without mass, two wheels, and a ball that slides as a caster.
std::string Burger() {
  Urdf urdf("burger", "base_footprint", Frame());
  urdf.Fix("base_footprint", "base_link", {0, 0, 0.01},
           Box(0.83, {0.14, 0.14, 0.14}, {-0.03, 0, 0.07}));
  for (int i = 0; i < 2; ++i) {
    const std::string name = std::string("wheel_") + Side(i);
    urdf.Join("base_link", {name,
                            "continuous",
                            {0, 0.08 * SignOf(i), 0.023},
                            kY,
                            Gear(),
                            WithMoments(Wheel(0.0285, 0.033, 0.018), {1.1e-3, 1.9e-2, 1.1e-3})});
  }
  urdf.Fix("base_link", "caster_back", {-0.081, 0, -0.004},
           WithMoments(Ball(0.005, 0.005), {1e-3, 1e-3, 1e-3}));
  urdf.Fix("base_link", "imu_link", {-0.03, 0, 0.07}, Frame());
  urdf.Fix("base_link", "base_scan", {-0.03, 0, 0.17}, Cylinder(0.114, 0.055, 0.03));
  return urdf.Raw(Friction("caster_back", 0.05)).Text();
}

// Casters that swivel, with wheels of their own.
std::string OfficeCart() {
  Urdf urdf("office_cart", "base_link", Box(15, {0.5, 0.4, 0.2}, {0, 0, 0.05}));
  for (int i = 0; i < 2; ++i) {
    urdf.Join("base_link", {std::string(Side(i)) + "_wheel",
                            "continuous",
                            {0.1, 0.23 * SignOf(i), 0},
                            kY,
                            Motor(10, 20, 0.05, 0.05),
                            Wheel(1, 0.1, 0.04)});
    const std::string caster = std::string(Side(i)) + "_caster";
    urdf.Join("base_link", {caster,
                            "continuous",
                            {-0.2, 0.15 * SignOf(i), -0.03},
                            kZ,
                            Motor(0, 0, 1e-3),
                            Box(0.1, {0.03, 0.03, 0.02})});
    urdf.Join(caster, {caster + "_wheel",
                       "continuous",
                       {-0.03, 0, -0.03},
                       kY,
                       Motor(0, 0, 1e-4),
                       Wheel(0.1, 0.04, 0.02)});
  }
  return urdf.Text();
}

// Four wheels that skid, bumpers that are capsules.
std::string SkidFour() {
  Urdf urdf("skid_four", "base_link", Box(33, {0.99, 0.38, 0.25}, {0, 0, 0.12}));
  for (int i = 0; i < 4; ++i) {
    const double x = i < 2 ? 0.256 : -0.256;
    urdf.Join("base_link", {"wheel_" + std::to_string(i),
                            "continuous",
                            {x, 0.285 * SignOf(i % 2), 0.033},
                            kY,
                            Motor(50, 20, 0.1),
                            Wheel(2.6, 0.165, 0.114)});
  }
  Part bumper = Capsule(2, 0.05, 0.4);
  bumper.rpy = "1.5707963268 0 0";
  return urdf.Fix("base_link", "front_bumper", {0.48, 0, 0.1}, bumper)
      .Fix("base_link", "top_plate", {0, 0, 0.26}, Wedge(1, "wedge.stl", {0.5, 0.3, 0.02}))
      .Text();
}

// The right front wheel is steered as the left one is.
std::string Racecar() {
  Urdf urdf("racecar", "chassis", Box(3, {0.4, 0.2, 0.08}, {0, 0, 0.03}));
  for (int i = 0; i < 2; ++i) {
    const std::string side = Side(i), hinge = side + "_steering_hinge";
    urdf.Join("chassis", {side + "_rear_wheel",
                          "continuous",
                          {-0.16, 0.11 * SignOf(i), 0},
                          kY,
                          Motor(2, 100, 0.002),
                          Wheel(0.3, 0.05, 0.045)});
    urdf.Join("chassis",
              {hinge,
               "revolute",
               {0.16, 0.1 * SignOf(i), 0},
               kZ,
               Range(-0.6, 0.6, 2, 4, 0.02, 0.01),
               Box(0.05, {0.02, 0.02, 0.02})},
              i == 0 ? "" : Mimic("left_steering_hinge_joint"));
    urdf.Join(hinge, {side + "_front_wheel",
                      "continuous",
                      {0, 0.02 * SignOf(i), 0},
                      kY,
                      Motor(2, 100, 0.002),
                      Wheel(0.3, 0.05, 0.045)});
  }
  return urdf.Raw("<transmission name=\"t\"><type>x</type></transmission>").Text();
}

// Rockers that a differential makes turn against each other, bogies, six wheels.
std::string RockerSix() {
  Urdf urdf("rocker_six", "body", Box(20, {0.6, 0.35, 0.2}, {0, 0, 0.1}));
  for (int i = 0; i < 2; ++i) {
    const std::string side = Side(i), rocker = side + "_rocker", bogie = side + "_bogie";
    const double y = SignOf(i);
    urdf.Join("body",
              {rocker,
               "revolute",
               {0, 0.25 * y, 0},
               kY,
               Range(-0.5, 0.5, 100, 1, 0.5),
               Box(2, {0.5, 0.03, 0.05}, {0.1, 0, -0.05})},
              i == 0 ? "" : Mimic("left_rocker_joint", -1));
    urdf.Join(rocker, {bogie,
                       "revolute",
                       {-0.2, 0, -0.05},
                       kY,
                       Range(-0.7, 0.7, 100, 1, 0.5),
                       Box(1, {0.35, 0.03, 0.05})});
    const Gear drive = Motor(20, 10, 0.1, 0.1);
    urdf.Join(
        rocker,
        {side + "_front", "continuous", {0.35, 0.08 * y, -0.1}, kY, drive, Wheel(1, 0.09, 0.08)});
    urdf.Join(
        bogie,
        {side + "_middle", "continuous", {0.15, 0.08 * y, -0.05}, kY, drive, Wheel(1, 0.09, 0.08)});
    urdf.Join(
        bogie,
        {side + "_rear", "continuous", {-0.15, 0.08 * y, -0.05}, kY, drive, Wheel(1, 0.09, 0.08)});
  }
  return urdf.Text();
}

// Three wheels with rollers, each on a hinge of its own.
std::string OmniThree() {
  Urdf urdf("omni_three", "base", Cylinder(8, 0.2, 0.1, {0, 0, 0.05}));
  const Vec3 at[] = {{0.2, 0, 0}, {-0.1, 0.1732, 0}, {-0.1, -0.1732, 0}};
  for (int i = 0; i < 3; ++i) {
    const std::string wheel = "wheel_" + std::to_string(i);
    const Vec3 axis = {at[i][0] * 5, at[i][1] * 5, 0};
    urdf.Join("base",
              {wheel, "continuous", at[i], axis, Motor(5, 30, 0.01), Invisible(Ball(0.4, 0.05))});
    for (int k = 0; k < 6; ++k) {
      const double angle = 1.0472 * k;
      // Around the wheel's rim, and along it.
      const Vec3 round = {-axis[1] * std::cos(angle), axis[0] * std::cos(angle), std::sin(angle)};
      const Vec3 along = {axis[1] * std::sin(angle), -axis[0] * std::sin(angle), std::cos(angle)};
      urdf.Join(wheel, {wheel + "_roller_" + std::to_string(k),
                        "continuous",
                        {0.04 * round[0], 0.04 * round[1], 0.04 * round[2]},
                        along,
                        Motor(0, 0, 1e-5),
                        Ball(0.01, 0.012)});
    }
  }
  return urdf.Text();
}

// A mast of two stages, of which the second goes as far as the first.
std::string Forklift() {
  Urdf urdf("forklift", "chassis", Box(900, {1.4, 0.8, 0.8}, {0, 0, 0.5}));
  for (int i = 0; i < 2; ++i) {
    urdf.Join("chassis", {std::string(Side(i)) + "_wheel",
                          "continuous",
                          {0.5, 0.35 * SignOf(i), 0.18},
                          kY,
                          Motor(300, 10, 1),
                          Wheel(15, 0.18, 0.1)});
  }
  urdf.Join("chassis", {"steering",
                        "revolute",
                        {-0.55, 0, 0.3},
                        kZ,
                        Range(-1.4, 1.4, 100, 2, 5, 2),
                        Box(5, {0.1, 0.1, 0.1})});
  urdf.Join(
      "steering",
      {"rear_wheel", "continuous", {0, 0, -0.12}, kY, Motor(300, 10, 1), Wheel(10, 0.18, 0.08)});
  urdf.Join("chassis", {"mast",
                        "prismatic",
                        {0.75, 0, 0.3},
                        kZ,
                        Range(0, 1.2, 20000, 0.5, 200, 50),
                        Box(60, {0.08, 0.6, 1.2}, {0, 0, 0.6})});
  urdf.Join("mast",
            {"fork",
             "prismatic",
             {0.05, 0, 0},
             kZ,
             Range(0, 1.2, 20000, 0.5, 200, 50),
             Box(40, {0.9, 0.5, 0.05}, {0.45, 0, 0})},
            Mimic("mast_joint"));
  return urdf.Text();
}

// A base, a torso that goes up, an arm, a gripper, a head: as those who serve have.
std::string ServiceRobot() {
  Urdf urdf("service_robot", "base_footprint", Frame());
  urdf.Fix("base_footprint", "base_link", {0, 0, 0.1}, Cylinder(40, 0.27, 0.2));
  for (int i = 0; i < 2; ++i) {
    urdf.Join("base_link", {std::string("wheel_") + Side(i),
                            "continuous",
                            {0, 0.2 * SignOf(i), -0.002},
                            kY,
                            Motor(6, 10, 1, 0.5),
                            Wheel(1.8, 0.099, 0.04)});
    for (int k = 0; k < 2; ++k) {
      const std::string caster = "caster_" + std::to_string(2 * i + k);
      urdf.Join("base_link", {caster,
                              "continuous",
                              {k == 0 ? 0.17 : -0.17, 0.1 * SignOf(i), -0.05},
                              kZ,
                              Motor(0, 0, 0.01),
                              Cylinder(0.05, 0.01, 0.02)});
      urdf.Join(caster, {caster + "_wheel",
                         "continuous",
                         {-0.02, 0, -0.027},
                         kY,
                         Motor(0, 0, 0.001),
                         Wheel(0.1, 0.025, 0.015)});
    }
  }
  urdf.Join("base_link", {"torso",
                          "prismatic",
                          {-0.06, 0, 0.6},
                          kZ,
                          Range(0, 0.35, 2000, 0.07, 1000, 100),
                          Box(13, {0.2, 0.25, 0.6}, {0, 0, -0.15})});
  urdf.Chain("torso", "head_",
             {{"pan",
               "revolute",
               {0.05, 0, 0.25},
               kZ,
               Range(-1.24, 1.24, 6, 3, 0.5, 1),
               Box(0.3, {0.05, 0.05, 0.05})},
              {"tilt",
               "revolute",
               {0, 0, 0.05},
               {0, -1, 0},
               Range(-0.98, 0.79, 6, 3, 0.5, 1),
               Box(0.7, {0.1, 0.2, 0.1})}});
  urdf.Chain("torso", "arm_",
             {{"1",
               "revolute",
               {0.15, 0, 0},
               kZ,
               Range(0.07, 2.68, 43, 2, 1, 1),
               Cylinder(1.4, 0.06, 0.12)},
              {"2",
               "revolute",
               {0.12, 0, -0.03},
               kY,
               Range(-1.5, 1.02, 43, 2, 1, 1),
               Cylinder(1.5, 0.06, 0.12)},
              {"3",
               "revolute",
               {0.1, 0, 0},
               kX,
               Range(-3.46, 1.57, 26, 2, 1, 1),
               Cylinder(1.7, 0.05, 0.2)},
              {"4",
               "revolute",
               {0.2, 0, 0},
               kY,
               Range(-0.32, 2.27, 26, 2, 1, 1),
               Cylinder(1.3, 0.05, 0.15)},
              {"5",
               "revolute",
               {0.1, 0, 0},
               kX,
               Range(-2.07, 2.07, 3, 2, 1, 1),
               Cylinder(1.8, 0.05, 0.15)},
              {"6",
               "revolute",
               {0.1, 0, 0},
               kY,
               Range(-1.39, 1.39, 6, 2, 1, 1),
               Cylinder(0.2, 0.03, 0.05)},
              {"7",
               "revolute",
               {0.02, 0, 0},
               kX,
               Range(-2.07, 2.07, 6, 2, 1, 1),
               Cylinder(0.1, 0.03, 0.05)}});
  urdf.Fix("arm_7", "gripper", {0.08, 0, 0}, Box(0.5, {0.06, 0.15, 0.06}));
  for (int i = 0; i < 2; ++i) {
    urdf.Join("gripper", {std::string("gripper_") + Side(i),
                          "prismatic",
                          {0.06, 0, 0},
                          {0, SignOf(i), 0},
                          Range(0, 0.045, 16, 0.05, 1, 1),
                          Box(0.1, {0.08, 0.02, 0.02})});
  }
  return urdf.Text();
}

// A joint of the plane under an arm, as planners have it.
std::string PlanarBase() {
  return Urdf("planar_base", "odom", Frame())
      .Join("odom", {"base", "planar", {0, 0, 0.3}, kZ, Gear(), Cylinder(30, 0.25, 0.3)})
      .Chain("base", "arm_",
             {{"1", "revolute", {0, 0, 0.2}, kZ, Range(-3, 3, 50, 2, 1), Cylinder(3, 0.06, 0.1)},
              {"2",
               "revolute",
               {0, 0, 0.1},
               kY,
               Range(-2, 2, 50, 2, 1),
               Cylinder(3, 0.05, 0.4, {0, 0, 0.2})},
              {"3",
               "revolute",
               {0, 0, 0.4},
               kY,
               Range(-2, 2, 30, 2, 1),
               Cylinder(2, 0.04, 0.3, {0, 0, 0.15})}})
      .Text();
}

// As in a first lesson on URDF: everything is there that a robot may have, a little of each.
std::string FirstLesson() {
  Urdf urdf("first_lesson", "base_link", Cylinder(10, 0.2, 0.6));
  for (int i = 0; i < 2; ++i) {
    const std::string side = Side(i);
    urdf.Fix("base_link", side + "_leg", {0, 0.22 * SignOf(i), 0.25},
             Box(10, {0.1, 0.2, 0.6}, {0, 0, -0.3}));
    urdf.Fix(side + "_leg", side + "_base", {0, 0, -0.6}, Box(10, {0.4, 0.1, 0.1}));
    for (const double x : {0.1333, -0.1333}) {
      const std::string wheel = side + (x > 0 ? "_front_wheel" : "_back_wheel");
      urdf.Join(side + "_base", {wheel,
                                 "continuous",
                                 {x, 0, -0.085},
                                 kY,
                                 Motor(100, 100),
                                 WithMoments(Wheel(1, 0.035, 0.1), {1, 1, 1})});
    }
  }
  urdf.Join("base_link", {"gripper_pole",
                          "prismatic",
                          {0.19, 0, 0.2},
                          kX,
                          Range(-0.38, 0, 1000, 0.5),
                          WithMoments(Cylinder(0.05, 0.01, 0.2, {0.1, 0, 0}, "0 1.5707963268 0"),
                                      {1e-3, 1e-3, 1e-3})});
  for (int i = 0; i < 2; ++i) {
    urdf.Join("gripper_pole", {std::string(Side(i)) + "_gripper",
                               "revolute",
                               {0.2, 0.01 * SignOf(i), 0},
                               {0, 0, SignOf(i)},
                               Range(0, 0.548, 1000, 0.5),
                               Wedge(0.05, "wedge.dae", {0.09, 0.02, 0.02})});
  }
  return urdf.Join("base_link", {"head", "continuous", {0, 0, 0.3}, kZ, Gear(), Ball(2, 0.2)})
      .Fix("head", "box", {0.18, 0, 0.14}, Box(1, {0.08, 0.08, 0.08}))
      .Text();
}

}  // namespace

std::vector<Robot> Bases() {
  return {{"burger", Burger(), false, 0},
          {"office_cart", OfficeCart(), false, 0.1},
          {"skid_four", SkidFour(), false, 0.133},
          {"racecar", Racecar(), false, 0.05},
          {"rocker_six", RockerSix(), false, 0.2},
          {"omni_three", OmniThree(), false, 0.06},
          {"forklift", Forklift(), false, 0.01},
          {"service_robot", ServiceRobot(), false, 0.003},
          {"planar_base", PlanarBase(), false, 0.5},
          {"first_lesson", FirstLesson(), false, 0.5}};
}

}  // namespace tcs::zoo
