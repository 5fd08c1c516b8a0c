// How samples leave: the reader history cache of a shadow reader. Cyclone calls its `store` in the
// thread that writes, for each sample of each writer that matches the reader; samples of the
// program's own writers are shipped to the process of the reader that the shadow stands for.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

#include "libtcs_preload/dds/guid.h"

namespace tcs::dds {

struct Tap {
  dds_rhc rhc;  // first: Cyclone has its address

  ddsi_domaingv* gv;
  std::uint32_t domain;
  std::uint32_t process;
  Guid reader{};
  std::string topic;
  bool is_reliable;
  bool catches_up;   // reliable and transient local: gets what writers have when they meet
  bool is_complete;  // CompleteTap has been called
  // Samples of all threads go to this reader alone until its history's end has been sent.
  bool catching_up;
  // The reader was lost and is found again (deaf_mute.h): the reader has had what was written
  // before that.
  std::int64_t lost_at_ns = INT64_MIN;  // monotonic
  // The samples that the reader has had alone of late, referred to: a thread that is writing while
  // the history is read stores its sample once more. `catching_up` and `had` are under the mutex,
  // and so is what is sent meanwhile, because the reader takes what comes after the history's end,
  // and nothing before.
  std::deque<ddsi_serdata*> had;
  std::mutex mutex;
};

// The tap belongs to the shadow reader that is made with it, and goes with that reader.
Tap* NewTap(ddsi_domaingv* gv, std::uint32_t domain, std::uint32_t process, const Guid& reader,
            const std::string& topic, bool is_reliable, bool catches_up);

// While this object lives, the calling thread makes the tap's shadow reader, and samples that it
// stores in the tap are samples that writers had already.
class MakingTap {
 public:
  explicit MakingTap(const Tap* tap);
  ~MakingTap();
  MakingTap(const MakingTap&) = delete;
  MakingTap& operator=(const MakingTap&) = delete;
};

// The shadow reader is there: tells the reader elsewhere that it has had what writers had.
void EndCatchUp(Tap& tap);

// Tells a reader elsewhere that it has what a writer had.
void SendHistoryEnd(const ddsi_domaingv& gv, const Guid& writer, const Guid& reader,
                    std::uint32_t process);

}  // namespace tcs::dds
