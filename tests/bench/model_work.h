// A robot that is a model, and what is done with it: samples at even times, each of which is
// answered by commands. Both tcs's dynamics and the bare engines do the same work.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simbody_bridge/dynamics.h"

namespace tcs::bench {

struct ModelWork {
  WorldSpec world;  // of one model that moves; the engine is not chosen yet
  VirtualDuration period;
  VirtualDuration answers_after;  // the commands, each sample
  int samples = 0;
  // What is commanded of each rotor and joint after a sample, in the model's order.
  std::vector<double> (*speeds_radps)(int sample, const RobotModel& model) = nullptr;
  std::vector<JointDrive> (*drives)(int sample, const RobotModel& model) = nullptr;

  double seconds() const { return samples * period.seconds(); }
  const RobotModel& model() const { return world.models.front(); }
};

// The quadrotor of examples/quadrotor, which hovers: a sample and four speeds each millisecond. The
// arm of examples/arm at 100 Hz, whose six servos follow positions that change. None, with a
// sentence on stderr, if the example cannot be loaded.
std::optional<ModelWork> QuadrotorWork(bool quick);
std::optional<ModelWork> ArmWork(bool quick);

// Each in seconds of the thread's processor time.
double DynamicsSeconds(const ModelWork& work, EngineKind engine);
// Simbody's or MuJoCo's own integration of the same model, from one sample to the next: what the
// commands make act is set at the samples.
double BareSimbodySeconds(const ModelWork& work);
double BareMujocoSeconds(const ModelWork& work);
// False where tcs was built without it.
bool HasMujoco();

}  // namespace tcs::bench
