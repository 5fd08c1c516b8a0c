#include "libtcs_preload/dds/type_code.h"

#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/ddsi_xt_impl.h>
#include <dds/ddsi/ddsi_xt_typeinfo.h>
#include <dds/ddsi/ddsi_xt_typemap.h>

#include <algorithm>
#include <utility>

namespace tcs::dds {
namespace {

constexpr std::uint32_t kXcdr2 = 2;

Payload SerialisedType(const void* what, const dds_topic_descriptor_t& type) {
  dds_ostreamLE_t stream;
  dds_ostreamLE_init(&stream, 0, kXcdr2);
  Payload bytes;
  if (dds_stream_writeLE(&stream, static_cast<const char*>(what), type.m_ops)) {
    const auto* start = reinterpret_cast<const std::byte*>(stream.x.m_buffer);
    bytes.assign(start, start + stream.x.m_index);
  }
  dds_ostreamLE_fini(&stream);
  return bytes;
}

bool IsReadable(Payload bytes, const dds_topic_descriptor_t& type) {
  std::uint32_t used = 0;
  return !bytes.empty() && dds_stream_normalize_data(reinterpret_cast<char*>(bytes.data()), &used,
                                                     static_cast<std::uint32_t>(bytes.size()),
                                                     false, kXcdr2, type.m_ops) != nullptr;
}

ddsi_sertype_cdr_data_t CdrOf(const Payload& bytes) {
  return {static_cast<std::uint32_t>(bytes.size()),
          reinterpret_cast<std::uint8_t*>(const_cast<std::byte*>(bytes.data()))};
}

// True if all identifiers are hashes, as those of a topic are. Cyclone aborts the program at
// identifiers of a kind that it does not know.
bool NamesTypesByHash(const ddsi_typeinfo_t& information) {
  const auto all_are = [](const DDS_XTypes_TypeIdentifierWithDependencies& ids,
                          DDS_XTypes_TypeKind kind) {
    const auto& others = ids.dependent_typeids;
    return ids.typeid_with_size.type_id._d == kind &&
           std::all_of(others._buffer, others._buffer + others._length,
                       [kind](const auto& other) { return other.type_id._d == kind; });
  };
  return all_are(information.x.minimal, DDS_XTypes_EK_MINIMAL) &&
         all_are(information.x.complete, DDS_XTypes_EK_COMPLETE);
}

void Delete(ddsi_typeinfo_t* information) {
  if (information == nullptr) return;
  ddsi_typeinfo_fini(information);
  dds_free(information);
}

}  // namespace

TypeCode CodeOf(const ddsi_sertype* type) {
  TypeCode code;
  ddsi_typeinfo_t* information = ddsi_sertype_typeinfo(type);
  ddsi_typemap_t* mapping = information != nullptr ? ddsi_sertype_typemap(type) : nullptr;
  if (mapping != nullptr) {
    code.information = SerialisedType(information, DDS_XTypes_TypeInformation_desc);
    code.mapping = SerialisedType(mapping, DDS_XTypes_TypeMapping_desc);
    ddsi_typemap_fini(mapping);
    dds_free(mapping);
  }
  Delete(information);
  return code;
}

TypeCode Checked(TypeCode code) {
  const bool is_readable = IsReadable(code.information, DDS_XTypes_TypeInformation_desc) &&
                           IsReadable(code.mapping, DDS_XTypes_TypeMapping_desc);
  if (!is_readable) return {};
  ddsi_typeinfo_t* information = InformationOf(code);
  const bool is_valid =
      information != nullptr && NamesTypesByHash(*information) && ddsi_typeinfo_valid(information);
  Delete(information);
  return is_valid ? std::move(code) : TypeCode{};
}

ddsi_typeinfo_t* InformationOf(const TypeCode& code) {
  if (code.information.empty()) return nullptr;
  const ddsi_sertype_cdr_data_t cdr = CdrOf(code.information);
  return ddsi_typeinfo_deser(&cdr);
}

ddsi_typemap_t* MappingOf(const TypeCode& code) {
  if (code.mapping.empty()) return nullptr;
  const ddsi_sertype_cdr_data_t cdr = CdrOf(code.mapping);
  return ddsi_typemap_deser(&cdr);
}

bool IsOfType(const ddsi_sertype* type, const TypeCode& code) {
  if (code.information.empty()) return true;
  ddsi_typeinfo_t* its = ddsi_sertype_typeinfo(type);
  ddsi_typeinfo_t* that = InformationOf(code);
  const bool same =
      its != nullptr && that != nullptr && ddsi_typeinfo_equal(its, that, DDSI_TYPE_IGNORE_DEPS);
  Delete(its);
  Delete(that);
  return same;
}

}  // namespace tcs::dds
