// What XTypes says of a type, as bytes: its TypeInformation, which identifies it and what it
// depends on, and its TypeMapping, which has the type objects of all of these.
#pragma once

#include <cstddef>
#include <vector>

#include "libtcs_preload/dds/cyclone.h"

namespace tcs::dds {

using Payload = std::vector<std::byte>;

// Empty: the type has none, as a type that a language binding without XTypes makes.
struct TypeCode {
  Payload information;
  Payload mapping;

  bool operator==(const TypeCode&) const = default;
};

TypeCode CodeOf(const ddsi_sertype* type);

// The same if Cyclone can read it, else empty: Cyclone trusts the bytes from which it makes a type.
TypeCode Checked(TypeCode code);

// Null if it is empty. The caller owns them.
ddsi_typeinfo_t* InformationOf(const TypeCode& code);
ddsi_typemap_t* MappingOf(const TypeCode& code);

// Whether the sertype is of the type that the code says: any is if it says nothing.
bool IsOfType(const ddsi_sertype* type, const TypeCode& code);

}  // namespace tcs::dds
