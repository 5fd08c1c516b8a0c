// A writer that offers a sample each second, and a reader that wants ten.
#include "tests/dds/scenarios/incompatible.h"

namespace {

using namespace incompatible;

void Writer(Process& self) { Offer(self, Qos().Reliable().Deadline(DDS_SECS(1))); }
void Reader(Process& self) {
  Request(self, Qos().Reliable().Deadline(DDS_MSECS(100)), Qos().Reliable().Deadline(DDS_SECS(1)));
}

}  // namespace

TCS_DDS_SCENARIO(incompatible_deadline, Writer, Reader);
