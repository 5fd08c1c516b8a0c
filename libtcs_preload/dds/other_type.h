// The type of a shadow whose original's type this program does not have: the type has what XTypes
// says of the original's, so that Cyclone can compare it, show it and look it up, and samples as
// the bytes that they travel as. Readers and writers of the program that match have types of their
// own, which Cyclone converts to and from, by these bytes.
#pragma once

#include <string>

#include "libtcs_preload/dds/cyclone.h"
#include "libtcs_preload/dds/type_code.h"

namespace tcs::dds {

// The caller owns the type.
ddsi_sertype* NewOtherType(const std::string& name, bool keyless, const TypeCode& code);

// Whether the sample is of such a type. The key of such a sample is not known: all samples are one
// instance, and only the writer's own type tells them apart.
bool IsOfOtherType(const ddsi_serdata* sample);

// Whether the two are one sample, of which Cyclone has made a sample of another type. For samples
// that the same writer wrote.
bool IsSameSample(const ddsi_serdata* a, const ddsi_serdata* b);

}  // namespace tcs::dds
