// A volatile writer, and a reader that wants the history.
#include "tests/dds/scenarios/incompatible.h"

namespace {

using namespace incompatible;

void Writer(Process& self) { Offer(self, Qos().Reliable()); }
void Reader(Process& self) { Request(self, Qos().Reliable().TransientLocal(), Qos().Reliable()); }

}  // namespace

TCS_DDS_SCENARIO(incompatible_durability, Writer, Reader);
