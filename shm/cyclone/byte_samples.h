// Samples for Cyclone DDS that are the bytes that they travel as, and what a type of such samples
// has in common with others: for programs that carry samples without knowing what is in them (the
// gateway, and libtcs_dds.so for types that its program does not have). A sample's key is not
// known: all samples of a type are one instance.
//
// Unlike the rest of shm/ this file needs libddsc and libstdc++, and allocates: it is for those two
// programs alone.
#pragma once

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace tcs::cyclone {

struct ByteSample : ddsi_serdata {
  std::vector<std::byte> bytes;
};

inline const ByteSample& ByteSampleOf(const ddsi_serdata* sample) {
  return *static_cast<const ByteSample*>(sample);
}

// The caller owns the returned sample.
inline ByteSample* NewByteSample(const ddsi_sertype* type, ddsi_serdata_kind kind,
                                 std::vector<std::byte> bytes) {
  auto* sample = new ByteSample;
  ddsi_serdata_init(sample, type, kind);
  sample->hash = type->serdata_basehash;
  sample->bytes = std::move(bytes);
  return sample;
}

// The operations that Cyclone calls on such a sample, in the order of ddsi_serdata_ops.
struct ByteSampleCalls {
  static bool SameKey(const ddsi_serdata*, const ddsi_serdata*) { return true; }

  static std::uint32_t Size(const ddsi_serdata* sample) {
    return static_cast<std::uint32_t>(ByteSampleOf(sample).bytes.size());
  }

  // Fragments are in order, and may overlap.
  static ddsi_serdata* FromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                                     const nn_rdata* fragment, std::size_t size) {
    std::vector<std::byte> bytes;
    bytes.reserve(size);
    for (; fragment != nullptr; fragment = fragment->nextfrag) {
      if (fragment->maxp1 <= bytes.size()) continue;
      const auto* payload = reinterpret_cast<const std::byte*>(
          NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment)));
      const std::size_t known = bytes.size() - fragment->min;
      bytes.insert(bytes.end(), payload + known, payload + (fragment->maxp1 - fragment->min));
    }
    bytes.resize(size);
    return NewByteSample(type, kind, std::move(bytes));
  }

  static ddsi_serdata* FromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind,
                                  ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* pieces,
                                  std::size_t size) {
    std::vector<std::byte> bytes;
    bytes.reserve(size);
    for (ddsrt_msg_iovlen_t i = 0; i < count; ++i) {
      const auto* start = static_cast<const std::byte*>(pieces[i].iov_base);
      bytes.insert(bytes.end(), start, start + pieces[i].iov_len);
    }
    bytes.resize(size);
    return NewByteSample(type, kind, std::move(bytes));
  }

  static ddsi_serdata* FromKeyHash(const ddsi_sertype* type, const ddsi_keyhash*) {
    return NewByteSample(type, SDK_KEY, {});
  }
  static ddsi_serdata* FromSample(const ddsi_sertype*, ddsi_serdata_kind, const void*) {
    return nullptr;
  }

  static void ToBytes(const ddsi_serdata* sample, std::size_t offset, std::size_t size, void* to) {
    std::memcpy(to, ByteSampleOf(sample).bytes.data() + offset, size);
  }
  static ddsi_serdata* ToBytesInPlace(const ddsi_serdata* sample, std::size_t offset,
                                      std::size_t size, ddsrt_iovec_t* piece) {
    piece->iov_base = const_cast<std::byte*>(ByteSampleOf(sample).bytes.data() + offset);
    piece->iov_len = size;
    return ddsi_serdata_ref(sample);
  }
  static void BytesDone(ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); }

  static bool ToSample(const ddsi_serdata*, void*, void**, void*) { return false; }
  static ddsi_serdata* ToUntyped(const ddsi_serdata* sample) {
    ByteSample* untyped = NewByteSample(sample->type, SDK_KEY, {});
    untyped->type = nullptr;
    return untyped;
  }
  static bool UntypedToSample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
    return false;
  }

  static void Free(ddsi_serdata* sample) { delete static_cast<ByteSample*>(sample); }
  static std::size_t Print(const ddsi_sertype*, const ddsi_serdata*, char* to, std::size_t size) {
    if (size > 0) *to = '\0';
    return 0;
  }
  static void KeyHash(const ddsi_serdata*, ddsi_keyhash* hash, bool) {
    std::memset(hash, 0, sizeof *hash);
  }
};

inline const ddsi_serdata_ops kByteSampleOperations = [] {
  ddsi_serdata_ops ops{};
  ops.eqkey = ByteSampleCalls::SameKey;
  ops.get_size = ByteSampleCalls::Size;
  ops.from_ser = ByteSampleCalls::FromFragments;
  ops.from_ser_iov = ByteSampleCalls::FromPieces;
  ops.from_keyhash = ByteSampleCalls::FromKeyHash;
  ops.from_sample = ByteSampleCalls::FromSample;
  ops.to_ser = ByteSampleCalls::ToBytes;
  ops.to_ser_ref = ByteSampleCalls::ToBytesInPlace;
  ops.to_ser_unref = ByteSampleCalls::BytesDone;
  ops.to_sample = ByteSampleCalls::ToSample;
  ops.to_untyped = ByteSampleCalls::ToUntyped;
  ops.untyped_to_sample = ByteSampleCalls::UntypedToSample;
  ops.free = ByteSampleCalls::Free;
  ops.print = ByteSampleCalls::Print;
  ops.get_keyhash = ByteSampleCalls::KeyHash;
  return ops;
}();

// The operations that every type of such samples has in common. `Type` is a struct that derives
// from ddsi_sertype. `equal` and `hash` are left to each type: Cyclone has compared the names
// already.
template <typename Type>
ddsi_sertype_ops ByteTypeOperations() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete static_cast<Type*>(type);
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void** samples, const ddsi_sertype*, void*, std::size_t,
                           std::size_t count) { std::fill_n(samples, count, nullptr); };
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  return ops;
}

}  // namespace tcs::cyclone
