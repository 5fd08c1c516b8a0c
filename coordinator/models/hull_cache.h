// Convex hulls that earlier runs have found, by the content of the meshes: in the user's cache
// folder ($XDG_CACHE_HOME/tcs/hulls, or ~/.cache/tcs/hulls), whose files may be deleted at any
// time. A file that is damaged there, or cannot be read or written, is as if it were not there.
#pragma once

#include <cstddef>
#include <string>

namespace tcs {

class HullCache {
 public:
  // For hulls of `most_vertices` of the mesh `text`; `reader` names the way in which the mesh is
  // read (a file's ending). Without a cache folder, or where the mesh is so small that it is
  // quickly read, nothing is kept.
  HullCache(const std::string& text, const std::string& reader, std::size_t most_vertices);

  // The hull that was kept; empty: none.
  std::string Find() const;
  void Keep(const std::string& hull) const;

 private:
  std::string folder_, path_;  // empty: nothing is kept
};

}  // namespace tcs
