// Whether the calling thread runs a listener of the program inside Cyclone, which then holds locks
// that the deliverer may need: such a thread must not wait for the deliverer.
#pragma once

#include "libtcs_preload/dds/cyclone.h"

namespace tcs::dds {

bool IsListening();

class Listening {
 public:
  Listening();
  ~Listening();
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;
};

// The status callback that the program's readers and writers are made with instead of Cyclone's
// own.
ddsi_status_cb_t ListeningReaderStatus(ddsi_status_cb_t real);
ddsi_status_cb_t ListeningWriterStatus(ddsi_status_cb_t real);

// Hook.
void DataAvailable(dds_reader* reader);

}  // namespace tcs::dds
