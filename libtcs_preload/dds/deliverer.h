// The thread that takes in what other processes send. The mirrors (mirrors.h) are its own: no lock
// of ours is held while Cyclone, and with it the program's listeners, run on it.
#pragma once

#include <cstdint>

namespace tcs::dds {

void StartDeliverer();

// True if the calling thread is the deliverer.
bool IsDeliverer();

// The program has a new topic or participant: there may be more to mirror. The look has happened
// when the calling thread goes on or next looks at what has come.
void LookAgain();

// The program's last participant in a domain is gone, and the domain's end has begun (program.h):
// the shadows are gone, too, when this returns, or, on the deliverer, soon. The domain's end is
// over then.
void CloseDomain(std::uint32_t domain);

}  // namespace tcs::dds
