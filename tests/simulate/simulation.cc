#include "tests/simulate/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "shm/clock_page.h"
#include "tests/simulate/broken.h"

namespace tcs::simulate {

namespace {

constexpr std::int64_t kUs = 1'000, kMs = 1'000'000;
constexpr int kThreads = 8;
constexpr VirtualDuration kWakeupP99 = VirtualDuration::Microseconds(80);

}  // namespace

Scenario Simulation::ScenarioOf(Luck& luck) {
  Scenario scenario;
  scenario.duration = VirtualDuration::Seconds(3600);
  scenario.drift_bound = VirtualNs(luck.Long(100 * kUs, 20 * kMs));
  scenario.seed = luck.Next();
  for (int robot = 0; robot < 3; ++robot) {
    RobotSpec& spec = scenario.robots.emplace_back();
    spec.name = fmt::format("robot{}", robot);
    // At times each thread has one for itself.
    spec.cores = luck.OnceIn(4) ? kThreads : static_cast<int>(luck.Between(1, 4));
    constexpr double kSpeeds[] = {1.0, 1.0, 0.5, 0.25, 1.5, 2.0};
    spec.speed = kSpeeds[luck.Between(0, 5)];
    spec.is_ideal = luck.OnceIn(8);
    if (scenario.seed % 8 == 0 && !spec.is_ideal) spec.wakeup = {kWakeupP99 / 4, kWakeupP99};
    if (luck.OnceIn(4)) spec.scheduler = SchedulerPolicy::kEarliestDeadlineFirst;
    for (std::int64_t clients = luck.Between(1, 2); clients > 0; --clients) {
      ClientSpec& client = spec.clients.emplace_back();
      client.name = fmt::format("{}/client{}", spec.name, spec.clients.size());
      client.priority = static_cast<int>(luck.Between(0, 2));
      if (luck.OnceIn(2)) client.deadline = VirtualNs(luck.Long(kMs, 50 * kMs));
    }
  }
  return scenario;
}

Simulation::Simulation(const SimulationSeeds& seeds, bool has_levels, bool is_fixed)
    : is_fixed_(is_fixed),
      script_(seeds.script),
      run_(ScenarioOf(script_), seeds.host, has_levels, is_fixed) {
  rules_.drift_bound_ns = run_.all().run.scenario.drift_bound.ns();
  rules_.has_kernel_waits = !is_fixed && seeds.script % 2 == 0;
  rules_.has_signals = HasSignals(seeds.script);
  rules_.has_timers = HasTimers(seeds.script);
  if (script_.OnceIn(4)) dies_at_ = static_cast<int>(script_.Between(0, 2'000));
  rules_.is_hostile = seeds.script % 5 == 0;
  AddPrograms(script_);
  // With levels nobody computes out of turn, unless the kernel holds whoever has it.
  if (has_levels && !rules_.has_kernel_waits) {
    run_.kernel().OnProgram([this](const SimThread& thread) {
      const Turn& turn = run_.all().run.turn;
      if (!turn.lasts() || turn.task()->tid != thread.tid)
        Broken("%d computes out of turn, at step %d", thread.tid, step_);
    });
  }
}

// Each client has a thread; the others are shared out.
void Simulation::AddPrograms(Luck& luck) {
  RunState& run = run_.all().run;
  std::vector<std::pair<Robot*, const ClientSpec*>> clients;
  for (Robot& robot : run.robots) {
    for (const ClientSpec& client : run.scenario.robots[robot.number - 1].clients)
      clients.emplace_back(&robot, &client);
  }
  std::vector<int> threads(clients.size(), 1);
  for (int left = kThreads - static_cast<int>(clients.size()); left > 0; --left)
    ++luck.OneOf(threads);
  for (std::size_t number = 0; number < clients.size(); ++number) {
    const auto [robot, client] = clients[number];
    run_.AddClient(*robot, *client);
    std::deque<SimLock>& locks = locks_.emplace_back();
    locks.resize(static_cast<std::size_t>(luck.Between(1, 3)));
    for (int thread = 0; thread < threads[number]; ++thread) AddThread(*robot, luck, locks);
  }
  std::vector<SimThread*> all;
  for (SimThread& thread : run_.kernel().threads()) all.push_back(&thread);
  for (SimProgram& program : programs_) program.Knows(all);
}

void Simulation::AddThread(const Robot& robot, Luck& luck, std::deque<SimLock>& locks) {
  ProgramRules rules = rules_;
  // Whoever the kernel holds comes back late by what it likes.
  rules.has_own_core = robot.cpus.size() >= kThreads && !rules.has_kernel_waits;
  rules.slack_ns =
      static_cast<std::int64_t>(static_cast<double>(rules.slack_ns) / std::min(1.0, robot.speed));
  // A handler may begin, and a sleep go on after it, each a wake-up later.
  if (!robot.wakeup.IsNone()) rules.slack_ns += 2 * WakeupLatency::kMostTimesP99 * kWakeupP99.ns();
  if (!is_fixed_) rules.call_ns = 420 * kUs;
  rules.is_hostile = rules_.is_hostile && &robot == &run_.all().run.robots.back();
  SimProgram& program = programs_.emplace_back(luck.Next(), rules, locks, file_);
  tasks_.push_back(
      &run_.AddThread([&program](const preload::GuestThread& guest) { program.Run(guest); }));
  run_.kernel().threads().back().program = &program;
}

int Simulation::Run(int steps) {
  for (step_ = 0; step_ < steps; ++step_) {
    if (step_ == dies_at_) run_.kernel().Kill(tasks_.front()->process->pid);
    if (!run_.all().loop.Step()) return step_;
    if (run_.kernel().traces()) TraceStep();
    Check();
  }
  CheckCharges();
  return steps;
}

void Simulation::Check() {
  const RunState& run = run_.all().run;
  if (!run.report.error.empty()) Broken("the run has failed: %s", run.report.error.c_str());
  for (const std::string& warning : run.report.warnings) {
    const bool is_right =
        (rules_.has_kernel_waits && warning.find("blocked in") != std::string::npos) ||
        (rules_.is_hostile && warning.find(run.robots.back().name) != std::string::npos);
    if (!is_right) Broken("a warning: %s", warning.c_str());
  }
  if (run.root.drift() > run.scenario.drift_bound)
    Broken("the leaves are %ld ns apart, of %ld", run.root.drift().ns(),
           run.scenario.drift_bound.ns());
}

// What programs are charged is what they have computed, whatever the host did meanwhile.
void Simulation::CheckCharges() {
  if (is_fixed_) return;
  constexpr std::int64_t kSlackNs = 400 * kUs;
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    const Robot& robot = *tasks_[i]->process->robot;
    const bool is_hostile = rules_.is_hostile && &robot == &run_.all().run.robots.back();
    if (robot.is_ideal || tasks_[i]->state == TaskState::kDead) continue;
    const auto computed_ns = static_cast<std::int64_t>(
        static_cast<double>(run_.kernel().threads()[i].program_ns) / robot.speed);
    const std::int64_t charged_ns = tasks_[i]->charged.ns();
    // Of each exchange with the coordinator a cheat may keep what an honest one can take, by the
    // host's clock.
    const std::int64_t kept_ns = 2 * kMs + run_.kernel().threads()[i].waits * shm::kMostExchangeNs;
    const std::int64_t slack_ns =
        computed_ns / 100 + kSlackNs +
        (is_hostile ? static_cast<std::int64_t>(static_cast<double>(kept_ns) / robot.speed) : 0);
    if (is_hostile && charged_ns > computed_ns) continue;
    if (std::abs(charged_ns - computed_ns) > slack_ns)
      Broken("thread %zu has computed for %ld ns, and was charged %ld", i, computed_ns, charged_ns);
  }
}

// Who was charged how much more in it, where that is not what was computed.
void Simulation::TraceStep() {
  std::string cpus;
  for (const VirtualCpu& cpu : run_.all().run.cpus) cpus += " " + std::to_string(cpu.progress.ns());
  fprintf(stderr, "step %d: cpus at%s\n", step_, cpus.c_str());
  charged_.resize(tasks_.size());
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    const SimThread& thread = run_.kernel().threads()[i];
    const std::int64_t off_ns = tasks_[i]->charged.ns() - thread.program_ns;
    if (std::abs(off_ns - charged_[i]) < 2'000) continue;
    fprintf(stderr, "step %d: thread %zu is charged %ld, %ld more than it has computed\n", step_, i,
            tasks_[i]->charged.ns(), off_ns);
    charged_[i] = off_ns;
  }
}

void Simulation::TraceThreads() const {
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    const SimThread& thread = run_.kernel().threads()[i];
    fprintf(stderr, "%s of %s: %zu acts, at %ld; computed %ld of %ld, charged %ld, debt %ld\n",
            std::to_string(tasks_[i]->tid).c_str(), tasks_[i]->process->name.c_str(),
            programs_[i].shown().size(), tasks_[i]->reached.ns(), thread.program_ns, thread.cpu_ns,
            tasks_[i]->charged.ns(), tasks_[i]->debt.ns());
  }
}

std::vector<std::vector<std::int64_t>> Simulation::Shown() const {
  std::vector<std::vector<std::int64_t>> shown;
  for (const SimProgram& program : programs_) {
    if (program.MustHold()) shown.push_back(program.shown());
  }
  return shown;
}

}  // namespace tcs::simulate
