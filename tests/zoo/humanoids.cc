#include "tests/zoo/robots.h"
#include "tests/zoo/urdf_text.h"

namespace tcs::zoo {
namespace {

// How a body is built: everything scales with its height, its motors with their strength.
struct Build {
  double height_m, mass_kg, effort_nm, damping, friction;
};

std::vector<Step> LegOf(const Build& b) {
  const double h = b.height_m, m = b.mass_kg, e = b.effort_nm, d = b.damping, f = b.friction;
  return {{"hip_pitch",
           "revolute",
           {0, 0.06 * h, -0.05 * h},
           kY,
           Range(-2.5, 2.8, e, 30, d, f),
           Cylinder(0.03 * m, 0.03 * h, 0.05 * h)},
          {"hip_roll",
           "revolute",
           {0, 0.02 * h, -0.02 * h},
           kX,
           Range(-0.5, 2.9, e, 20, d, f),
           Cylinder(0.03 * m, 0.03 * h, 0.05 * h)},
          {"hip_yaw",
           "revolute",
           {0, 0, -0.06 * h},
           kZ,
           Range(-2.7, 2.7, e, 30, d, f),
           Capsule(0.05 * m, 0.03 * h, 0.12 * h, {0, 0, -0.06 * h})},
          {"knee",
           "revolute",
           {0, 0, -0.16 * h},
           kY,
           Range(-0.08, 2.8, 1.5 * e, 20, d, f),
           Capsule(0.05 * m, 0.025 * h, 0.14 * h, {0, 0, -0.1 * h})},
          {"ankle_pitch",
           "revolute",
           {0, 0, -0.22 * h},
           kY,
           Range(-0.87, 0.52, 0.4 * e, 30, d, f),
           Ball(0.002 * m, 0.015 * h)},
          {"ankle_roll",
           "revolute",
           {0, 0, -0.01 * h},
           kX,
           Range(-0.26, 0.26, 0.4 * e, 30, d, f),
           Box(0.015 * m, {0.14 * h, 0.06 * h, 0.02 * h}, {0.02 * h, 0, -0.02 * h})}};
}

std::vector<Step> ArmOf(const Build& b) {
  const double h = b.height_m, m = b.mass_kg, e = 0.3 * b.effort_nm, d = 0.5 * b.damping,
               f = 0.5 * b.friction;
  return {{"shoulder_pitch",
           "revolute",
           {0, 0.09 * h, 0.16 * h},
           kY,
           Range(-3, 2.6, e, 37, d, f),
           Cylinder(0.02 * m, 0.025 * h, 0.04 * h)},
          {"shoulder_roll",
           "revolute",
           {0, 0.03 * h, 0},
           kX,
           Range(-1.5, 2.2, e, 37, d, f),
           Cylinder(0.02 * m, 0.025 * h, 0.06 * h)},
          {"shoulder_yaw",
           "revolute",
           {0, 0.01 * h, -0.08 * h},
           kZ,
           Range(-2.6, 2.6, e, 37, d, f),
           Capsule(0.02 * m, 0.022 * h, 0.06 * h)},
          {"elbow",
           "revolute",
           {0, 0, -0.07 * h},
           kY,
           Range(-1.9, 0.9, e, 37, d, f),
           Capsule(0.015 * m, 0.02 * h, 0.08 * h, {0, 0, -0.05 * h})},
          {"wrist_yaw",
           "revolute",
           {0, 0, -0.1 * h},
           kZ,
           Range(-2, 2, 0.3 * e, 37, d, f),
           Cylinder(0.004 * m, 0.015 * h, 0.03 * h)},
          {"wrist_roll",
           "revolute",
           {0, 0, -0.02 * h},
           kX,
           Range(-1.5, 1.5, 0.3 * e, 37, d, f),
           Cylinder(0.002 * m, 0.015 * h, 0.02 * h)},
          {"wrist_pitch",
           "revolute",
           {0, 0, -0.01 * h},
           kY,
           Range(-1.5, 1.5, 0.3 * e, 37, d, f),
           Box(0.005 * m, {0.02 * h, 0.05 * h, 0.06 * h}, {0, 0, -0.04 * h})}};
}

// A trunk with legs and arms, of so many joints each.
Urdf Body(const std::string& name, const Build& b, std::size_t waist, std::size_t arm) {
  const double h = b.height_m, m = b.mass_kg;
  Urdf urdf(name, "pelvis", Box(0.1 * m, {0.08 * h, 0.12 * h, 0.06 * h}));
  const Gear gear = Range(-1.2, 1.2, b.effort_nm, 10, b.damping, b.friction);
  const Part torso = Box(0.25 * m, {0.12 * h, 0.16 * h, 0.2 * h}, {0, 0, 0.1 * h}),
             piece = Box(0.02 * m, {0.06 * h, 0.08 * h, 0.04 * h});
  const std::vector<Step> all = {
      {"waist_yaw", "revolute", {0, 0, 0.05 * h}, kZ, gear, waist == 1 ? torso : piece},
      {"waist_roll", "revolute", {0, 0, 0.03 * h}, kX, gear, waist == 2 ? torso : piece},
      {"waist_pitch", "revolute", {0, 0, 0.02 * h}, kY, gear, torso}};
  urdf.Chain("pelvis", "", {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(waist)});
  const std::string chest = all[waist - 1].name;
  urdf.Chain("pelvis", "left_", LegOf(b)).Chain("pelvis", "right_", Mirrored(LegOf(b)));
  std::vector<Step> steps = ArmOf(b);
  steps.resize(arm);
  urdf.Chain(chest, "left_", steps).Chain(chest, "right_", Mirrored(steps));
  urdf.Chain(chest, "head_",
             {{"yaw",
               "revolute",
               {0, 0, 0.22 * h},
               kZ,
               Range(-2, 2, 0.1 * b.effort_nm, 8, 0.1 * b.damping, 0.1 * b.friction),
               Cylinder(0.003 * m, 0.02 * h, 0.03 * h)},
              {"pitch",
               "revolute",
               {0, 0, 0.03 * h},
               kY,
               Range(-0.6, 0.5, 0.1 * b.effort_nm, 8, 0.1 * b.damping, 0.1 * b.friction),
               Ball(0.05 * m, 0.06 * h, {0, 0, 0.06 * h})}});
  urdf.Fix("pelvis", "imu_in_pelvis", {0.02 * h, 0, 0}, Frame());
  return urdf;
}

// Fingers of `joints` each below the last joint of an arm.
void AddFingers(Urdf* urdf, const std::string& wrist, const std::string& side, int fingers,
                int joints, double damping, double friction) {
  for (int i = 0; i < fingers; ++i) {
    std::string on = wrist;
    for (int k = 0; k < joints; ++k) {
      const std::string name = side + "finger" + std::to_string(i) + "_" + std::to_string(k);
      urdf->Join(on, {name,
                      "revolute",
                      {0, k == 0 ? 0.02 * (i - 2) : 0, k == 0 ? -0.12 : -0.035},
                      kY,
                      Range(-0.1, 1.6, 1, 6, damping, friction),
                      Capsule(0.02, 0.008, 0.02, {0, 0, -0.018})});
      on = name;
    }
  }
}

std::string Compact23() { return Body("compact23", {1.3, 35, 88, 0, 0}, 1, 5).Text(); }
std::string Full29() { return Body("full29", {1.3, 35, 88, 0.05, 0.1}, 3, 7).Text(); }

// Hips that one motor turns, fingers that all follow one.
std::string Desktop25() {
  const Build b = {0.57, 5.3, 1.5, 0.02, 0.03};
  Urdf urdf("desktop25", "torso", Box(1.05, {0.08, 0.1, 0.12}));
  urdf.Chain(
      "torso", "head_",
      {{"yaw", "revolute", {0, 0, 0.1}, kZ, Range(-2.08, 2.08, 1.5, 8), Cylinder(0.08, 0.02, 0.04)},
       {"pitch", "revolute", {}, kY, Range(-0.67, 0.51, 1.5, 7), Ball(0.6, 0.055, {0, 0, 0.05})}});
  for (const bool left : {true, false}) {
    const std::string side = left ? "left_" : "right_";
    const double y = left ? 1 : -1;
    urdf.Join("torso",
              {side + "hip_yaw_pitch",
               "revolute",
               {0, 0.05 * y, -0.085},
               {0, 0.7071, -0.7071 * y},
               Range(-1.145, 0.74, 1.5, 4, 0.02, 0.03),
               Box(0.07, {0.03, 0.03, 0.03})},
              left ? "" : Mimic("left_hip_yaw_pitch_joint"));
    std::vector<Step> leg = LegOf(b);
    leg.erase(leg.begin() + 2);
    leg[2].at_m = {0, 0, -0.1};
    leg.front().at_m = {};
    urdf.Chain(side + "hip_yaw_pitch", side, left ? leg : Mirrored(leg));
    std::vector<Step> arm = ArmOf(b);
    arm.resize(5);
    urdf.Chain("torso", side, left ? arm : Mirrored(arm));
    urdf.Join(side + "wrist_yaw", {side + "hand",
                                   "revolute",
                                   {0, 0, -0.03},
                                   kY,
                                   Range(0, 1, 0.3, 8),
                                   Box(0.1, {0.03, 0.03, 0.03})});
    for (int i = 0; i < 3; ++i) {
      const std::string finger = side + "finger" + std::to_string(i);
      urdf.Join(side + "hand",
                {finger,
                 "revolute",
                 {0, 0.012 * (i - 1), -0.02},
                 kY,
                 Range(0, 1, 0.1, 8),
                 WithMoments(Capsule(2e-3, 0.004, 0.02, {0, 0, -0.01}), {1e-7, 1e-7, 1e-8})},
                Mimic(side + "hand_joint", -0.999, 0.999));
      urdf.Join(finger,
                {finger + "_tip",
                 "revolute",
                 {0, 0, -0.025},
                 kY,
                 Range(0, 1, 0.1, 8),
                 WithMoments(Capsule(1e-3, 0.004, 0.01, {0, 0, -0.01}), {1e-7, 1e-7, 1e-8})},
                Mimic(side + "hand_joint", -0.999, 0.999));
    }
  }
  return urdf.Text();
}

// It hangs by its pelvis; gears of damping 1 and friction 1 down to the fingers, which mimic.
std::string Torque42() {
  Urdf urdf = Body("torque42", {1.75, 90, 160, 1, 1}, 2, 7);
  for (const std::string side : {"left_", "right_"}) {
    urdf.Join(side + "wrist_pitch", {side + "gripper",
                                     "revolute",
                                     {0, 0, -0.1},
                                     kX,
                                     Range(-0.96, 0, 8, 1, 1, 1),
                                     Box(0.2, {0.03, 0.06, 0.03})});
    for (int i = 0; i < 6; ++i) {
      const std::string finger = side + "gripper_" + std::to_string(i);
      urdf.Join(i < 3 ? side + "wrist_pitch" : side + "gripper_" + std::to_string(i - 3),
                {finger,
                 "revolute",
                 {0, i < 3 ? 0.03 * (i - 1) : 0, i < 3 ? -0.12 : -0.03},
                 kX,
                 Range(-1.05, 1.05, 10, 1, 1, 1),
                 Box(0.02, {0.01, 0.01, 0.03}, {0, 0, -0.015})},
                Mimic(side + "gripper_joint", i % 2 == 0 ? -1 : 1));
    }
  }
  return urdf.Text();
}

std::string Giant59() {
  Urdf urdf = Body("giant59", {1.9, 130, 350, 0.5, 0.5}, 3, 7);
  for (const std::string side : {"left_", "right_"})
    AddFingers(&urdf, side + "wrist_pitch", side, 5, 3, 0.01, 0.01);
  return urdf.Text();
}

// Motors' inertias are 0, as a drawing's export has them.
std::string Child45() {
  Urdf urdf = Body("child45", {1, 28, 40, 0.06, 0}, 3, 7);
  for (const std::string side : {"left_", "right_"}) {
    for (int i = 0; i < 4; ++i) {
      const std::string name = side + "motor" + std::to_string(i);
      urdf.Join(side + "wrist_pitch",
                {name,
                 "revolute",
                 {0, 0.01 * (i - 1.5), -0.07},
                 kY,
                 Range(-1, 1, 2, 5),
                 WithMoments(Invisible(Ball(0.01, 0.01)), {1e-12, 1e-12, 1e-12})});
      urdf.Join(name, {name + "_tip",
                       "revolute",
                       {0, 0, -0.02},
                       kY,
                       Range(-1, 1, 2, 5),
                       WithMoments(Capsule(0.01, 0.006, 0.02), {0, 0, 0})});
    }
  }
  return urdf.Text();
}

// A trunk on a table, two strong arms.
std::string Upper15() {
  Urdf urdf("upper15", "torso", Box(35, {0.3, 0.4, 0.6}));
  const Build b = {1.9, 70, 170, 0.7, 0};
  urdf.Join("torso", {"head",
                      "revolute",
                      {0.06, 0, 0.65},
                      kZ,
                      Range(-1.57, 1.57, 50, 10),
                      Box(0.55, {0.05, 0.2, 0.15})});
  return urdf.Chain("torso", "left_", ArmOf(b)).Chain("torso", "right_", Mirrored(ArmOf(b))).Text();
}

}  // namespace

std::vector<Robot> Humanoids() {
  return {{"compact23", Compact23(), false, 0.8},  {"full29", Full29(), false, 0.8},
          {"desktop25", Desktop25(), false, 0.35}, {"torque42", Torque42(), true, 1.2},
          {"giant59", Giant59(), false, 1.2},      {"child45", Child45(), true, 1},
          {"upper15", Upper15(), true, 1}};
}

}  // namespace tcs::zoo
