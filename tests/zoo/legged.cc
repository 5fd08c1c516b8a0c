#include "tests/zoo/robots.h"
#include "tests/zoo/urdf_text.h"

namespace tcs::zoo {
namespace {

struct Corner {
  const char* name;
  double x, y;
};
constexpr Corner kCorners[] = {{"FL", 1, 1}, {"FR", 1, -1}, {"RL", -1, 1}, {"RR", -1, -1}};

// Knees that cannot be straight; feet, some of which are points; frames of sensors.
std::string Dog12() {
  Urdf urdf("dog12", "base", Box(6.9, {0.38, 0.1, 0.11}));
  urdf.Fix("base", "imu", {-0.02, 0, 0.04}, Frame())
      .Fix("base", "radar", {0.29, 0, -0.05}, Frame());
  for (const auto& [name, x, y] : kCorners) {
    const std::string leg = std::string(name) + "_";
    urdf.Chain("base", leg,
               {{"hip",
                 "revolute",
                 {0.193 * x, 0.0465 * y, 0},
                 kX,
                 Range(-1.05, 1.05, 23.7, 30),
                 Cylinder(0.68, 0.046, 0.04, {0, 0.08 * y, 0}, "1.5708 0 0")},
                {"thigh",
                 "revolute",
                 {0, 0.0955 * y, 0},
                 kY,
                 x > 0 ? Range(-1.57, 3.49, 23.7, 30) : Range(-0.52, 4.53, 23.7, 30),
                 Box(1.15, {0.0245, 0.034, 0.213}, {0, 0, -0.1})},
                {"calf",
                 "revolute",
                 {0, 0, -0.213},
                 kY,
                 Range(-2.72, -0.84, 45, 16),
                 Cylinder(0.15, 0.012, 0.12, {0.01, 0, -0.06})}});
    urdf.Fix(leg + "calf", leg + "foot", {0, 0, -0.213}, Ball(0.04, 0.022));
    urdf.Fix(leg + "foot", leg + "contact", {0, 0, -0.022}, Ball(0, 0));
  }
  return urdf.Text();
}

// Rotors of gears that are fixed to what they are in, with inertias of points.
std::string Dog12Geared() {
  Urdf urdf("dog12_geared", "base", Box(5, {0.37, 0.1, 0.11}));
  for (const auto& [name, x, y] : kCorners) {
    const std::string leg = std::string(name) + "_";
    urdf.Chain("base", leg,
               {{"hip",
                 "continuous",
                 {0.18 * x, 0.05 * y, 0},
                 kX,
                 Motor(33, 21, 0.1, 0.2),
                 WithMoments(Box(0.7, {0.08, 0.08, 0.08}), {4e-4, 6e-4, 4e-4})},
                {"thigh",
                 "continuous",
                 {0, 0.08 * y, 0},
                 kY,
                 Motor(33, 21, 0.1, 0.2),
                 Box(1, {0.03, 0.03, 0.2}, {0, 0, -0.1})},
                {"calf",
                 "continuous",
                 {0, 0, -0.2},
                 kY,
                 Motor(33, 21, 0.1, 0.2),
                 Box(0.17, {0.02, 0.02, 0.2}, {0, 0, -0.1})}});
    urdf.Fix("base", leg + "hip_rotor", {0.1 * x, 0.05 * y, 0},
             WithMoments(Invisible(Ball(0.089, 0.02)), {1.1e-4, 5.9e-5, 5.9e-5}));
    urdf.Fix(leg + "hip", leg + "thigh_rotor", {0, 0.02 * y, 0},
             WithMoments(Invisible(Ball(0.089, 0.02)), {5.9e-5, 1.3e-4, 5.9e-5}));
    urdf.Fix(leg + "thigh", leg + "calf_rotor", {},
             WithMoments(Invisible(Ball(1e-9, 0.02)), {0, 0, 0}));
    urdf.Fix(leg + "calf", leg + "foot", {0, 0, -0.2}, Ball(0.06, 0.02));
  }
  return urdf.Text();
}

// Inertias as draughtsmen leave them.
std::string Cheetah12() {
  Urdf urdf("cheetah12", "body",
            WithMoments(Box(3.3, {0.2, 0.1, 0.1}), {0.011253, 0.036203, 0.042673}));
  for (const auto& [name, x, y] : kCorners) {
    const std::string leg = std::string(name) + "_";
    urdf.Chain(
        "body", leg,
        {{"abduct",
          "continuous",
          {0.19 * x, 0.049 * y, 0},
          kX,
          Motor(18, 40),
          WithMoments(Invisible(Ball(0.54, 0.04, {0, 0.036 * y, 0})), {3.81e-4, 5.6e-4, 4.44e-4})},
         {"thigh",
          "continuous",
          {0, 0.062 * y, 0},
          {0, -1, 0},
          Motor(18, 40),
          WithMoments(Box(0.634, {0.03, 0.03, 0.2}, {0, 0, -0.1}), {1.983e-3, 2.103e-3, 4.08e-5})},
         {"shank",
          "continuous",
          {0, 0, -0.209},
          {0, -1, 0},
          Motor(26, 27),
          WithMoments(Box(0.064, {0.02, 0.02, 0.18}, {0, 0, -0.09}), {2.45e-4, 2.48e-5, 6e-6})}});
    urdf.Fix(leg + "shank", leg + "foot", {0, 0, -0.19}, Ball(0, 0.02));
  }
  return urdf.Text();
}

// A dog that carries an arm.
std::string Dog18() {
  Urdf urdf("dog18", "base", Box(30, {0.9, 0.25, 0.2}));
  for (const auto& [name, x, y] : kCorners) {
    const std::string leg = std::string(name) + "_";
    urdf.Chain("base", leg,
               {{"haa",
                 "revolute",
                 {0.34 * x, 0.12 * y, 0},
                 kX,
                 Range(-0.7, 0.5, 140, 12, 0.2, 0.5),
                 Cylinder(2, 0.06, 0.1)},
                {"hfe",
                 "revolute",
                 {0.06 * x, 0.08 * y, 0},
                 kY,
                 Range(-9, 9, 140, 12, 0.2, 0.5),
                 Cylinder(3, 0.05, 0.28, {0, 0, -0.14})},
                {"kfe",
                 "revolute",
                 {0, 0.03 * y, -0.28},
                 kY,
                 Range(-9, 9, 140, 12, 0.2, 0.5),
                 Cylinder(0.4, 0.025, 0.28, {0, 0, -0.14})}});
    urdf.Fix(leg + "kfe", leg + "foot", {0, 0, -0.31}, Ball(0.2, 0.03));
  }
  urdf.Chain(
      "base", "arm_",
      {{"1", "revolute", {0.3, 0, 0.15}, kZ, Range(-3, 3, 30, 3, 0.5, 0.2), Cylinder(1, 0.05, 0.1)},
       {"2",
        "revolute",
        {0, 0, 0.05},
        kY,
        Range(-3, 0.5, 30, 3, 0.5, 0.2),
        Capsule(1, 0.04, 0.3, {0, 0, 0.15})},
       {"3",
        "revolute",
        {0, 0, 0.34},
        kY,
        Range(0, 3.1, 30, 3, 0.5, 0.2),
        Capsule(0.8, 0.03, 0.3, {0, 0, 0.15})},
       {"4",
        "revolute",
        {0, 0, 0.3},
        kZ,
        Range(-2.8, 2.8, 10, 3, 0.5, 0.2),
        Cylinder(0.3, 0.03, 0.06)},
       {"5",
        "revolute",
        {0, 0, 0.05},
        kY,
        Range(-1.8, 1.8, 10, 3, 0.5, 0.2),
        Cylinder(0.3, 0.03, 0.06)},
       {"6",
        "revolute",
        {0, 0, 0.05},
        kZ,
        Range(-2.8, 2.8, 10, 3, 0.5, 0.2),
        Cylinder(0.1, 0.03, 0.02)}});
  return urdf.Text();
}

std::string Hexapod18() {
  Urdf urdf("hexapod18", "trunk", Cylinder(2, 0.15, 0.06));
  for (int i = 0; i < 6; ++i) {
    const double x = 0.14 * (1 - i / 2), y = i % 2 == 0 ? 0.12 : -0.12, out = i % 2 == 0 ? 1 : -1;
    urdf.Chain("trunk", "leg" + std::to_string(i) + "_",
               {{"coxa",
                 "revolute",
                 {x, y, 0},
                 kZ,
                 Range(-1.2, 1.2, 6, 8, 0.02, 0.02),
                 Box(0.08, {0.04, 0.05, 0.04}, {0, 0.025 * out, 0})},
                {"femur",
                 "revolute",
                 {0, 0.05 * out, 0},
                 {-out, 0, 0},
                 Range(-1.5, 1.5, 6, 8, 0.02, 0.02),
                 Box(0.1, {0.03, 0.1, 0.03}, {0, 0.05 * out, 0})},
                {"tibia",
                 "revolute",
                 {0, 0.1 * out, 0},
                 {-out, 0, 0},
                 Range(-2.4, 1, 6, 8, 0.02, 0.02),
                 Capsule(0.08, 0.012, 0.12, {0, 0, -0.07})}});
  }
  return urdf.Text();
}

// Springs of steel, which no motor drives, are stiff dampers here.
std::string Biped14() {
  Urdf urdf("biped14", "pelvis", Box(10.3, {0.2, 0.2, 0.25}, {0.05, 0, 0.03}));
  const std::vector<Step> leg = {{"hip_roll",
                                  "revolute",
                                  {0.02, 0.135, 0},
                                  kX,
                                  Range(-0.26, 0.39, 112, 12, 1),
                                  Cylinder(1.8, 0.06, 0.08)},
                                 {"hip_yaw",
                                  "revolute",
                                  {0, 0, -0.07},
                                  kZ,
                                  Range(-0.39, 0.39, 112, 12, 1),
                                  Cylinder(1.2, 0.06, 0.1)},
                                 {"hip_pitch",
                                  "revolute",
                                  {0, 0, -0.09},
                                  {0, -1, 0},
                                  Range(-0.87, 1.39, 195, 9, 1),
                                  Box(5.5, {0.08, 0.08, 0.15})},
                                 {"knee",
                                  "revolute",
                                  {0, 0, -0.12},
                                  {0, -1, 0},
                                  Range(-2.86, -0.64, 195, 9, 1),
                                  Box(0.75, {0.1, 0.05, 0.1})},
                                 {"shin_spring",
                                  "revolute",
                                  {0.06, 0, -0.05},
                                  {0, -1, 0},
                                  Range(-0.35, 0.35, 0, 20, 100),
                                  Box(0.58, {0.03, 0.03, 0.4}, {0, 0, -0.2})},
                                 {"tarsus",
                                  "revolute",
                                  {0, 0, -0.43},
                                  {0, -1, 0},
                                  Range(0.87, 2.97, 0, 20, 0.1),
                                  Box(0.78, {0.03, 0.03, 0.4}, {0, 0, -0.2})},
                                 {"toe",
                                  "revolute",
                                  {0, 0, -0.41},
                                  {0, -1, 0},
                                  Range(-2.44, -0.52, 45, 12, 1),
                                  Capsule(0.15, 0.02, 0.16, {0, 0, -0.03})}};
  return urdf.Chain("pelvis", "left_", leg).Chain("pelvis", "right_", Mirrored(leg)).Text();
}

// One leg that goes in and out, below hips whose frame has no mass.
std::string Hopper() {
  return Urdf("hopper", "torso", Box(4, {0.3, 0.3, 0.2}))
      .Join("torso", {"hip_x", "revolute", {}, kX, Range(-0.8, 0.8, 20, 10, 0.1), Frame()})
      .Join("hip_x", {"hip_y",
                      "revolute",
                      {},
                      kY,
                      Range(-0.8, 0.8, 20, 10, 0.1),
                      Cylinder(0.5, 0.03, 0.2, {0, 0, -0.15})})
      .Join("hip_y", {"leg",
                      "prismatic",
                      {0, 0, -0.3},
                      kZ,
                      Range(-0.05, 0.2, 400, 5, 20),
                      Cylinder(0.2, 0.01, 0.3, {0, 0, -0.1})})
      .Fix("leg", "foot", {0, 0, -0.26}, Ball(0.05, 0.03))
      .Text();
}

// Motors in pairs; what holds the bars together is no tree, and is left open here. Limits are equal
// where a joint is locked.
std::string Minitaur8() {
  Urdf urdf("minitaur8", "base", Box(3.3, {0.4, 0.2, 0.08}));
  for (const auto& [name, x, y] : kCorners) {
    for (const char* side : {"L", "R"}) {
      const std::string motor = std::string(name) + side + "_";
      urdf.Chain("base", motor,
                 {{"motor",
                   "continuous",
                   {0.21 * x, 0.1 * y, 0},
                   kY,
                   Gear(),
                   Cylinder(0.24, 0.04, 0.02, {}, "1.5708 0 0")},
                  {"upper",
                   "fixed",
                   {0, 0.02 * y, 0},
                   kX,
                   {},
                   Box(0.034, {0.1, 0.01, 0.01}, {0.05, 0, 0})},
                  {"lower",
                   "continuous",
                   {0.1, 0, 0},
                   kY,
                   Gear(),
                   Box(0.086, {0.2, 0.01, 0.01}, {0.1, 0, 0})}});
    }
  }
  Gear locked = Range(0.3, 0.3000001, 1, 1);
  return urdf
      .Join("base", {"tail", "revolute", {-0.25, 0, 0}, kY, locked, Box(0.1, {0.1, 0.02, 0.02})})
      .Text();
}

}  // namespace

std::vector<Robot> Legged() {
  return {{"dog12", Dog12(), false, 0.5},          {"dog12_geared", Dog12Geared(), false, 0.45},
          {"cheetah12", Cheetah12(), false, 0.45}, {"dog18", Dog18(), false, 0.65},
          {"hexapod18", Hexapod18(), false, 0.2},  {"biped14", Biped14(), false, 1.3},
          {"hopper", Hopper(), false, 0.65},       {"minitaur8", Minitaur8(), false, 0.3}};
}

}  // namespace tcs::zoo
