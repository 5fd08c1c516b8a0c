// std::random_device of libstdc++. By default it draws by instructions of the processor (rdseed,
// rdrand), which nobody can replace: a virtual machine alone could trap them. So where draws repeat
// std::random_device is told to read the kernel's device instead, which the shim sees.
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include <cstddef>

#include "libtcs_preload/guest.h"
#include "libtcs_preload/random.h"

using namespace tcs::preload;

namespace {

constexpr const char* kInstructions[] = {"default", "hw", "hardware", "rdseed", "rdrand", "rdrnd"};

// std::string, as libstdc++ lays it out: as it has done since GCC 5, and as it did before.
struct Text {
  const char* begin;
  std::size_t size;
  char small[16];
};
struct SharedText {
  std::size_t size, room;
  int more_owners;
  alignas(8) char text[16];
};

constexpr std::size_t kSize = sizeof "/dev/urandom" - 1;
Text g_device{g_device.small, kSize, "/dev/urandom"};
SharedText g_shared_device{kSize, kSize, 0, "/dev/urandom"};
const char* g_shared_begin = g_shared_device.text;

bool DrawsByInstructions(const char* token, std::size_t size) {
  for (const char* name : kInstructions) {
    if (strlen(name) == size && memcmp(name, token, size) == 0) return true;
  }
  return false;
}

using Init = void(void* device, const void* token);

// The function of the caller's own library, where the C++ library is there for some libraries only.
Init* Real(const char* name, const void* caller) {
  void* found = dlsym(RTLD_NEXT, name);
  Dl_info info{};
  if (found == nullptr && dladdr(caller, &info) != 0) {
    void* library = dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
    if (library != nullptr) found = dlsym(library, name);
  }
  if (found == nullptr) abort();  // nobody calls a function that is nowhere
  return reinterpret_cast<Init*>(found);
}

bool AreInstructionsReplaced() { return Current() != nullptr && DrawsRepeat(); }

}  // namespace

// std::random_device::_M_init(const std::string&), which the constructors call. The real functions
// throw exceptions, so that nothing may be left to do after them.
#define TCS_INIT _ZNSt13random_device7_M_initERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEE
#define TCS_INIT_OLD _ZNSt13random_device7_M_initERKSs
#define TCS_NAME(name) TCS_NAME_OF(name)
#define TCS_NAME_OF(name) #name

TCS_EXPORT void TCS_INIT(void* device, const Text* token) {
  Init* real = Real(TCS_NAME(TCS_INIT), __builtin_return_address(0));
  if (AreInstructionsReplaced() && DrawsByInstructions(token->begin, token->size))
    token = &g_device;
  real(device, token);
}

TCS_EXPORT void TCS_INIT_OLD(void* device, const char* const* token) {
  Init* real = Real(TCS_NAME(TCS_INIT_OLD), __builtin_return_address(0));
  if (AreInstructionsReplaced() && DrawsByInstructions(*token, strlen(*token)))
    token = &g_shared_begin;
  real(device, token);
}
