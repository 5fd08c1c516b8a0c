// trials.json: the record of what a result folder holds the trials of. The file is written before
// the first trial, and says to a later call whether it may go on there.
#pragma once

#include <map>
#include <string>
#include <variant>

#include "coordinator/trials/plan.h"

namespace tcs {

struct TrialsRecord {
  TrialsPlan plan;
  std::string scenario_hash;                    // of the file's text
  std::map<std::string, std::string> programs;  // the files that clients are started from, hashed
};

// 16 hexadecimal digits that say whether a file is still the same; empty if it cannot be read.
std::string HashOfFile(const std::string& path);

std::string ToJson(const TrialsRecord& record);
// The record, or what is wrong with the text.
[[nodiscard]] std::variant<TrialsRecord, std::string> RecordFromJson(const std::string& text);

// The difference that matters for a trial's outcome, as the end of a sentence: "was made with
// --sync consistent, not callback"; empty if the trials of both records belong together. Records
// with more or fewer trials, other values of the same key or another name belong together.
std::string WhatDiffers(const TrialsRecord& before, const TrialsRecord& now);

// The first program that has changed; empty if none has.
std::string ChangedProgram(const TrialsRecord& before, const TrialsRecord& now);

}  // namespace tcs
