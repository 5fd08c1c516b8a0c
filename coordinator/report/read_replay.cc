#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "coordinator/report/read_said.h"
#include "coordinator/report/replay.h"
#include "coordinator/report/replay_reader.h"
#include "coordinator/report/replay_scene.h"
#include "coordinator/report/text.h"
#include "coordinator/text/csv.h"

namespace tcs::report {

const std::vector<std::string_view> kStateColumns{
    "time_s", "body", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw", "vx_mps", "vy_mps", "vz_mps"};
const std::vector<std::string_view> kJointColumns{"time_s", "joint", "position", "velocity",
                                                  "effort"};
const std::vector<std::string_view> kContactColumns{
    "time_s", "first", "second", "x_m", "y_m", "z_m", "force_x_n", "force_y_n", "force_z_n"};
const std::vector<std::string_view> kCommandColumns{"acts_ns", "target", "quantity", "value"};

namespace {

// The most moments per second: as many as a screen shows. The deltas of a pose and of a number take
// no more bytes than this.
constexpr double kMostPerSecond = 50;
constexpr double kBytesOfPose = 12, kBytesOfNumber = 3;
// Contacts are bounded beside all that: a contact takes some 16 bytes, and all contacts a third of
// the room.
constexpr std::size_t kRoomPerContact = 50;

void Warn(const std::string& path, std::int64_t lines, std::vector<std::string>* warnings) {
  if (lines == 0) return;
  warnings->push_back(
      fmt::format("{} has {} that cannot be used; left out", path, Count(lines, "line")));
}

}  // namespace

double IntervalOf(const ReplayScene& scene, double end_s, std::size_t most_bytes) {
  double numbers = 0;
  for (const ReplayScene::Robot& robot : scene.robots) {
    numbers += 9.0 + 6.0 * static_cast<double>(robot.joint_units.size());
  }
  const double bytes =
      kBytesOfPose * static_cast<double>(scene.tracks.size()) + kBytesOfNumber * numbers;
  return std::max(1 / kMostPerSecond, end_s * bytes / static_cast<double>(most_bytes));
}

bool PoseTrack::IsStill() const {
  return std::all_of(poses.begin(), poses.end(),
                     [&](const PoseRow& pose) { return pose == poses.front(); });
}

LoadResult<Replay> ReadReplay(const std::string& folder, const std::string& name, double end_s,
                              std::size_t most_bytes, std::vector<std::string>* warnings) {
  Replay replay;
  replay.name = name;
  replay.end_s = end_s;
  replay.contacts = ContactTrack(most_bytes / kRoomPerContact);
  ReadSaid(folder, &replay);
  auto scene = ReadReplayScene(folder, MeshLooks::kRead);
  if (const auto* error = std::get_if<LoadError>(&scene)) return *error;
  auto& found = std::get<ReplayScene>(scene);
  const double interval_s = IntervalOf(found, end_s, most_bytes);
  ReplayReader reader(std::move(found), &replay, interval_s);
  struct File {
    const char* name;
    std::vector<std::string_view> columns;
    bool (ReplayReader::*take)(const CsvFields&);
  };
  // The moments are those of the first file.
  const File files[] = {{"/bodies.csv", kStateColumns, &ReplayReader::TakeState},
                        {"/joints.csv", kJointColumns, &ReplayReader::TakeJoint},
                        {"/contacts.csv", kContactColumns, &ReplayReader::TakeContact},
                        {"/commands.csv", kCommandColumns, &ReplayReader::TakeCommand}};
  for (const File& file : files) {
    const std::string path = folder + file.name;
    if (!IsFile(path)) continue;
    const auto read = ReadCsv(path, file.columns,
                              [&](const CsvFields& fields) { return (reader.*file.take)(fields); });
    if (const auto* error = std::get_if<LoadError>(&read)) return *error;
    Warn(path, std::get<std::int64_t>(read), warnings);
  }
  reader.Finish();
  return replay;
}

}  // namespace tcs::report
