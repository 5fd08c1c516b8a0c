// Whether a link touches anything that is not of its own model: by where the links are, whatever
// engine moves them.
#pragma once

#include <span>
#include <vector>

#include "simbody_bridge/dynamics.h"

namespace tcs {

class Touching {
 public:
  // `link` as Dynamics numbers links. The world outlives this.
  Touching(const WorldSpec& world, int link);

  // The links whose poses Touches needs: the link itself first. As Dynamics numbers links.
  std::span<const int> links() const { return links_; }
  // `poses` are those of these links. Whether the link is as near to something as `margin_m`.
  bool Touches(std::span<const Pose> poses, double margin_m) const;

 private:
  struct Part {
    const Shape* shape;
    std::size_t link;  // place in `links_`
  };
  std::vector<int> links_;
  std::vector<Part> own_, others_;
  std::vector<const Shape*> fixtures_;
};

}  // namespace tcs
