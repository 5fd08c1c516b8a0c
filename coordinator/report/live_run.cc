#include "coordinator/report/live_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>
#include <vector>

#include "coordinator/report/csv_tail.h"
#include "coordinator/report/replay.h"
#include "coordinator/report/replay_reader.h"
#include "coordinator/report/replay_scene.h"
#include "coordinator/report/said_tail.h"
#include "coordinator/report/timeline.h"

namespace tcs::report {

namespace {

using Json = nlohmann::ordered_json;

// The most that a page is given at once.
constexpr std::size_t kMostLiveBytes = 4'000'000, kMostLiveSlices = 80'000, kLeastMoments = 500,
                      kMostMoments = 100'000;

// How many moments a page is given, by the bytes that each moment takes.
std::size_t MostMoments(const ReplayScene& scene) {
  const double interval_s = IntervalOf(scene, 1e9, kMostLiveBytes);
  return std::clamp(static_cast<std::size_t>(1e9 / interval_s), kLeastMoments, kMostMoments);
}

std::string NameOf(const std::string& folder) {
  return std::filesystem::path(folder).filename().string();
}

}  // namespace

struct LiveRun::Reading {
  Reading(const std::string& folder, ReplayScene scene)
      : most_moments(MostMoments(scene)),
        bodies(folder + "/bodies.csv", kStateColumns, kStateColumns.size()),
        joints(folder + "/joints.csv", kJointColumns, kJointColumns.size()),
        contacts(folder + "/contacts.csv", kContactColumns, kContactColumns.size()),
        commands(folder + "/commands.csv", kCommandColumns, kCommandColumns.size()),
        dispatches(folder + "/dispatches.csv", kDispatchColumns, kDispatchColumnsWithoutReal),
        said(folder) {
    replay.name = timeline.name = NameOf(folder);
    replay.scene = scene.json;
    const double interval_s = IntervalOf(scene, 0, kMostLiveBytes);
    reader = std::make_unique<ReplayReader>(std::move(scene), &replay, interval_s);
  }

  const std::size_t most_moments;
  Replay replay;
  Timeline timeline;
  CsvTail bodies, joints, contacts, commands, dispatches;
  SaidTail said;
  std::unique_ptr<ReplayReader> reader;
  TimelineBuilder slices{&timeline};
  std::size_t released = 0;  // moments of which all is known
  // How coarse contacts were at the last look: whether there were sums alone, at which moments.
  std::pair<bool, std::size_t> contacts_were{false, 1};

  // Reads on. Lines of moments that are not there yet wait for these moments.
  CsvTail::Found Look() {
    released = replay.time_s.size();
    const auto found = bodies.Look([this](const CsvFields& fields) {
      static_cast<void>(reader->TakeState(fields));
      return CsvTail::Taken::kYes;
    });
    if (found == CsvTail::Found::kReplaced) return found;
    const double last_s = replay.time_s.empty() ? -1 : replay.time_s.back();
    static_cast<void>(joints.Look([&](const CsvFields& fields) {
      const auto time_s = ToReal(fields[0]);
      if (time_s && *time_s > last_s) return CsvTail::Taken::kLater;
      static_cast<void>(reader->TakeJoint(fields));
      return CsvTail::Taken::kYes;
    }));
    static_cast<void>(contacts.Look([&](const CsvFields& fields) {
      const auto time_s = ToReal(fields[0]);
      if (time_s && *time_s > last_s) return CsvTail::Taken::kLater;
      static_cast<void>(reader->TakeContact(fields));
      return CsvTail::Taken::kYes;
    }));
    static_cast<void>(commands.Look([&](const CsvFields& fields) {
      const auto acts_ns = ToInteger(fields[0]);
      if (acts_ns && static_cast<double>(*acts_ns) * 1e-9 > last_s) return CsvTail::Taken::kLater;
      static_cast<void>(reader->TakeCommand(fields));
      return CsvTail::Taken::kYes;
    }));
    static_cast<void>(dispatches.Look([this](const CsvFields& fields) {
      static_cast<void>(slices.Take(fields));
      return CsvTail::Taken::kYes;
    }));
    said.Look(&replay);
    reader->FindAllPaths();
    return found;
  }

  // True if there was too much, so that something was made coarser.
  bool MadeCoarser() {
    bool is_coarser =
        contacts_were != std::pair(replay.contacts.has_sums(), replay.contacts.stride());
    while (replay.time_s.size() > most_moments) {
      reader->Thin();
      released = (released + 1) / 2;
      is_coarser = true;
    }
    if (timeline.slices.size() > kMostLiveSlices) {
      std::vector<Timeline> one;
      one.push_back(std::move(timeline));
      Shorten(&one, kMostLiveSlices / 2);
      timeline = std::move(one[0]);
      is_coarser = true;
    }
    contacts_were = {replay.contacts.has_sums(), replay.contacts.stride()};
    return is_coarser;
  }

