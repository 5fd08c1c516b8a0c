// What each robot of the zoo costs (tests/zoo): to load, and to move.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tcs::bench {

struct ZooRow {
  std::string robot;
  double load_ms = 0;
  // Virtual time to processor time of what was slowest of being free, held and moved; none: it did
  // not go well, or there is no such engine.
  std::optional<double> simbody, mujoco;
  // How far its joints are from where DART has them after 1 s of smooth motion, in rad or m; none:
  // there is no DART, or it cannot read the file.
  std::optional<double> from_dart;
};

std::vector<ZooRow> MeasureZoo(bool quick);

}  // namespace tcs::bench
