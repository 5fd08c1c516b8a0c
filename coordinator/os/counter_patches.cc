#include "coordinator/os/counter_patches.h"

#include <elf.h>
#include <fcntl.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "coordinator/os/auxiliary_vector.h"
#include "coordinator/port/unique_fd.h"
#include "shm/machine_code/image.h"
#include "shm/machine_code/replacement_plan.h"
#include "shm/machine_code/stand_in.h"

// Reads CLOCK_MONOTONIC by a system call, as a function that keeps all registers and flags but
// those of rdtsc. Copied into programs, with the counter's rate in its place.
__asm__(
    ".text\n\t.p2align 4\n"
    "tcs_counter_of_kernel:\n\t"
    "pushfq\n\tpushq %rcx\n\tpushq %rsi\n\tpushq %rdi\n\tpushq %r9\n\tpushq %r11\n\t"
    "subq $16, %rsp\n\t"
    "movl $1, %edi\n\tmovq %rsp, %rsi\n\t"
    "xorl %r9d, %r9d\n\t"  // no argument of this call; it marks the shim's own calls
    "movl $228, %eax\n\tsyscall\n\t"
    "imulq $1000000000, (%rsp), %rax\n\taddq 8(%rsp), %rax\n\t"
    "movabsq $0x7c57a7e17c57a7e1, %rcx\n"
    "tcs_counter_rate_end:\n\t"
    "mulq %rcx\n\tshrdq $32, %rdx, %rax\n\tmovq %rax, %rdx\n\tshrq $32, %rdx\n\t"
    "movl %eax, %eax\n\t"
    "addq $16, %rsp\n\t"
    "popq %r11\n\tpopq %r9\n\tpopq %rdi\n\tpopq %rsi\n\tpopq %rcx\n\tpopfq\n\tret\n"
    "tcs_counter_of_kernel_end:\n\t");
extern "C" {
extern const std::uint8_t tcs_counter_of_kernel[], tcs_counter_rate_end[],
    tcs_counter_of_kernel_end[];
}

