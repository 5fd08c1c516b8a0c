// How samples leave: the reader history cache of a shadow reader. Cyclone calls its `store` in the
// thread that writes, for each sample of each writer that matches the reader; what is the
// program's own is shipped to the process of the reader that the shadow stands for.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

struct Tap {
  dds_rhc rhc;  // first: Cyclone has its address

  ddsi_domaingv* gv;
  std::uint32_t domain;
  std::uint32_t process;
  Guid reader;
  std::string topic;
  bool catches_up;  // reliable and transient local: gets what writers have when they meet
  // Samples of all threads go to this reader alone until its history's end has been sent.
  std::atomic<bool> catching_up;
};

// Belongs to the shadow reader that is made with it, and goes with it.
Tap* NewTap(ddsi_domaingv* gv, std::uint32_t domain, std::uint32_t process, const Guid& reader,
            const std::string& topic, bool catches_up);

// While it lives, the calling thread makes the tap's shadow reader, and what it stores in the tap
// is what writers had already.
class MakingTap {
 public:
  explicit MakingTap(const Tap* tap);
  ~MakingTap();
  MakingTap(const MakingTap&) = delete;
  MakingTap& operator=(const MakingTap&) = delete;
};

// Tells a reader elsewhere that it has what a writer had.
void SendHistoryEnd(std::uint32_t domain, const Guid& writer, const Guid& reader,
                    std::uint32_t process);

}  // namespace tcs::dds
