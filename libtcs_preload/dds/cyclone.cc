#include "libtcs_preload/dds/cyclone.h"

#include <dlfcn.h>
#include <link.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "libtcs_preload/dds/say.h"

namespace tcs::dds {
namespace {

constexpr char kLibrary[] = "libddsc.so.0debian";
constexpr char kFile[] = "libddsc.so." DDS_VERSION;

RealCalls g_real;

bool FindAll(const Link& link, void* library) {
#define TCS_DDS_FIND(name)                                                                \
  g_real.name = reinterpret_cast<decltype(g_real.name)>(link.look_up(library, #name));    \
  if (g_real.name == nullptr) {                                                           \
    Say("the program's %s has no function %s, so its DDS uses sockets", kLibrary, #name); \
    return false;                                                                         \
  }
  TCS_DDS_CALLS(TCS_DDS_FIND)
#undef TCS_DDS_FIND
  return true;
}

}  // namespace

const RealCalls& Real() { return g_real; }

bool FindCyclone(const Link& link) {
  void* library = dlopen(kLibrary, RTLD_LAZY | RTLD_NOLOAD);
  link_map* map = nullptr;
  if (library == nullptr || dlinfo(library, RTLD_DI_LINKMAP, &map) != 0) {
    Say("this program has no %s, so its DDS uses sockets", kLibrary);
    return false;
  }
  // The package's file carries the version in its name; nothing else in the library does.
  char* file = realpath(map->l_name, nullptr);
  const char* base = file != nullptr ? strrchr(file, '/') : nullptr;
  const bool same = base != nullptr && strcmp(base + 1, kFile) == 0;
  if (!same) {
    Say("DDS in shared memory needs %s, but this program has %s, so its DDS uses sockets", kFile,
        file != nullptr ? file : map->l_name);
  }
  free(file);
  return same && FindAll(link, library);
}

bool LayoutIsAsCompiled(const ddsi_domaingv& gv, const ddsi_participant& participant) {
  constexpr std::uint32_t kEclipse = 0x0110;
  return gv.ppguid_base.prefix.u[0] >> 16 == kEclipse &&
         participant.e.guid.prefix.u[0] >> 16 == kEclipse &&
         participant.e.guid.entityid.u == NN_ENTITYID_PARTICIPANT && participant.e.gv == &gv &&
         participant.avail_entityids.x.min == 1 && gv.m_tkmap != nullptr &&
         gv.entity_index != nullptr;
}

}  // namespace tcs::dds