namespace tcs {

namespace {

using shm::Code;
using shm::CodeRange;

struct Section {
  std::uint64_t address = 0, size = 0;
};

bool Read(int fd, void* to, std::size_t size, std::uint64_t offset) {
  return pread(fd, to, size, static_cast<off_t>(offset)) == static_cast<ssize_t>(size);
}

// The section with the entries for unwinding; empty: there is none.
Section UnwindSection(int fd, const Elf64_Ehdr& header) {
  if (header.e_shentsize != sizeof(Elf64_Shdr) || header.e_shstrndx >= header.e_shnum) return {};
  std::vector<Elf64_Shdr> sections(header.e_shnum);
  if (!Read(fd, sections.data(), sections.size() * sizeof(Elf64_Shdr), header.e_shoff)) return {};
  for (const Elf64_Shdr& one : sections) {
    char name[sizeof ".eh_frame"] = {};
    if (!Read(fd, name, sizeof name, sections[header.e_shstrndx].sh_offset + one.sh_name)) continue;
    if (memcmp(name, ".eh_frame", sizeof name) == 0) return {one.sh_addr, one.sh_size};
  }
  return {};
}

// A file's segments as they lie in memory. Behind them is a table of the functions, for files that
// have none, such as static programs.
class LaidOut {
 public:
  explicit LaidOut(const std::string& path) {
    const UniqueFd file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
    Elf64_Ehdr header{};
    if (file.get() < 0 || !Read(file.get(), &header, sizeof header, 0) ||
        memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_ident[EI_CLASS] != ELFCLASS64 ||
        header.e_machine != EM_X86_64 || header.e_phentsize != sizeof(Elf64_Phdr)) {
      return;
    }
    segments_.resize(header.e_phnum);
    if (!Read(file.get(), segments_.data(), segments_.size() * sizeof(Elf64_Phdr),
              header.e_phoff)) {
      return;
    }
    std::uint64_t least = ~std::uint64_t{0}, most = 0;
    for (const Elf64_Phdr& one : segments_) {
      if (one.p_type != PT_LOAD) continue;
      least = std::min(least, one.p_vaddr / kPage * kPage);
      most = std::max(most, one.p_vaddr + one.p_filesz + kPage);
    }
    if (most <= least || most - least > kMostSize) return;
    const Section unwind = UnwindSection(file.get(), header);
    const bool has_section = unwind.address >= least && unwind.size < most - least &&
                             unwind.address + unwind.size <= most;
    const std::size_t table_at = most - least;
    size_ = table_at + kPage + (has_section ? unwind.size : 0);
    void* at = mmap(nullptr, size_, PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (at == MAP_FAILED) return;
    memory_ = static_cast<std::uint8_t*>(at);
    for (const Elf64_Phdr& one : segments_) {
      if (one.p_type == PT_LOAD &&
          !Read(file.get(), memory_ + (one.p_vaddr - least), one.p_filesz, one.p_offset)) {
        return;
      }
    }
    image_ = {memory_ - least, segments_.data(), segments_.size()};
    functions_ = image_.Functions();
    if (image_.Segment(PT_GNU_EH_FRAME) == nullptr && has_section) {
      ListFunctions({image_.At(unwind.address), image_.At(unwind.address + unwind.size)},
                    memory_ + table_at);
    }
  }
  ~LaidOut() {
    if (memory_ != nullptr) munmap(memory_, size_);
  }
  LaidOut(const LaidOut&) = delete;
  LaidOut& operator=(const LaidOut&) = delete;

  // The image has no segments where the file is no such program.
  const shm::Image& image() const { return image_; }
  const shm::UnwindTable& functions() const { return functions_; }

  static constexpr std::uint64_t kPage = 4096;

 private:
  static constexpr std::uint64_t kMostSize = 1 << 30;

  // Writes such a table as linkers make, at `to`, where there is room.
  void ListFunctions(CodeRange entries, std::uint8_t* to) {
    constexpr std::size_t kLeastEntry = 16;
    std::vector<std::pair<std::int32_t, std::int32_t>> list;  // begin and entry, from the table
    std::uint32_t size = 0, of_common = 0;
    for (Code at = entries.begin; entries.end - at > std::ptrdiff_t{kLeastEntry};
         at += sizeof size + size) {
      memcpy(&size, at, sizeof size);
      memcpy(&of_common, at + 4, sizeof of_common);
      if (size == 0 || size > static_cast<std::size_t>(entries.end - at)) break;
      std::int32_t begin = 0;
      memcpy(&begin, at + 8, sizeof begin);
      if (of_common != 0) {
        list.emplace_back(static_cast<std::int32_t>(at + 8 + begin - to),
                          static_cast<std::int32_t>(at - to));
      }
    }
    std::ranges::sort(list);
    const auto count = static_cast<std::uint32_t>(list.size());
    const std::uint8_t head[] = {1, 0x1b, 0x03, 0x3b, 0, 0, 0, 0};
    memcpy(to, head, sizeof head);
    memcpy(to + 8, &count, sizeof count);
    memcpy(to + 12, list.data(), list.size() * sizeof list[0]);
    functions_ = shm::UnwindTable(to, {memory_, memory_ + size_}, image_.Whole());
  }

  std::vector<Elf64_Phdr> segments_;
  std::uint8_t* memory_ = nullptr;
  std::size_t size_ = 0;
  shm::Image image_;
  shm::UnwindTable functions_;
};

std::vector<std::uint8_t> ReadFunction(std::uint64_t ticks_per_ns_q32) {
  std::vector<std::uint8_t> function(tcs_counter_of_kernel, tcs_counter_of_kernel_end);
  const auto rate_end = static_cast<std::size_t>(tcs_counter_rate_end - tcs_counter_of_kernel);
  memcpy(&function[rate_end - sizeof ticks_per_ns_q32], &ticks_per_ns_q32, sizeof ticks_per_ns_q32);
  return function;
}

// Behind a segment's code its last page has room that nothing uses.
class Segment {
 public:
  Segment(const shm::Image& image, CodeRange code, const Elf64_Phdr& header,
          CounterPatches* patches)
      : image_(image), place_(code.end), patches_(patches) {
    const std::uint64_t end = header.p_vaddr + header.p_filesz;
    if (header.p_memsz == header.p_filesz) {
      room_end_ = code.end + (LaidOut::kPage - end % LaidOut::kPage) % LaidOut::kPage;
    }
  }

