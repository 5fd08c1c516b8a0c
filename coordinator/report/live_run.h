// The state of a run that goes on, and its news: read from the tables that the run writes, each
// line once.
//
// Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace tcs::report {

class LiveRun {
 public:
  // How much of the run somebody has. A place of another generation is of no use: another run has
  // begun in the folder, or there was too much of this run, and it was made coarser.
  struct Place {
    std::uint64_t generation = 0;
    std::size_t moments = 0, said = 0, slices = 0;
  };

  // The folder may still be empty.
  explicit LiveRun(std::string folder);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  // Reads the lines that have come since the last look. A moment is complete at the second look
  // after it was written: the tables are written one after the other.
  void Look();

  bool HasMoments() const;
  // How far the run has come, in virtual seconds.
  double LastS() const;
  Place place() const;
  // The news since `from`: {generation, replay, timeline}, each as the page's scripts decode them,
  // with the numbers of the moments, lines and slices that the news begin with; everything if
  // `from` is of no use.
  nlohmann::ordered_json NewsSince(const Place& from) const;

 private:
  struct Reading;

  std::string folder_;
  std::uint64_t generation_ = 1;
  std::unique_ptr<Reading> reading_;
};

}  // namespace tcs::report
