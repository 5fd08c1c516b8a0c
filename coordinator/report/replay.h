// The motion of one run's world, made small enough for a page that shows the run again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "coordinator/errors/load_error.h"
#include "coordinator/report/contact_track.h"

namespace tcs::report {

// Position in metres, then an orientation x, y, z, w.
using PoseRow = std::array<double, 7>;

// The track of a body, or of a link and all that is fixed to it.
struct PoseTrack {
  std::string name;  // in bodies.csv
  std::vector<PoseRow> poses;

  [[nodiscard]] bool IsStill() const;
};

// A quantity over time. A commanded quantity counts from the first command on.
struct Signal {
  std::size_t robot = 0;
  std::string panel;  // that the signal is drawn in, with its unit: "velocity [m/s]"
  std::string name;
  std::size_t first = 0;  // moment from which on there are values
  std::vector<double> values;
};

// A body or a model.
struct RobotTracks {
  std::string name;
  std::size_t root = 0;  // a track
  std::vector<std::size_t>
      paths;  // tracks that show its way: the root, or what moves on one that stands
};

// A line that a client wrote. A mark is a line that begins with "mark:".
struct Said {
  std::int64_t time_us = 0;
  std::string client, stream, text;
  bool is_mark = false;
};

struct Replay {
  std::string name;            // the system's
  std::vector<double> time_s;  // of the moments, in virtual time
  std::vector<PoseTrack> tracks;
  std::vector<RobotTracks> robots;
  std::vector<Signal> signals;
  ContactTrack contacts;
  nlohmann::ordered_json scene;  // things to draw: "tracks" has the shapes of each, in its frame
  std::vector<Said> said;
  std::int64_t said_more = 0;  // lines that there was no room for
  double end_s = 0;
  std::size_t trials = 1;  // of which this is the first
};

// Reads the replay from a run's folder. A folder without bodies.csv has a replay without moments,
// tracks and robots. The runs of earlier versions have no shapes. `most_bytes` is about the size
// that the encoded replay may have: more bodies have fewer moments.
[[nodiscard]] LoadResult<Replay> ReadReplay(const std::string& folder, const std::string& name,
                                            double end_s, std::size_t most_bytes,
                                            std::vector<std::string>* warnings);

// The replay as page/replay_data.js reads it: an object of JSON, tracks and signals in it as base64
// of bytes.
[[nodiscard]] nlohmann::ordered_json ToJson(const Replay& replay);
[[nodiscard]] std::string Encoded(const Replay& replay);

}  // namespace tcs::report