  void Add(const shm::Replacements& found, std::uint64_t ticks_per_ns_q32) {
    const std::vector<std::uint8_t> function = ReadFunction(ticks_per_ns_q32);
    const Code reads = place_;
    const bool has_function = Put(function);
    for (std::size_t i = 0; i < found.count(); ++i) {
      if (!has_function || !Lead(found[i], reads))
        patches_->left.push_back(AddressOf(found[i].read));
    }
  }

 private:
  static constexpr std::size_t kMostOfOne = 160;

  std::uint64_t AddressOf(Code at) const { return static_cast<std::uint64_t>(at - image_.base); }

  bool Put(const std::vector<std::uint8_t>& bytes) {
    if (room_end_ == nullptr || bytes.size() > static_cast<std::size_t>(room_end_ - place_)) {
      return false;
    }
    patches_->patches.push_back({AddressOf(place_), bytes});
    place_ += bytes.size();
    return true;
  }

  bool Lead(const shm::Replacement& replacement, Code reads) {
    std::vector<std::uint8_t> bytes(kMostOfOne);
    shm::CodeWriter writer(bytes.data(), place_, bytes.size());
    shm::WriteStandIn(writer, replacement, {}, [&](shm::CodeWriter& code, Code read) {
      code.Bytes({0x48, 0x8d, 0x64, 0x24, 0x80});           // lea -128(%rsp), %rsp
      code.Leading({0xe8}, reads);                          // call
      code.Bytes({0x48, 0x8d, 0xa4, 0x24, 0x80, 0, 0, 0});  // lea 128(%rsp), %rsp
      // rdtscp tells a processor, too: the first one.
      if (read[1] != 0x31) code.Bytes({0xb9, 0, 0, 0, 0});  // mov $0, %ecx
    });
    bytes.resize(writer.size());
    const Code stand_in = place_;
    if (!writer.is_sound() || !Put(bytes)) return false;
    return shm::LeadToStandIn(replacement, stand_in,
                              [&](Code at, const std::uint8_t* what, std::size_t size) {
                                patches_->patches.push_back({AddressOf(at), {what, what + size}});
                              });
  }

  const shm::Image& image_;
  Code place_, room_end_ = nullptr;
  CounterPatches* const patches_;
};

}  // namespace

CounterPatches PatchesOf(const std::string& executable, std::uint64_t ticks_per_ns_q32) {
  CounterPatches patches;
  const LaidOut file(executable);
  const shm::Image& image = file.image();
  const auto room = std::make_unique<shm::PlanRoom>();
  image.ForEachCode([&](CodeRange code, const Elf64_Phdr& header) {
    shm::Replacements found(*room);
    found.Plan(code, file.functions(), [&](Code read) {
      patches.left.push_back(static_cast<std::uint64_t>(read - image.base));
    });
    if (found.count() > 0) Segment(image, code, header, &patches).Add(found, ticks_per_ns_q32);
  });
  return patches;
}

bool WritePatches(pid_t pid, const CounterPatches& patches, std::uint64_t* first_left) {
  *first_left = 0;
  if (patches.patches.empty() && patches.left.empty()) return true;
  std::map<std::uint64_t, std::uint64_t> told = ReadAuxiliaryVector(pid);
  const UniqueFd memory(
      open(("/proc/" + std::to_string(pid) + "/mem").c_str(), O_RDWR | O_CLOEXEC));
  if (memory.get() < 0 || told[AT_PHDR] == 0) return false;
  // The first segment header of a position-independent program says where the program lies.
  std::uint64_t base = 0;
  for (std::uint64_t i = 0; i < told[AT_PHNUM]; ++i) {
    Elf64_Phdr segment{};
    const auto at = static_cast<off_t>(told[AT_PHDR] + i * sizeof segment);
    if (pread(memory.get(), &segment, sizeof segment, at) != sizeof segment) return false;
    if (segment.p_type == PT_LOAD && segment.p_offset == 0) {
      base = told[AT_PHDR] / LaidOut::kPage * LaidOut::kPage - segment.p_vaddr;
    }
  }
  for (const CounterPatches::Patch& patch : patches.patches) {
    const auto at = static_cast<off_t>(base + patch.address);
    if (pwrite(memory.get(), patch.bytes.data(), patch.bytes.size(), at) !=
        static_cast<ssize_t>(patch.bytes.size())) {
      return false;
    }
  }
  if (!patches.left.empty()) *first_left = base + patches.left.front();
  return true;
}

}  // namespace tcs
