// The meshes that robots are drawn with, small enough for a page.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

namespace tcs::report {

class Looks {
 public:
  // Takes meshes of so many files at most, each of which may be used any number of times.
  explicit Looks(std::size_t files);

  // Puts the mesh of the file, scaled along its axes, into `meshes`, as page/replay_data.js reads
  // it, and returns its number there; none where the mesh cannot be read, or there is no room for
  // it.
  std::optional<std::size_t> Take(const std::string& path, const std::array<double, 3>& scale,
                                  nlohmann::ordered_json* meshes);
  // The file's own colour of that mesh, from 0 to 1.
  std::optional<std::array<double, 3>> ColourOf(std::size_t mesh) const;

 private:
  std::size_t most_triangles_;  // of each mesh
  std::size_t files_left_;
  std::map<std::size_t, std::array<double, 3>> colours_;
  std::map<std::pair<std::string, std::array<double, 3>>, std::optional<std::size_t>> taken_;
};

}  // namespace tcs::report
