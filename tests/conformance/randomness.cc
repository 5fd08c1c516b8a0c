// Random numbers: as many as asked for, different each time; under fixed accounting the same in
// each run, which the scenario tests compare.
#include <dlfcn.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/syscall.h>
#include <sys/uio.h>

#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

std::vector<std::uint64_t> g_words;

// How a program draws eight bytes: what the call returned.
template <class Call>
void Draw(const char* what, Call call) {
  std::uint64_t word = 0;
  const long got = call(reinterpret_cast<char*>(&word));
  EXPECT(got == 8, "%s: %ld, %s", what, got, strerror(errno));
  for (const std::uint64_t before : g_words) EXPECT(word != before, "%s: drawn before", what);
  g_words.push_back(word);
  printf("%016llx %s\n", static_cast<unsigned long long>(word), what);
}

// From the generator that newer kernels have in their vDSO, for newer C libraries and for Go.
using DrawOfVdso = ssize_t(void*, std::size_t, unsigned, void*, std::size_t);
long DrawFromVdso(DrawOfVdso* draw, char* word) {
  std::uint32_t needed[16] = {};
  EXPECT(draw(nullptr, 0, 0, needed, ~std::size_t{0}) == 0 && needed[0] > 0, "what it needs");
  void* state =
      mmap(nullptr, 4096, static_cast<int>(needed[1]), static_cast<int>(needed[2]), -1, 0);
  EXPECT(state != MAP_FAILED, "%s", strerror(errno));
  const ssize_t got = draw(word, 8, 0, state, needed[0]);
  munmap(state, 4096);
  return got;
}

void DrawByCalls() {
  Draw("getrandom", [](char* word) { return getrandom(word, 8, 0); });
  Draw("getentropy", [](char* word) { return getentropy(word, 8) == 0 ? 8 : -1; });
  Draw("arc4random_buf", [](char* word) { return arc4random_buf(word, 8), 8; });
  Draw("arc4random", [](char* word) {
    const std::uint32_t halves[] = {arc4random(), arc4random()};
    return memcpy(word, halves, 8), 8;
  });
  Draw("a raw getrandom",
       [](char* word) { return syscall(SYS_getrandom, word, 8, GRND_NONBLOCK); });
  void* vdso = dlopen("linux-vdso.so.1", RTLD_LAZY | RTLD_NOLOAD);
  auto* of_vdso =
      vdso == nullptr ? nullptr : reinterpret_cast<DrawOfVdso*>(dlsym(vdso, "__vdso_getrandom"));
  if (of_vdso != nullptr) {
    Draw("the vDSO's getrandom", [=](char* word) { return DrawFromVdso(of_vdso, word); });
  }
  for (int i = 0; i < 1000; ++i) EXPECT(arc4random_uniform(10) < 10, "beyond the bound");
  EXPECT(arc4random_uniform(1) == 0 && arc4random_uniform(0) == 0, "nothing to choose from");
  char large[300];
  EXPECT(getentropy(large, sizeof large) == -1 && errno == EIO, "too much entropy");
  EXPECT(syscall(SYS_getrandom, large, 8, 0x100) == -1 && errno == EINVAL, "a wrong flag");
  EXPECT(syscall(SYS_getrandom, large, 8, GRND_RANDOM | GRND_INSECURE) == -1 && errno == EINVAL,
         "flags that contradict each other");
  EXPECT(syscall(SYS_getrandom, 1, 8, 0) == -1 && errno == EFAULT, "no memory");
}

iovec* Halves(char* word) {
  static iovec halves[2];
  halves[0] = {word, 4};
  halves[1] = {word + 4, 4};
  return halves;
}

