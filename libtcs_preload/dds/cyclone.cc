#include "libtcs_preload/dds/cyclone.h"

#include <dlfcn.h>
#include <link.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

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

// Whether a segment of notes has a GNU build id of these hexadecimal digits.
bool HasBuildId(const char* notes, std::size_t size, std::string_view digits) {
  constexpr std::size_t kNameSize = 4;  // "GNU" and its zero
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes, sizeof note);
    const std::size_t name_size = (note.n_namesz + std::size_t{3}) & ~std::size_t{3};
    const std::size_t whole =
        sizeof note + name_size + ((note.n_descsz + std::size_t{3}) & ~std::size_t{3});
    if (whole > size) return false;
    const char* name = notes + sizeof note;
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == kNameSize &&
        std::memcmp(name, "GNU", kNameSize) == 0) {
      std::string id;
      for (std::size_t i = 0; i < note.n_descsz; ++i) {
        constexpr char kDigits[] = "0123456789abcdef";
        const auto byte = static_cast<unsigned char>(name[name_size + i]);
        id += {kDigits[byte >> 4], kDigits[byte & 15]};
      }
      return id == digits;
    }
    notes += whole;
    size -= whole;
  }
  return false;
}

bool IsBuild(const link_map& map, std::string_view digits) {
  struct Search {
    ElfW(Addr) address;
    std::string_view digits;
  } search{map.l_addr, digits};
  const auto look = [](dl_phdr_info* info, std::size_t, void* data) {
    const auto& sought = *static_cast<const Search*>(data);
    if (info->dlpi_addr != sought.address) return 0;
    for (int i = 0; i < info->dlpi_phnum; ++i) {
      const ElfW(Phdr)& header = info->dlpi_phdr[i];
      if (header.p_type != PT_NOTE) continue;
      const auto* notes = reinterpret_cast<const char*>(info->dlpi_addr + header.p_vaddr);
      if (HasBuildId(notes, header.p_memsz, sought.digits)) return 1;
    }
    return -1;
  };
  return !digits.empty() && dl_iterate_phdr(look, &search) == 1;
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
  // The very library that this one was compiled for, or Debian's file of its version: a later build
  // of the package carries the version in its name; nothing else in the library does.
  char* file = realpath(map->l_name, nullptr);
  const char* base = file != nullptr ? strrchr(file, '/') : nullptr;
  const bool same =
      IsBuild(*map, TCS_DDSC_BUILD_ID) || (base != nullptr && strcmp(base + 1, kFile) == 0);
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
