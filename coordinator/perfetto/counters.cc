#include "coordinator/perfetto/counters.h"

#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/report/csv.h"

namespace tcs::perfetto {
namespace {

using report::CsvFields;
using report::ReadCsv;
using report::ToInteger;
using report::ToReal;

using Named = std::vector<std::pair<std::string_view, std::string_view>>;

// What is no number of JSON's is left out.
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
  if (!report::IsFile(path)) return {};
  const auto read = ReadCsv(path, columns, take);
  const auto* error = std::get_if<LoadError>(&read);
  return error == nullptr ? "" : error->message;
}

}  // namespace

std::string AddBodies(const std::string& folder, EventWriter* events) {
  const std::string path = folder + "/bodies.csv";
  if (!report::IsFile(path)) return {};
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
  if (!report::IsFile(path)) return {};
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

// A line holds one quantity of a command.
std::string AddCommands(const std::string& folder, EventWriter* events) {
  const std::string path = folder + "/commands.csv";
  if (!report::IsFile(path)) return {};
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
