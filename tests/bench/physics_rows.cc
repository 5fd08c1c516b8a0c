#include "tests/bench/physics_rows.h"

#include <memory>
#include <numeric>
#include <utility>

#include "tests/bench/bare_simbody.h"
#include "tests/bench/physics_world.h"

namespace tcs::bench {

namespace {

constexpr int kBodies[] = {1, 2, 8, 32, 96, 512};
constexpr VirtualDuration kAnswer = VirtualDuration::Microseconds(500);  // after the sample

constexpr int kCheckpoints = 100;

struct Run {
  double seconds = 0;
  double checkpoint_s = 0;  // for each
  Dynamics::Work work;
};

// As the coordinator's world does it. Commands come one by one, each at a time of its own.
Run RunDynamics(const WorldSpec& world, int samples, VirtualDuration period, bool changes) {
  const auto dynamics = MakeDynamics(world);
  const int bodies = static_cast<int>(world.bodies.size());
  std::vector<int> all(static_cast<std::size_t>(bodies));
  std::iota(all.begin(), all.end(), 0);
  std::vector<BodyState> states(all.size());
  const double start_s = CpuSeconds();
  for (int sample = 1; sample <= samples; ++sample) {
    const VirtualTime now = VirtualTime() + period * sample;
    dynamics->AdvanceTo(now);
    dynamics->Read(now, all, states);
    for (int i = 0; i < bodies; ++i) {
      dynamics->Apply(i, ChangingWrench(changes ? sample : 0),
                      now + kAnswer + VirtualDuration::Microseconds(i));
    }
  }
  Run run{.seconds = CpuSeconds() - start_s, .work = dynamics->work()};
  std::unique_ptr<Dynamics::Checkpoint> checkpoint = dynamics->Save();
  const double saving_s = CpuSeconds();
  for (int i = 0; i < kCheckpoints; ++i) checkpoint = dynamics->Save(std::move(checkpoint));
  run.checkpoint_s = (CpuSeconds() - saving_s) / kCheckpoints;
  return run;
}

PhysicsRow MeasureRow(int bodies, int samples, int rounds) {
  std::vector<double> bare, changing, same, checkpoint, changing_ratio, unlike_ratio, same_ratio;
  const WorldSpec world = PhysicsWorld(bodies), unlike = PhysicsWorldOfUnlikeBodies(bodies);
  PhysicsRow row{.bodies = bodies};
  const double count = static_cast<double>(bodies) * samples;
  for (int round = 0; round < rounds; ++round) {
    bare.push_back(BareSimbodySeconds(bodies, samples) / count);
    const Run with_changes = RunDynamics(world, samples, kSamplePeriod, true);
    changing.push_back(with_changes.seconds / count);
    checkpoint.push_back(with_changes.checkpoint_s / bodies);
    same.push_back(RunDynamics(world, samples, kSamplePeriod, false).seconds / count);
    const Run of_unlike = RunDynamics(unlike, samples, kSamplePeriod, true);
    unlike_ratio.push_back(of_unlike.seconds / count / bare.back());
    changing_ratio.push_back(changing.back() / bare.back());
    same_ratio.push_back(same.back() / bare.back());
    row.steps_per_sample = static_cast<double>(with_changes.work.steps) / count;
  }
  row.bare_us = 1e6 * SpreadOf(bare).median;
  row.changing_us = 1e6 * SpreadOf(changing).median;
  row.checkpoint_us = 1e6 * SpreadOf(checkpoint).median;
  row.same_us = 1e6 * SpreadOf(same).median;
  row.changing = SpreadOf(changing_ratio);
  row.unlike = SpreadOf(unlike_ratio);
  row.same = SpreadOf(same_ratio);
  return row;
}

}  // namespace

PhysicsRows MeasurePhysics(int rounds, bool quick) {
  const int samples = quick ? 10 : 500;
  PhysicsRows results{.rounds = rounds, .virtual_s = samples * kSamplePeriod.seconds()};
  for (const int bodies : kBodies) results.rows.push_back(MeasureRow(bodies, samples, rounds));
  std::vector<double> samples_us;
  for (int round = 0; round < rounds; ++round) {
    const Run run =
        RunDynamics(PhysicsWorld(1), 10 * samples, VirtualDuration::Milliseconds(1), false);
    samples_us.push_back(1e6 * run.seconds / (10 * samples));
  }
  results.sample_at_1khz_us = SpreadOf(samples_us).median;
  return results;
}

}  // namespace tcs::bench
