// Makes a replay of the lines of a run's tables, one after the other: the lines of bodies.csv say
// which moments there are, the lines of joints.csv, contacts.csv and commands.csv are put to these
// moments.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "coordinator/report/replay.h"
#include "coordinator/report/replay_scene.h"
#include "coordinator/text/csv.h"

namespace tcs::report {

// The columns that the reader wants of each table.
extern const std::vector<std::string_view> kStateColumns, kJointColumns, kContactColumns,
    kCommandColumns;

class ReplayReader {
 public:
  // `replay` is filled, and outlives this. Of moments that are closer than `interval_s` the first
  // is kept.
  ReplayReader(ReplayScene scene, Replay* replay, double interval_s);

  // Fields under the columns above. False: the line is of no use.
  [[nodiscard]] bool TakeState(const CsvFields& fields);
  [[nodiscard]] bool TakeJoint(const CsvFields& fields);
  [[nodiscard]] bool TakeContact(const CsvFields& fields);
  // The command holds until the next one of its kind.
  [[nodiscard]] bool TakeCommand(const CsvFields& fields);

  // Once all lines are taken: every moment has a pose of every track, and each signal a value from
  // its first one on. Before that a signal's values begin with the first moment, and are not a
  // number where nothing was said.
  void Finish();

  // For a run that goes on.
  void FindAllPaths();
  // Leaves every second moment out, also of those to come.
  void Thin();

 private:
  std::size_t AddTrack(const std::string& name);
  bool NoteTime(double time_s);
  std::optional<std::size_t> MomentOf(double time_s) const;
  void TakePose(std::size_t number, const std::array<double, 10>& n);
  std::string UnitOf(const std::string& joint) const;
  Signal* SignalOf(const std::string& target, std::string_view panel, std::string_view unit,
                   const std::string& name);
  Signal* SignalAt(std::size_t robot, const std::string& panel, const std::string& name);
  void Hold(Signal* signal) const;
  void FindPaths(std::size_t number);

  ReplayScene scene_;
  Replay& replay_;
  double interval_s_;
  bool has_scene_ = false;
  std::unordered_map<std::string, std::size_t> track_of_, signal_of_;
};

}  // namespace tcs::report
