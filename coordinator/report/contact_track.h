// The contact forces of a replay: at its moments, and as few as it has room for.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace tcs::report {

class ContactTrack {
 public:
  struct Point {
    std::size_t moment = 0;
    std::size_t pair = 0;
    std::array<double, 3> point_m{};  // in the world
    std::array<double, 3> force_n{};  // on the first of the two
    double weight_n = 0;              // the point's weight in a mean
  };
  // Names as in contacts.csv.
  struct Pair {
    std::string first, second;
    bool second_moves = false;  // the second one feels the opposite force
  };

  // How many points there may be. With one more all become coarser: first each two things have one
  // force, the sum, at the mean place of its parts; then every second moment has the contacts of
  // the moment before.
  explicit ContactTrack(std::size_t most_points = 100'000) : most_points_(most_points) {}

  // Moments come in their order; a contact of a moment that is past is left out.
  void Add(std::size_t moment, const Pair& pair, const std::array<double, 3>& point_m,
           const std::array<double, 3>& force_n);
  // Every second moment of the replay is left out.
  void Thin();

  const std::vector<Pair>& pairs() const { return pairs_; }
  const std::vector<Point>& points() const { return points_; }  // by moment
  // A moment shows the contacts of the last moment before it whose number the stride divides.
  std::size_t stride() const { return stride_; }
  bool has_sums() const { return has_sums_; }

  // The contacts of the moments from `begin` to before `end`, with moments counted from `begin`.
  ContactTrack Part(std::size_t begin, std::size_t end) const;

 private:
  void MakeCoarser();
  void KeepMultiplesOf(std::size_t stride);

  std::size_t most_points_;
  std::vector<Pair> pairs_;
  std::map<std::pair<std::string, std::string>, std::size_t> pair_of_;
  std::vector<Point> points_;
  std::size_t stride_ = 1;
  bool has_sums_ = false;
};

// As page/replay_data.js reads it, of so many moments; null where nothing touches.
[[nodiscard]] nlohmann::ordered_json ToJson(const ContactTrack& contacts, std::size_t moments);

}  // namespace tcs::report
