// What a run that goes on has done so far, and what of it is new: read from the tables that it
// writes, each line once.
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
  // How much of it somebody has. Of another generation it is all of no use: another run has begun
  // in the folder, or there was too much of this one, and it was made coarser.
  struct Place {
    std::uint64_t generation = 0;
    std::size_t moments = 0, said = 0, slices = 0;
  };

  // The folder may still be empty.
  explicit LiveRun(std::string folder);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  // Reads what has come since. What the tables say of a moment is there at the second look after it
  // was written: they are written one after the other.
  void Look();

  bool HasMoments() const;
  // How far it has come, in virtual seconds.
  double LastS() const;
  Place place() const;
  // What is new since `from`: {generation, replay, timeline}, each as the page's scripts decode
  // them, with the numbers of what they begin with; everything if `from` is of no use.
  nlohmann::ordered_json NewsSince(const Place& from) const;

 private:
  struct Reading;

  std::string folder_;
  std::uint64_t generation_ = 1;
  std::unique_ptr<Reading> reading_;
};

}  // namespace tcs::report
