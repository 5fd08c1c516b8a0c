#include "coordinator/snapshot/recorded_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <variant>

#include "coordinator/text/csv.h"

namespace tcs::snapshot {
namespace {

using Lines = std::map<std::string, std::vector<std::string>>;

// The lines of a table that belong to one moment.
struct Moment {
  std::int64_t at_ns = -1;
  Lines lines;
  std::optional<std::int64_t> before_ns, after_ns;  // the moments next to a time that is not there
};

// A table's first two columns are the time in seconds and a name. Of the last moment those lines
// are taken that `whole` says are all, else of the one before.
LoadResult<Moment> ReadMoment(const std::string& path, const std::vector<std::string_view>& columns,
                              std::optional<std::int64_t> at_ns) {
  Moment now, before;
  const auto read = ReadCsv(path, columns, [&](const CsvFields& fields) {
    const auto time_s = ToReal(fields[0]);
    if (!time_s) return false;
    const std::int64_t time_ns = std::llround(*time_s * 1e9);
    if (at_ns && time_ns != *at_ns) {
      if (time_ns < *at_ns) now.before_ns = time_ns;
      if (time_ns > *at_ns && !now.after_ns) now.after_ns = time_ns;
      return true;
    }
    for (std::size_t i = 2; i < fields.size(); ++i) {
      if (!ToReal(fields[i])) return false;
    }
    if (time_ns != now.at_ns) {
      before = std::exchange(now, {.before_ns = now.before_ns, .after_ns = now.after_ns});
      now.at_ns = time_ns;
    }
    now.lines[std::string(fields[1])] = {fields.begin() + 2, fields.end()};
    return true;
  });
  if (const auto* error = std::get_if<LoadError>(&read)) return *error;
  // A run that was killed may have left a part of its last moment.
  const bool is_whole = before.at_ns < 0 || now.lines.size() >= before.lines.size();
  return is_whole ? now : before;
}

std::string NextTo(const Moment& moment) {
  std::string text;
  if (moment.before_ns) text = SecondsText(*moment.before_ns);
  if (moment.after_ns) text += (text.empty() ? "" : " and ") + SecondsText(*moment.after_ns);
  return text.empty() ? "it has none" : "next to it are " + text;
}

}  // namespace

LoadResult<RecordedState> ReadState(const std::string& folder, std::optional<std::int64_t> at_ns) {
  const std::string bodies_csv = folder + "/bodies.csv", joints_csv = folder + "/joints.csv";
  if (!IsFile(bodies_csv)) {
    return LoadError{bodies_csv + " does not exist; give the folder of a run that had a world"};
  }
  const auto bodies_at = [&bodies_csv](std::optional<std::int64_t> ns) {
    return ReadMoment(bodies_csv,
                      {"time_s", "body", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw", "vx_mps",
                       "vy_mps", "vz_mps", "wx_radps", "wy_radps", "wz_radps"},
                      ns);
  };
  const auto joints_at = [&joints_csv](std::optional<std::int64_t> ns) {
    return ReadMoment(joints_csv, {"time_s", "joint", "position", "velocity"}, ns);
  };
  auto bodies = bodies_at(at_ns);
  if (const auto* error = std::get_if<LoadError>(&bodies)) return *error;
  LoadResult<Moment> joints = Moment{};
  if (IsFile(joints_csv)) {
    joints = joints_at(at_ns);
    if (const auto* error = std::get_if<LoadError>(&joints)) return *error;
    // A run that was killed may have written more of the one than of the other.
    const std::int64_t both_ns =
        std::min(std::get<Moment>(bodies).at_ns, std::get<Moment>(joints).at_ns);
    if (!at_ns && both_ns >= 0) {
      bodies = bodies_at(both_ns);
      joints = joints_at(both_ns);
    }
  }
  Moment& at = std::get<Moment>(bodies);
  if (at.at_ns < 0) {
    return LoadError{
        fmt::format("{} has no line of {}: {}; a smaller csv_period of the scenario writes more",
                    bodies_csv, at_ns ? SecondsText(*at_ns) : "any time", NextTo(at))};
  }
  return RecordedState{at.at_ns, std::move(at.lines), std::move(std::get<Moment>(joints).lines)};
}

}  // namespace tcs::snapshot
