#include "tests/zoo/robots.h"
#include "tests/zoo/urdf_text.h"

namespace tcs::zoo {
namespace {

// Tendons couple the last two joints of a finger; the palm is on a wrist of two joints.
std::string Tendons24() {
  Urdf urdf("tendons24", "forearm", Cylinder(3, 0.07, 0.3, {0, 0, -0.05}));
  urdf.Join("forearm", {"wrist",
                        "revolute",
                        {0, -0.01, 0.213},
                        kY,
                        Range(-0.524, 0.175, 10, 2, 0.1),
                        Box(0.1, {0.03, 0.03, 0.03})});
  urdf.Join("wrist", {"palm",
                      "revolute",
                      {0, 0, 0.034},
                      kX,
                      Range(-0.698, 0.489, 30, 2, 0.1),
                      Box(0.3, {0.084, 0.022, 0.1}, {0, 0, 0.05})});
  for (int i = 0; i < 4; ++i) {
    const std::string f = "finger" + std::to_string(i) + "_";
    urdf.Chain("palm", f,
               {{"knuckle",
                 "revolute",
                 {0.033 - 0.022 * i, 0, 0.095},
                 {0, -1, 0},
                 Range(-0.349, 0.349, 2, 2, 0.1),
                 WithMoments(Cylinder(0.008, 0.005, 0.01), {3.2e-7, 2.6e-7, 2.6e-7})},
                {"proximal",
                 "revolute",
                 {},
                 kX,
                 Range(-0.262, 1.571, 2, 2, 0.1),
                 WithMoments(Capsule(0.03, 0.01, 0.025, {0, 0, 0.0225}), {1e-5, 9.8e-6, 1.8e-6})}});
    urdf.Join(f + "proximal", {f + "middle",
                               "revolute",
                               {0, 0, 0.045},
                               kX,
                               Range(0, 1.571, 2, 2, 0.1),
                               WithMoments(Capsule(0.017, 0.008, 0.012, {0, 0, 0.0125}),
                                           {2.7e-6, 2.6e-6, 8.7e-7})});
    urdf.Join(f + "middle",
              {f + "distal",
               "revolute",
               {0, 0, 0.025},
               kX,
               Range(0, 1.571, 2, 2, 0.1),
               WithMoments(Capsule(0.012, 0.007, 0.012, {0, 0, 0.012}), {1.7e-6, 1.6e-6, 4e-7})},
              i == 3 ? "" : Mimic(f + "middle_joint"));
    urdf.Fix(f + "distal", f + "tip", {0, 0, 0.026}, Frame());
  }
  urdf.Chain("palm", "thumb_",
             {{"base",
               "revolute",
               {0.034, -0.009, 0.029},
               {0, 0, -1},
               Range(-1.047, 1.047, 5, 4, 0.2),
               WithMoments(Cylinder(0.01, 0.006, 0.01), {1.6e-7, 1.6e-7, 1.6e-7})},
              {"proximal",
               "revolute",
               {},
               kX,
               Range(0, 1.222, 3, 4, 0.1),
               Capsule(0.04, 0.012, 0.02, {0, 0, 0.02})},
              {"hub",
               "revolute",
               {0, 0, 0.038},
               kX,
               Range(-0.209, 0.209, 2, 4, 0.1),
               WithMoments(Ball(0.002, 0.004), {1e-12, 1e-12, 3e-13})},
              {"middle",
               "revolute",
               {},
               {0, -1, 0},
               Range(-0.698, 0.698, 1, 2, 0.1),
               Capsule(0.02, 0.01, 0.012, {0, 0, 0.016})},
              {"distal",
               "revolute",
               {0, 0, 0.032},
               kX,
               Range(-0.262, 1.571, 1, 4, 0.1),
               Capsule(0.017, 0.009, 0.012, {0, 0, 0.01})}});
  return urdf.Text();
}

// Four fingers of meshes that are in the palm where they start, as far apart as those of the hand
// in whose style they are: side by side they would rub along whole faces (docs/LIMITATIONS.md,
// MuJoCo).
std::string Printed16() {
  Urdf urdf("printed16", "palm", Wedge(0.3, "wedge.stl", {0.12, 0.1, 0.05}));
  for (int i = 0; i < 4; ++i) {
    urdf.Chain("palm", "f" + std::to_string(i) + "_",
               {{"mcp",
                 "revolute",
                 {0.1, 0.045 * i, 0.01},
                 kY,
                 Range(-0.314, 2.23, 0.95, 8.5),
                 Wedge(0.044, "wedge.obj", {0.04, 0.03, 0.03})},
                {"pip",
                 "revolute",
                 {0.01, 0, 0.005},
                 kZ,
                 Range(-1.047, 1.047, 0.95, 8.5),
                 Wedge(0.032, "wedge.obj", {0.03, 0.03, 0.03})},
                {"dip",
                 "revolute",
                 {0.035, 0, 0},
                 kY,
                 Range(-0.506, 1.885, 0.95, 8.5),
                 Wedge(0.037, "wedge.dae", {0.04, 0.03, 0.03})},
                {"tip",
                 "revolute",
                 {0.036, 0, 0},
                 kY,
                 Range(-0.366, 2.042, 0.95, 8.5),
                 Wedge(0.016, "wedge.stl", {0.04, 0.02, 0.02})}});
  }
  return urdf.Text();
}

// Fingers that spread as one, and whose ends follow their beginnings.
std::string ThreeFingers8() {
  Urdf urdf("three_fingers8", "base", Cylinder(0.6, 0.045, 0.08));
  for (int i = 0; i < 3; ++i) {
    const std::string f = "finger" + std::to_string(i) + "_";
    std::string on = "base";
    if (i < 2) {
      urdf.Join("base",
                {f + "prox",
                 "revolute",
                 {i == 0 ? -0.025 : 0.025, 0, 0.08},
                 {0, 0, i == 0 ? -1.0 : 1.0},
                 Range(0, 3.1416, 30, 2, 0.01),
                 Box(0.14, {0.04, 0.04, 0.02})},
                i == 0 ? "" : Mimic("finger0_prox_joint"));
      on = f + "prox";
    }
    urdf.Join(on, {f + "med",
                   "revolute",
                   {i == 2 ? -0.05 : 0.05, 0, i == 2 ? 0.1 : 0.02},
                   kY,
                   Range(0, 2.44, 30, 2, 0.01),
                   Box(0.06, {0.07, 0.02, 0.02}, {0.035, 0, 0})});
    urdf.Join(f + "med",
              {f + "dist",
               "revolute",
               {0.07, 0, 0},
               kY,
               Range(0, 0.84, 30, 2, 0.01),
               Box(0.04, {0.055, 0.02, 0.015}, {0.028, 0, 0})},
              Mimic(f + "med_joint", 0.333));
  }
  return urdf.Text();
}

// Six bars, of which five follow one.
std::string Parallel6() {
  Urdf urdf("parallel6", "base", Box(0.66, {0.09, 0.06, 0.1}, {0, 0, 0.04}));
  for (const bool left : {true, false}) {
    const std::string side = left ? "left_" : "right_";
    const double x = left ? 1 : -1;
    urdf.Join("base",
              {side + "outer_knuckle",
               "revolute",
               {0.03 * x, 0, 0.055},
               {0, -x, 0},
               Range(0, 0.8, 1000, 2, 0.1),
               Box(0.014, {0.03, 0.02, 0.01}, {0.015 * x, 0, 0})},
              left ? "" : Mimic("left_outer_knuckle_joint"));
    urdf.Fix(side + "outer_knuckle", side + "outer_finger", {0.0315 * x, 0, -0.004},
             Box(0.026, {0.01, 0.02, 0.05}, {0, 0, 0.02}));
    urdf.Join(side + "outer_finger",
              {side + "inner_finger",
               "revolute",
               {0.006 * x, 0, 0.047},
               {0, -x, 0},
               Range(-0.8757, 0, 1000, 2, 0.1),
               Box(0.01, {0.01, 0.02, 0.04}, {0, 0, 0.02})},
              Mimic("left_outer_knuckle_joint", -1));
    urdf.Join("base",
              {side + "inner_knuckle",
               "revolute",
               {0.0127 * x, 0, 0.0614},
               {0, -x, 0},
               Range(0, 0.8757, 1000, 2, 0.1),
               Box(0.027, {0.03, 0.02, 0.01}, {0.015 * x, 0, 0.02})},
              Mimic("left_outer_knuckle_joint"));
  }
  return urdf.Text();
}

// Six motors for twelve joints.
std::string Prosthesis12() {
  Urdf urdf("prosthesis12", "hand_base", Box(0.14, {0.03, 0.07, 0.13}, {0, 0, 0.06}));
  urdf.Join("hand_base", {"thumb_yaw",
                          "revolute",
                          {-0.01, -0.02, 0.06},
                          {0, 0, -1},
                          Range(-0.1, 1.3, 1, 0.5),
                          Box(0.002, {0.01, 0.01, 0.01})});
  urdf.Join("thumb_yaw", {"thumb_pitch",
                          "revolute",
                          {0, -0.01, 0},
                          {0, 0, 1},
                          Range(0, 0.5, 1, 0.5),
                          Box(0.0066, {0.02, 0.01, 0.01}, {0, -0.01, 0})});
  urdf.Join("thumb_pitch",
            {"thumb_middle",
             "revolute",
             {0.044, -0.03, 0},
             kZ,
             Range(0, 0.8, 1, 0.5),
             Box(0.0038, {0.02, 0.01, 0.01})},
            Mimic("thumb_pitch_joint", 1.6));
  urdf.Join("thumb_middle",
            {"thumb_end",
             "revolute",
             {0.02, -0.02, 0},
             kZ,
             Range(0, 1.2, 1, 0.5),
             Box(0.0033, {0.02, 0.01, 0.01})},
            Mimic("thumb_pitch_joint", 2.4));
  for (int i = 0; i < 4; ++i) {
    const std::string f = "finger" + std::to_string(i) + "_";
    urdf.Join("hand_base", {f + "near",
                            "revolute",
                            {0, 0.03 - 0.019 * i, 0.137},
                            {0, -1, 0},
                            Range(0, 1.7, 1, 0.5),
                            Capsule(0.0043, 0.007, 0.025, {0, 0, 0.016})});
    urdf.Join(f + "near",
              {f + "far",
               "revolute",
               {0, 0, 0.033},
               {0, -1, 0},
               Range(0, 1.7, 1, 0.5),
               Capsule(0.0034, 0.006, 0.03, {0, 0, 0.02})},
              Mimic(f + "near_joint", 1.06));
  }
  return urdf.Text();
}

// Springs in the fingers, which are dampers here; a cup without mass that moves.
std::string Soft9() {
  Urdf urdf("soft9", "mount", Box(0.2, {0.06, 0.06, 0.04}));
  for (int i = 0; i < 2; ++i) {
    std::string on = "mount";
    for (int k = 0; k < 4; ++k) {
      const std::string name = "f" + std::to_string(i) + "_" + std::to_string(k);
      urdf.Join(on, {name,
                     "revolute",
                     {k == 0 ? 0.03 - 0.06 * i : 0, 0, k == 0 ? 0.03 : 0.02},
                     kY,
                     Range(-0.6, 0.6, 0.5, 5, 0.02, 0.005),
                     Capsule(0.004, 0.006, 0.01, {0, 0, 0.01})});
      on = name;
    }
  }
  return urdf.Join("mount", {"cup", "prismatic", {0, 0, 0.03}, kZ, Range(0, 0.02, 5, 1), Frame()})
      .Text();
}

}  // namespace

std::vector<Robot> Hands() {
  std::vector<Robot> robots = {{"tendons24", Tendons24()},          {"printed16", Printed16()},
                               {"three_fingers8", ThreeFingers8()}, {"parallel6", Parallel6()},
                               {"prosthesis12", Prosthesis12()},    {"soft9", Soft9()}};
  for (Robot& robot : robots) {
    robot.has_fixed_base = true;
    robot.height_m = 1;
    robot.touches_itself = true;
  }
  return robots;
}

}  // namespace tcs::zoo
