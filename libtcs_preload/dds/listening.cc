#include "libtcs_preload/dds/listening.h"

#include <atomic>

namespace tcs::dds {
namespace {

thread_local int t_listening;

// Cyclone has one status callback of each kind.
std::atomic<ddsi_status_cb_t> g_reader_status;
std::atomic<ddsi_status_cb_t> g_writer_status;

void ReaderStatus(void* entity, const ddsi_status_cb_data_t* data) {
  const Listening listening;
  g_reader_status.load(std::memory_order_relaxed)(entity, data);
}

void WriterStatus(void* entity, const ddsi_status_cb_data_t* data) {
  const Listening listening;
  g_writer_status.load(std::memory_order_relaxed)(entity, data);
}

}  // namespace

bool IsListening() { return t_listening != 0; }
Listening::Listening() { ++t_listening; }
Listening::~Listening() { --t_listening; }

ddsi_status_cb_t ListeningReaderStatus(ddsi_status_cb_t real) {
  if (real == nullptr) return nullptr;
  g_reader_status.store(real, std::memory_order_relaxed);
  return ReaderStatus;
}

ddsi_status_cb_t ListeningWriterStatus(ddsi_status_cb_t real) {
  if (real == nullptr) return nullptr;
  g_writer_status.store(real, std::memory_order_relaxed);
  return WriterStatus;
}

void DataAvailable(dds_reader* reader) {
  const Listening listening;
  Real().dds_reader_data_available_cb(reader);
}

}  // namespace tcs::dds
