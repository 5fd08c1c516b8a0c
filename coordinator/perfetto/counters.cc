#include "coordinator/perfetto/counters.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/text/csv.h"

namespace tcs::perfetto {
namespace {

// The most values of one quantity of a sensor: some megabytes of them are slow to look at, and show
// nothing more.
constexpr std::int64_t kMostValues = 20'000;

using Named = std::vector<std::pair<std::string_view, std::string_view>>;

// A value that is no number of JSON's is left out.
void Add(std::string_view name, std::string_view value, Named* values) {
  if (ToReal(value)) values->emplace_back(name, value);
}

// The columns hold seconds, of which nine decimals are whole nanoseconds.
std::optional<std::int64_t> ToNs(std::string_view seconds) {
  const auto time_s = ToReal(seconds);
  if (!time_s) return std::nullopt;
  return std::llround(*time_s * 1e9);
}

std::string Read(const std::string& path, const std::vector<std::string_view>& columns,
                 const std::function<bool(const CsvFields&)>& take) {
  if (!IsFile(path)) return {};
  const auto read = ReadCsv(path, columns, take);
  const auto* error = std::get_if<LoadError>(&read);
  return error == nullptr ? "" : error->message;
}

}  // namespace

std::string AddBodies(const std::string& folder, EventWriter* events) {
  const std::string path = folder + "/bodies.csv";
  if (!IsFile(path)) return {};
  const int group = events->AddGroup("bodies");
  return Read(
      path,
      {"time_s", "body", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw", "vx_mps", "vy_mps", "vz_mps"},
      [&](const CsvFields& fields) {
        const auto at_ns = ToNs(fields[0]);
        if (!at_ns) return false;
        const auto add = [&](const char* what, std::size_t first,
                             std::initializer_list<std::string_view> names) {
          Named values;
          for (const std::string_view name : names) Add(name, fields[first++], &values);
          events->Counter(group, std::string(fields[1]) + " " + what, *at_ns, values);
        };
        add("position (m)", 2, {"x", "y", "z"});
        add("orientation", 5, {"x", "y", "z", "w"});
        add("velocity (m per s)", 9, {"x", "y", "z"});
        return true;
      });
}

std::string AddJoints(const std::string& folder, EventWriter* events) {
  const std::string path = folder + "/joints.csv";
  if (!IsFile(path)) return {};
  const int group = events->AddGroup("joints");
  return Read(path, {"time_s", "joint", "position", "velocity", "effort"},
              [&](const CsvFields& fields) {
                const auto at_ns = ToNs(fields[0]);
                if (!at_ns) return false;
                Named values;
                Add("position", fields[2], &values);
                Add("velocity", fields[3], &values);
                Add("effort", fields[4], &values);
                events->Counter(group, fields[1], *at_ns, values);
                return true;
              });
}

std::string AddMeasurements(const std::string& folder, EventWriter* events) {
  const std::string path = folder + "/sensors.csv";
  if (!IsFile(path)) return {};
  const auto name_of = [](std::string_view channel, std::string_view of, std::string_view what) {
    std::string name(channel);
    if (!of.empty() && of != channel) name += " " + std::string(of);
    return name + " " + std::string(what);
  };
  std::map<std::string, std::int64_t> count, place;
  std::string error = Read(path, {"channel", "of", "quantity"}, [&](const CsvFields& fields) {
    ++count[name_of(fields[0], fields[1], fields[2])];
    return true;
  });
  if (!error.empty()) return error;
  const int group = events->AddGroup("sensors");
  return Read(path, {"time_ns", "channel", "of", "quantity", "x", "y", "z", "w"},
              [&](const CsvFields& fields) {
                const auto at_ns = ToInteger(fields[0]);
                if (!at_ns) return false;
                const std::string name = name_of(fields[1], fields[2], fields[3]);
                const std::int64_t every = (count[name] + kMostValues - 1) / kMostValues;
                if (place[name]++ % std::max<std::int64_t>(every, 1) != 0) return true;
                Named values;
                if (fields[5].empty()) {
                  Add("value", fields[4], &values);
                } else {
                  for (std::size_t i = 0; i < 4; ++i) {
                    constexpr std::string_view kAxes[] = {"x", "y", "z", "w"};
                    if (!fields[4 + i].empty()) Add(kAxes[i], fields[4 + i], &values);
                  }
                }
                events->Counter(group, name, *at_ns, values);
                return true;
              });
}

// A line holds one quantity of a command.
std::string AddCommands(const std::string& folder, EventWriter* events) {
  const std::string path = folder + "/commands.csv";
  if (!IsFile(path)) return {};
  const int group = events->AddGroup("commands");
  return Read(path, {"acts_ns", "channel", "target", "quantity", "value"},
              [&](const CsvFields& fields) {
                const auto at_ns = ToInteger(fields[0]);
                if (!at_ns) return false;
                Named values;
                Add(fields[3], fields[4], &values);
                events->Counter(group, std::string(fields[2]) + " by " + std::string(fields[1]),
                                *at_ns, values);
                return true;
              });
}

}  // namespace tcs::perfetto
