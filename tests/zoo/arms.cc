#include "tests/zoo/robots.h"
#include "tests/zoo/urdf_text.h"

namespace tcs::zoo {
namespace {

constexpr double kTurn = 6.2832;

// A cobot whose links are meshes, on a frame without mass that is called world.
std::string Cobot6() {
  return Urdf("cobot6", "world", Frame())
      .Fix("world", "base_link", {}, Wedge(4, "wedge.stl", {0.15, 0.15, 0.1}))
      .Chain("base_link", "",
             {{"shoulder",
               "revolute",
               {0, 0, 0.16},
               kZ,
               Range(-kTurn, kTurn, 330, 2, 0.1, 0.1),
               Wedge(3.8, "wedge.stl", {0.12, 0.12, 0.14})},
              {"upper_arm",
               "revolute",
               {0, 0.14, 0},
               kY,
               Range(-kTurn, kTurn, 330, 2, 0.1, 0.1),
               Wedge(8.4, "wedge.obj", {0.12, 0.12, 0.42})},
              {"forearm",
               "revolute",
               {0, -0.12, 0.42},
               kY,
               Range(-3.1416, 3.1416, 150, 3, 0.1, 0.1),
               Wedge(2.3, "wedge.obj", {0.1, 0.1, 0.39})},
              {"wrist_1",
               "revolute",
               {0, 0, 0.39},
               kY,
               Range(-kTurn, kTurn, 54, 3.2, 0.1, 0.1),
               Wedge(1.2, "wedge.dae", {0.08, 0.1, 0.1})},
              {"wrist_2",
               "revolute",
               {0, 0.09, 0},
               kZ,
               Range(-kTurn, kTurn, 54, 3.2, 0.1, 0.1),
               Wedge(1.2, "wedge.dae", {0.08, 0.1, 0.1})},
              {"wrist_3",
               "revolute",
               {0, 0, 0.09},
               kY,
               Range(-kTurn, kTurn, 54, 3.2, 0.1, 0.1),
               Wedge(0.25, "wedge.stl", {0.07, 0.04, 0.07})}})
      .Fix("wrist_3", "flange", {0, 0.05, 0}, Frame())
      .Fix("flange", "tool0", {}, Frame())
      .Text();
}

// Its fourth joint cannot be at 0; a hand overlaps the flange, and its fingers mimic.
std::string Cobot7() {
  Urdf urdf("cobot7", "link0", Box(2.8, {0.2, 0.15, 0.14}));
  urdf.Chain("link0", "",
             {{"link1",
               "revolute",
               {0, 0, 0.33},
               kZ,
               Range(-2.9, 2.9, 87, 2.2, 0.003),
               Capsule(2.7, 0.06, 0.2, {0, 0, -0.1})},
              {"link2",
               "revolute",
               {0, 0, 0},
               kY,
               Range(-1.8, 1.8, 87, 2.2, 0.003),
               Capsule(2.7, 0.06, 0.2, {0, 0, 0.1})},
              {"link3",
               "revolute",
               {0, 0, 0.32},
               kZ,
               Range(-2.9, 2.9, 87, 2.2, 0.003),
               Capsule(2.4, 0.06, 0.15)},
              {"link4",
               "revolute",
               {0.08, 0, 0},
               {0, -1, 0},
               Range(-3.07, -0.07, 87, 2.2, 0.003),
               Capsule(2.4, 0.06, 0.15)},
              {"link5",
               "revolute",
               {-0.08, 0, 0.38},
               kZ,
               Range(-2.9, 2.9, 12, 2.6, 0.003),
               Capsule(2.6, 0.05, 0.2, {0, 0, -0.12})},
              {"link6",
               "revolute",
               {0, 0, 0},
               {0, -1, 0},
               Range(-0.02, 3.75, 12, 2.6, 0.003),
               Capsule(1.5, 0.05, 0.1)},
              {"link7",
               "revolute",
               {0.09, 0, 0},
               {0, 0, -1},
               Range(-2.9, 2.9, 12, 2.6, 0.003),
               Capsule(0.45, 0.04, 0.1, {0, 0, -0.08})}});
  urdf.Fix("link7", "hand", {0, 0, -0.1}, Box(0.73, {0.04, 0.2, 0.07}, {0, 0, -0.03}));
  const Part finger = Box(0.01, {0.02, 0.02, 0.05}, {0, 0, -0.03});
  urdf.Join("hand",
            {"finger_1", "prismatic", {0, 0, -0.06}, kY, Range(0, 0.04, 20, 0.2, 10), finger});
  urdf.Join(
      "hand",
      {"finger_2", "prismatic", {0, 0, -0.06}, {0, -1, 0}, Range(0, 0.04, 20, 0.2, 10), finger},
      Mimic("finger_1_joint"));
  return urdf.Text();
}

// Moments of inertia that no body has, and much damping.
std::string Heavy7() {
  Urdf urdf("heavy7", "link_0", Cylinder(5, 0.1, 0.15));
  const Vec3 broken[] = {{0.1, 0.09, 0.02},    {0.05, 0.018, 0.044}, {0.08, 0.075, 0.01},
                         {0.03, 0.01, 0.029},  {0.02, 0.018, 0.005}, {0.005, 0.0036, 0.0047},
                         {0.001, 0.001, 0.001}};
  std::string on = "link_0";
  for (int i = 0; i < 7; ++i) {
    const std::string name = "link_" + std::to_string(i + 1);
    urdf.Join(on, {name,
                   "revolute",
                   {0, 0, 0.2},
                   i % 2 == 0 ? kZ : kY,
                   Range(-2.9, 2.9, i < 4 ? 176 : 40, 1.7, 10, 0.5),
                   WithMoments(Cylinder(i < 4 ? 4 : 1.5, 0.06, 0.18, {0, 0, 0.1}), broken[i])});
    on = name;
  }
  return urdf.Text();
}

// Gears that are far stiffer than the wrists are heavy.
std::string Light7() {
  Urdf urdf("light7", "base", Cylinder(2, 0.06, 0.1));
  std::string on = "base";
  for (int i = 0; i < 7; ++i) {
    const std::string name = "link" + std::to_string(i + 1);
    urdf.Join(on, {name,
                   "revolute",
                   {0, i % 2 == 0 ? 0 : 0.03, 0.15},
                   i % 2 == 0 ? kZ : kY,
                   Range(-3, 3, i < 3 ? 50 : 20, 3.14, 10, 1),
                   Cylinder(i < 3 ? 2 : 0.15, i < 3 ? 0.05 : 0.02, 0.12, {0, 0, 0.06})});
    on = name;
  }
  return urdf.Text();
}

// Efforts and speeds of 0, as exporters leave them.
std::string Industrial6() {
  const Gear none = Range(-2.8, 2.8, 0, 0);
  return Urdf("industrial6", "base", Box(150, {0.8, 0.6, 0.4}))
      .Chain(
          "base", "",
          {{"link_1", "revolute", {0, 0, 0.45}, kZ, none, Box(120, {0.5, 0.4, 0.3})},
           {"link_2", "revolute", {0.3, 0, 0.1}, kY, none, Box(80, {0.2, 0.2, 0.9}, {0, 0, 0.5})},
           {"link_3", "revolute", {0, 0, 1.1}, kY, none, Box(60, {0.3, 0.25, 0.3})},
           {"link_4",
            "revolute",
            {0.3, 0, 0.15},
            kX,
            none,
            Box(25, {0.8, 0.15, 0.15}, {0.4, 0, 0})},
           {"link_5", "revolute", {0.9, 0, 0}, kY, none, Box(8, {0.15, 0.1, 0.1})},
           {"link_6",
            "revolute",
            {0.12, 0, 0},
            kX,
            none,
            Cylinder(1, 0.05, 0.02, {}, "0 1.5708 0")}})
      .Text();
}

std::string TwoArms() {
  const std::vector<Step> arm = {{"1",
                                  "revolute",
                                  {0.05, 0.07, 0.4},
                                  {0.3, 0.5, 0.8},
                                  Range(-2.9, 2.9, 100, 3, 0.2, 0.1),
                                  Capsule(2, 0.05, 0.08)},
                                 {"2",
                                  "revolute",
                                  {0.03, 0.05, 0.05},
                                  kY,
                                  Range(-2.5, 0.76, 100, 3, 0.2, 0.1),
                                  Capsule(1.8, 0.05, 0.1)},
                                 {"3",
                                  "revolute",
                                  {0, 0, 0.15},
                                  kZ,
                                  Range(-2.9, 2.9, 100, 3, 0.2, 0.1),
                                  Capsule(1.1, 0.04, 0.1)},
                                 {"4",
                                  "revolute",
                                  {0.04, 0, 0.08},
                                  kY,
                                  Range(-2.1, 1.4, 50, 3, 0.1, 0.05),
                                  Capsule(1.1, 0.04, 0.1)},
                                 {"5",
                                  "revolute",
                                  {0.04, 0, 0.1},
                                  kZ,
                                  Range(-5.06, 5.06, 50, 7, 0.1, 0.05),
                                  Capsule(0.7, 0.04, 0.1)},
                                 {"6",
                                  "revolute",
                                  {0, 0, 0.13},
                                  kY,
                                  Range(-1.5, 2.4, 20, 7, 0.05, 0.02),
                                  Capsule(0.5, 0.03, 0.05)},
                                 {"7",
                                  "revolute",
                                  {0.03, 0, 0.03},
                                  kZ,
                                  Range(-4, 4, 20, 7, 0.05, 0.02),
                                  Cylinder(0.05, 0.03, 0.02)}};
  Urdf urdf("two_arms", "body", Box(20, {0.3, 0.3, 0.5}, {0, 0, 0.2}));
  for (const std::string side : {"left_", "right_"}) {
    urdf.Chain("body", side, side == "left_" ? arm : Mirrored(arm));
    urdf.Fix(side + "7", side + "gripper", {0, 0, 0.04}, Box(0.2, {0.06, 0.08, 0.05}));
    urdf.Join(side + "gripper", {side + "finger_l",
                                 "prismatic",
                                 {0, 0, 0.05},
                                 kY,
                                 Range(0, 0.025, 20, 2),
                                 Box(0.01, {0.02, 0.01, 0.04})});
    urdf.Join(side + "gripper",
              {side + "finger_r",
               "prismatic",
               {0, 0, 0.05},
               {0, -1, 0},
               Range(0, 0.025, 20, 2),
               Box(0.01, {0.02, 0.01, 0.04})},
              Mimic(side + "finger_l_joint"));
  }
  return urdf.Text();
}

// A printed arm with servos of models: small, with visual meshes of which one is not there.
std::string Hobby5() {
  Urdf urdf("hobby5", "base", Wedge(0.15, "wedge.stl", {0.1, 0.08, 0.05}));
  urdf.Chain("base", "",
             {{"shoulder",
               "revolute",
               {0, 0, 0.054},
               kZ,
               Range(-1.92, 1.92, 10, 10),
               Wedge(0.1, "wedge.stl", {0.04, 0.04, 0.05})},
              {"upper",
               "revolute",
               {-0.03, -0.018, 0.054},
               kY,
               Range(-1.75, 1.75, 10, 10),
               Wedge(0.1, "wedge.obj", {0.03, 0.03, 0.11})},
              {"lower",
               "revolute",
               {-0.11, 0, -0.028},
               kY,
               Range(-1.69, 1.69, 10, 10),
               Wedge(0.1, "wedge.obj", {0.03, 0.03, 0.13})},
              {"wrist",
               "revolute",
               {-0.13, 0, 0.005},
               kY,
               Range(-1.66, 1.66, 10, 10),
               Wedge(0.08, "wedge.dae", {0.03, 0.03, 0.06})},
              {"gripper",
               "revolute",
               {0, -0.061, 0},
               kX,
               Range(-2.7, 2.8, 10, 10),
               Wedge(0.09, "wedge.dae", {0.05, 0.04, 0.05})},
              {"jaw",
               "revolute",
               {0.02, 0, 0.02},
               kZ,
               Range(-0.17, 1.75, 10, 10),
               WithMoments(Wedge(0.012, "wedge.stl", {0.05, 0.01, 0.03}), {2e-6, 3e-6, 2.5e-6})}});
  return urdf
      .Raw(
          "<link name=\"horn\"><visual><geometry><mesh "
          "filename=\"package://zoo_description/meshes/horn.stl\"/></geometry></visual></link>")
      .Raw(
          "<joint name=\"horn_joint\" type=\"fixed\"><parent link=\"base\"/><child "
          "link=\"horn\"/></joint>")
      .Text();
}

std::string Scara() {
  return Urdf("scara", "base", Box(10, {0.15, 0.15, 0.4}, {0, 0, 0.2}))
      .Chain("base", "",
             {{"inner",
               "revolute",
               {0, 0, 0.42},
               kZ,
               Range(-2.3, 2.3, 60, 7.5, 0.5, 0.2),
               Box(5, {0.3, 0.1, 0.08}, {0.12, 0, 0})},
              {"outer",
               "revolute",
               {0.25, 0, 0.05},
               kZ,
               Range(-2.5, 2.5, 30, 10, 0.3, 0.1),
               Box(3, {0.25, 0.08, 0.1}, {0.1, 0, 0})},
              {"quill",
               "prismatic",
               {0.2, 0, 0},
               {0, 0, -1},
               Range(0, 0.2, 200, 1.1, 20, 5),
               Cylinder(0.8, 0.012, 0.3)},
              {"flange",
               "continuous",
               {0, 0, -0.16},
               {0, 0, -1},
               Motor(3, 20, 0.01, 0.005),
               Cylinder(0.05, 0.02, 0.01)}})
      .Text();
}

// Names without efforts and speeds; a limit with lower above upper.
std::string Gantry() {
  Gear unknown;
  unknown.lower = -0.5;
  unknown.upper = 0.5;
  return Urdf("gantry", "frame", Box(100, {2, 1.5, 0.1}))
      .Chain(
          "frame", "",
          {{"bridge", "prismatic", {0, 0, 1}, kX, unknown, Box(40, {0.1, 1.5, 0.1})},
           {"trolley", "prismatic", {0, 0, 0.1}, kY, unknown, Box(15, {0.2, 0.2, 0.15})},
           {"mast", "prismatic", {0, 0, 0}, {0, 0, -1}, unknown, Box(8, {0.08, 0.08, 0.8})},
           {"wrist", "revolute", {0, 0, -0.42}, kZ, Range(2, -2, 10, 3), Cylinder(1, 0.04, 0.05)}})
      .Text();
}

// Joints that turn for ever, and fingers that are light and rub.
std::string Assistive6() {
  Urdf urdf("assistive6", "world", Frame());
  urdf.Fix("world", "base", {}, Cylinder(0.47, 0.05, 0.1));
  urdf.Chain(
      "base", "",
      {{"link_1",
        "continuous",
        {0, 0, 0.16},
        {0, 0, -1},
        Motor(40, 0.6),
        Cylinder(0.75, 0.04, 0.12)},
       {"link_2",
        "revolute",
        {0, 0, 0.12},
        kY,
        Range(0.82, 5.46, 80, 0.6),
        Cylinder(0.99, 0.04, 0.4, {0, 0, -0.2})},
       {"link_3",
        "revolute",
        {0, 0, -0.41},
        {0, -1, 0},
        Range(0.33, 5.95, 40, 0.6),
        Cylinder(0.69, 0.03, 0.2, {0, 0, -0.1})},
       {"link_4", "continuous", {0, 0, -0.21}, kZ, Motor(20, 0.8), Cylinder(0.43, 0.03, 0.07)},
       {"link_5",
        "continuous",
        {0, 0, -0.07},
        {0.5, 0, 0.866},
        Motor(20, 0.8),
        Cylinder(0.43, 0.03, 0.07)},
       {"link_6",
        "continuous",
        {0, 0, -0.07},
        {-0.5, 0, 0.866},
        Motor(20, 0.8),
        Cylinder(0.72, 0.03, 0.1)}});
  for (int i = 0; i < 3; ++i) {
    const std::string finger = "finger_" + std::to_string(i);
    urdf.Chain("link_6", finger,
               {{"_base",
                 "revolute",
                 {0.03 * (i - 1), i == 1 ? -0.03 : 0.03, -0.1},
                 kX,
                 Range(0, 1.51, 2, 1, 0, 0.1),
                 Wedge(0.01, "wedge.stl", {0.01, 0.01, 0.04})},
                {"_tip",
                 "revolute",
                 {0, 0, -0.044},
                 kX,
                 Range(0, 2, 2, 1, 0, 0.1),
                 Wedge(0.01, "wedge.stl", {0.01, 0.01, 0.03})}});
  }
  return urdf.Text();
}

// Many joints one after another.
std::string Snake16() {
  Urdf urdf("snake16", "head", Box(0.2, {0.06, 0.05, 0.05}));
  std::string on = "head";
  for (int i = 0; i < 16; ++i) {
    const std::string name = "module_" + std::to_string(i);
    urdf.Join(on, {name,
                   "revolute",
                   {0.06, 0, 0},
                   i % 2 == 0 ? kZ : kY,
                   Range(-1.57, 1.57, 7, 3, 0.1, 0.05),
                   Capsule(0.2, 0.025, 0.02, {0.03, 0, 0})});
    on = name;
  }
  return urdf.Text();
}

std::string Surgical() {
  return Urdf("surgical", "remote_center", Frame())
      .Chain("remote_center", "",
             {{"yaw",
               "revolute",
               {},
               kX,
               Range(-1.6, 1.6, 10, 2, 0.05, 0.02),
               Box(1, {0.1, 0.1, 0.2}, {0, 0, 0.2})},
              {"pitch",
               "revolute",
               {},
               kY,
               Range(-0.9, 0.9, 10, 2, 0.05, 0.02),
               Box(1, {0.1, 0.1, 0.2}, {0, 0, 0.25})},
              {"insertion",
               "prismatic",
               {},
               {0, 0, -1},
               Range(0, 0.24, 30, 0.4, 1, 0.5),
               Box(0.3, {0.05, 0.05, 0.1}, {0, 0, 0.3})},
              {"roll",
               "revolute",
               {},
               {0, 0, -1},
               Range(-3, 3, 1, 3, 1e-3, 1e-3),
               Cylinder(0.01, 0.004, 0.4)},
              {"wrist_pitch",
               "revolute",
               {0, 0, -0.2},
               kX,
               Range(-1.5, 1.5, 0.03, 3, 1e-4),
               WithMoments(Cylinder(1e-3, 0.003, 0.008), {1e-6, 1e-6, 1e-6})},
              {"wrist_yaw",
               "revolute",
               {0, 0, -0.009},
               kY,
               Range(-1.5, 1.5, 0.03, 3, 1e-4),
               WithMoments(Cylinder(3e-4, 0.002, 0.006), {1e-6, 1e-6, 1e-6})},
              {"jaw",
               "revolute",
               {0, 0, -0.004},
               kY,
               Range(-1, 1, 0.02, 3, 1e-4),
               WithMoments(Box(1e-4, {0.001, 0.001, 0.008}), {1e-6, 1e-6, 1e-6})}})
      .Text();
}

std::string CartPole() {
  return Urdf("cart_pole", "slider", Frame())
      .Join("slider", {"cart", "prismatic", {}, kX, Range(-4, 4, 100, 10), Box(1, {0.3, 0.2, 0.1})})
      .Join("cart", {"pole",
                     "continuous",
                     {0, 0, 0.05},
                     kY,
                     Motor(10, 10),
                     WithMoments(Cylinder(0.1, 0.02, 1, {0, 0, 0.5}), {0, 0, 0})})
      .Text();
}

}  // namespace

std::vector<Robot> Arms() {
  std::vector<Robot> robots = {{"cobot6", Cobot6()},           {"cobot7", Cobot7()},
                               {"heavy7", Heavy7()},           {"light7", Light7()},
                               {"industrial6", Industrial6()}, {"two_arms", TwoArms()},
                               {"hobby5", Hobby5()},           {"scara", Scara()},
                               {"gantry", Gantry()},           {"assistive6", Assistive6()},
                               {"snake16", Snake16()},         {"surgical", Surgical()},
                               {"cart_pole", CartPole()}};
  for (Robot& robot : robots) {
    robot.has_fixed_base = true;
    robot.height_m = 2;
    robot.touches_itself = robot.name == "cobot7" || robot.name == "assistive6";
  }
  return robots;
}

}  // namespace tcs::zoo
