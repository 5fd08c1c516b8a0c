// Random numbers: as many as asked for, different each time; under fixed accounting the same in
// each run, which the scenario tests compare.
#include <sys/random.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

int main(int argc, char** argv) {
  Begin(argc, argv);
  std::uint64_t words[5] = {};
  EXPECT(getrandom(&words[0], 8, 0) == 8, "getrandom: %s", strerror(errno));
  EXPECT(getentropy(&words[1], 8) == 0, "getentropy: %s", strerror(errno));
  arc4random_buf(&words[2], 8);
  words[3] = std::uint64_t{arc4random()} << 32 | arc4random();
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < i; ++k) EXPECT(words[i] != words[k], "draws %d and %d are equal", k, i);
  }
  for (int i = 0; i < 1000; ++i) EXPECT(arc4random_uniform(10) < 10, "beyond the bound");
  EXPECT(arc4random_uniform(1) == 0 && arc4random_uniform(0) == 0, "nothing to choose from");
  char large[300];
  EXPECT(getentropy(large, sizeof large) == -1 && errno == EIO, "too much entropy");
  for (const std::uint64_t word : words) printf("%016llx\n", (unsigned long long)word);
}
