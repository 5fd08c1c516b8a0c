#include <cmath>

#include "tests/zoo/robots.h"
#include "tests/zoo/urdf_text.h"

namespace tcs::zoo {
namespace {

std::string Hexacopter() {
  Urdf urdf("hexacopter", "base_link", Box(1.5, {0.25, 0.25, 0.1}));
  for (int i = 0; i < 6; ++i) {
    const double angle = 1.0472 * i;
    urdf.Join("base_link", {"rotor_" + std::to_string(i),
                            "continuous",
                            {0.28 * std::cos(angle), 0.28 * std::sin(angle), 0.05},
                            kZ,
                            Gear(),
                            Cylinder(0.005, 0.12, 0.005)});
  }
  return urdf.Text();
}

// A camera that three light motors hold, below propellers that are frames.
std::string CameraDrone() {
  Urdf urdf("camera_drone", "frame", Box(1, {0.3, 0.3, 0.06}));
  for (int i = 0; i < 4; ++i) {
    urdf.Fix("frame", "prop_" + std::to_string(i),
             {i < 2 ? 0.2 : -0.2, i % 2 == 0 ? 0.2 : -0.2, 0.03}, Frame());
  }
  return urdf
      .Chain("frame", "gimbal_",
             {{"yaw",
               "continuous",
               {0.1, 0, -0.04},
               kZ,
               Motor(0.1, 30, 1e-4),
               Cylinder(0.01, 0.015, 0.02)},
              {"roll",
               "revolute",
               {-0.02, 0, -0.02},
               kX,
               Range(-0.8, 0.8, 0.1, 30, 1e-4),
               Cylinder(0.005, 0.01, 0.02)},
              {"pitch",
               "revolute",
               {0.02, 0, 0},
               kY,
               Range(-1.6, 0.5, 0.1, 30, 1e-4),
               WithMoments(Box(0.02, {0.02, 0.02, 0.02}), {2e-7, 2e-7, 2e-7})}})
      .Text();
}

// A wing and rudders that are flat.
std::string Glider() {
  Urdf urdf("glider", "fuselage", Capsule(0.6, 0.05, 0.6));
  urdf.Fix("fuselage", "wing", {0, 0, 0.05}, Wedge(0.3, "wedge.stl", {0.2, 1.4, 0}));
  for (const char* name : {"left_aileron", "right_aileron", "elevator", "rudder"}) {
    const bool is_tail = name[0] == 'e' || name[2] == 'd';
    urdf.Join("fuselage", {name,
                           "revolute",
                           {is_tail ? -0.5 : -0.1,
                            name[0] == 'l'               ? 0.5
                            : name[0] == 'r' && !is_tail ? -0.5
                                                         : 0,
                            0.05},
                           name[2] == 'd' ? kZ : kY,
                           Range(-0.5, 0.5, 1, 5, 1e-3),
                           Box(0.01, {0.05, 0.3, 1e-4}, {-0.025, 0, 0})});
  }
  return urdf.Text();
}

// Two rotors on one mast turn against each other.
std::string Coaxial() {
  return Urdf("coaxial", "body", Capsule(0.25, 0.04, 0.1))
      .Join("body", {"upper",
                     "continuous",
                     {0, 0, 0.15},
                     kZ,
                     Motor(1, 500, 1e-6),
                     Box(0.02, {0.34, 0.02, 0.002})})
      .Join("body",
            {"lower",
             "continuous",
             {0, 0, 0.1},
             kZ,
             Motor(1, 500, 1e-6),
             Box(0.02, {0.34, 0.02, 0.002})},
            Mimic("upper_joint", -1))
      .Join("body", {"tail_rotor",
                     "continuous",
                     {-0.2, 0, 0},
                     kY,
                     Motor(1e-12, 1000),
                     WithMoments(Box(1e-9, {0.05, 0.01, 0.001}), {1e-15, 1e-15, 1e-15})})
      .Text();
}

std::string Submarine() {
  Urdf urdf("submarine", "hull", Box(11, {0.45, 0.3, 0.25}));
  for (int i = 0; i < 8; ++i) {
    urdf.Fix("hull", "thruster_" + std::to_string(i),
             {i % 2 == 0 ? 0.15 : -0.15, i < 4 ? 0.2 : -0.2, i % 4 < 2 ? 0.1 : -0.1},
             Cylinder(0.3, 0.04, 0.06));
  }
  urdf.Join("hull", {"jaw_left",
                     "revolute",
                     {0.3, 0.02, -0.1},
                     kZ,
                     Range(0, 0.8, 10, 1, 0.1, 0.1),
                     Box(0.05, {0.1, 0.01, 0.02}, {0.05, 0, 0})});
  return urdf
      .Join("hull",
            {"jaw_right",
             "revolute",
             {0.3, -0.02, -0.1},
             {0, 0, -1},
             Range(0, 0.8, 10, 1, 0.1, 0.1),
             Box(0.05, {0.1, 0.01, 0.02}, {0.05, 0, 0})},
            Mimic("jaw_left_joint"))
      .Text();
}

std::string Excavator() {
  return Urdf("excavator", "tracks", Box(3000, {2.5, 1.8, 0.6}, {0, 0, 0.3}))
      .Chain("tracks", "",
             {{"house",
               "continuous",
               {0, 0, 0.6},
               kZ,
               Motor(60000, 1, 500, 200),
               Box(4000, {2.2, 1.7, 1.3}, {-0.3, 0, 0.7})},
              {"boom",
               "revolute",
               {0.8, 0, 0.4},
               {0, -1, 0},
               Range(-0.9, 1.2, 300000, 0.6, 2000, 500),
               Box(600, {3, 0.3, 0.3}, {1.5, 0, 0})},
              {"stick",
               "revolute",
               {3, 0, 0},
               {0, -1, 0},
               Range(-2.6, -0.6, 150000, 0.8, 1000, 300),
               Box(300, {1.6, 0.25, 0.25}, {0.8, 0, 0})},
              {"bucket",
               "revolute",
               {1.6, 0, 0},
               {0, -1, 0},
               Range(-2.5, 0.7, 60000, 1, 500, 200),
               Wedge(200, "wedge.stl", {0.6, 0.7, 0.6})}})
      .Text();
}

// Furniture: a door with a handle, drawers that nobody drives.
std::string Cabinet() {
  Urdf urdf("cabinet", "carcass", Box(30, {0.4, 0.8, 1}, {-0.25, 0, 0}));
  urdf.Chain("carcass", "",
             {{"door",
               "revolute",
               {0, 0.4, 0},
               {0, 0, -1},
               Range(-1.6, 0, 0, 0, 0.5, 0.3),
               Box(4, {0.02, 0.4, 0.9}, {0, -0.2, 0})},
              {"handle",
               "revolute",
               {0.03, -0.35, 0},
               kX,
               Range(-0.8, 0.8, 0, 0, 0.01, 0.02),
               Box(0.1, {0.02, 0.1, 0.02})}});
  for (int i = 0; i < 3; ++i) {
    urdf.Join("carcass", {"drawer_" + std::to_string(i),
                          "prismatic",
                          {0, -0.2, 0.3 * (i - 1)},
                          kX,
                          Range(0, 0.3, 0, 0, 5, 2),
                          Box(2, {0.38, 0.38, 0.2}, {-0.18, 0, 0})});
  }
  return urdf.Text();
}

// Nobody has said what its joints can do.
std::string DoublePendulum() {
  return Urdf("double_pendulum", "pivot", Frame())
      .Chain("pivot", "",
             {{"upper", "continuous", {}, kY, Gear(), Cylinder(1, 0.02, 1, {0, 0, -0.5})},
              {"lower", "revolute", {0, 0, -1}, kY, Gear(), Cylinder(1, 0.02, 1, {0, 0, -0.5})}})
      .Text();
}

}  // namespace

std::vector<Robot> Craft() {
  return {{"hexacopter", Hexacopter(), false, 1},
          {"camera_drone", CameraDrone(), false, 1},
          {"glider", Glider(), false, 2},
          {"coaxial", Coaxial(), false, 1},
          {"submarine", Submarine(), false, 1}};
}

std::vector<Robot> Machines() {
  return {{"excavator", Excavator(), false, 0.02},
          {"cabinet", Cabinet(), true, 1},
          {"double_pendulum", DoublePendulum(), true, 3}};
}

}  // namespace tcs::zoo