// Of a device, under whatever name: what it is decides.
void DrawFrom(const char* device) {
  const int fd = open(device, O_RDONLY);
  Draw("read", [=](char* word) { return read(fd, word, 8); });
  Draw("readv", [=](char* word) { return readv(fd, Halves(word), 2); });
  Draw("pread", [=](char* word) { return pread(fd, word, 8, 0); });
  Draw("pread64", [=](char* word) { return pread64(fd, word, 8, 0); });
  Draw("preadv", [=](char* word) { return preadv(fd, Halves(word), 2, 0); });
  Draw("preadv64", [=](char* word) { return preadv64(fd, Halves(word), 2, 0); });
  Draw("a raw read", [=](char* word) { return syscall(SYS_read, fd, word, 8); });
  Draw("a raw readv", [=](char* word) { return syscall(SYS_readv, fd, Halves(word), 2); });
  EXPECT(syscall(SYS_read, fd, 1, 8) == -1 && errno == EFAULT, "no memory");
  EXPECT(syscall(SYS_read, fd, nullptr, 0) == 0, "nothing asked for");
  std::vector<char> many(100'000);
  EXPECT(syscall(SYS_read, fd, many.data(), many.size()) == static_cast<long>(many.size()), "many");
  FILE* stream = fdopen(fd, "rb");
  Draw("a stream of a descriptor",
       [=](char* word) { return static_cast<long>(fread(word, 1, 8, stream)); });
  EXPECT(fclose(stream) == 0, "%s", strerror(errno));

  const long raw = syscall(SYS_openat, AT_FDCWD, device, O_RDONLY);
  Draw("opened raw", [=](char* word) { return read(static_cast<int>(raw), word, 8); });
  EXPECT(dup2(static_cast<int>(raw), STDIN_FILENO) == STDIN_FILENO, "%s", strerror(errno));
  close(static_cast<int>(raw));
  Draw("the standard input",
       [](char* word) { return static_cast<long>(fread(word, 1, 8, stdin)); });
  for (auto* open_stream : {&fopen, &fopen64}) {
    FILE* file = open_stream(device, "rb");
    Draw("a stream", [=](char* word) { return static_cast<long>(fread(word, 1, 8, file)); });
    fclose(file);
  }
  std::ifstream file(device, std::ios::binary);
  Draw("a stream of C++", [&](char* word) { return file.read(word, 8).gcount(); });
}

void DrawByCpp() {
  for (const char* token : {"default", "rdrand", "rdseed", "/dev/urandom"}) {
    std::random_device device(token);
    Draw("std::random_device", [&](char* word) {
      const std::uint32_t halves[] = {device(), device()};
      return memcpy(word, halves, 8), 8;
    });
  }
  try {
    std::random_device device("no such token");
    EXPECT(false, "a wrong token is taken");
  } catch (const std::runtime_error&) {
  }
}

// The first eight bytes of 128 bits, 6 of which say what it is.
void TakeUuid(const char* what, const std::string& text) {
  EXPECT(text.size() == 37 && text[36] == '\n', "%s: '%s'", what, text.c_str());
  Draw(what, [&](char* word) {
    unsigned parts[5];
    unsigned long node;
    EXPECT(sscanf(text.c_str(), "%8x-%4x-4%3x-%4x-%12lx", &parts[0], &parts[1], &parts[2],
                  &parts[3], &node) == 5,
           "%s: '%s'", what, text.c_str());
    EXPECT(parts[3] >> 14 == 2, "%s: its variant is %x", what, parts[3] >> 12);
    const std::uint64_t value = std::uint64_t{parts[0]} << 32 | (node & ~0u);
    return memcpy(word, &value, 8), 8;
  });
}

void DrawUuids() {
  constexpr char kFile[] = "/proc/sys/kernel/random/uuid";
  char text[100];
  const int fd = open(kFile, O_RDONLY);
  long got = read(fd, text, sizeof text);
  TakeUuid("an identifier", {text, static_cast<std::size_t>(got)});
  EXPECT(read(fd, text, sizeof text) == 0, "there is more");
  lseek(fd, 0, SEEK_SET);
  got = syscall(SYS_read, fd, text, sizeof text);
  TakeUuid("an identifier, read raw", {text, static_cast<std::size_t>(got)});
  EXPECT(syscall(SYS_read, fd, text, sizeof text) == 0, "there is more");
  close(fd);
  FILE* stream = fopen(kFile, "r");
  EXPECT(fgets(text, sizeof text, stream) == text, "%s", strerror(errno));
  TakeUuid("an identifier of a stream", text);
  EXPECT(fgets(text, sizeof text, stream) == nullptr && feof(stream) != 0, "there is more");
  fclose(stream);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  DrawByCalls();
  DrawFrom("/dev/urandom");
  DrawFrom("/dev/random");
  DrawFrom("/proc/self/root/dev/urandom");
  DrawByCpp();
  DrawUuids();
}
