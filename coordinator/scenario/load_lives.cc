#include "coordinator/scenario/load_lives.h"

#include <signal.h>
#include <string.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "coordinator/errors/nearest.h"

namespace tcs {
namespace {

namespace fs = std::filesystem;

constexpr int kLastNamedSignal = 31;

// True for signals that stop or continue a program: none of these ends a program by itself.
bool OnlyStopsOrContinues(int signal) {
  return signal == SIGSTOP || signal == SIGTSTP || signal == SIGTTIN || signal == SIGTTOU ||
         signal == SIGCONT;
}

// The number of the signal with that name, with or without SIG.
int LoadSignal(const YamlValue& value) {
  const std::string text = value.AsText();
  std::vector<std::string> known;
  for (int number = 1; number <= kLastNamedSignal; ++number) {
    const std::string name = sigabbrev_np(number);
    if (text == name || text == "SIG" + name) {
      if (OnlyStopsOrContinues(number)) {
        value.Fail("is " + text + ", which ends no program; use SIGTERM, SIGINT or SIGKILL");
      }
      return number;
    }
    if (!OnlyStopsOrContinues(number)) known.push_back("SIG" + name);
  }
  value.Fail("is the unknown '" + text + "'; " + Suggest(text, known, "signals"));
}

// Absolute, without "." and "..", and without a slash at its end.
fs::path FolderNamed(const YamlValue& value, const Variables& variables) {
  const std::string text = Substitute(value, variables);
  if (text.empty()) value.Fail("is empty; name a folder or leave the key out");
  fs::path path = (fs::path(variables.scenario_directory) / text).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

fs::path ExistingFolder(const YamlValue& value, const Variables& variables) {
  fs::path path = FolderNamed(value, variables);
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    value.Fail("is '" + path.string() +
               "', and there is no such folder; make it, or name one that "
               "exists");
  }
  return path;
}

bool IsInside(const fs::path& path, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return !folder.empty() && end == folder.end();
}

// A folder of the client's own in the run's results.
void LoadOwnFolder(const YamlValue& value, const Variables& variables, ClientSpec* client) {
  const YamlMap map = value.AsMap();
  map.AllowOnly({"fresh", "copy_of"});
  const YamlValue* fresh = map.Find("fresh");
  const YamlValue* copy_of = map.Find("copy_of");
  if (copy_of == nullptr && (fresh == nullptr || !fresh->AsBoolean())) {
    value.Fail(
        "has neither fresh: true nor copy_of: FOLDER; write one of them, or a folder's name");
  }
  if (fresh != nullptr && !fresh->AsBoolean())
    fresh->Fail("is false, but a copy is always fresh; remove it");
  client->folder = ClientFolder::kFresh;
  client->working_directory = variables.result_directory + "/" + FileNameOf(*client);
  if (copy_of == nullptr) return;
  const fs::path from = ExistingFolder(*copy_of, variables);
  std::error_code error;
  const fs::path result = fs::weakly_canonical(variables.result_directory, error);
  if (!error && IsInside(result, fs::canonical(from, error))) {
    copy_of->Fail("is '" + from.string() + "', which holds the results (" +
                  variables.result_directory +
                  ") themselves; name a folder beside them, or choose another one for them with "
                  "--out");
  }
  client->copied_folder = from;
}

void LoadWorkingDirectory(const YamlValue& value, const Variables& variables, ClientSpec* client) {
  if (value.IsMap()) return LoadOwnFolder(value, variables, client);
  const fs::path path = FolderNamed(value, variables);
  if (IsInside(path, fs::path(variables.result_directory).lexically_normal())) {
    client->folder = ClientFolder::kMade;
    client->working_directory = path;
  } else {
    client->working_directory = ExistingFolder(value, variables);
  }
}

// The client that `value` names: ROBOT/CLIENT, or the client's own name where only one client can
// be meant; clients of the same robot come before others.
std::string FindClient(const YamlValue& value, const std::string& robot, const Scenario& scenario) {
  const std::string text = value.AsText();
  std::vector<std::string> known, meant;
  for (const RobotSpec& other : scenario.robots) {
    for (const ClientSpec& client : other.clients) {
      known.push_back(client.name);
      if (client.name == text || client.name == robot + "/" + text) return client.name;
      if (client.name == other.name + "/" + text) meant.push_back(client.name);
    }
  }
  if (meant.size() == 1) return meant[0];
  if (meant.size() > 1) {
    value.Fail("is '" + text + "', which can mean " + meant[0] + " or " + meant[1] +
               "; write ROBOT/CLIENT");
  }
  // A slip of the fingers may also be in the client's name alone.
  std::vector<std::string> own;
  for (const std::string& name : known) {
    if (name.rfind(robot + "/", 0) == 0) own.push_back(name.substr(robot.size() + 1));
  }
  const auto nearest = Nearest(text, own);
  value.Fail("is the unknown client '" + text + "'; " +
             (nearest ? "did you mean '" + *nearest + "'?" : Suggest(text, known, "clients")));
}

// "a/x after b/y after a/x": the way back to `first`; empty if there is none.
std::string WayBack(const std::string& first, const std::map<std::string, std::string>& after) {
  std::string way = first;
  auto next = after.find(first);
  for (std::size_t steps = 0; next != after.end() && steps <= after.size(); ++steps) {
    way += " after " + next->second;
    if (next->second == first) return way;
    next = after.find(next->second);
  }
  return {};
}

}  // namespace

void LoadLife(const YamlMap& map, const Variables& variables, ClientSpec* client) {
  if (const YamlValue* v = map.Find("start")) client->start = v->AsDuration();
  if (const YamlValue* v = map.Find("stop_signal")) client->stop_signal = LoadSignal(*v);
  if (const YamlValue* v = map.Find("stop_grace")) client->stop_grace = v->AsDuration();
  if (const YamlValue* v = map.Find("working_directory")) {
    LoadWorkingDirectory(*v, variables, client);
  }
}

void LoadOrder(const YamlMap& robots, Scenario* scenario) {
  std::map<std::string, std::string> after;
  std::vector<YamlValue> places;
  std::size_t r = 0;
  for (const YamlMap::Entry& robot : robots.entries()) {
    const YamlMap robot_map = robot.value.AsMap();
    const YamlMap clients = robot_map.Require("clients", "").AsMap();
    std::size_t c = 0;
    for (const YamlMap::Entry& entry : clients.entries()) {
      const YamlMap map = entry.value.AsMap();
      ClientSpec& client = scenario->robots[r].clients[c++];
      if (const YamlValue* v = map.Find("start"); v && client.start >= scenario->duration) {
        scenario->warnings.push_back(v->place().Prefix() + v->name() + " is " + v->AsText() +
                                     ", when the run is over: the client is never started");
      }
      if (const YamlValue* v = map.Find("after")) {
        after[client.name] = client.after = FindClient(*v, robot.key, *scenario);
        if (const std::string way = WayBack(client.name, after); !way.empty()) {
          v->Fail("makes a cycle, so none of them would start: " + way +
                  "; let one of them start without another");
        }
      }
    }
    ++r;
  }
}

}  // namespace tcs
