// Stock OMPL: `planners WHICH SECONDS` plans for so long on a problem without a solution (or, for
// those that improve one, with), and prints how long that took by the clock and what was found. It
// is as ordinary as such programs are: it knows nothing of tcs.
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/control/SimpleSetup.h>
#include <ompl/control/planners/sst/SST.h>
#include <ompl/control/spaces/RealVectorControlSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/AnytimePathShortening.h>
#include <ompl/geometric/planners/cforest/CForest.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/tools/benchmark/Benchmark.h>
#include <ompl/tools/multiplan/ParallelPlan.h>
#include <ompl/util/RandomNumbers.h>
#include <time.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace ob = ompl::base;
namespace oc = ompl::control;
namespace og = ompl::geometric;

namespace {

constexpr int kDimensions = 4;

// Of all threads; they count by themselves and add up seldom, for a counter that they share would
// be what they wait for.
std::atomic<long> g_checks{0};
thread_local long t_checks = 0;

void CountCheck() {
  if (++t_checks % 64 == 0) g_checks += 64;
}

double* Values(ob::State* state) {
  return state->as<ob::RealVectorStateSpace::StateType>()->values;
}
const double* Values(const ob::State* state) {
  return state->as<ob::RealVectorStateSpace::StateType>()->values;
}

double Now() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A unit cube with a wall across. With `gap` there is a way past it.
og::SimpleSetup Cube(bool gap) {
  auto space = std::make_shared<ob::RealVectorStateSpace>(kDimensions);
  space->setBounds(0, 1);
  og::SimpleSetup setup(space);
  setup.setStateValidityChecker([gap](const ob::State* state) {
    CountCheck();
    const double* x = Values(state);
    return x[0] < 0.5 || x[0] > 0.6 || (gap && x[1] > 0.9);
  });
  ob::ScopedState<> start(space), goal(space);
  for (unsigned i = 0; i < kDimensions; ++i) {
    start[i] = 0.1;
    goal[i] = 0.9;
  }
  goal[1] = 0.1;
  setup.setStartAndGoalStates(start, goal);
  setup.setOptimizationObjective(
      std::make_shared<ob::PathLengthOptimizationObjective>(setup.getSpaceInformation()));
  return setup;
}

void Print(const std::string& which, double took, const ob::ProblemDefinition& problem) {
  const ob::PathPtr path = problem.getSolutionPath();
  const double cost = path && !problem.hasApproximateSolution() ? path->length() : 0;
  std::printf("%s took %.9f s, %ld checks, cost %.17g\n", which.c_str(), took, g_checks.load(),
              cost);
}

void Solve(const std::string& which, double seconds, bool gap,
           const std::function<ob::PlannerPtr(const ob::SpaceInformationPtr&)>& make) {
  og::SimpleSetup setup = Cube(gap);
  setup.setPlanner(make(setup.getSpaceInformation()));
  setup.setup();
  const double start = Now();
  setup.getPlanner()->solve(seconds);
  const double took = Now() - start;
  ob::PlannerData data(setup.getSpaceInformation());
  setup.getPlanner()->getPlannerData(data);
  std::printf("%u states; ", data.numVertices());
  Print(which, took, *setup.getProblemDefinition());
}

template <class Planner>
ob::PlannerPtr Make(const ob::SpaceInformationPtr& space) {
  return std::make_shared<Planner>(space);
}

// Four planners that grow at a steady rate however much they know already.
void SolveInParallel(double seconds) {
  og::SimpleSetup setup = Cube(false);
  setup.setup();
  ompl::tools::ParallelPlan parallel(setup.getProblemDefinition());
  for (int i = 0; i < 4; ++i) {
    auto planner = std::make_shared<og::KPIECE1>(setup.getSpaceInformation());
    planner->setProjectionEvaluator(setup.getStateSpace()->getDefaultProjection());
    parallel.addPlanner(planner);
  }
  const double start = Now();
  parallel.solve(seconds, false);
  Print("parallel", Now() - start, *setup.getProblemDefinition());
}

void SolveWithControls(double seconds) {
  auto space = std::make_shared<ob::RealVectorStateSpace>(kDimensions);
  space->setBounds(-1, 1);
  auto controls = std::make_shared<oc::RealVectorControlSpace>(space, kDimensions / 2);
  ob::RealVectorBounds bounds(kDimensions / 2);
  bounds.setLow(-1);
  bounds.setHigh(1);
  controls->setBounds(bounds);
  oc::SimpleSetup setup(controls);
  const oc::SpaceInformationPtr& information = setup.getSpaceInformation();
  setup.setStateValidityChecker([&information](const ob::State* state) {
    CountCheck();
    return information->satisfiesBounds(state);
  });
  setup.setStatePropagator(
      [](const ob::State* from, const oc::Control* control, double duration, ob::State* to) {
        const double* u = control->as<oc::RealVectorControlSpace::ControlType>()->values;
        for (int i = 0; i < kDimensions / 2; ++i) {
          const int speed = i + kDimensions / 2;
          Values(to)[i] = Values(from)[i] + duration * Values(from)[speed];
          Values(to)[speed] = Values(from)[speed] + duration * u[i];
        }
      });
  ob::ScopedState<> start(space), goal(space);
  for (unsigned i = 0; i < kDimensions; ++i) {
    start[i] = 0;
    goal[i] = 0.8;
  }
  setup.setStartAndGoalStates(start, goal, 0.05);
  information->setPropagationStepSize(0.05);
  information->setMinMaxControlDuration(1, 10);
  setup.setPlanner(std::make_shared<oc::SST>(information));
  setup.setup();
  const double begun = Now();
  setup.getPlanner()->solve(seconds);
  Print("sst", Now() - begun, *setup.getProblemDefinition());
}

void RunBenchmark(double seconds) {
  og::SimpleSetup setup = Cube(false);
  ompl::tools::Benchmark benchmark(setup, "cube");
  benchmark.addPlanner(Make<og::RRTConnect>(setup.getSpaceInformation()));
  benchmark.addPlanner(Make<og::KPIECE1>(setup.getSpaceInformation()));
  ompl::tools::Benchmark::Request request(seconds, 4096, 2);
  request.displayProgress = false;
  benchmark.benchmark(request);
  for (const auto& planner : benchmark.getRecordedExperimentData().planners) {
    for (std::map<std::string, std::string> run : planner.runs) {
      std::printf("%s: %s s, %s states\n", planner.name.c_str(), run["time REAL"].c_str(),
                  run["graph states INTEGER"].c_str());
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: planners WHICH SECONDS\n");
    return 2;
  }
  const std::string which = argv[1];
  const double seconds = std::atof(argv[2]);
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  ompl::RNG::setSeed(1);
  if (which == "rrtconnect") Solve(which, seconds, false, Make<og::RRTConnect>);
  if (which == "rrtstar") Solve(which, seconds, true, Make<og::RRTstar>);
  if (which == "prmstar") Solve(which, seconds, true, Make<og::PRMstar>);
  if (which == "cforest") Solve(which, seconds, true, Make<og::CForest>);
  if (which == "anytime") Solve(which, seconds, true, Make<og::AnytimePathShortening>);
  if (which == "parallel") SolveInParallel(seconds);
  if (which == "sst") SolveWithControls(seconds);
  if (which == "benchmark") RunBenchmark(seconds);
}
