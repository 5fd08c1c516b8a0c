// What a conformance program tells: events, one per line, that are the same in every run; or the
// one sentence that says why it gave up.
#pragma once

#include <dds/dds.h>

namespace dds_test {

// Any thread, listeners included.
__attribute__((format(printf, 1, 2))) void Event(const char* format, ...);

__attribute__((format(printf, 1, 2))) [[noreturn]] void Fail(const char* format, ...);

// The name of a return code: "ok", or Cyclone's name of the error.
const char* Code(dds_return_t code);

// What a call returned, which must be no error.
template <class T>
T NoError(T result, const char* call) {
  if (result < 0) Fail("%s: %s", call, Code(static_cast<dds_return_t>(result)));
  return result;
}
#define OK(call) ::dds_test::NoError((call), #call)

}  // namespace dds_test
