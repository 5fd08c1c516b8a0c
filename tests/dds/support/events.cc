#include "tests/dds/support/events.h"

#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include <string>

namespace dds_test {

namespace {

void Line(FILE* to, const char* format, va_list arguments) {
  const std::string line = std::string(format) + "\n";
  vfprintf(to, line.c_str(), arguments);
  fflush(to);
}

}  // namespace

void Event(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  Line(stdout, format, arguments);
  va_end(arguments);
}

void Fail(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  Line(stderr, format, arguments);
  va_end(arguments);
  _exit(1);
}

const char* Code(dds_return_t code) { return code >= 0 ? "ok" : dds_strretcode(code); }

}  // namespace dds_test
