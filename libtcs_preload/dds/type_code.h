// The bytes that XTypes has for a type: the TypeInformation, which identifies the type and the
// types that it depends on, and the TypeMapping, which has the type objects of all of these.
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

// The given code if Cyclone can read it, else an empty code: Cyclone trusts the bytes from which it
// makes a type.
TypeCode Checked(TypeCode code);

// Null if the code is empty. The caller owns the results.
ddsi_typeinfo_t* InformationOf(const TypeCode& code);
ddsi_typemap_t* MappingOf(const TypeCode& code);

// Whether the sertype is of the type that the code says: any sertype is if the code says nothing.
bool IsOfType(const ddsi_sertype* type, const TypeCode& code);

}  // namespace tcs::dds
