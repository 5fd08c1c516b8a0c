#include "coordinator/trials/slurm_folder.h"

#include <errno.h>
#include <fmt/format.h>
#include <string.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "coordinator/os/files.h"
#include "coordinator/trials/outcome.h"

namespace tcs {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kRetired = ".over";

// The names are read through the folder itself: network file systems ask for its entries anew each
// time it is opened, while they may remember for long that a single file was not there.
std::vector<std::string> NamesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator{};
       entry.increment(error)) {
    names.push_back(entry->path().filename());
  }
  return names;
}

template <typename Number>
std::optional<Number> ToNumber(const std::string& text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  if (read.ec != std::errc{} || read.ptr != end) return {};
  return number;
}

}  // namespace

std::string ToJson(const SlurmWork& work) {
  Json trials = Json::array();
  for (const SlurmTrial& trial : work.trials) {
    trials.push_back({{"seed", trial.seed},
                      {"folder", trial.folder},
                      {"shown_folder", trial.shown_folder},
                      {"arguments", trial.arguments}});
  }
  Json environment = Json::array();
  for (const SlurmVariable& variable : work.environment) {
    environment.push_back({variable.name});
    if (variable.value.has_value()) environment.back().push_back(*variable.value);
  }
  const Json json{{"version", work.version},    {"directory", work.directory},
                  {"results", work.results},    {"in_host_network", work.in_host_network},
                  {"environment", environment}, {"trials", trials}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<SlurmWork> SlurmWorkFromJson(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    SlurmWork work;
    json.at("version").get_to(work.version);
    json.at("directory").get_to(work.directory);
    json.at("results").get_to(work.results);
    json.at("in_host_network").get_to(work.in_host_network);
    for (const Json& variable : json.at("environment")) {
      SlurmVariable& read = work.environment.emplace_back();
      variable.at(0).get_to(read.name);
      if (variable.size() > 1) read.value = variable.at(1).get<std::string>();
    }
    for (const Json& trial : json.at("trials")) {
      SlurmTrial& read = work.trials.emplace_back();
      trial.at("seed").get_to(read.seed);
      trial.at("folder").get_to(read.folder);
      trial.at("shown_folder").get_to(read.shown_folder);
      trial.at("arguments").get_to(read.arguments);
    }
    return work;
  } catch (const Json::exception&) {
    return {};
  }
}

std::string SlurmWorkFolder::Make(const SlurmWork& work) const {
  for (const char* part : {"claims", "progress", "runs", "errors"}) {
    if (std::string error = MakeFolder(path_ + "/" + part); !error.empty()) return error;
  }
  return WriteWhole(path_ + "/work.json", ToJson(work));
}

std::optional<SlurmWork> SlurmWorkFolder::Read() const {
  return SlurmWorkFromJson(ReadText(path_ + "/work.json"));
}

bool SlurmWorkFolder::TryToClaim(std::size_t trial, const Claim& claim) const {
  const std::string who = claim.job + "@" + claim.node;
  return symlink(who.c_str(), fmt::format("{}/claims/{}", path_, trial).c_str()) == 0;
}

void SlurmWorkFolder::Release(std::size_t trial) const {
  unlink(fmt::format("{}/claims/{}", path_, trial).c_str());
}

std::map<std::size_t, Claim> SlurmWorkFolder::Claims() const {
  std::map<std::size_t, Claim> claims;
  for (const std::string& name : NamesIn(path_ + "/claims")) {
    const auto trial = ToNumber<std::size_t>(name);
    std::error_code error;
    const std::string who = fs::read_symlink(path_ + "/claims/" + name, error);
    const std::size_t at = who.find('@');
    if (trial.has_value() && !error && at != std::string::npos) {
      claims[*trial] = {who.substr(0, at), who.substr(at + 1)};
    }
  }
  return claims;
}

std::vector<bool> SlurmWorkFolder::Claimed(std::size_t count) const {
  std::vector<bool> claimed(count, false);
  for (const std::string& name : NamesIn(path_ + "/claims")) {
    const auto trial = ToNumber<std::size_t>(name);
    if (trial.has_value() && *trial < count) claimed[*trial] = true;
  }
  return claimed;
}

void SlurmWorkFolder::SetProgress(std::size_t trial, std::int64_t virtual_ns) const {
  // Progress is for people who watch: nothing depends on it.
  static_cast<void>(WriteWhole(fmt::format("{}/progress/{}", path_, trial),
                               std::to_string(virtual_ns), Withstands::kCrash));
}

std::int64_t SlurmWorkFolder::Progress(std::size_t trial) const {
  return ToNumber<std::int64_t>(ReadText(fmt::format("{}/progress/{}", path_, trial))).value_or(0);
}

std::string SlurmWorkFolder::RunFolder(std::size_t trial, const std::string& job) const {
  return fmt::format("{}/runs/{}.{}", path_, trial, job);
}

void SlurmWorkFolder::SetError(const std::string& job, const std::string& sentence) const {
  static_cast<void>(WriteWhole(path_ + "/errors/" + job, sentence, Withstands::kCrash));
}

std::string SlurmWorkFolder::Error(const std::string& job) const {
  const std::vector<std::string> names = NamesIn(path_ + "/errors");
  const bool is_there = std::find(names.begin(), names.end(), job) != names.end();
  return is_there ? ReadText(path_ + "/errors/" + job) : "";
}

std::string PublishRun(const std::string& run, const std::string& result) {
  std::error_code error;
  fs::create_directories(fs::path(result).parent_path(), error);
  if (std::rename(run.c_str(), result.c_str()) == 0) return {};
  const int why = errno;
  if (why == ENOTEMPTY || why == EEXIST) {
    fs::remove_all(run, error);
    return {};
  }
  return fmt::format("{} cannot be renamed to {}: {}", run, result, strerror(why));
}

std::string NewWorkName() {
  std::uint64_t number = 0;
  while (getrandom(&number, sizeof number, 0) != sizeof number) {
  }
  return fmt::format("tcs-{:016x}", number);
}

std::string WorkFolderIn(const std::string& results, const std::string& name) {
  return results + "/slurm/" + name;
}

std::vector<std::string> RetireWorkFolders(const std::string& results) {
  std::vector<std::string> retired;
  const std::string all = results + "/slurm", over = kRetired;
  std::error_code error;
  for (const std::string& name : NamesIn(all)) {
    const bool is_over = name.size() > over.size() &&
                         name.compare(name.size() - over.size(), over.size(), over) == 0;
    std::string path = all + "/" + name;
    if (!is_over && std::rename(path.c_str(), (path + over).c_str()) == 0) {
      retired.push_back(name);
      path += over;
    }
    // A run that has not ended yet may still write into the folder: then the folder is removed next
    // time.
    fs::remove_all(path, error);
  }
  fs::remove(all, error);
  return retired;
}

}  // namespace tcs
