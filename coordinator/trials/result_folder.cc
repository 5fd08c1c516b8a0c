#include "coordinator/trials/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>
#include <vector>

#include "coordinator/trials/outcome.h"
#include "coordinator/trials/slurm_folder.h"

namespace tcs {

namespace {

namespace fs = std::filesystem;

constexpr const char* kRecord = "trials.json";

std::vector<fs::path> EntriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator{};
       entry.increment(error)) {
    entries.push_back(entry->path());
  }
  return entries;
}

// "seed-0001"
bool IsTrial(const fs::path& path) {
  const std::string name = path.filename(), mark = "seed-";
  return name.compare(0, mark.size(), mark) == 0 && name.size() > mark.size() &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(mark.size()), name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Throws filesystem_error.
void RemoveTrials(const fs::path& folder) {
  for (const fs::path& entry : EntriesOf(folder)) {
    if (!fs::is_directory(fs::symlink_status(entry))) continue;
    if (IsTrial(entry)) {
      fs::remove_all(entry);
      continue;
    }
    const std::vector<fs::path> inner = EntriesOf(entry);
    for (const fs::path& trial : inner) {
      if (IsTrial(trial)) fs::remove_all(trial);
    }
    // Removes a folder that held nothing but trials.
    if (!inner.empty() && EntriesOf(entry).empty()) fs::remove(entry);
  }
  fs::remove(folder / kRecord);
}

std::string GoOnWith(const std::string& path, TrialsRecord* record, ResultFolder* folder) {
  const std::string file = path + "/" + kRecord;
  auto read = RecordFromJson(ReadText(file));
  if (const auto* error = std::get_if<std::string>(&read)) {
    return fmt::format(
        "{} is not what tcsim wrote ({}); choose another folder with --out, or delete its trials "
        "with --restart",
        file, *error);
  }
  const auto& before = std::get<TrialsRecord>(read);
  if (const std::string difference = WhatDiffers(before, *record); !difference.empty()) {
    return fmt::format(
        "'{}' {}; choose another folder with --out, or delete its trials with --restart", path,
        difference);
  }
  folder->has_trials = true;
  folder->changed_program = ChangedProgram(before, *record);
  record->programs = before.programs;
  return {};
}

}  // namespace

std::string EnterResultFolder(const std::string& path, bool restart, TrialsRecord record,
                              ResultFolder* folder) {
  if (std::string error = MakeFolder(path); !error.empty()) return error;
  folder->lock = FolderLock(path);
  if (!folder->lock.IsOurs()) {
    return fmt::format(
        "another tcsim trials is at work in '{}'; wait for it, or choose another "
        "folder with --out",
        path);
  }
  std::vector<fs::path> entries = EntriesOf(path);
  // Such a file is left by a call that was killed while it wrote.
  std::erase_if(entries, [](const fs::path& entry) {
    return entry.filename() == std::string(kRecord) + ".new";
  });
  if (fs::path file = fs::path(path) / kRecord; fs::exists(file)) {
    if (restart) {
      folder->left_jobs = RetireWorkFolders(path);
      try {
        RemoveTrials(path);
      } catch (const fs::filesystem_error& error) {
        return fmt::format("the trials in '{}' cannot be removed: {}", path,
                           error.code().message());
      }
    } else if (std::string error = GoOnWith(path, &record, folder); !error.empty()) {
      return error;
    }
  } else if (!entries.empty()) {
    return fmt::format(
        "the folder '{}' holds other files than trials; choose another folder with --out", path);
  }
  if (!restart) folder->left_jobs = RetireWorkFolders(path);
  return WriteWhole(path + "/" + kRecord, ToJson(record));
}

}  // namespace tcs
