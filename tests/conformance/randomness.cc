// Random numbers: as many as asked for, different each time; under fixed accounting the same in
// each run, which the scenario tests compare.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/uio.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

// From the generator that newer kernels have in their vDSO, for newer C libraries and for Go; 1
// where there is none.
std::uint64_t DrawFromVdso() {
  using Draw = ssize_t(void*, std::size_t, unsigned, void*, std::size_t);
  void* vdso = dlopen("linux-vdso.so.1", RTLD_LAZY | RTLD_NOLOAD);
  auto* draw = vdso == nullptr ? nullptr : reinterpret_cast<Draw*>(dlsym(vdso, "__vdso_getrandom"));
  if (draw == nullptr) return 1;
  std::uint32_t needed[16] = {};
  EXPECT(draw(nullptr, 0, 0, needed, ~std::size_t{0}) == 0 && needed[0] > 0, "what it needs");
  void* state =
      mmap(nullptr, 4096, static_cast<int>(needed[1]), static_cast<int>(needed[2]), -1, 0);
  EXPECT(state != MAP_FAILED, "%s", strerror(errno));
  std::uint64_t word = 0;
  EXPECT(draw(&word, sizeof word, 0, state, needed[0]) == sizeof word, "the vDSO's getrandom");
  munmap(state, 4096);
  return word;
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  std::uint64_t words[9] = {};
  EXPECT(getrandom(&words[0], 8, 0) == 8, "getrandom: %s", strerror(errno));
  EXPECT(getentropy(&words[1], 8) == 0, "getentropy: %s", strerror(errno));
  arc4random_buf(&words[2], 8);
  words[3] = std::uint64_t{arc4random()} << 32 | arc4random();
  words[4] = DrawFromVdso();
  const int device = open("/dev/urandom", O_RDONLY);
  EXPECT(read(device, &words[5], 8) == 8, "/dev/urandom: %s", strerror(errno));
  const iovec halves[] = {{&words[6], 4}, {reinterpret_cast<char*>(&words[6]) + 4, 4}};
  EXPECT(readv(device, halves, 2) == 8, "a list of buffers: %s", strerror(errno));
  close(device);
  for (const int i : {7, 8}) {
    FILE* stream = fopen(i == 7 ? "/dev/urandom" : "/dev/random", "rb");
    EXPECT(stream != nullptr && fread(&words[i], 8, 1, stream) == 1, "%s", strerror(errno));
    fclose(stream);
  }
  for (int i = 0; i < 9; ++i) {
    for (int k = 0; k < i; ++k) EXPECT(words[i] != words[k], "draws %d and %d are equal", k, i);
  }
  for (int i = 0; i < 1000; ++i) EXPECT(arc4random_uniform(10) < 10, "beyond the bound");
  EXPECT(arc4random_uniform(1) == 0 && arc4random_uniform(0) == 0, "nothing to choose from");
  char large[300];
  EXPECT(getentropy(large, sizeof large) == -1 && errno == EIO, "too much entropy");
  for (const std::uint64_t word : words) printf("%016llx\n", (unsigned long long)word);
}