  // The part of the replay from that moment on, as a replay of its own.
  Replay ReplaySince(std::size_t moment, std::size_t line) const {
    Replay part;
    part.name = replay.name;
    const auto from = static_cast<std::ptrdiff_t>(moment),
               to = static_cast<std::ptrdiff_t>(released);
    part.time_s.assign(replay.time_s.begin() + from, replay.time_s.begin() + to);
    if (released > 0) part.end_s = replay.time_s[released - 1];
    for (const PoseTrack& track : replay.tracks) {
      PoseTrack& its = part.tracks.emplace_back(PoseTrack{track.name, {}});
      for (std::size_t i = moment; i < released; ++i) {
        if (track.poses.empty()) break;
        its.poses.push_back(track.poses[std::min(i, track.poses.size() - 1)]);
      }
    }
    part.robots = replay.robots;
    for (const Signal& signal : replay.signals) AddPart(signal, moment, &part);
    part.contacts = replay.contacts.Part(moment, released);
    part.said.assign(replay.said.begin() + static_cast<std::ptrdiff_t>(line), replay.said.end());
    part.said_more = replay.said_more;
    if (moment == 0) part.scene = replay.scene;
    return part;
  }

  // A moment without a value has the value of the moment before.
  void AddPart(const Signal& signal, std::size_t moment, Replay* part) const {
    const auto at = [&signal](std::size_t i) {
      return i < signal.values.size() ? signal.values[i] : std::nan("");
    };
    double held = std::nan("");
    for (std::size_t i = std::min(moment, signal.values.size()); i-- > 0 && std::isnan(held);)
      held = at(i);
    Signal its{signal.robot, signal.panel, signal.name, 0, {}};
    for (std::size_t i = moment; i < released; ++i) {
      if (!std::isnan(at(i))) held = at(i);
      if (std::isnan(held)) {
        ++its.first;
      } else {
        its.values.push_back(held);
      }
    }
    if (!its.values.empty()) part->signals.push_back(std::move(its));
  }

  Timeline TimelineSince(std::size_t slice) const {
    Timeline part = {.name = timeline.name,
                     .rows = timeline.rows,
                     .has_real_times = timeline.has_real_times,
                     .slices = {timeline.slices.begin() + static_cast<std::ptrdiff_t>(slice),
                                timeline.slices.end()},
                     .virtual_end = timeline.virtual_end,
                     .real_end = timeline.real_end,
                     .merged_us = timeline.merged_us};
    return part;
  }
};

LiveRun::LiveRun(std::string folder) : folder_(std::move(folder)) {}

LiveRun::~LiveRun() = default;

void LiveRun::Look() {
  if (reading_ == nullptr) {
    // The scene is there before the first moment.
    if (!IsFile(folder_ + "/bodies.csv")) return;
    auto scene = ReadReplayScene(folder_, MeshLooks::kLeftOut);
    if (std::holds_alternative<LoadError>(scene)) return;
    reading_ = std::make_unique<Reading>(folder_, std::move(std::get<ReplayScene>(scene)));
  }
  if (reading_->Look() == CsvTail::Found::kReplaced) {
    reading_.reset();
    ++generation_;
  } else if (reading_->MadeCoarser()) {
    ++generation_;
  }
}

bool LiveRun::HasMoments() const { return reading_ != nullptr && reading_->released > 0; }

double LiveRun::LastS() const {
  return HasMoments() ? reading_->replay.time_s[reading_->released - 1] : 0;
}

LiveRun::Place LiveRun::place() const {
  if (reading_ == nullptr) return {.generation = generation_};
  return {generation_, reading_->released, reading_->replay.said.size(),
          reading_->timeline.slices.size()};
}

Json LiveRun::NewsSince(const Place& from) const {
  const Place here = place();
  const bool is_known = from.generation == generation_ && from.moments <= here.moments &&
                        from.said <= here.said && from.slices <= here.slices;
  const Place begin = is_known ? from : Place{};
  Json news{{"generation", generation_},
            {"from", {{"moments", begin.moments}, {"said", begin.said}, {"slices", begin.slices}}},
            {"to", {{"moments", here.moments}, {"said", here.said}, {"slices", here.slices}}}};
  if (reading_ == nullptr) return news;
  news["replay"] = ToJson(reading_->ReplaySince(begin.moments, begin.said));
  news["timeline"] = ToJson(reading_->TimelineSince(begin.slices));
  return news;
}

}  // namespace tcs::report
