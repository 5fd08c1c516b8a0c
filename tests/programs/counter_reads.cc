// counter_reads FILE...: of each program or library the reads of the cycle counter in its code, and
// how many of them can be replaced: a line FILE READS REPLACED, where there are any. The table in
// docs/LIMITATIONS.md was made by it, of the libraries that most files of a machine need:
//   for f in /usr/bin/* /usr/lib/x86_64-linux-gnu/*.so*; do readelf -d "$f"; done 2>/dev/null |
//     awk '/NEEDED/ {print $5}' | sort | uniq -c | sort -rn | head -200
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "shm/machine_code/image.h"
#include "shm/machine_code/replacement_plan.h"

using namespace tcs::shm;

namespace {

std::vector<char> Read(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

int main(int argc, char** argv) {
  const auto room = std::make_unique<PlanRoom>();
  for (int i = 1; i < argc; ++i) {
    const std::vector<char> file = Read(argv[i]);
    Elf64_Ehdr header;
    if (file.size() < sizeof header || memcmp(file.data(), ELFMAG, SELFMAG) != 0) continue;
    memcpy(&header, file.data(), sizeof header);
    std::vector<Elf64_Phdr> segments(header.e_phnum);
    if (header.e_phoff + segments.size() * sizeof(Elf64_Phdr) > file.size()) continue;
    memcpy(segments.data(), file.data() + header.e_phoff, segments.size() * sizeof(Elf64_Phdr));
    std::uint64_t least = ~std::uint64_t{0}, most = 0;
    for (const Elf64_Phdr& one : segments) {
      if (one.p_type != PT_LOAD) continue;
      least = std::min<std::uint64_t>(least, one.p_vaddr / 4096 * 4096);
      most = std::max<std::uint64_t>(most, one.p_vaddr + one.p_filesz);
    }
    if (most <= least) continue;
    std::vector<std::uint8_t> memory(most - least);
    for (const Elf64_Phdr& one : segments) {
      if (one.p_type != PT_LOAD || one.p_offset + one.p_filesz > file.size()) continue;
      memcpy(&memory[one.p_vaddr - least], &file[one.p_offset], one.p_filesz);
    }
    const Image image{memory.data() - least, segments.data(), segments.size()};
    const UnwindTable functions = image.Functions();
    std::size_t replaced = 0, left = 0;
    image.ForEachCode([&](CodeRange code, const Elf64_Phdr&) {
      Replacements found(*room);
      found.Plan(code, functions, [&](Code) { ++left; });
      for (std::size_t k = 0; k < found.count(); ++k) {
        for (Code at = found[k].moved.begin; at < found[k].moved.end;) {
          replaced += CounterReadSize(at, code.end) != 0;
          at += Decode(at, code.end).size;
        }
      }
    });
    if (replaced + left > 0) std::printf("%s %zu %zu\n", argv[i], replaced + left, replaced);
  }
}
