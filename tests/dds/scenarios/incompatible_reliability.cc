// A best-effort writer, and a reader that wants it reliable.
#include "tests/dds/scenarios/incompatible.h"

namespace {

using namespace incompatible;

void Writer(Process& self) { Offer(self, Qos().BestEffort()); }
void Reader(Process& self) { Request(self, Qos().Reliable(), Qos().BestEffort()); }

}  // namespace

TCS_DDS_SCENARIO(incompatible_reliability, Writer, Reader);
