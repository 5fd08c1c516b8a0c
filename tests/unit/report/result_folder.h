// Makes result folders as tcsim leaves them, with a few values in them.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace tcs::report {

// Enough for any replay here.
inline constexpr std::size_t kRoom = 10'000'000;

class ResultFolderTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(root_); }
  void TearDown() override { std::filesystem::remove_all(root_); }

  static nlohmann::json Summary() {
    return {{"scenario", "chase"},
            {"seed", 1},
            {"accounting", "measured"},
            {"sync", "consistent"},
            {"interrupted", false},
            {"virtual_ns", 2'000'000'000},
            {"real_ns", 4'000'000'000},
            {"drift_ns", 1'000'000},
            {"drift_bound_ns", 1'000'000},
            {"staleness_ns", 0},
            {"clients_ns", 3'000'000'000},
            {"dynamics_ns", 800'000'000},
            {"coordinating_ns", 100'000'000},
            {"overhead_percent", 2.5},
            {"verdict", nlohmann::json::array()},
            {"clients", {{"r/planner", Client("best-effort")}, {"r/controller", WithDeadline()}}}};
  }
  // Of a controller that keeps a period of 5 us but once.
  static nlohmann::json WithDeadline() {
    nlohmann::json client = Client("periodic");
    client["counted_after_ns"] = 10;
    client["response_ns"] = {{"count", 2}, {"p50", 4000}, {"p99", 9000}, {"max", 9000}};
    client["deadline"] = {{"deadline_ns", 5000},
                          {"period_of", "imu"},
                          {"judged", 2},
                          {"missed", 1},
                          {"most_in_a_row", 1}};
    return client;
  }
  static nlohmann::json Client(const char* of_class) {
    return {{"robot", "r"},     {"class", of_class}, {"charged_ns", 1'000'000'000},
            {"host_cpu_ns", 1}, {"stolen_ns", 5},    {"activations", 2},
            {"overruns", 1},    {"ended_at_ns", -1}, {"wait_status", 0}};
  }

  // Two bodies that keep `distance_m` for `samples`.
  static std::string Bodies(double distance_m, int samples) {
    std::string text =
        "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps\n";
    for (int i = 0; i < samples; ++i) {
      text += fmt::format("{0:.2f},a,0,0,0,{2}\n{0:.2f},b,0,{1},0,{2}\n{0:.2f},c,1,0,0,{2}\n",
                          i * 0.01, distance_m, "0,0,0,1,0,0,0,0,0,0");
    }
    return text;
  }

  void Write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = root_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  void WriteRun(const std::string& folder, double distance_m = 5, int samples = 3) {
    Write(folder + "/summary.json", Summary().dump());
    Write(folder + "/bodies.csv", Bodies(distance_m, samples));
    Write(folder + "/activations.csv",
          "client,thread,cause,release_ns,start_ns,end_ns,charged_ns\n"
          "r/planner,0,start,0,0,10,10\n"
          "r/planner,0,input,1000,2000,501000,400000\n"
          "r/planner,0,thread,600000,600000,1001000,300000\n"
          "r/planner,3,input,0,0,9,9\n"
          "r/controller,0,time,0,7000,8000,1000\n");
    Write(folder + "/responses.csv",
          "client,thread,cause,release_ns,start_ns,end_ns,deadline_ns,queued_ns,away_ns,wakeup_ns,"
          "executed_ns,cores_ns,locks_ns,room_ns,rest_ns,whose\n"
          "r/controller,0,start,0,0,10,5000,0,0,0,10,0,0,0,0,\n"
          "r/controller,0,time,1000,1000,5000,5000,0,0,0,4000,0,0,0,0,\n"
          "r/controller,0,time,6000,12000,15000,5000,0,0,0,3000,6000,0,0,0,core:r/planner=6000\n");
    Write(folder + "/dispatches.csv",
          "row,virtual_start_ns,virtual_end_ns,real_start_ns,real_end_ns\n"
          "r/planner,0,1000000,0,1000000\ndynamics,0,1000000,1000000,1100000\n"
          "r/controller,1000000,1000000,1100000,1100000\n");
  }
  std::string Path(const std::string& name) const { return (root_ / name).string(); }

  const std::filesystem::path root_ =
      ::testing::TempDir() + std::string("report_") +
      ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

}  // namespace tcs::report
