// How a replay is written into the page; page/replay_data.js reads it.
//
// A number becomes a whole one by an offset and a step, which are those of its track or signal: 16
// bits over the number's range, but steps of a micrometre at the least. Then each number is written
// as the difference to the one before, in as few bytes as that needs.
#include <algorithm>
#include <cmath>
#include <span>

#include "coordinator/report/bytes.h"
#include "coordinator/report/replay.h"

namespace tcs::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSteps = 65'535, kLeastStep = 1e-6, kOrientationStep = 1.0 / 32'767;

struct Scale {
  double least = 0, step = kLeastStep;

  std::int64_t Of(double value) const { return std::llround((value - least) / step); }
};

template <class Get>
Scale ScaleOf(std::size_t count, Get get) {
  double least = get(std::size_t{0}), most = least;
  for (std::size_t i = 1; i < count; ++i) {
    least = std::min(least, get(i));
    most = std::max(most, get(i));
  }
  return {least, std::max(kLeastStep, (most - least) / kSteps)};
}

Json TrackJson(const PoseTrack& track) {
  const std::size_t count =
      track.IsStill() ? std::min<std::size_t>(1, track.poses.size()) : track.poses.size();
  Json least = Json::array(), step = Json::array();
  Scale scales[7];
  for (std::size_t axis = 0; axis < 7; ++axis) {
    scales[axis] = axis < 3 && count > 0
                       ? ScaleOf(count, [&](std::size_t i) { return track.poses[i][axis]; })
                       : Scale{0, kOrientationStep};
    least.push_back(scales[axis].least);
    step.push_back(scales[axis].step);
  }
  std::string bytes;
  std::int64_t before[7] = {};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 7; ++axis) {
      const std::int64_t now = scales[axis].Of(track.poses[i][axis]);
      PutSigned(&bytes, now - before[axis]);
      before[axis] = now;
    }
  }
  return {{"name", track.name},
          {"count", count},
          {"least", std::move(least)},
          {"step", std::move(step)},
          {"data", Base64(bytes)}};
}

Json SignalJson(const Signal& signal) {
  const Scale scale =
      ScaleOf(signal.values.size(), [&](std::size_t i) { return signal.values[i]; });
  std::string bytes;
  std::int64_t before = 0;
  for (const double value : signal.values) {
    PutSigned(&bytes, scale.Of(value) - before);
    before = scale.Of(value);
  }
  return {{"robot", signal.robot}, {"panel", signal.panel}, {"name", signal.name},
          {"first", signal.first}, {"least", scale.least},  {"step", scale.step},
          {"data", Base64(bytes)}};
}

}  // namespace

Json ToJson(const Replay& replay) {
  std::string times;
  std::int64_t before = 0;
  for (const double time_s : replay.time_s) {
    const std::int64_t now_us = std::llround(time_s * 1e6);
    PutNumber(&times, static_cast<std::uint64_t>(std::max<std::int64_t>(0, now_us - before)));
    before = now_us;
  }
  Json tracks = Json::array(), robots = Json::array(), signals = Json::array(),
       said = Json::array();
  for (const PoseTrack& track : replay.tracks) tracks.push_back(TrackJson(track));
  for (const RobotTracks& robot : replay.robots) {
    robots.push_back({{"name", robot.name}, {"root", robot.root}, {"paths", robot.paths}});
  }
  for (const Signal& signal : replay.signals) signals.push_back(SignalJson(signal));
  for (const Said& line : replay.said) {
    said.push_back({line.time_us, line.client, line.stream, line.text, line.is_mark});
  }
  return {{"name", replay.name},
          {"end", replay.end_s},
          {"count", replay.time_s.size()},
          {"times", Base64(times)},
          {"tracks", std::move(tracks)},
          {"robots", std::move(robots)},
          {"signals", std::move(signals)},
          {"said", std::move(said)},
          {"contacts", ToJson(replay.contacts, replay.time_s.size())},
          {"scene", replay.scene}};
}

std::string Encoded(const Replay& replay) { return ForScript(ToJson(replay)); }

}  // namespace tcs::report
