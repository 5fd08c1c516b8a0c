#include "coordinator/os/futex_key.h"

#include <fcntl.h>
#include <linux/ioctl.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <fstream>
#include <optional>
#include <string>

#include "coordinator/port/unique_fd.h"

namespace tcs {

namespace {

struct Mapping {
  bool is_shared = false;
  std::uint64_t first = 0, offset = 0, inode = 0;
  unsigned major = 0, minor = 0;
};

// The query of linux/fs.h since 6.11: it tells one mapping, without all the text of the others.
struct MappingQuery {
  std::uint64_t size, query_flags, query_addr;
  std::uint64_t vma_start, vma_end, vma_flags, vma_page_size, vma_offset;
  std::uint64_t inode;
  std::uint32_t dev_major, dev_minor, vma_name_size, build_id_size;
  std::uint64_t vma_name_addr, build_id_addr;
};
static_assert(sizeof(MappingQuery) == 104);
constexpr unsigned long kQueryMapping = _IOWR(0x9f /* PROCFS_IOCTL_MAGIC */, 17, MappingQuery);
constexpr std::uint64_t kIsShared = 0x08;

// None: this kernel does not answer, or the process has gone.
std::optional<Mapping> AskForMapping(const std::string& maps, std::uint64_t address) {
  const UniqueFd fd(open(maps.c_str(), O_RDONLY | O_CLOEXEC));
  if (!fd) return std::nullopt;
  MappingQuery query{};
  query.size = sizeof query;
  query.query_addr = address;
  if (ioctl(fd.get(), kQueryMapping, &query) != 0) return std::nullopt;
  return Mapping{(query.vma_flags & kIsShared) != 0,
                 query.vma_start,
                 query.vma_offset,
                 query.inode,
                 query.dev_major,
                 query.dev_minor};
}

std::optional<Mapping> ReadMapping(const std::string& path, std::uint64_t address) {
  std::ifstream maps(path);
  for (std::string line; std::getline(maps, line);) {
    unsigned long long first = 0, last = 0, offset = 0, inode = 0;
    unsigned major = 0, minor = 0;
    char rights[5] = "";
    if (sscanf(line.c_str(), "%llx-%llx %4s %llx %x:%x %llu", &first, &last, rights, &offset,
               &major, &minor, &inode) == 7 &&
        address >= first && address < last) {
      return Mapping{rights[3] == 's', first, offset, inode, major, minor};
    }
  }
  return std::nullopt;
}

}  // namespace

FutexKey KeyOf(pid_t pid, std::uint64_t address, bool is_private) {
  if (is_private) return {pid, 0, address};
  const std::string path = "/proc/" + std::to_string(pid) + "/maps";
  std::optional<Mapping> mapping = AskForMapping(path, address);
  if (!mapping.has_value()) mapping = ReadMapping(path, address);
  if (!mapping.has_value() || !mapping->is_shared) return {pid, 0, address};
  const std::uint64_t device = std::uint64_t{mapping->major} << 20 | mapping->minor;
  return {0, device << 40 ^ mapping->inode, address - mapping->first + mapping->offset};
}

}  // namespace tcs
